//! When energy alone decides the face.

use crate::{Model, Motion};
use coinmc_core::Face;

/// The face, if it is decided: a coin with less energy than it takes to stand on its rim, 1 + r, stays
/// in the well it is in. A coin that has sunk in stands that much lower.
///
/// Nothing is left out of the energy, so that the oracle does not share the errors of the engines'
/// decision rule. A coin that rolls has to be followed until friction has used up its energy.
pub(crate) fn decided(model: &Model, motion: &Motion) -> Option<Face> {
    let energy = motion.energy(model) - motion.gap(model).min(0.0);
    (energy < 1.0 + model.rim).then(|| leans_towards(model, motion))
}

/// The face towards which the coin leans.
pub(crate) fn leans_towards(model: &Model, motion: &Motion) -> Face {
    let c = motion.axis.z;
    match () {
        () if c.abs() < model.half => Face::Side,
        () if c > 0.0 => Face::Heads,
        () => Face::Tails,
    }
}
