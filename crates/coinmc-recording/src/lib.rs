#![doc = include_str!("../README.md")]
//!
//! # Contents
//! * [`Recorder`] writes. Messages are encoded as Protocol Buffers or as JSON, from what serde makes of
//!   them; chunks can be compressed with LZ4, in pure Rust. Everything that was flushed survives a crash.
//! * [`recover()`] copies what is readable in a truncated or damaged file to a new one.
//! * [`foxglove`] holds the messages that viewers draw.
//! * [`NewFile`] is a file that appears complete or not at all.
//!
//! The `mcap` crate reads these files in the tests but does not write them: it defines a channel
//! only in the first chunk, so that losing this chunk loses the rest of the file; it has one
//! compression per file, with a C library for LZ4; and its reader stops at the first damaged byte.

mod chunk;
mod compression;
mod decode;
mod encode;
mod encoding;
mod error;
pub mod foxglove;
mod new_file;
mod protobuf;
mod recorder;
mod recover;
mod schema;
mod sink;
mod summary;
mod writer;

pub use compression::{Compression, UnknownCompression};
pub use encoding::{Encoding, UnknownEncoding};
pub use error::Error;
pub use new_file::{NewFile, sync_directory};
pub use protobuf::SchemaError;
pub use recorder::{Channel, Recorder};
pub use recover::{Recovered, recover, salvage};
pub use schema::Schema;
pub use sink::{Sink, Unsynced};
pub use writer::{Attachment, Options};
