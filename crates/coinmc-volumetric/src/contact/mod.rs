//! Sustained contact: on one rim point, and on the side.

mod follow;
mod integrator;
mod line;
pub(crate) mod rim;
mod state;

pub(crate) use follow::{Contact, FLAT, Leave};
pub(crate) use rim::{Law, fastest};

#[cfg(test)]
mod tests;
