//! The public engine of one law of impact: scalar or in batches.

use crate::batch::Batch;
use crate::impact_law::ImpactLaw;
use crate::parameters::Parameters;
use crate::settings::{Decision, Settings};
use crate::settings_error::SettingsError;
use coinmc_core::{
    Engine, Launch, LaunchSource, Observer, Outcome, OutcomeSink, Scene, TossBatch, toss_sequential,
};
use coinmc_lanes::{Lanes, NoSuchLanes};

/// Simulates planar tosses of one scene under one law of impact.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_flat::{FlatEngine, Moreau, Settings};
/// let coin = Coin::cylinder(1.5, 0.01)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let engine = FlatEngine::new(&scene, &Settings::default(), Moreau)?;
/// let launch = Preset::Robot
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let outcome = engine.toss(&mut (), &launch, &mut ());
/// assert!(outcome.face().is_some() && outcome.impacts > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct FlatEngine<L> {
    pub(crate) parameters: Parameters<L>,
    lanes: Lanes,
}

impl<L: ImpactLaw> FlatEngine<L> {
    /// An engine for this scene. It uses `law` and ignores `settings.law`.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        Ok(Self {
            parameters: Parameters::new(scene, settings, law)?,
            lanes: fastest_lanes(),
        })
    }

    /// A batch of tosses, if they can be computed in lanes: the law's impacts are impulses, the
    /// lanes are not scalar, and energy alone decides.
    pub(crate) fn batch(&self) -> Option<Batch<'_, L>> {
        let batched = L::BATCHED
            && self.lanes != Lanes::Scalar
            && self.parameters.settings.decision == Decision::Energy;
        batched.then(|| Batch::new(&self.parameters, self.lanes))
    }

    pub(crate) fn toss_observed<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        self.parameters.toss(launch, observer)
    }
}

/// [`Lanes::best`], except that portable lanes give way to the scalar path: they are no faster (0.8
/// to 1 times its speed, measured on x86-64 when programs for it had them).
fn fastest_lanes() -> Lanes {
    match Lanes::best() {
        Lanes::Portable => Lanes::Scalar,
        best => best,
    }
}

impl<L: ImpactLaw> Engine for FlatEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        self.lanes
    }

    fn with_lanes(mut self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        self.lanes = lanes.available()?;
        Ok(self)
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.toss_observed(launch, observer)
    }

    fn toss_many(&self, (): &mut (), launches: LaunchSource<'_>, sink: &mut OutcomeSink<'_>) {
        match self.batch() {
            Some(batch) => batch.toss_all_in_batch(launches, sink),
            None => toss_sequential(self, &mut (), launches, sink),
        }
    }
}
