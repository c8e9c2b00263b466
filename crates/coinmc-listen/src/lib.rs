#![doc = include_str!("../README.md")]
//!
//! # How it works
//! ```text
//! WAV ─▶ Recording ─▶ Onsets ─▶ Bounces ─┐                      drops: simulated drops that sound alike
//!                  └▶ Whirr              ├─▶ FromDrops
//! config ─▶ Observations ─▶ Tosser ─▶ Struck ─▶ Bounces, as they would be heard
//!                                  └▶ Synthetic: a Recording to test with
//! ```
//!
//! # Files
//! `wav`, `recording` WAV files · `spectrum`, `onsets` when something strikes · `envelope`, `chirp`, `whirr` the pitch of a
//! coin that settles · `struck` tosses of the engine until the coin rests · `heard` bounces, from a recording or a
//! toss · `regression`, `posterior` the surface from bounces · `settling` rolling friction from a whirr · `files` the
//! recordings · `listened` all recordings together · `written` JSON, CSV and
//! lines of a config · `rattle`, `synthetic` recordings of simulated tosses.

mod chirp;
mod envelope;
mod error;
mod files;
mod filter;
mod heard;
mod listened;
mod onsets;
mod posterior;
mod rattle;
mod recording;
mod regression;
mod settling;
mod spectrum;
mod struck;
mod synthetic;
mod wav;
mod whirr;
mod written;

pub use error::{ListenError, RecordingError};
pub use files::MOST_FILES;
pub use heard::{Bounces, NoBounces};
pub use listened::{Heard, Kind, RollingFriction, Told};
pub use onsets::{Onset, Onsets};
pub use posterior::{Effort, Estimated, FromDrops};
pub use recording::{MAX_SAMPLES, Recording};
pub use struck::{Strike, Struck, StruckError, Tosser};
pub use synthetic::Synthetic;
pub use whirr::{NoWhirr, Pitch, Whirr};
pub use written::{config, csv, document};
