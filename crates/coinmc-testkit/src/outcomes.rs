//! Comparing outcomes.

use coinmc_core::{Face, Outcome};

/// Heads and tails exchanged.
pub fn turned(face: Option<Face>) -> Option<Face> {
    face.map(|face| match face {
        Face::Heads => Face::Tails,
        Face::Tails => Face::Heads,
        Face::Side => Face::Side,
    })
}

/// Impacts, contact steps and jams.
pub fn counts(outcome: &Outcome) -> (u32, u32, u32) {
    (outcome.impacts, outcome.contact_steps, outcome.jams)
}

/// 1 for the side, else 0.
pub fn side(outcome: &Outcome) -> f64 {
    f64::from(u8::from(outcome.face() == Some(Face::Side)))
}

/// Mean and standard error of paired differences.
pub fn paired(differences: &[f64]) -> (f64, f64) {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let square = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n;
    (mean, (square / n).sqrt())
}
