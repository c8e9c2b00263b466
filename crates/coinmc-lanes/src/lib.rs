//! Arithmetic on one number, or on eight side by side, the same to the last bit.
//!
//! A kernel is written once over [`Lane`] and is run on the lanes that the processor has: with
//! [`Lanes::enter`] on eight at a time, or plainly on `f64`. A lane offers only what IEEE 754 fixes
//! to the last bit, so how many there are changes the speed and nothing else.
//!
//! # Example
//! ```
//! use coinmc_lanes::{Block, Lanes, Wide, Work};
//!
//! struct Roots<'a>(&'a mut Block);
//!
//! impl Work for Roots<'_> {
//!     type Output = ();
//!
//!     #[inline(always)]
//!     fn run<L: Wide>(self) {
//!         *self.0 = L::load(self.0).sqrt().store();
//!     }
//! }
//!
//! let mut numbers = [1.0, 4.0, 9.0, 16.0, 25.0, 36.0, 49.0, 64.0];
//! Lanes::best().enter(Roots(&mut numbers));
//! assert_eq!(numbers, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
//! ```

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
