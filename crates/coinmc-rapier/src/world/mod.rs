//! Rapier's world: a half-space and coins above it, each in a numbered slot. The coins do not touch
//! one another. Lengths in D, times in sqrt(D/g).

#[cfg(not(feature = "rapier"))]
mod absent;
#[cfg(feature = "rapier")]
mod rapier;

#[cfg(not(feature = "rapier"))]
pub(crate) use absent::World;
#[cfg(feature = "rapier")]
pub(crate) use rapier::World;
