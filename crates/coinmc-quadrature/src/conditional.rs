//! The probabilities of the faces if one quantity of a launch is random, in closed form.
//!
//! The phase Φ at the passage is monotone in that quantity, so its distribution function G is that
//! of the quantity at the value that leads to Φ. Heads shows for cos Φ > (sin α − A)/B, an interval
//! about each whole turn; tails for cos Φ < −(sin α + A)/B, an interval about each half turn. Each
//! has the probability Σ G(end) − G(start); a wide normal distribution has a Fourier series of a
//! few terms. An azimuth is simpler: the axis ends uniformly on a circle.

use crate::axis::Turning;
use crate::passage::{Passage, support};
use crate::variable::{Variable, rate, without};
use coinmc_core::{Launch, LaunchDistribution, Marginal, Orientation, Scene, UniformSource};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// Turns over which the quantity may spread the phase; beyond them the quantity is drawn.
const MAX_TURNS: f64 = 256.0;
/// Largest phase, rad, with enough digits left for the sum.
const MAX_PHASE: f64 = 1e9;

/// A scene whose launches are given except for one quantity.
#[derive(Debug)]
pub(crate) struct Conditional<'a> {
    scene: &'a Scene,
    passage: Passage,
    variable: Variable,
    marginal: Marginal,
    /// The launches without the quantity.
    rest: LaunchDistribution,
    /// sin α.
    border: f64,
}

/// The probabilities of the faces for one launch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Faces {
    /// P(heads), P(tails), P(side).
    pub(crate) p: [f64; 3],
    /// The quantity was drawn, not integrated out: one probability is 1.
    pub(crate) drawn: bool,
}

impl Faces {
    fn integrated(p: [f64; 3]) -> Self {
        Self { p, drawn: false }
    }
}

/// Phases and their distribution function.
struct Phases<'a> {
    conditional: &'a Conditional<'a>,
    launch: Launch,
    turning: Turning,
    /// The phase at value 0 of tilt or rate, or at time 0 for velocity or height.
    origin: f64,
    /// Change of the phase with tilt or rate.
    slope: f64,
}

impl<'a> Conditional<'a> {
    pub(crate) fn new(scene: &'a Scene, launches: &LaunchDistribution, variable: Variable) -> Self {
        let marginal = match (variable, launches.orientation) {
            (Variable::Tilt, Orientation::Tilt(tilt)) => tilt,
            (Variable::Rate, _) => rate(&launches.spin).unwrap_or(Marginal::Constant(0.0)),
            (Variable::Velocity, _) => launches.velocity_m_s[2],
            _ => launches.height_m,
        };
        let half = scene.coin.ratio() / 2.0;
        Self {
            scene,
            passage: Passage::new(scene),
            variable,
            marginal,
            rest: without(launches, variable),
            border: half / libm::hypot(1.0, half),
        }
    }

    /// P(heads), P(tails), P(side), with the other quantities of the launch drawn from `uniforms`.
    /// `drawn` is a uniform for the quantity itself, in case it spreads the phase over too many
    /// turns. All are zero where numbers leave their range.
    pub(crate) fn faces(&self, uniforms: &mut impl UniformSource, drawn: f64) -> Faces {
        let launch = self.rest.launch(&self.scene.coin, uniforms);
        if self.variable == Variable::Azimuth {
            return Faces::integrated(self.over_azimuth(&launch));
        }
        let phases = Phases::new(self, launch);
        let Turning { along, across, .. } = phases.turning;
        let (heads, tails) = (self.border - along, self.border + along);
        if let Some(normal) = phases.wide_normal() {
            let heads = normal.within(0.0, half_width(heads, across));
            let tails = normal.within(PI, half_width(tails, across));
            return Faces::integrated([heads, tails, (1.0 - heads - tails).max(0.0)]);
        }
        let (from, to) = phases.range();
        if !(to - from).is_finite() {
            return Faces::integrated([0.0; 3]);
        }
        if to - from > MAX_TURNS * TAU || from.abs().max(to.abs()) > MAX_PHASE {
            let phase = phases.at(self.marginal.quantile(drawn));
            let cos = across * libm::cos(phase);
            let heads = f64::from(u8::from(cos > heads));
            let tails = f64::from(u8::from(cos < -tails));
            return Faces {
                p: [heads, tails, 1.0 - heads - tails],
                drawn: true,
            };
        }
        let heads = phases.within(0.0, half_width(heads, across));
        let tails = phases.within(PI, half_width(tails, across));
        // rounding may make it negative
        Faces::integrated([heads, tails, (1.0 - heads - tails).max(0.0)])
    }

    /// Whether the quantity can be integrated out if nothing else is random: it does not spread the
    /// phase over too many turns.
    pub(crate) fn is_integrable(&self) -> bool {
        struct Constant;
        impl UniformSource for Constant {
            fn uniform(&mut self, _: u32) -> f64 {
                0.5
            }
        }
        !self.faces(&mut Constant, 0.5).drawn
    }

    /// The probabilities over the azimuth. With the angular velocity ω given, an isotropic axis has
    /// a uniform component along ω and a uniform azimuth about it. Another azimuth turns the whole
    /// flight about ω, so the axis ends uniformly on a circle about ω.
    fn over_azimuth(&self, launch: &Launch) -> [f64; 3] {
        let along = launch.axis.z;
        let rate = launch.spin_rad_s.norm();
        // the same flight turned so that ω points up
        let upright = Launch {
            axis: UnitVector3::new_unchecked(Vector3::new(
                (1.0 - along * along).sqrt(),
                0.0,
                along,
            )),
            spin_rad_s: Vector3::new(0.0, 0.0, rate),
            ..*launch
        };
        let turning = Turning::of(&upright, self.scene);
        let time = self.passage.time(launch.height_m, launch.velocity_m_s.z);
        let phase = turning.phase + turning.rate * self.passage.turning_time(time);
        if !phase.is_finite() {
            return [0.0; 3];
        }
        let along = turning.along + turning.across * libm::cos(phase);
        let rise = if rate > 0.0 {
            launch.spin_rad_s.z / rate
        } else {
            0.0
        };
        let across = ((1.0 - along * along).max(0.0) * (1.0 - rise * rise).max(0.0)).sqrt();
        shares_of_circle(self.border, along * rise, across)
    }
}

/// A phase with a normal distribution that spreads over a good part of a turn, rad.
struct WideNormal {
    mean: f64,
    sd: f64,
}

impl WideNormal {
    /// The probability of a phase within `half` of `centre`, modulo whole turns: the Fourier series
    /// of that interval, each term damped by the characteristic function e^(−k²σ²/2) of the normal.
    fn within(&self, centre: f64, half: f64) -> f64 {
        // e^(−40) is below rounding; eight terms at σ = 1
        const SMALLEST: f64 = -40.0;
        let (mut sum, mut k) = (half / PI, 1.0);
        loop {
            let damping = -0.5 * (k * self.sd) * (k * self.sd);
            if damping < SMALLEST {
                return sum.clamp(0.0, 1.0);
            }
            let wave = libm::sin(k * half) * libm::cos(k * (self.mean - centre));
            sum += 2.0 * wave * libm::exp(damping) / (PI * k);
            k += 1.0;
        }
    }
}

/// The shares of heads, tails and side on a circle about `along` of radius `across`.
fn shares_of_circle(border: f64, along: f64, across: f64) -> [f64; 3] {
    let heads = half_width(border - along, across) / PI;
    let tails = half_width(border + along, across) / PI;
    [heads, tails, (1.0 - heads - tails).max(0.0)]
}

/// Half the length of the interval on which across·cos exceeds a level.
fn half_width(level: f64, across: f64) -> f64 {
    if level >= across {
        0.0
    } else if level <= -across {
        PI
    } else {
        libm::acos(level / across)
    }
}

impl<'a> Phases<'a> {
    fn new(conditional: &'a Conditional<'a>, launch: Launch) -> Self {
        let Conditional { passage, scene, .. } = conditional;
        let turning = Turning::of(&launch, scene);
        let mut phases = Self {
            conditional,
            launch,
            turning,
            origin: turning.phase,
            slope: 0.0,
        };
        let turned = || {
            let time = passage.time(launch.height_m, launch.velocity_m_s.z);
            passage.turning_time(time)
        };
        match conditional.variable {
            Variable::Tilt => {
                // u_z = cos(tilt + ω τ), in either sense of rotation
                let spin = launch.spin_rad_s.y;
                phases.turning = Turning {
                    along: 0.0,
                    across: 1.0,
                    phase: 0.0,
                    rate: spin,
                };
                phases.origin = if spin == 0.0 { 0.0 } else { spin * turned() };
                phases.slope = 1.0;
            }
            Variable::Rate => phases.slope = turning.rate * turned(),
            Variable::Velocity | Variable::Height | Variable::Azimuth => {}
        }
        phases
    }

    /// The distribution of the phase, if it is linear in a normal quantity and has a standard
    /// deviation of a radian or more: the series is then shorter than the sum over turns.
    fn wide_normal(&self) -> Option<WideNormal> {
        let Conditional { marginal, .. } = self.conditional;
        let Marginal::Normal { mean, sd } = *marginal else {
            return None;
        };
        let normal = WideNormal {
            mean: self.at(mean),
            sd: self.slope * sd,
        };
        let linear = matches!(self.conditional.variable, Variable::Tilt | Variable::Rate);
        let fits = normal.sd >= 1.0 && normal.sd.is_finite() && normal.mean.abs() < MAX_PHASE;
        (linear && fits).then_some(normal)
    }

    /// The phase at a value of the quantity.
    fn at(&self, value: f64) -> f64 {
        let passage = &self.conditional.passage;
        let (h, v) = (self.launch.height_m, self.launch.velocity_m_s.z);
        let time = match self.conditional.variable {
            Variable::Tilt | Variable::Rate => return self.origin + self.slope * value,
            Variable::Velocity => passage.time(h, value),
            Variable::Height | Variable::Azimuth => passage.time(value, v),
        };
        self.origin + self.turning.rate * passage.turning_time(time)
    }

    /// The least and the largest phase.
    fn range(&self) -> (f64, f64) {
        let (low, high) = support(&self.conditional.marginal);
        (self.at(low), self.at(high))
    }

    /// P(phase <= Φ).
    fn below(&self, phase: f64) -> f64 {
        let Conditional {
            passage,
            marginal,
            variable,
            ..
        } = self.conditional;
        let reached = phase - self.origin;
        if matches!(variable, Variable::Tilt | Variable::Rate) {
            return if self.slope == 0.0 {
                f64::from(u8::from(reached >= 0.0))
            } else {
                distribution(marginal, reached / self.slope)
            };
        }
        if reached < 0.0 {
            return 0.0;
        }
        if self.turning.rate == 0.0 {
            return 1.0;
        }
        let time = passage.time_of_turning(reached / self.turning.rate);
        if time == f64::INFINITY {
            return 1.0;
        }
        let (h, v) = (self.launch.height_m, self.launch.velocity_m_s.z);
        let value = match variable {
            Variable::Velocity if time == 0.0 => return 0.0,
            Variable::Velocity => passage.velocity(h, time),
            _ => passage.height(v, time),
        };
        distribution(marginal, value)
    }

    /// The probability of a phase within `half` of `centre`, modulo whole turns.
    fn within(&self, centre: f64, half: f64) -> f64 {
        if half <= 0.0 {
            return 0.0;
        }
        if half >= PI {
            return 1.0;
        }
        let (from, to) = self.range();
        let first = ((from - centre - half) / TAU).floor();
        let last = ((to - centre + half) / TAU).ceil();
        let mut sum = 0.0;
        let mut turn = first;
        while turn <= last {
            let middle = centre + turn * TAU;
            sum += self.below(middle + half) - self.below(middle - half);
            turn += 1.0;
        }
        sum.clamp(0.0, 1.0)
    }
}

/// P(X <= x).
fn distribution(marginal: &Marginal, x: f64) -> f64 {
    match *marginal {
        Marginal::Constant(value) => f64::from(u8::from(value <= x)),
        Marginal::Uniform { from, to } => ((x - from) / (to - from)).clamp(0.0, 1.0),
        Marginal::Normal { mean, sd } => 0.5 * libm::erfc((mean - x) / sd * FRAC_1_SQRT_2),
    }
}

#[cfg(test)]
mod tests;
