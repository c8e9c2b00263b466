//! Launches, the initial states of tosses, and their distributions.

mod config;
mod draw;
mod lanes;
mod marginal;
mod orientation;
mod preset;
mod sincos;
mod source;
mod spin;
mod starts;

pub use lanes::Launches;
pub use marginal::{Marginal, inverse_normal_cdf};
pub use orientation::Orientation;
pub use preset::Preset;
pub use source::LaunchSource;
pub use spin::Spin;
pub use starts::Starts;

use crate::{Coin, Stream, UniformSource};
use coinmc_lanes::{Lane, Lanes};
use draw::{Draw, Uniforms, sample3};
use nalgebra::{UnitVector3, Vector3};
use std::ops::Range;
use thiserror::Error;

/// One initial state. The coin is a body of revolution, so rotation about its axis has no effect
/// and the axis alone gives its orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Launch {
    /// Height of the centre above the surface, m. A coin that would start inside the surface is
    /// lifted until it touches.
    pub height_m: f64,
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// u, the outward normal of the heads face.
    pub axis: UnitVector3<f64>,
    /// Angular velocity in the laboratory frame, rad/s.
    pub spin_rad_s: Vector3<f64>,
}

/// Dimensions of the launch. Each quantity has its own dimensions, random or not, so that two
/// distributions that differ in one quantity share the random numbers of all others. The most used
/// dimensions come first, because they share one Philox block.
pub(crate) mod dimension {
    pub(crate) const ORIENTATION: [u32; 3] = [0, 1, 2];
    pub(crate) const SPIN: [u32; 3] = [3, 4, 5];
    pub(crate) const HEIGHT: u32 = 6;
    pub(crate) const VELOCITY: [u32; 3] = [7, 8, 9];
}

/// The distribution of launches: independent marginals mapped by inverse CDF.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Preset, Stream};
/// let coin = Coin::cylinder(1.5, 0.01)?;
/// let launches = Preset::Robot.distribution();
/// let launch = launches.launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// assert!(launch.spin_rad_s.y >= 0.0 && launch.spin_rad_s.y <= 10.0 * std::f64::consts::PI);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaunchDistribution {
    /// Height of the centre, m.
    pub height_m: Marginal,
    /// Velocity of the centre, component by component, m/s.
    pub velocity_m_s: [Marginal; 3],
    /// Orientation of the coin.
    pub orientation: Orientation,
    /// Spin of the coin.
    pub spin: Spin,
}

/// What is wrong with a launch distribution.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LaunchError {
    /// A parameter is NaN or infinite.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// A uniform marginal has `from` > `to`.
    #[error("uniform from {from} to {to} is empty")]
    EmptyRange {
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// A standard deviation is negative.
    #[error("standard deviation must not be negative, found {0}")]
    NegativeDeviation(f64),
}

impl LaunchDistribution {
    /// Checks every marginal.
    ///
    /// # Errors
    /// The first [`LaunchError`] in the order height, velocity, orientation, spin.
    pub fn validate(&self) -> Result<(), LaunchError> {
        self.height_m.validate()?;
        self.velocity_m_s.iter().try_for_each(Marginal::validate)?;
        self.orientation.validate()?;
        self.spin.validate()
    }

    /// Computes a launch from uniform random numbers.
    pub fn launch(&self, coin: &Coin, uniforms: &mut impl UniformSource) -> Launch {
        self.draw(coin, uniforms).launch(|&number| number)
    }

    /// The launches of these tosses, drawn several at a time with these lanes (one at a time where there are
    /// none): each is the [`launch`](Self::launch) of its toss, bit for bit.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Domain, Lanes, Preset, Stream};
    /// let coin = Coin::cylinder(1.5, 0.01)?;
    /// let launches = Preset::Clean.distribution();
    /// let stream = Stream::new(1, Domain::Launch, 0);
    /// let many: Vec<_> = launches.launches(&coin, &stream, 7..20, Lanes::best()).collect();
    /// assert_eq!(many.len(), 13);
    /// assert_eq!(many[5], launches.launch(&coin, &mut stream.toss(12)));
    /// # Ok::<(), coinmc_core::CoinError>(())
    /// ```
    pub fn launches(
        &self,
        coin: &Coin,
        stream: &Stream,
        tosses: Range<u64>,
        lanes: Lanes,
    ) -> Launches {
        Launches::new(self, coin, stream, tosses, lanes)
    }

    /// One launch, or one per lane.
    #[inline(always)]
    fn draw<L: Lane>(&self, coin: &Coin, uniforms: &mut impl Uniforms<L>) -> Draw<L> {
        let axis = self.orientation.draw(uniforms);
        Draw {
            axis,
            spin: self.spin.draw(coin, axis, uniforms),
            height: self.height_m.sample(dimension::HEIGHT, uniforms),
            velocity: sample3(&self.velocity_m_s, dimension::VELOCITY, uniforms),
        }
    }

    /// Whether every launch moves in the xz plane: axis in it and spin about y, as the flat
    /// engine requires. (A velocity along y is carried along unchanged by a smooth plane and is
    /// excluded too.)
    pub fn is_planar(&self) -> bool {
        self.orientation.is_planar()
            && self.spin.is_planar()
            && self.velocity_m_s[1] == Marginal::Constant(0.0)
    }
}
