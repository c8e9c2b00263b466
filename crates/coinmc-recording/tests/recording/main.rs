//! Recordings as another reader sees them, and their recovery after any damage.

mod common;
mod damage;
mod limits;
mod protobuf;
mod read_back;
mod truncation;
