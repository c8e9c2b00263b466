//! The kinds of lanes, and which of them a processor has.

use crate::portable;
use crate::wide::Work;
#[cfg(target_arch = "x86_64")]
use crate::{avx2, avx512};
use std::fmt;
use thiserror::Error;

/// How many numbers are computed at once, and with which instructions. The results are
/// bit-identical with all of them.
///
/// # Example
/// ```
/// use coinmc_lanes::Lanes;
/// assert!(Lanes::best().is_available() && Lanes::Scalar.is_available());
/// println!("{} of {:?}", Lanes::best(), Lanes::ALL);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lanes {
    /// One at a time.
    Scalar,
    /// Eight at once, with the vector instructions that every processor of the architecture has.
    Portable,
    /// Eight at once, in two registers of AVX2.
    Avx2,
    /// Eight at once, in one register of AVX-512.
    Avx512,
}

/// The processor lacks the instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this processor does not support {0} lanes; Lanes::best() names the best it supports")]
pub struct NoSuchLanes(pub Lanes);

impl Lanes {
    /// All kinds, whether this processor has them or not.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Portable, Self::Avx2, Self::Avx512];

    /// The fastest lanes of this processor. In WebAssembly without vector instructions portable lanes are
    /// arrays, and one number at a time is faster.
    pub fn best() -> Self {
        let vectors = [Self::Avx512, Self::Avx2];
        let best = vectors.into_iter().find(|lanes| lanes.is_available());
        let other = if cfg!(all(target_arch = "wasm32", not(target_feature = "simd128"))) {
            Self::Scalar
        } else {
            Self::Portable
        };
        best.unwrap_or(other)
    }

    /// Whether this processor has them.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar | Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => avx512::is_available(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// These lanes, if this processor has them.
    ///
    /// # Errors
    /// [`NoSuchLanes`] if it lacks their instructions.
    pub fn available(self) -> Result<Self, NoSuchLanes> {
        if self.is_available() {
            Ok(self)
        } else {
            Err(NoSuchLanes(self))
        }
    }

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Runs the work with these lanes, or with portable ones if this processor does not have them.
    #[inline]
    pub fn enter<W: Work>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        let entered = match self {
            Self::Avx512 => avx512::enter(work),
            Self::Avx2 => avx2::enter(work),
            Self::Portable | Self::Scalar => Err(work),
        };
        #[cfg(not(target_arch = "x86_64"))]
        let entered: Result<W::Output, W> = Err(work);
        entered.unwrap_or_else(W::run::<portable::Eight>)
    }
}

impl fmt::Display for Lanes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
