//! The engine of a law that is known at run time only.

use crate::batch::Batch;
use crate::engine::FlatEngine;
use crate::laws::chatterjee_ruina::ChatterjeeRuina;
use crate::laws::gaek_sukhov::GaekSukhovImpact;
use crate::laws::half_sine::HalfSineImpact;
use crate::laws::line_contact::LineContactImpact;
use crate::laws::moreau::Moreau;
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
pub enum AnyFlatEngine {
    /// [`Moreau`].
    Moreau(FlatEngine<Moreau>),
    /// [`ChatterjeeRuina`].
    ChatterjeeRuina(FlatEngine<ChatterjeeRuina>),
    /// [`GaekSukhovImpact`].
    GaekSukhov(FlatEngine<GaekSukhovImpact>),
    /// [`HalfSineImpact`].
    HalfSine(FlatEngine<HalfSineImpact>),
    /// [`LineContactImpact`].
    LineContact(FlatEngine<LineContactImpact>),
}

impl AnyFlatEngine {
    /// The engine of `settings.law`.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or the law is none for this scene.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        Ok(match settings.law {
            Law::Moreau => Self::Moreau(FlatEngine::new(scene, settings, Moreau)?),
            Law::ChatterjeeRuina => {
                Self::ChatterjeeRuina(FlatEngine::new(scene, settings, ChatterjeeRuina)?)
            }
            Law::GaekSukhov(gaek_sukhov) => {
                let law = GaekSukhovImpact::new(scene, gaek_sukhov)?;
                Self::GaekSukhov(FlatEngine::new(scene, settings, law)?)
            }
            Law::HalfSine(pulse) => {
                let law = HalfSineImpact::new(scene, pulse)?;
                Self::HalfSine(FlatEngine::new(scene, settings, law)?)
            }
            Law::LineContact(line) => {
                let law = LineContactImpact::new(scene, line)?;
                Self::LineContact(FlatEngine::new(scene, settings, law)?)
            }
        })
    }
}

/// The same of every law.
macro_rules! each_law {
    ($any:expr, $engine:ident => $same:expr) => {
        match $any {
            Self::Moreau($engine) => $same,
            Self::ChatterjeeRuina($engine) => $same,
            Self::GaekSukhov($engine) => $same,
            Self::HalfSine($engine) => $same,
            Self::LineContact($engine) => $same,
        }
    };
}

impl AnyFlatEngine {
    /// The same with these lanes instead of the fastest of this processor, for [`Engine::toss_all`].
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor has no such instructions.
    pub fn with_lanes(self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        Ok(match self {
            Self::Moreau(engine) => Self::Moreau(engine.with_lanes(lanes)?),
            Self::ChatterjeeRuina(engine) => Self::ChatterjeeRuina(engine.with_lanes(lanes)?),
            Self::GaekSukhov(engine) => Self::GaekSukhov(engine.with_lanes(lanes)?),
            Self::HalfSine(engine) => Self::HalfSine(engine.with_lanes(lanes)?),
            Self::LineContact(engine) => Self::LineContact(engine.with_lanes(lanes)?),
        })
    }

    /// The lanes of [`Engine::toss_all`].
    pub fn lanes(&self) -> Lanes {
        each_law!(self, engine => engine.lanes())
    }
}

impl AnyFlatEngine {
    fn any_observer<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        if O::ACTIVE {
            self.observed(launch, &mut DynObserver::new(observer))
        } else {
            self.unobserved(launch)
        }
    }
}

// nothing of this is generic: so it is compiled here
impl AnyFlatEngine {
    fn unobserved(&self, launch: &Launch) -> Outcome {
        each_law!(self, engine => engine.toss_observed(launch, &mut ()))
    }

    fn observed(&self, launch: &Launch, observer: &mut DynObserver) -> Outcome {
        each_law!(self, engine => engine.toss_observed(launch, observer))
    }

    fn batch(&self) -> Option<AnyBatch<'_>> {
        match self {
            Self::Moreau(engine) => engine.batch().map(AnyBatch::Moreau),
            Self::ChatterjeeRuina(engine) => engine.batch().map(AnyBatch::ChatterjeeRuina),
            // not side by side
            Self::GaekSukhov(_) | Self::HalfSine(_) | Self::LineContact(_) => None,
        }
    }
}

enum AnyBatch<'a> {
    Moreau(Batch<'a, Moreau>),
    ChatterjeeRuina(Batch<'a, ChatterjeeRuina>),
}

/// The same of every law with batches.
macro_rules! each_batch {
    ($any:expr, $batch:ident => $same:expr) => {
        match $any {
            Self::Moreau($batch) => $same,
            Self::ChatterjeeRuina($batch) => $same,
        }
    };
}

impl TossBatch for AnyBatch<'_> {
    type End = Outcome;

    fn has_room(&self) -> bool {
        each_batch!(self, batch => batch.has_room())
    }

    fn launch(&mut self, launch: &Launch) {
        each_batch!(self, batch => batch.launch(launch));
    }

    fn advance(&mut self) -> bool {
        each_batch!(self, batch => batch.advance())
    }

    fn ended(&mut self) -> &mut Vec<(u64, Outcome)> {
        each_batch!(self, batch => batch.ended())
    }
}

impl Engine for AnyFlatEngine {
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
        each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        match self.batch() {
            Some(batch) => batch.toss_all_in_batch(launches, each),
            None => toss_sequential(self, &mut (), launches, each),
        }
    }
}
