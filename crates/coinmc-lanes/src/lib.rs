#![doc = include_str!("../README.md")]
//!
//! # How it works
//! A kernel is written once, generic over [`Lane`]. It runs on one `f64`, or with [`Lanes::enter`]
//! on eight lanes of the instruction set that the processor has. A lane offers only operations
//! whose results IEEE 754 fixes to the last bit, so the number of lanes changes the speed and
//! nothing else.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lane;
mod lanes;
mod operators;
// An optimized program for x86-64 computes one number at a time where there is no AVX2: portable kernels
// would be a third of the engine in space and of the time to compile it, for processors of before 2015.
#[cfg(any(not(target_arch = "x86_64"), debug_assertions))]
mod portable;
mod route;
mod trig;
mod wide;

pub use lane::{Lane, Mask};
pub use lanes::{Lanes, NoSuchLanes};
pub use route::Route;
pub use trig::{COSINE, PI_2_TAIL, SINE, sin_cos, sin_cos_near_zero};
pub use wide::{Bits, Block, WIDTH, Wide, Work, first, lanes_of};
