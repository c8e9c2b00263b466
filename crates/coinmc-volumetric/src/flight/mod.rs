//! Free flight: closed form from contact to contact, and a first contact that is never missed.

mod orbit;
mod search;
mod searching;
mod station;

pub(crate) use orbit::{Drag, Orbit};
pub(crate) use search::{Departure, first_contact, least_time};
pub(crate) use searching::Searching;
pub(crate) use station::{Departing, Leavers, MOTION, load, store};

#[cfg(test)]
mod tests;
