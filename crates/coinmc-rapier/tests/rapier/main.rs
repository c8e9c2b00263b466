//! Tosses in time steps: the same for everybody, the same for both faces, right in the limits, never
//! above their energy, and unharmed by anything they are given.

mod common;
mod determinism;
mod hostile;
mod limits;
mod physics;
mod skips;
mod symmetry;
mod watching;
