//! Free flight: closed form from contact to contact, and a first contact that is never missed.

mod orbit;
mod search;
mod station;

pub(crate) use orbit::{Drag, Orbit};
pub(crate) use search::{Departure, first_contact, least_time};
pub(crate) use station::{Departing, Group, Leavers, MOTION, load, store};

#[cfg(test)]
mod tests;
