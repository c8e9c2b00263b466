//! Free flight: closed form from contact to contact, and a first contact that is never missed.

mod bounds;
mod departure;
mod gap;
mod orbit;
mod profile;
mod search;

pub(crate) use bounds::{Bounds, Extent};
pub(crate) use departure::Departure;
pub(crate) use gap::Gap;
pub(crate) use orbit::{Orbit, OrbitState, velocity_left};
pub(crate) use profile::OneRim;
pub(crate) use search::{MAX_EVALUATIONS, Search, first_contact, least_time};

#[cfg(test)]
mod tests;
