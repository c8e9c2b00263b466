//! The oracles against closed forms and against each other.

mod common;
mod contact;
mod equations;
mod flight;
mod ground;
mod tosses;
