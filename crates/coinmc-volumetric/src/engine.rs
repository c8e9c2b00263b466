//! The engine: one model, tossed on the scalar path or in lanes.

use crate::batch::Batch;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::settings::{Settings, SettingsError};
use coinmc_core::{Engine, Launch, Observer, Outcome, Scene, TossBatch, toss_sequential};
use coinmc_lanes::{Lanes, NoSuchLanes};
use std::ops::ControlFlow;

/// Simulates tosses of one scene under one impact law.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};
/// let coin = Coin::cylinder(0.85, 0.01)?;
/// let surface = Surface::new(0.5, 0.3)?.with_friction_lengths(1e-4, 1e-4)?;
/// let scene = Scene::new(coin, surface, 9.81)?;
/// let engine = VolumetricEngine::new(&scene, &Settings::default(), Moreau)?;
/// let launch = Preset::Clean
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let outcome = engine.toss(&mut (), &launch, &mut ());
/// assert!(outcome.face().is_some() && outcome.impacts > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct VolumetricEngine<L> {
    pub(crate) model: Model<L>,
    lanes: Lanes,
}

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// An engine for this scene. The impact law is `law`; `settings.law` is not used.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        Ok(Self {
            model: Model::new(scene, settings, law)?,
            lanes: Lanes::best(),
        })
    }

    /// The same engine with these lanes for [`Engine::toss_all`], instead of [`Lanes::best`].
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor lacks the instructions.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface};
    /// use coinmc_volumetric::{Lanes, Moreau, Settings, VolumetricEngine};
    /// let scene = Scene::new(Coin::cylinder(0.85, 0.01)?, Surface::new(0.5, 0.3)?, 9.81)?;
    /// let engine = VolumetricEngine::new(&scene, &Settings::default(), Moreau)?;
    /// assert_eq!(engine.with_lanes(Lanes::Portable)?.lanes(), Lanes::Portable);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_lanes(mut self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        self.lanes = lanes.available()?;
        Ok(self)
    }

    /// The lanes that [`Engine::toss_all`] uses.
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// A batch for many tosses; `None` if the lanes are [`Lanes::Scalar`].
    pub(crate) fn batch(&self) -> Option<Batch<'_, L>> {
        (self.lanes != Lanes::Scalar).then(|| Batch::new(&self.model, self.lanes))
    }
}

impl<L: ImpactLaw> Engine for VolumetricEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        self.lanes
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.model.run(launch, observer).outcome
    }

    fn toss_all(
        &self,
        (): &mut (),
        launches: impl Iterator<Item = Launch>,
        mut each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        match self.batch() {
            Some(batch) => {
                batch.toss_all_in_batch(launches, |number, end| each(number, &end.outcome));
            }
            None => toss_sequential(self, &mut (), launches, each),
        }
    }
}
