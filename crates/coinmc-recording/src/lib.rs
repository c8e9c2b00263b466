#![doc = include_str!("../README.md")]
//!
//! # Contents
//! * [`Recorder`] writes. Messages are JSON, told by serde; chunks can be compressed by LZ4, in
//!   Rust alone. What was flushed survives a crash.
//! * [`recover()`] reads what can be read of a file that was cut off or damaged, and writes it anew.
//! * [`foxglove`] has the messages that viewers draw.
//! * [`NewFile`] is a file that is there as a whole or not at all.

mod chunk;
mod compression;
mod error;
mod fields;
pub mod foxglove;
mod place;
mod recorder;
mod recover;
mod schema;
mod sink;
mod summary;
mod wire;
mod writer;

pub use compression::{Compression, UnknownCompression};
pub use error::Error;
pub use place::NewFile;
pub use recorder::{Channel, Recorder};
pub use recover::{Recovered, recover, salvage};
pub use schema::Schema;
pub use sink::{Passing, Sink};
pub use writer::{Attachment, Options};
