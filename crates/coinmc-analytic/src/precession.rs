//! A coin that starts heads up, spins and precesses, and lands without a bounce.
//!
//! # Derivation
//!
//! In flight no torque acts, so the angular momentum `L` is fixed in space. The coin has an axis of
//! symmetry, so its normal `u` keeps the angle ψ to `L` and circles it at a constant rate. At the
//! start the heads face lies level, `u = z`; hence `L` makes the angle ψ with the *vertical* as
//! well. With φ the angle by which `u` has circled `L` since,
//!
//! > `u_z = cos²ψ + sin²ψ·cos φ`.
//!
//! ψ = 90° is the clean flip about a diameter; ψ = 0 is a coin thrown flat like a discus. If
//! ψ < 45° or ψ > 135° the heads face never looks down, although the coin may seem to tumble.
//! Nothing depends on the sense of `L`, so ψ and π − ψ give the same result. [`thin`] needs only
//! the sign of `u_z`; [`thick`] applies the test of an adhesive landing to `u_z` (see the crate's
//! overview).
//!
//! # What is assumed
//!
//! * The coin starts with heads up and level. Without that `L` may point anywhere.
//! * φ is uniform on the circle when the coin lands: it has circled many times, and the number of
//!   times is not controlled. For a thick coin also: the contact itself does not distort the
//!   distribution of φ, that is, the coin hardly turns while it falls by its own size (or it is
//!   caught).
//! * ψ is known. If it has a distribution, average these probabilities over it.
//!
//! **Source.** P. Diaconis, S. Holmes and R. Montgomery, "Dynamical bias in the coin toss", SIAM
//! Review 49, 211 (2007), for the thin coin; the thick one joins it to the landing of E. H. Yong
//! and L. Mahadevan, Am. J. Phys. 79, 1195 (2011).

use std::f64::consts::PI;

pub mod thick;
pub mod thin;

/// Whether `psi_rad` is an angle between two directions.
fn is_angle(psi_rad: f64) -> bool {
    (0.0..=PI).contains(&psi_rad)
}
