//! The laws of impact, each in a file of its own: its parameters, how a config gives them, and its
//! impact.
//!
//! A new law is a file and, here, a module, a variant and a line in each list. The compiler demands
//! all of them except the line in [`LAWS`], without which no config can name the law.

pub(crate) mod chatterjee_ruina;
pub(crate) mod gaek_sukhov;
pub(crate) mod half_sine;
pub(crate) mod line_contact;
pub(crate) mod moreau;
pub(crate) mod palmgren;

use crate::impact_law::PlanarLaw;
use crate::settings_error::SettingsError;
use chatterjee_ruina::ChatterjeeRuina;
use coinmc_core::schema::{Values, unlisted};
use coinmc_core::{EngineError, LawDescriptor, LawSettings};
use gaek_sukhov::GaekSukhov;
use half_sine::HalfSine;
use line_contact::LineContact;
use moreau::Moreau;

/// The laws, in the order of the reference.
pub(crate) const LAWS: [LawDescriptor; 5] = [
    LawDescriptor::of::<Moreau>(),
    LawDescriptor::of::<ChatterjeeRuina>(),
    LawDescriptor::of::<GaekSukhov>(),
    LawDescriptor::of::<HalfSine>(),
    LawDescriptor::of::<LineContact>(),
];

/// The law of impact at a corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Law {
    /// Newton restitution, Coulomb friction against the final slip (Moreau 1988), guarded by
    /// Chatterjee–Ruina where that would gain energy.
    #[default]
    Moreau,
    /// Chatterjee & Ruina (1998), tangential restitution 0.
    ChatterjeeRuina,
    /// Gaek & Sukhov's law as published.
    GaekSukhov(GaekSukhov),
    /// A force that is half a sine in time.
    HalfSine(HalfSine),
    /// Elastic line contact with damping and friction, resolved in time.
    LineContact(LineContact),
}

/// Evaluates an expression with the parameters of the law.
macro_rules! each_law {
    ($any:expr, $law:ident => $same:expr) => {
        match $any {
            Law::Moreau => each_law!(@ $crate::laws::moreau::Moreau, $law => $same),
            Law::ChatterjeeRuina => each_law!(@ $crate::laws::chatterjee_ruina::ChatterjeeRuina, $law => $same),
            Law::GaekSukhov(law) => each_law!(@ law, $law => $same),
            Law::HalfSine(law) => each_law!(@ law, $law => $same),
            Law::LineContact(law) => each_law!(@ law, $law => $same),
        }
    };
    (@ $one:expr, $law:ident => $same:expr) => {{
        let $law = $one;
        $same
    }};
}

pub(crate) use each_law;

impl Law {
    /// The laws without parameters.
    pub const RIGID: [Self; 2] = [Self::Moreau, Self::ChatterjeeRuina];

    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        fn name_of<L: LawSettings>(_: L) -> &'static str {
            L::NAME
        }
        each_law!(self, law => name_of(law))
    }

    /// The law that the values of the engine's table give.
    pub(crate) fn read(values: &Values) -> Result<Self, EngineError> {
        let (name, parameters) = values.named("law")?;
        Ok(match name {
            Moreau::NAME => Self::Moreau,
            ChatterjeeRuina::NAME => Self::ChatterjeeRuina,
            GaekSukhov::NAME => Self::GaekSukhov(GaekSukhov::read(parameters)?),
            HalfSine::NAME => Self::HalfSine(HalfSine::read(parameters)?),
            LineContact::NAME => Self::LineContact(LineContact::read(parameters)?),
            _ => return Err(unlisted("law", name)),
        })
    }

    pub(crate) fn validate(self) -> Result<(), SettingsError> {
        each_law!(self, law => law.validate())
    }
}
