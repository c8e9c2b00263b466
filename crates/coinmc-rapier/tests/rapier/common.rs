//! Scenes, launches and engines that the tests share.

use coinmc_core::{
    Coin, Domain, Drag, Engine, Face, Launch, Outcome, Preset, Scene, Stream, Surface,
};
use coinmc_rapier::{Account, RapierEngine, Settings, Workspace};
use std::ops::ControlFlow;

/// R = 1 cm, g = 9.81 m/s².
pub(crate) fn scene(ratio: f64, restitution: f64, friction: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a good coin");
    let surface = Surface::new(restitution, friction).expect("a good surface");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("good gravity")
}

/// The Unity scene of Gaek & Sukhov, arXiv 2401.03557, table 1.
pub(crate) fn table1(ratio: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.5).expect("a good coin");
    let surface = Surface::new(0.3, 10.0)
        .and_then(|surface| surface.with_restitution_threshold(2.0))
        .expect("a good surface");
    let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("good gravity");
    let drag = Drag::new(1.0, 0.05).expect("good drag");
    scene.with_drag(drag).with_gyroscopic_torque(false)
}

pub(crate) fn launch(preset: Preset, scene: &Scene, seed: u64, toss: u64) -> Launch {
    let stream = Stream::new(seed, Domain::Launch, 0);
    preset
        .distribution()
        .launch(&scene.coin, &mut stream.toss(toss))
}

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

pub(crate) fn is_side(outcome: &Outcome) -> f64 {
    f64::from(u8::from(outcome.face() == Some(Face::Side)))
}

/// Mean and standard error of paired differences.
pub(crate) fn paired(differences: &[f64]) -> (f64, f64) {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let square = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n;
    (mean, (square / n).sqrt())
}
