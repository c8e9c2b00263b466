//! Studies of the engine in time steps, one a file.

mod energy;
mod restitution;
mod speed;
mod step;
mod stress;
mod trend;

pub(crate) use energy::RapierEnergy;
pub(crate) use restitution::RapierRestitution;
pub(crate) use speed::RapierSpeed;
pub(crate) use step::RapierStep;
pub(crate) use stress::RapierStress;

use coinmc_bench::Case;
use coinmc_core::{Engine, Launch, Preset, Tally};
use coinmc_rapier::{Account, Flaw, RapierEngine, Settings, Workspace};
use std::ops::{ControlFlow, Range};

/// H/R of the scenes.
const RATIOS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

/// Steps, s, from the one of Unity to where a toss costs a second.
const STEPS: [f64; 9] = [2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5];

/// The two scenes at one ratio, without friction lengths: `clean` (R = 1 cm, e = 0.5, μ = 0.3) and
/// `table1`, Unity's.
fn cases(ratio: f64) -> [Case; 2] {
    [
        Case::new(Preset::Clean, 0.01, ratio, 0.5, 0.3),
        Case::table1(ratio),
    ]
}

/// An engine with a world.
struct Tosser {
    case: Case,
    engine: RapierEngine,
    workspace: Workspace,
}

impl Tosser {
    fn new(case: &Case, settings: &Settings) -> anyhow::Result<Self> {
        let engine = RapierEngine::new(&case.scene, settings)?;
        let workspace = engine.workspace();
        Ok(Self {
            case: *case,
            engine,
            workspace,
        })
    }

    fn launch(&self, seed: u64, toss: u64) -> Launch {
        launch(&self.case, seed, toss)
    }

    /// Several at a time, in one world; as many of the tosses as `go_on` lets begin.
    fn examine_all(
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
            .map(|toss| launch(&case, seed, toss));
        self.engine
            .examine_all(&mut self.workspace, launches, |number, account| {
                each(&launch(&case, seed, start + number as u64), account);
                ControlFlow::Continue(())
            });
    }

    fn examine(&mut self, launch: &Launch) -> Account {
        self.engine.examine(&mut self.workspace, launch, &mut ())
    }
}

/// The launch of a toss: the same in all engines.
fn launch(case: &Case, seed: u64, toss: u64) -> Launch {
    let mut uniforms = Case::stream(seed).toss(toss);
    case.launches().launch(&case.scene.coin, &mut uniforms)
}

/// How many tosses went wrong in which way, and how many had no end.
#[derive(Debug, Clone, Copy, Default)]
struct Flaws {
    tunnelled: u64,
    sunk: u64,
    exploded: u64,
    not_finite: u64,
}

impl Flaws {
    const COLUMNS: [&'static str; 5] = ["tunnelled", "sunk", "exploded", "not_finite", "undecided"];

    fn add(&mut self, flaw: Option<Flaw>) {
        match flaw {
            Some(Flaw::Tunnelled) => self.tunnelled += 1,
            Some(Flaw::Sunk) => self.sunk += 1,
            Some(Flaw::Exploded) => self.exploded += 1,
            Some(Flaw::NotFinite) => self.not_finite += 1,
            None => {}
        }
    }

    fn merge(&mut self, other: &Self) {
        self.tunnelled += other.tunnelled;
        self.sunk += other.sunk;
        self.exploded += other.exploded;
        self.not_finite += other.not_finite;
    }

    /// The cells under [`Flaws::COLUMNS`]; undecided are those that hit a limit.
    fn cells(&self, tally: &Tally) -> Vec<String> {
        let limits = tally.undecided() - tally.failed;
        [
            self.tunnelled,
            self.sunk,
            self.exploded,
            self.not_finite,
            limits,
        ]
        .map(|count| count.to_string())
        .to_vec()
    }
}
