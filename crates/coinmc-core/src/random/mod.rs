//! Random numbers as input, not state.
//!
//! A counter-based generator maps (seed, domain, point, toss, draw) to a number, so any toss can
//! be computed by itself, anywhere, in any order: no generator is seeded, split or advanced.

mod philox;
mod stream;

pub use philox::Philox4x64;
pub(crate) use stream::EachUniforms;
pub use stream::{Domain, Stream, TossUniforms, UniformSource, unit_interval};
