//! A filmed drop.

/// Greatest number of frames of a drop.
pub const MAX_FRAMES: usize = 100_000;

/// A filmed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coordinate {
    /// Horizontal position of the centre.
    X,
    /// Height of the centre.
    Z,
    /// Angle θ of the coin's axis from the vertical: u = (sin θ, cos θ) in the plane (x, z).
    Theta,
}

impl Coordinate {
    /// All coordinates, in the order of every table.
    pub const ALL: [Self; 3] = [Self::X, Self::Z, Self::Theta];

    /// The name used in results, with the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x_m",
            Self::Z => "z_m",
            Self::Theta => "theta_rad",
        }
    }

    pub(crate) fn index(self) -> usize {
        self as usize
    }
}

/// One frame; `None` for an unmarked point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Time, s, from the film's own origin.
    pub time_s: f64,
    /// x and z of the centre, m, and θ, rad (up to whole turns), as [`Coordinate::ALL`] orders
    /// them.
    pub seen: [Option<f64>; 3],
}

/// The frames of one drop in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmedDrop {
    /// Name in messages and tables.
    pub name: String,
    /// The frames.
    pub frames: Vec<Frame>,
}

impl FilmedDrop {
    /// Frame rate, 1/s: the inverse of the median time between frames. 0 for fewer than two frames.
    pub fn rate_hz(&self) -> f64 {
        let mut steps: Vec<f64> = self
            .frames
            .windows(2)
            .map(|pair| pair[1].time_s - pair[0].time_s)
            .collect();
        median(&mut steps).map_or(0.0, |step| 1.0 / step)
    }
}

/// The median of the values, which it sorts; the lower one of the two in the middle.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}

/// An angle without whole turns, in [−π, π].
pub(crate) fn wrapped(angle: f64) -> f64 {
    libm::remainder(angle, std::f64::consts::TAU)
}
