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
    let face = leans_towards(model, motion);
    let [heads, tails] = model.rims.map(|(radius, half)| libm::hypot(radius, half));
    let barrier = match face {
        // on the rim of the other face
        Face::Heads => tails,
        Face::Tails => heads,
        Face::Side => heads.min(tails),
    };
    (energy < barrier + model.rim).then_some(face)
}

/// The face towards which the coin leans.
pub(crate) fn leans_towards(model: &Model, motion: &Motion) -> Face {
    let c = motion.axis.z;
    let [heads, tails] = model
        .rims
        .map(|(radius, half)| half / libm::hypot(radius, half));
    match () {
        () if c >= tails => Face::Heads,
        () if -c >= heads => Face::Tails,
        () => Face::Side,
    }
}
