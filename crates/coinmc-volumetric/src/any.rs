//! The engine of a law that is known at run time only.

use crate::batch::Batch;
use crate::engine::VolumetricEngine;
use crate::finished_toss::FinishedToss;
use crate::impact::{ChatterjeeRuina, Moreau, Stronge};
use crate::settings::{Law, Settings, SettingsError};
use coinmc_core::{
    DynObserver, Engine, Launch, Observer, Outcome, Scene, TossBatch, toss_sequential,
};
use coinmc_lanes::{Lanes, NoSuchLanes};
use std::ops::ControlFlow;

/// An engine of any law, for callers that learn the law at run time: one `match` a toss.
///
/// It is compiled with this crate, for all laws and once for all observers; of the engine of one law
/// every caller compiles an instance of its own, and one more for each observer.
#[derive(Debug, Clone)]
pub enum AnyVolumetricEngine {
    /// [`Moreau`].
    Moreau(VolumetricEngine<Moreau>),
    /// [`ChatterjeeRuina`].
    ChatterjeeRuina(VolumetricEngine<ChatterjeeRuina>),
    /// [`Stronge`].
    Stronge(VolumetricEngine<Stronge>),
}

/// The same of every law.
macro_rules! each_law {
    ($any:expr, $it:ident => $same:expr) => {
        match $any {
            Self::Moreau($it) => $same,
            Self::ChatterjeeRuina($it) => $same,
            Self::Stronge($it) => $same,
        }
    };
}

impl AnyVolumetricEngine {
    /// The engine of `settings.law`.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        Ok(match settings.law {
            Law::Moreau => Self::Moreau(VolumetricEngine::new(scene, settings, Moreau)?),
            Law::ChatterjeeRuina => {
                Self::ChatterjeeRuina(VolumetricEngine::new(scene, settings, ChatterjeeRuina)?)
            }
            Law::Stronge => Self::Stronge(VolumetricEngine::new(scene, settings, Stronge)?),
        })
    }

    /// The same with these lanes instead of [`Lanes::best`], for [`Engine::toss_all`].
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor has no such instructions.
    pub fn with_lanes(self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        Ok(match self {
            Self::Moreau(engine) => Self::Moreau(engine.with_lanes(lanes)?),
            Self::ChatterjeeRuina(engine) => Self::ChatterjeeRuina(engine.with_lanes(lanes)?),
            Self::Stronge(engine) => Self::Stronge(engine.with_lanes(lanes)?),
        })
    }

    fn any_observer<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        if O::ACTIVE {
            self.observed(launch, &mut DynObserver::new(observer))
        } else {
            self.unobserved(launch)
        }
    }
}

// nothing of this is generic: so it is compiled here
impl AnyVolumetricEngine {
    fn unobserved(&self, launch: &Launch) -> Outcome {
        each_law!(self, engine => engine.toss(&mut (), launch, &mut ()))
    }

    fn observed(&self, launch: &Launch, observer: &mut DynObserver) -> Outcome {
        each_law!(self, engine => engine.toss(&mut (), launch, observer))
    }

    fn batch(&self) -> Option<AnyBatch<'_>> {
        Some(match self {
            Self::Moreau(engine) => AnyBatch::Moreau(engine.batch()?),
            Self::ChatterjeeRuina(engine) => AnyBatch::ChatterjeeRuina(engine.batch()?),
            Self::Stronge(engine) => AnyBatch::Stronge(engine.batch()?),
        })
    }
}

enum AnyBatch<'a> {
    Moreau(Batch<'a, Moreau>),
    ChatterjeeRuina(Batch<'a, ChatterjeeRuina>),
    Stronge(Batch<'a, Stronge>),
}

impl TossBatch for AnyBatch<'_> {
    type End = FinishedToss;

    fn has_room(&self) -> bool {
        each_law!(self, batch => batch.has_room())
    }

    fn launch(&mut self, launch: &Launch) {
        each_law!(self, batch => batch.launch(launch));
    }

    fn advance(&mut self) -> bool {
        each_law!(self, batch => batch.advance())
    }

    fn ended(&mut self) -> &mut Vec<(u64, FinishedToss)> {
        each_law!(self, batch => batch.ended())
    }
}

impl Engine for AnyVolumetricEngine {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        each_law!(self, engine => engine.lanes())
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.any_observer(launch, observer)
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
