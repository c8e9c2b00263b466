//! The engine in time steps: its scenes, and an engine with its world.

use crate::Case;
use coinmc_core::{Engine, Launch, Preset};
use coinmc_rapier::{Account, RapierEngine, Settings, SettingsError, Workspace};
use std::ops::{ControlFlow, Range};

/// H/R of the scenes.
pub const RATIOS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

/// The two scenes at one ratio, without friction lengths: `clean` (R = 1 cm, e = 0.5, μ = 0.3) and
/// `table1`, Unity's.
pub fn cases(ratio: f64) -> [Case; 2] {
    [
        Case::new(Preset::Clean, 0.01, ratio, 0.5, 0.3),
        Case::table1(ratio),
    ]
}

/// An engine with a world.
pub struct Tosser {
    case: Case,
    engine: RapierEngine,
    workspace: Workspace,
}

impl Tosser {
    /// An engine for the case, and a world for it.
    ///
    /// # Errors
    /// If a setting is out of range for the scene.
    pub fn new(case: &Case, settings: &Settings) -> Result<Self, SettingsError> {
        let engine = RapierEngine::new(&case.scene, settings)?;
        let workspace = engine.workspace();
        Ok(Self {
            case: *case,
            engine,
            workspace,
        })
    }

    /// Several tosses at a time in one world; no further toss begins once `go_on` is false.
    pub fn examine_all(
        &mut self,
        seed: u64,
        tosses: Range<u64>,
        go_on: impl Fn() -> bool,
        mut each: impl FnMut(&Launch, &Account),
    ) {
        let case = self.case;
        let start = tosses.start;
        let launches = tosses
            .take_while(|_| go_on())
            .map(|toss| case.launch(seed, toss));
        self.engine
            .examine_all(&mut self.workspace, launches, |number, account| {
                each(&case.launch(seed, start + number as u64), account);
                ControlFlow::Continue(())
            });
    }

    /// One toss.
    pub fn examine(&mut self, launch: &Launch) -> Account {
        self.engine.examine(&mut self.workspace, launch, &mut ())
    }
}
