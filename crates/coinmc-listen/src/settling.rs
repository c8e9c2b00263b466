//! Rolling friction from a whirr, by whirrs that the engine simulates.
//!
//! The law of whirring neglects that a coin may slip as it settles. So coins are let settle on surfaces of the
//! prior, their pitch is read in the same range, and what the law makes of it is compared with the truth.

use crate::error::ListenError;
use crate::posterior::on_surface;
use crate::regression::Regression;
use crate::struck::Tosser;
use crate::whirr::Whirr;
use coinmc_calibrate::{Observations, Parameter, rolling_friction_of_whirr};
use coinmc_core::{
    Domain, Event, Launch, Observer, Scene, State, Stream, UniformSource, inverse_normal_cdf,
};
use coinmc_questions::{QuestionError, Workers};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;
use std::sync::atomic::Ordering;

/// Coins that are let settle.
const COINS: usize = 160;
/// Of which the law must be able to read so many.
const LEAST: usize = 30;
/// ln of the range of rolling friction lengths around what the law says.
const RANGE: [f64; 2] = [-1.0, 0.4];
/// How near to the recording a simulated whirr counts fully, in ln of what the law says.
const NEAR: f64 = 0.2;
/// Sine of the lean at which they begin.
const SINE: f64 = 0.7;
/// Samples a second, and how far beyond the pitches of the recording those of a simulated whirr may be.
const RATE_HZ: f64 = 1000.0;
const MARGIN: f64 = 1.02;
/// Longest whirr, s.
const LONGEST_S: f64 = 60.0;

/// ln ρ_c of a whirr and its standard error, with what slip does to it; `None` where the engine's coins do not
/// whirr like this.
pub(crate) fn rolling_friction(
    whirr: &Whirr,
    observed: &Observations,
    seed: u64,
    workers: &Workers<'_>,
) -> Result<Option<(f64, f64)>, ListenError> {
    let scene = &observed.plan.points[0].scene;
    let pitches = whirr.readings.iter();
    let readings: Vec<_> = pitches.map(|p| (p.time_s, p.frequency_hz)).collect();
    let Some((by_law, share)) = rolling_friction_of_whirr(scene, &readings, whirr.scatter) else {
        return Ok(None);
    };
    let [low, high] = [
        readings[0].1 / MARGIN,
        readings[readings.len() - 1].1 * MARGIN,
    ];
    let stream = Stream::new(seed, Domain::Parameters, 2);
    let found = workers.each(COINS, &|coin| {
        if workers.cancel.load(Ordering::Relaxed) {
            return Err(ListenError::Question(QuestionError::Stopped));
        }
        let mut uniforms = stream.toss(coin as u64);
        let z: Vec<f64> = (0..)
            .zip(&observed.priors)
            .map(|(dimension, prior)| {
                let uniform = uniforms.uniform(dimension);
                if prior.parameter == Parameter::RollingFriction {
                    let log = RANGE[0] + (RANGE[1] - RANGE[0]) * uniform;
                    prior.z(by_law * libm::exp(log))
                } else {
                    inverse_normal_cdf(uniform)
                }
            })
            .collect();
        let point = on_surface(observed, &z)?;
        let turning = uniforms.uniform(10);
        let mut seen = Rounds::default();
        Tosser::new(&point)?.show(&leaning(&point.scene, turning), &mut seen);
        let pitches: Vec<_> = seen
            .pitches()
            .into_iter()
            .filter(|(_, f)| (low..=high).contains(f))
            .collect();
        (workers.made)(1);
        let law = rolling_friction_of_whirr(&point.scene, &pitches, whirr.scatter);
        let truth = point.scene.surface.rolling_friction_m();
        let apart = |(law, _): (f64, f64)| (libm::log(law / by_law), libm::log(truth));
        Ok((pitches.len() >= 3).then_some(law).flatten().map(apart))
    })?;
    let pairs: Vec<(f64, f64)> = found.into_iter().flatten().collect();
    Ok(at_recording(&pairs, share))
}

/// The truth where the law says what it says of the recording.
fn at_recording(pairs: &[(f64, f64)], share: f64) -> Option<(f64, f64)> {
    if pairs.len() < LEAST {
        return None;
    }
    let rows: Vec<Vec<f64>> = pairs.iter().map(|(x, _)| vec![1.0, *x]).collect();
    let truths: Vec<Vec<f64>> = pairs.iter().map(|(_, y)| vec![*y]).collect();
    let weight = |x: f64| libm::exp(-0.5 * (x / NEAR) * (x / NEAR));
    let weights: Vec<f64> = pairs.iter().map(|(x, _)| weight(*x)).collect();
    let fit = Regression::fit(&rows, &truths, &weights)?;
    let total: f64 = weights.iter().sum();
    let off = rows
        .iter()
        .zip(&truths)
        .zip(&weights)
        .map(|((row, truth), weight)| {
            let off = truth[0] - fit.at(row)[0];
            weight * off * off
        });
    let spread = off.sum::<f64>() / total;
    let log = fit.at(&[1.0, 0.0])[0];
    (total > 5.0 && log.is_finite()).then(|| (log, (spread + share * share).sqrt()))
}

/// A coin that leans and whirrs steadily. It turns about its axis at this share of what keeps its centre at rest,
/// from none to all.
fn leaning(scene: &Scene, turning: f64) -> Launch {
    let coin = &scene.coin;
    let radius = coin.radius_m();
    let h = 0.5 * coin.height_m() / radius;
    let kt = coin.transverse_gyration_m2() / (radius * radius);
    let (sin, cos) = (SINE, (1.0 - SINE * SINE).sqrt());
    let lever = scene.gravity_m_s2() / radius * (cos - h * sin);
    let ka = coin.axial_gyration_m2() / (radius * radius);
    let inertia = kt * cos + turning * ka * h * sin + (1.0 - turning) * h * (sin + h * cos);
    let round = (lever / (sin * inertia)).sqrt();
    let (down, axis) = (Vector3::new(cos, 0.0, -sin), Vector3::new(sin, 0.0, cos));
    let axial = -turning * h * round * sin;
    Launch {
        height_m: 0.0,
        velocity_m_s: Vector3::new(0.0, radius * (round * sin * h + axial), 0.0),
        axis: UnitVector3::new_normalize(axis),
        spin_rad_s: axis * axial - down * (round * sin),
    }
}

/// The direction in which the axis leans, at equal steps.
#[derive(Debug, Default)]
struct Rounds {
    turned: f64,
    last: Option<f64>,
    samples: u32,
    /// When each round was complete.
    complete_s: Vec<f64>,
}

impl Rounds {
    /// Times, s, and rounds a second over two rounds.
    fn pitches(&self) -> Vec<(f64, f64)> {
        let of = |three: &[f64]| (three[1], 2.0 / (three[2] - three[0]));
        self.complete_s.windows(3).map(of).collect()
    }
}

impl Observer for Rounds {
    fn event(&mut self, _: &Event) {}

    fn wants_at_s(&self) -> f64 {
        f64::from(self.samples + 1) / RATE_HZ
    }

    fn sample(&mut self, state: &State) {
        self.samples += 1;
        let azimuth = libm::atan2(state.axis.y, state.axis.x);
        if let Some(last) = self.last {
            let by = libm::remainder(azimuth - last, TAU).abs();
            let rounds = (self.turned + by) / TAU;
            if by > 0.0 && rounds.floor() > (self.turned / TAU).floor() {
                let over = (rounds - rounds.floor()) * TAU / by;
                self.complete_s.push(state.time_s - over / RATE_HZ);
            }
            self.turned += by;
        }
        self.last = Some(azimuth);
    }

    fn has_seen_enough(&self) -> bool {
        f64::from(self.samples) > LONGEST_S * RATE_HZ
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leaning_coin_goes_round_as_steady_motion_does_and_faster_and_faster() {
        let text = "coin = { ratio = 0.16, radius_m = 0.0116 }\n\
            surface = { restitution = 0.5, friction = 0.5, rolling_friction_m = 2e-5 }\n\
            launch.preset = 'drop'\nengine.volumetric = {}";
        let observed = Observations::parse("inline", text, &[], "".as_ref()).unwrap();
        let point = &observed.plan.points[0];
        let mut seen = Rounds::default();
        let tosser = Tosser::new(point).unwrap();
        tosser.show(&leaning(&point.scene, 1.0), &mut seen);
        let pitches = seen.pitches();
        // H/(2R) = 0.08, k_t = 0.252, k_a = 0.5 in R²
        let cos = (1.0 - SINE * SINE).sqrt();
        let inertia = SINE * (0.252 * cos + 0.5 * 0.08 * SINE);
        let steady = (9.81 / 0.0116 * (cos - 0.08 * SINE) / inertia).sqrt() / TAU;
        assert!(
            (pitches[0].1 / steady - 1.0).abs() < 0.02,
            "{:?} {steady}",
            pitches[0]
        );
        let at = |f: f64| pitches.iter().find(|pitch| pitch.1 > f).unwrap().0;
        assert!(at(15.0) < at(20.0) && at(20.0) < at(30.0));
    }

    #[test]
    fn what_the_law_misses_is_put_right() {
        // the law says 20 % too much, and scatters by 1 %
        let pair = |k: u32| {
            let x = (f64::from(k) - 50.0) / 100.0;
            (x, x - libm::log(1.2) + 0.01 * f64::from(k % 3) - 0.01)
        };
        let pairs: Vec<_> = (0..100).map(pair).collect();
        let (log, error) = at_recording(&pairs, 0.02).unwrap();
        assert!((log + libm::log(1.2)).abs() < 0.003, "{log}");
        assert!(error > 0.02 && error < 0.03, "{error}");
        assert!(at_recording(&pairs[..20], 0.02).is_none());
    }
}
