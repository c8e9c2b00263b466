//! The laws of impact that a user may choose, each in a file of its own.
//!
//! A new law is a file and, here, a variant and a line in each list. The compiler asks for
//! each line except that in [`LAWS`], without which no config can name the law.

mod chatterjee_ruina;
mod moreau;
mod stronge;

pub use chatterjee_ruina::ChatterjeeRuina;
pub use moreau::Moreau;
pub use stronge::Stronge;

use crate::impact::ImpactLaw;
use coinmc_core::schema::{Values, unlisted};
use coinmc_core::{EngineError, LawDescriptor, LawSettings};
use std::fmt::Debug;

/// The laws, in the order of the reference.
pub(crate) const LAWS: [LawDescriptor; 3] = [
    LawDescriptor::of::<Moreau>(),
    LawDescriptor::of::<ChatterjeeRuina>(),
    LawDescriptor::of::<Stronge>(),
];

/// The law of impact at the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Law {
    /// Newton restitution, Coulomb friction against the final slip (Moreau 1988), guarded by
    /// Chatterjee–Ruina where that would gain energy.
    #[default]
    Moreau,
    /// Chatterjee & Ruina (1998), tangential restitution 0.
    ChatterjeeRuina,
    /// Stronge's energetic restitution, the Darboux–Keller equations through slip reversals.
    Stronge,
}

impl Law {
    /// All laws.
    pub const ALL: [Self; 3] = [Self::Moreau, Self::ChatterjeeRuina, Self::Stronge];

    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moreau => Moreau::NAME,
            Self::ChatterjeeRuina => ChatterjeeRuina::NAME,
            Self::Stronge => Stronge::NAME,
        }
    }

    /// The law that the values of the engine's table name.
    pub(crate) fn read(values: &Values) -> Result<Self, EngineError> {
        let (name, _) = values.named("law")?;
        let law = Self::ALL.into_iter().find(|law| law.name() == name);
        law.ok_or_else(|| unlisted("law", name))
    }

    /// Runs a task with the type of this law.
    pub(crate) fn visit<V: LawVisitor>(self, visitor: V) -> V::Output {
        match self {
            Self::Moreau => visitor.visit(Moreau),
            Self::ChatterjeeRuina => visitor.visit(ChatterjeeRuina),
            Self::Stronge => visitor.visit(Stronge),
        }
    }
}

/// A task that is generic over impact laws, for a law that is known only at run time.
pub(crate) trait LawVisitor {
    type Output;

    fn visit<I: ImpactLaw + Debug + Send + 'static>(self, law: I) -> Self::Output;
}
