//! Tosses seen again: as they were, written down right, found by how they went.

mod files;
mod motion;
mod plans;
mod refusals;
mod replay;
mod searching;
