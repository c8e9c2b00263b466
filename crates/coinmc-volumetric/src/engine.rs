//! The toss: flight, impact, sustained contact, decision. (Seam: the body is being written.)

use crate::impact::{ChatterjeeRuina, Moreau, Stronge};
use crate::settings::{Law, Settings, SettingsError};
use coinmc_core::{Ended, Engine, Launch, Observer, Outcome, Scene};

/// Follows tosses of one scene.
#[derive(Debug, Clone)]
pub struct VolumetricEngine<L> {
    settings: Settings,
    law: L,
}

/// An engine of any law, for callers that learn the law at run time: one `match`, then static
/// dispatch.
#[derive(Debug, Clone)]
pub enum AnyVolumetricEngine {
    /// [`Moreau`].
    Moreau(VolumetricEngine<Moreau>),
    /// [`ChatterjeeRuina`].
    ChatterjeeRuina(VolumetricEngine<ChatterjeeRuina>),
    /// [`Stronge`].
    Stronge(VolumetricEngine<Stronge>),
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
}

impl<L> VolumetricEngine<L> {
    /// An engine for this scene. `settings.law` is not looked at: `law` is the law.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(_scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self {
            settings: *settings,
            law,
        })
    }
}

impl<L: Copy + Sync> Engine for VolumetricEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn toss(&self, (): &mut (), _launch: &Launch, _observer: &mut impl Observer) -> Outcome {
        let _ = (self.settings, self.law);
        Outcome {
            ended: Ended::Failed,
            impacts: 0,
            contact_steps: 0,
            jams: 0,
            overruled: false,
        }
    }
}
