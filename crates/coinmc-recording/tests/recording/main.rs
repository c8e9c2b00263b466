//! Recordings as other readers see them, and what is left of them after any damage.

mod common;
mod damage;
mod limits;
mod read_back;
mod truncation;
