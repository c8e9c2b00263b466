#![doc = include_str!("../README.md")]
//!
//! # How it works
//! A kernel is written once over [`Lane`] and is run on the lanes that the processor has: with
//! [`Lanes::enter`] on eight at a time, or plainly on `f64`. A lane offers only what IEEE 754 fixes
//! to the last bit, so how many there are changes the speed and nothing else.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lane;
mod lanes;
mod operators;
mod portable;
mod route;
mod trig;
mod wide;

pub use lane::{Lane, Mask};
pub use lanes::{Lanes, NoSuchLanes};
pub use route::Route;
pub use trig::{COSINE, PI_2_TAIL, SINE, sin_cos, sin_cos_near_zero};
pub use wide::{Bits, Block, WIDTH, Wide, Work, first, lanes_of};
