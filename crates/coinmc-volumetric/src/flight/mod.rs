//! Free flight: closed form from contact to contact, and a first contact that is never missed.

mod orbit;
mod search;

pub(crate) use orbit::{Drag, Orbit};
pub(crate) use search::{Departure, first_contact};

#[cfg(test)]
mod tests;
