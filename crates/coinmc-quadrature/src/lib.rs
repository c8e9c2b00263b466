#![doc = include_str!("../README.md")]
//!
//! # What decides an adhesive landing
//! No point of the coin is farther from its centre than D = sqrt(R² + H²/4), so nothing touches
//! before the centre has come down to D. The height of the centre at which a coin touches,
//! s(u) = R sqrt(1 − u_z²) + (H/2)|u_z|, reaches D just where |u_z| = sin α, the border between the
//! side and a face (see [`coinmc_analytic`]). Below D the axis cannot cross that border without
//! having touched before. Hence
//!
//! > the axis **at the moment when the centre passes D on its way down** decides the face:
//! > side ⇔ `|u_z| < sin α` at that moment,
//!
//! for any spin, with or without drag, if the coin is released at or above D. No search for the
//! first contact is needed. Until then u turns about the fixed direction of its angular momentum
//! (without gyroscopic torque: of its angular velocity), `u_z = A + B cos(φ₀ + wτ)`, and the moment
//! follows from height and vertical velocity alone.
//!
//! # Methods
//! * [`Method::Zone`]: the joint distribution of axis and spin is invariant under rotation, so the
//!   axis is isotropic at that moment too: P(side) = sin α, exact.
//! * [`Method::Arc`]: a planar toss whose tilt is uniform over whole turns: P(side) = 2α/π, exact.
//! * [`Method::Over`]: one random quantity (the azimuth of an isotropic axis, or one in which the
//!   phase is monotone: tilt, rate of spin, vertical velocity, height) is integrated out in closed
//!   form, the other random quantities by scrambled Sobol points.
//! * [`Method::Tossed`]: where none of these applies and few quantities are random, the engine
//!   tosses at scrambled Sobol points.
//!
//! In all other cases random tosses are as good.
//!
//! Sixteen independent scrambles give a Student interval: see [`integrate`].
//!
//! # Files
//! `passage` when the centre passes D · `axis` how the axis turns until then · `variable` the
//! quantity integrated out · `method` which method a scene has · `conditional` the closed form ·
//! `sobol` the points · `replicates` scrambles, interval, stopping · `integrate` one scene.

mod axis;
mod conditional;
mod integral;
mod integrate;
mod method;
mod passage;
mod replicates;
mod sobol;
mod variable;

pub use integral::{Integral, Share};
pub use integrate::integrate;
pub use method::Method;
pub use replicates::{Goal, MAX_EVALUATIONS, MIN_EVALUATIONS, REPLICATES};
pub use sobol::{DIMENSIONS, Points, Sobol};
pub use variable::Variable;
