//! What was measured: numbers that a law connects with one parameter, and counts of faces.
//!
//! Each law is derived in docs/methods/calibrate.md; each file here reads the keys of one table of the
//! config and reduces its readings to a number with its standard error.

mod bounces;
mod counts;
mod drops;
mod readings;
mod roll_out;
mod scatter;
mod spin_down;
mod tilt;
mod whirr;

pub(crate) use bounces::Bounces;
pub(crate) use counts::CountsGiven;
pub(crate) use drops::Drops;
pub(crate) use roll_out::RollOut;
pub(crate) use spin_down::SpinDown;
pub(crate) use tilt::Tilt;
pub use whirr::rolling_friction_of_whirr;
pub(crate) use whirr::{Whirr, rate_per_length as whirr_rate};

use crate::Parameter;
use coinmc_core::Scene;

/// A kind of measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Counts of faces.
    Counts,
    /// Filmed drops.
    Film,
    /// How far the coin rolls from a ramp.
    RollOut,
    /// The angle at which the coin slides.
    Tilt,
    /// How a spinning coin slows down.
    SpinDown,
    /// How the pitch of a whirring coin rises.
    Whirr,
    /// When a dropped coin bounces.
    Bounces,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Counts,
        Self::Film,
        Self::RollOut,
        Self::Tilt,
        Self::SpinDown,
        Self::Whirr,
        Self::Bounces,
    ];

    /// The name of its table in configs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Counts => "counts",
            Self::Film => "film",
            Self::RollOut => "roll_out",
            Self::Tilt => "tilt",
            Self::SpinDown => "spin_down",
            Self::Whirr => "whirr",
            Self::Bounces => "bounces",
        }
    }
}

/// A number that can be measured, as a function of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// The parameter times a factor: ρ_c/R, g ρ_p/k_t, …
    Times(Parameter, f64),
    /// The angle atan μ at which the coin slides, degrees.
    SlidingAngle,
    /// ln e.
    LogRestitution,
}

impl Law {
    /// The parameter on which it depends.
    pub const fn parameter(self) -> Parameter {
        match self {
            Self::Times(parameter, _) => parameter,
            Self::SlidingAngle => Parameter::Friction,
            Self::LogRestitution => Parameter::Restitution,
        }
    }

    /// Its value.
    pub fn at(self, parameter: f64) -> f64 {
        match self {
            Self::Times(_, factor) => factor * parameter,
            Self::SlidingAngle => libm::atan(parameter).to_degrees(),
            Self::LogRestitution => libm::log(parameter),
        }
    }

    /// The parameter at which it has a value; out of range where there is none.
    pub fn inverse(self, value: f64) -> f64 {
        match self {
            Self::Times(_, factor) => value / factor,
            Self::SlidingAngle => libm::tan(value.to_radians()),
            Self::LogRestitution => libm::exp(value),
        }
    }
}

/// A measured number.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// What was measured.
    pub kind: Kind,
    /// Which table of the config it is from, such as `tilt 2`.
    pub name: String,
    /// What it tells.
    pub law: Law,
    /// The number, of the quantity that the law gives.
    pub value: f64,
    /// Its standard error, of the same unit …
    pub absolute: f64,
    /// … and as a share of what the law gives; both add up in squares.
    pub relative: f64,
    /// How many times as large as stated the error is, because the readings scatter so much more than it allows.
    pub excess: f64,
}

impl Reading {
    /// The standard error if the law gives this value.
    pub fn error_at(&self, predicted: f64) -> f64 {
        let relative = self.relative * predicted;
        (self.absolute * self.absolute + relative * relative).sqrt()
    }

    /// ln of its probability density, but for a constant.
    pub fn log_likelihood(&self, parameter: f64) -> f64 {
        let predicted = self.law.at(parameter);
        let error = self.error_at(predicted);
        let off = (self.value - predicted) / error;
        -0.5 * off * off - libm::log(error)
    }
}

/// What one table of readings says, before it has its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reduced {
    pub(crate) law: Law,
    pub(crate) value: f64,
    pub(crate) absolute: f64,
    pub(crate) relative: f64,
}

/// Reads the readings of a table in its scene.
pub(crate) trait Reduce {
    const KIND: Kind;
    /// The numbers that it gives, with the coin and the gravity of its scene.
    fn reduce(&self, scene: &Scene) -> Vec<Reduced>;
    /// How many times as large as stated the errors are in that, because readings [scatter](scatter) more.
    fn excess(&self) -> f64 {
        1.0
    }
}
