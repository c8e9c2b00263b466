//! The engine of a law that is known at run time only.

use crate::engine::FlatEngine;
use crate::half_sine::HalfSineImpact;
use crate::impact::{ChatterjeeRuina, Moreau};
use crate::line::LineImpact;
use crate::paper::PaperImpact;
use crate::settings::{Law, Settings, SettingsError};
use coinmc_core::{Engine, Launch, Observer, Outcome, Scene};

/// An engine of any law, for callers that learn the law at run time: one `match`, then static
/// dispatch.
#[derive(Debug, Clone)]
pub enum AnyFlatEngine {
    /// [`Moreau`].
    Moreau(FlatEngine<Moreau>),
    /// [`ChatterjeeRuina`].
    ChatterjeeRuina(FlatEngine<ChatterjeeRuina>),
    /// [`PaperImpact`].
    Paper(FlatEngine<PaperImpact>),
    /// [`HalfSineImpact`].
    HalfSine(FlatEngine<HalfSineImpact>),
    /// [`LineImpact`].
    LineContact(FlatEngine<LineImpact>),
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
            Law::Paper(paper) => {
                let law = PaperImpact::new(scene, paper)?;
                Self::Paper(FlatEngine::new(scene, settings, law)?)
            }
            Law::HalfSine(pulse) => {
                let law = HalfSineImpact::new(scene, pulse)?;
                Self::HalfSine(FlatEngine::new(scene, settings, law)?)
            }
            Law::LineContact(line) => {
                let law = LineImpact::new(scene, line)?;
                Self::LineContact(FlatEngine::new(scene, settings, law)?)
            }
        })
    }
}

/// One `match` a toss: for callers that have no loop of their own to compile for each law.
impl Engine for AnyFlatEngine {
    type Workspace = ();

    fn workspace(&self) {}

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        match self {
            Self::Moreau(engine) => engine.toss(&mut (), launch, observer),
            Self::ChatterjeeRuina(engine) => engine.toss(&mut (), launch, observer),
            Self::Paper(engine) => engine.toss(&mut (), launch, observer),
            Self::HalfSine(engine) => engine.toss(&mut (), launch, observer),
            Self::LineContact(engine) => engine.toss(&mut (), launch, observer),
        }
    }
}
