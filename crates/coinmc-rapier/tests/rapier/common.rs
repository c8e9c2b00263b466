//! Engines that the tests share.

use coinmc_core::{Engine, Launch, Outcome, Scene};
use coinmc_rapier::{Account, RapierEngine, Settings, Workspace};
use std::ops::ControlFlow;

/// An engine and a world that is used again and again.
pub(crate) struct Tosser {
    pub(crate) engine: RapierEngine,
    workspace: Workspace,
}

impl Tosser {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Self {
        let engine = RapierEngine::new(scene, settings).expect("good settings");
        let workspace = engine.workspace();
        Self { engine, workspace }
    }

    pub(crate) fn examine(&mut self, launch: &Launch) -> Account {
        self.engine.examine(&mut self.workspace, launch, &mut ())
    }

    /// Several at a time, in one world; in the order of the launches.
    pub(crate) fn examine_all(&mut self, launches: &[Launch]) -> Vec<Account> {
        let mut accounts = vec![None; launches.len()];
        let each = |number: usize, account: &Account| {
            assert_eq!(accounts[number].replace(*account), None, "{number} twice");
            ControlFlow::Continue(())
        };
        let launches = launches.iter().copied();
        self.engine.examine_all(&mut self.workspace, launches, each);
        accounts
            .into_iter()
            .map(|account| account.expect("each toss ends"))
            .collect()
    }

    pub(crate) fn toss(&mut self, launch: &Launch) -> Outcome {
        self.examine(launch).outcome
    }
}

/// Steps that are coarse enough for a test and fine enough for the physics.
pub(crate) fn quick() -> Settings {
    Settings {
        step_s: 2e-3,
        time_limit: 100.0,
        ..Settings::default()
    }
}
