//! Heads and tails of a coin whose faces differ.
//!
//! A conical edge makes heads and tails different wells: at the thickness at which the side has its
//! probability they share the rest unevenly, and no thickness makes all three alike. So the answer of a design
//! is the thickness for the side, and what the two faces then get.

use crate::seen::Seen;
use crate::{QuestionError, Root, Template, Workers};
use coinmc_core::{Estimate, Face};

/// The fewest and the most tosses that tell heads from tails.
const TOSSES: [u64; 2] = [4096, 100_000];

/// How often a coin with a conical edge shows each of its faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faces {
    /// P(heads).
    pub heads: Estimate,
    /// P(tails).
    pub tails: Estimate,
}

impl Faces {
    /// By tosses at a root, as many as found it.
    pub(super) fn at(
        template: &Template,
        root: &Root,
        workers: &Workers<'_>,
    ) -> Result<Self, QuestionError> {
        let plan = template.plan(&[("coin.ratio", format!("{:?}", root.value))])?;
        let [least, most] = TOSSES;
        let counts = workers.count_first(&plan, 0..root.tosses.clamp(least, most))?;
        let of = |face| Seen::of(counts, face).estimate(&plan);
        Ok(Self {
            heads: of(Face::Heads),
            tails: of(Face::Tails),
        })
    }

    /// The share of heads in what the side leaves.
    pub(super) fn share_of_heads(&self) -> f64 {
        self.heads.p / (self.heads.p + self.tails.p)
    }
}
