//! The kinds of lanes, and which of them a processor has.

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
    /// Eight at once, with the vector instructions that every processor of the architecture has. Not in an
    /// optimized program for x86-64.
    Portable,
    /// Eight at once, in two registers of AVX2.
    Avx2,
    /// Eight at once, in one register of AVX-512.
    Avx512,
}

/// The processor lacks the instructions, or the program the lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this program or processor has no {0} lanes; Lanes::best() names the best it has")]
pub struct NoSuchLanes(pub Lanes);

impl Lanes {
    /// All kinds, whether there are any here or not.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Portable, Self::Avx2, Self::Avx512];

    /// The fastest lanes of this processor. In WebAssembly without vector instructions portable lanes are
    /// arrays, and one number at a time is faster.
    pub fn best() -> Self {
        if cfg!(all(target_arch = "wasm32", not(target_feature = "simd128"))) {
            return Self::Scalar;
        }
        Self::wide().next().unwrap_or(Self::Scalar)
    }

    /// The lanes of eight that are [available](Self::is_available), the fastest first. On x86-64 without AVX2
    /// there may be none.
    pub fn wide() -> impl Iterator<Item = Self> {
        let all = [Self::Avx512, Self::Avx2, Self::Portable];
        all.into_iter().filter(|lanes| lanes.is_available())
    }

    /// Whether this program has them, and this processor their instructions.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar => true,
            Self::Portable => cfg!(any(not(target_arch = "x86_64"), debug_assertions)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => avx512::is_available(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// These lanes, if there are any.
    ///
    /// # Errors
    /// [`NoSuchLanes`] unless they are [available](Self::is_available).
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

    /// Runs the work with these lanes.
    ///
    /// # Panics
    /// If they are none of [`wide`](Self::wide): [`Scalar`](Self::Scalar) has no eight lanes.
    #[inline]
    pub fn enter<W: Work>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        let entered = match self {
            Self::Avx512 => avx512::enter(work),
            Self::Avx2 => avx2::enter(work),
            #[cfg(debug_assertions)]
            Self::Portable => Some(work.run::<crate::portable::Eight>()),
            _ => None,
        };
        #[cfg(not(target_arch = "x86_64"))]
        let entered = (self == Self::Portable).then(|| work.run::<crate::portable::Eight>());
        entered.unwrap_or_else(|| panic!("{}", NoSuchLanes(self)))
    }
}

impl fmt::Display for Lanes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
