//! The engine: one model, tossed on the scalar path or in lanes.

use crate::batch::Batch;
use crate::conical::Conical;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::settings::{Settings, SettingsError};
use crate::table::Table;
use coinmc_core::{
    Engine, Launch, LaunchSource, Observer, Outcome, OutcomeSink, Scene, TossBatch, toss_sequential,
};
use coinmc_lanes::{Lanes, NoSuchLanes};

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
    table: Option<Table<L>>,
    conical: Option<Conical<L>>,
    lanes: Lanes,
}

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// An engine for this scene. The impact law is `law`; `settings.law` is not used.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        let mut endless = *scene;
        endless.surface = scene.surface.without_edge();
        Ok(Self {
            model: Model::new(&endless, settings, law)?,
            table: Table::new(scene, settings, law)?,
            conical: Conical::new(scene, settings, law)?,
            lanes: Lanes::best(),
        })
    }

    /// A batch for many tosses; `None` if the lanes are [`Lanes::Scalar`], on a table with an edge, or of a
    /// coin with a conical edge.
    pub(crate) fn batch(&self) -> Option<Batch<'_, L>> {
        (self.lanes != Lanes::Scalar && self.table.is_none() && self.conical.is_none())
            .then(|| Batch::new(&self.model, self.lanes))
    }
}

impl<L: ImpactLaw> Engine for VolumetricEngine<L> {
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
        match (&self.table, &self.conical) {
            (None, None) => self.model.run(launch, observer),
            (Some(table), _) => table.run(&self.model, launch, observer),
            (None, Some(conical)) => conical.run(launch, observer),
        }
        .outcome
    }

    fn toss_many(&self, (): &mut (), launches: LaunchSource<'_>, sink: &mut OutcomeSink<'_>) {
        let Some(batch) = self.batch() else {
            return toss_sequential(self, &mut (), launches, sink);
        };
        let mut outcomes = Vec::new();
        batch.toss_all_in_batch(launches, |ended| {
            outcomes.clear();
            outcomes.extend(ended.iter().map(|(number, end)| (*number, end.outcome)));
            sink(&outcomes)
        });
    }
}
