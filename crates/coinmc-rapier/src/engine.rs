//! The engine: one toss at a time, or several in one world.

use crate::account::Account;
use crate::batch;
use crate::driver::Driver;
use crate::settings::{Settings, SettingsError};
use crate::world::World;
use coinmc_core::{Engine, Launch, LaunchSource, Observer, Outcome, OutcomeSink, Scene};
use std::ops::ControlFlow;

/// Follows tosses of one scene with Rapier's steps.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_rapier::{RapierEngine, Settings};
/// let coin = Coin::cylinder(2.0, 0.01)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let engine = RapierEngine::new(&scene, &Settings::default())?;
/// let launch = Preset::Clean
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let account = engine.examine(&mut engine.workspace(), &launch, &mut ());
/// assert!(account.outcome.face().is_some() && account.steps > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RapierEngine(Driver);

/// A worker's world: a half-space and coins.
pub struct Workspace(World);

impl RapierEngine {
    /// An engine for this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range or this build has no Rapier.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        Driver::new(scene, settings).map(Self)
    }

    /// Follows one toss and returns its full account.
    pub fn examine(
        &self,
        workspace: &mut Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Account {
        self.0.toss(&mut workspace.0, launch, observer)
    }

    /// Follows many tosses, several at a time ([`Settings::tosses_at_once`]), and calls `visit` with
    /// the number of each among the launches and its account, in any order, until `visit` breaks
    /// off.
    ///
    /// Every account is bit-identical to that of [`RapierEngine::examine`].
    pub fn examine_all(
        &self,
        workspace: &mut Workspace,
        launches: impl Iterator<Item = Launch>,
        visit: impl FnMut(usize, &Account) -> ControlFlow<()>,
    ) {
        batch::toss_all_in_batch(&self.0, &mut workspace.0, launches, visit);
    }
}

impl Engine for RapierEngine {
    type Workspace = Workspace;

    fn workspace(&self) -> Workspace {
        let Driver {
            scaled,
            settings,
            step,
            ..
        } = &self.0;
        Workspace(World::new(scaled, settings, *step))
    }

    fn toss(
        &self,
        workspace: &mut Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Outcome {
        self.examine(workspace, launch, observer).outcome
    }

    /// One outcome at a time: a toss takes milliseconds.
    fn toss_many(
        &self,
        workspace: &mut Workspace,
        launches: LaunchSource<'_>,
        sink: &mut OutcomeSink<'_>,
    ) {
        self.examine_all(workspace, launches, |number, account| {
            sink(&[(number as u64, account.outcome)])
        });
    }
}
