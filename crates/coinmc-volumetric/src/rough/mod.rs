//! Rough ground: sustained contact and low hops on a random height field.
//!
//! # Law
//! The ground is z = h(x, y), a stationary isotropic Gaussian field of rms slope s and correlation
//! C(r) = σ² exp(−r²/2ℓ²), σ = sℓ. To first order in the slope, a rim point that rolls needs only to
//! follow the height of the ground under it: static friction supplies whatever the tilt of the normal
//! would change. So the coin moves as on a level plane that rises and falls under each rim. In a frame
//! that rises at the rate of the ground under the touching rim, its equations of motion are exactly
//! those on a plane, gyroscopic torque and weight included, as long as that rate is constant. Hence
//! the law: *between nodes, `ground_step`·ℓ apart along the way, the ground under either rim rises at
//! a constant rate; at a node the rate changes, and the rim follows or leaves the ground.*
//!
//! * The height under a rim is that of the dilated field: a rim bridges hollows that are narrower than
//!   its own curvature ([`ground`]).
//! * A bend that the rim can follow is followed without loss: hollows whose curvature is below that
//!   of the rim, and bumps over which the ground falls away more slowly than the rim would. The rest
//!   of a hollow's bend is an impact by the impact law; beyond a bump the coin hops.
//! * The other rim touches when it meets its own track. Both rims stay down while the normal forces
//!   that this takes are positive.
//! * A slope pulls a coin in contact downhill ([`slopes`]).
//! * An impact is one with the plane that touches the ground there, under any law ([`incline`], [`impact`]).
//! * Mechanical energy is a budget that only impacts and friction reduce. What a coin that rolls gains by
//!   climbing is taken from its velocities at every node, and returned on the way down.
//!
//! Where on the field a coin lands is random: a hash of its motion, so that a toss remains a pure
//! function of its launch. Ground that rises against the rim is met more often. High flights end on other
//! ground.
//!
//! # Range
//! First order in s. The limits s → 0 and ℓ → ∞ are the plane. A coin on one rim that leans far beyond
//! the balance, or is flatter than [`FLATTEST`], moves as on a plane.
//!
//! # Modules
//! Each line uses only the lines above it:
//!
//! - `field` the random field in its own units · `ground` what a rim meets · `random_place` where
//! - `tracks` the ground under both rims · `rims_in_flight` where they are in flight
//! - `incline` the plane that touches the ground
//! - `walk` the state of a coin and the loop; `balance` its energy; `impact` its impacts; `hop`, `rim_contact`,
//!   `both_rims` its three kinds of motion; `slopes` their pull; `decision` its end

mod balance;
mod both_rims;
mod decision;
mod field;
mod ground;
mod hop;
mod impact;
mod incline;
mod random_place;
mod rim_contact;
mod rims_in_flight;
mod slopes;
#[cfg(test)]
mod test_scenes;
mod tracks;
mod walk;

pub(crate) use ground::Ground;
pub(crate) use walk::FLATTEST;
