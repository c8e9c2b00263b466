#![doc = include_str!("../README.md")]
//!
//! # Terms
//!
//! The coin is a cylinder of height `H` and radius `R`, its mass spread evenly.
//!
//! | term | meaning |
//! |---|---|
//! | ratio `x` | `H/R`, from 0 (a disc without thickness) to +∞ (a rod) |
//! | `l` | `sqrt(R² + H²/4)`, from the centre to any point of either rim |
//! | `α` | `atan(x/2)`, half the angle of the side seen from the centre; `sin α = (H/2)/l` |
//! | `u` | unit normal of the heads face, pointing out of the coin |
//! | heads | the heads face shows: `u` points up when the coin lies |
//! | side | the coin rests on its curved surface |
//! | fair | `P(side) = 1/3`, so that all three outcomes are equally likely |
//! | adhesive | the point that touches first sticks, and the coin tips about it until it rests |
//!
//! # What an adhesive landing decides
//!
//! A tilted coin touches the floor with one point of a rim. Tipping about that point under gravity,
//! it falls to the side of the pivot on which its centre lies, so it comes to rest on the part of
//! its surface that the vertical line through its centre crosses. That vertical makes the angle
//! `acos |u_z|` with the axis of the coin, and the rim is seen from the centre at `π/2 − α` from
//! the axis. Therefore
//!
//! > side ⇔ `|u_z| < sin α`,  heads ⇔ `u_z > sin α`,  tails ⇔ `u_z < −sin α`.
//!
//! The arc, zone and precession rules are this one test under three distributions of `u`.
//!
//! # The rules
//!
//! | [`Rule`] | P(side) | fair `x` | what is uniform |
//! |---|---|---|---|
//! | [`arc`] | `(2/π)·atan(x/2)` | 1.1547 | angle of a spin about a horizontal diameter |
//! | [`zone`] | `x/sqrt(x² + 4)` | 0.7071 | orientation in space |
//! | [`surface_area`] | `x/(1 + x)` | 0.5 | point of the surface |
//! | [`cross_section`] | `x/(2 + x)` | 1 | point of the outline of the axial section |
//! | [`well_depth::flat`] | wells of potential energy, depth × angle | 1.6570 | (bouncing) |
//! | [`well_depth::solid`] | wells, depth × solid angle; a heuristic | 1.3545 | (bouncing) |
//!
//! A coin that starts heads up and precesses is in [`precession`]: its outcome also depends on the
//! angle ψ between its normal and its angular momentum, so it is not a [`Rule`]. For a coin whose
//! spin and speed are known instead of random, see [`keller`].
//!
//! # Numbers
//!
//! Every function is total: outside its domain it returns NaN, and it never panics. A ratio of 0
//! and a ratio of +∞ give the limits. Within ratios of 1e-12 to 1e12 the probability of the side
//! *and* that of the faces are each correct to a few units in the last place: neither is computed
//! as one minus the other. All elementary functions come from the crate `libm`, so that every
//! platform returns the same bits.

pub mod arc;
pub mod cross_section;
pub mod keller;
pub mod precession;
pub mod surface_area;
pub mod well_depth;
pub mod zone;

mod geometry;
mod probabilities;
mod rule;

pub use probabilities::FaceProbabilities;
pub use rule::{Rule, UnknownRule};
