//! Sustained contact: on one rim point, and on the side.

pub(crate) mod attempt;
mod events;
mod follow;
pub(crate) mod integrator;
mod line;
pub(crate) mod rim;
pub(crate) mod state;

pub(crate) use events::Reach;
pub(crate) use follow::{Contact, FLAT, Leave, Next, Phase, Spent};
pub(crate) use rim::{Law, fastest};

#[cfg(test)]
mod tests;
