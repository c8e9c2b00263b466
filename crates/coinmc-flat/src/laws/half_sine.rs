//! An impact by a force that is half a sine in time, N(t) = N_max sin(πt/τ).
//!
//! The pulse has the impulse η = 2 N_max τ/π. If N_max is not given, η is the impulse of
//! [`Moreau`]'s law, with which the corner would leave at e times its speed of approach if nothing
//! moved in the meantime. Friction has the same ratio to N as in that impulse. The coin moves,
//! turns and falls while the force acts on the present position of the corner. As τ → 0 the law
//! becomes Moreau's, with an error of order τ.
//!
//! τ is given, or is the duration of a lossless impact on a line contact at this speed (which falls
//! slowly with the speed, as u^(-1/19)).
//!
//! # Where it breaks
//! * **N_max given**: η does not depend on the speed of approach. *Fallback*: an impulse above
//!   Newton's is reduced to Newton's (counted as a gain of energy if it exceeds that of e = 1); an
//!   impulse too small to stop the corner is raised to one that does (counted as a sinking).
//! * The force does not depend on the depth: with e < 1 the corner ends u τ(1 − e)/2 below the
//!   surface. The coin is set back onto the surface. Where that, or the rotation during the pulse,
//!   gains energy, the gain is counted and all velocities are reduced by one factor.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::dormand_prince::{Step, System, growth};
use crate::impact_law::{Impact, ImpactLaw, PlanarLaw, Resolution};
use crate::laws::moreau::Moreau;
use crate::laws::palmgren::{Materials, duration, scene_stiffness};
use crate::motion::Motion;
use crate::settings_error::SettingsError;
use crate::shape::Shape;
use coinmc_core::schema::{Absent, Bounds, Rule, TableKind, Values, fields, number, table};
use coinmc_core::{EngineError, LawSettings, Scene};
use coinmc_lanes::{Lane, sin_cos};
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps after which a pulse is given up; the worst of the stress test needs some hundreds.
const MAX_STEPS: u32 = 20_000;
/// The largest angle, rad, that a coin may turn in a pulse; beyond it the contact is not an impact.
const MAX_TURNED: f64 = 1.0;

/// A force that is half a sine in time.
///
/// # Example
/// ```
/// use coinmc_flat::{HalfSine, Law, PulseTime, Settings};
/// let law = Law::HalfSine(HalfSine { time: PulseTime::Given(1e-3), peak_n: None });
/// assert!(Settings { law, ..Settings::default() }.validate().is_ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSine {
    /// Duration.
    pub time: PulseTime,
    /// N_max, N; if absent, it follows from the restitution.
    pub peak_n: Option<f64>,
}

/// The duration of a pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PulseTime {
    /// This duration, s.
    Given(f64),
    /// The duration of a lossless impact on a line contact of these materials.
    Contact(Materials),
}

const TIME_S: Bounds = Bounds::closed(1e-12, 1.0);
const PEAK_N: Bounds = Bounds::closed(1e-12, 1e15);

impl LawSettings for HalfSine {
    const NAME: &'static str = "half-sine";
    const DOC: &'static str = "A force that is half a sine in time.";

    fn parameters() -> TableKind {
        TableKind {
            fields: vec![
                number(
                    "time_s",
                    "How long the force acts, s.",
                    TIME_S,
                    Absent::Omitted,
                ),
                table(
                    "contact",
                    "What touches, if the time is to follow from it: that of a lossless line contact.",
                    fields(Materials::parameters()),
                    Absent::Omitted,
                ),
                number(
                    "peak_n",
                    "Largest force, N; what the restitution asks for if absent.",
                    PEAK_N,
                    Absent::Omitted,
                ),
            ],
            rules: vec![Rule::ExactlyOne(&["time_s", "contact"])],
        }
    }

    fn read(parameters: &Values) -> Result<Self, EngineError> {
        let time = match parameters.table("contact")? {
            Some(contact) => PulseTime::Contact(Materials::read(contact)?),
            None => PulseTime::Given(parameters.number("time_s")?),
        };
        Ok(Self {
            time,
            peak_n: parameters.optional("peak_n")?,
        })
    }
}

impl PlanarLaw for HalfSine {
    type Impact = HalfSineImpact;

    fn validate(&self) -> Result<(), SettingsError> {
        match self.time {
            PulseTime::Given(time) => TIME_S.check("time_s", time)?,
            PulseTime::Contact(materials) => materials.validate()?,
        }
        Ok(self
            .peak_n
            .map_or(Ok(()), |peak| PEAK_N.check("peak_n", peak))?)
    }

    fn impact(self, scene: &Scene) -> Result<HalfSineImpact, SettingsError> {
        HalfSineImpact::new(scene, self)
    }
}

/// [`HalfSine`] in one scene, in dimensionless units.
#[derive(Debug, Clone, Copy)]
pub struct HalfSineImpact {
    time: Time,
    /// N_max in m g.
    peak: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
enum Time {
    Given(f64),
    FromStiffness(f64),
}

impl HalfSineImpact {
    /// The law in this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if a quantity is out of range.
    pub fn new(scene: &Scene, pulse: HalfSine) -> Result<Self, SettingsError> {
        pulse.validate()?;
        let weight = scene.coin.mass_kg() * scene.gravity_m_s2();
        let time = match pulse.time {
            PulseTime::Given(time) => Time::Given(time / scene.time_scale_s()),
            PulseTime::Contact(materials) => {
                Time::FromStiffness(scene_stiffness(scene, &materials))
            }
        };
        Ok(Self {
            time,
            peak: pulse.peak_n.map(|peak| peak / weight),
        })
    }

    /// The pulse; `None` if the corner does not approach.
    fn pulse(&self, impact: &mut Impact<'_>) -> Option<Pulse> {
        let (delta, omega, inertia) = (impact.motion.delta, impact.motion.omega, impact.shape.k);
        let (sin, cos) = sin_cos(delta);
        let matrix = ContactMatrix::new(sin, cos, inertia);
        let ux = impact.motion.vx - omega * cos;
        let uz = impact.motion.vz + omega * sin;
        if uz >= 0.0 {
            return None;
        }
        let time = match self.time {
            Time::Given(time) => time,
            Time::FromStiffness(stiffness) => duration(stiffness, 1.0 / matrix.zz, -uz),
        };
        Some(Pulse {
            delta,
            inertia,
            impulse: self.impulse_within_limits(matrix, (ux, uz), impact, time),
            time,
        })
    }

    /// The impulse of the pulse.
    fn impulse_within_limits(
        &self,
        matrix: ContactMatrix,
        (ux, uz): (f64, f64),
        impact: &mut Impact<'_>,
        time: f64,
    ) -> Impulse {
        let (e, mu) = (impact.restitution, impact.friction);
        let wanted = Moreau.impulse(matrix, ux, uz, e, mu);
        let Some(peak) = self.peak else {
            return wanted;
        };
        let given = 2.0 * peak * time / PI;
        if given >= wanted.z {
            let most = Moreau.impulse(matrix, ux, uz, 1.0, mu);
            impact.breaks.energy_gains += u32::from(given > most.z);
            return wanted;
        }
        let least = Moreau.impulse(matrix, ux, uz, 0.0, mu);
        if given < least.z {
            impact.breaks.sinkings += 1;
            return least;
        }
        Impulse {
            x: wanted.x * (given / wanted.z),
            z: given,
            sticks: false,
        }
    }
}

/// A pulse. Its system has the state (angle turned, angular velocity, time). The centre needs no
/// integration: its acceleration is known as a function of time.
struct Pulse {
    delta: f64,
    inertia: f64,
    impulse: Impulse,
    time: f64,
}

impl Pulse {
    /// Moves the coin to a time `t` after the touch, when its state is (turned, omega). Half a sine
    /// has then given the share (1 − cos φ)/2 of its impulse, φ = πt/τ, whose integral is t/2 − τ
    /// sin φ/2π.
    fn apply(&self, motion: &mut Motion, shape: &Shape, [turned, omega, _]: [f64; 3], t: f64) {
        let (sin, cos) = libm::sincos(PI * t / self.time);
        let (given, so_far) = (0.5 * (1.0 - cos), 0.5 * t - 0.5 * self.time * sin / PI);
        motion.x += motion.vx * t + self.impulse.x * so_far;
        motion.z += (motion.vz - 0.5 * t) * t + self.impulse.z * so_far;
        motion.vx += self.impulse.x * given;
        motion.vz += self.impulse.z * given - t;
        motion.omega = omega;
        motion.time += t;
        motion.turn(shape, turned);
    }

    /// Share of the impulse per unit time.
    fn density(&self, t: f64) -> f64 {
        let angle = (PI * t / self.time).clamp(0.0, PI);
        let (sin, _) = sin_cos(if angle > FRAC_PI_2 { PI - angle } else { angle });
        FRAC_PI_2 / self.time * sin
    }
}

impl System<3> for Pulse {
    fn rates(&self, y: &[f64; 3]) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.delta + y[0]);
        let density = self.density(y[2]);
        let torque = density * (sin * self.impulse.z - cos * self.impulse.x);
        [y[1], torque / self.inertia, 1.0]
    }
}

/// The state at the time `until`, at most the end of the pulse, and the number of steps; `None` if
/// given up.
fn integrate(pulse: &Pulse, omega: f64, tolerance: f64, until: f64) -> Option<([f64; 3], u32)> {
    let mut y = [0.0, omega, 0.0];
    let mut rates = pulse.rates(&y);
    let speed = pulse.impulse.z + omega.abs();
    let allowed = [
        tolerance * speed * pulse.time,
        tolerance * speed,
        f64::INFINITY,
    ];
    let mut h = 0.1 * pulse.time;
    for steps in 1..=MAX_STEPS {
        h = h.min(pulse.time - y[2]);
        let step = Step::take(pulse, &y, &rates, h);
        let shares = step.error.iter().zip(allowed);
        let error = shares
            .map(|(error, allowed)| error.abs() / allowed)
            .fold(0.0, f64::max);
        if !step.end.iter().all(|y| y.is_finite()) || step.end[0].abs() > MAX_TURNED {
            return None;
        }
        if error <= 1.0 {
            if step.end[2] > until {
                return Some((step.at((until - y[2]) / h), steps));
            }
            (y, rates) = (step.end, step.rates);
            if y[2] >= pulse.time * (1.0 - 1e-14) {
                return Some((y, steps));
            }
        }
        h *= growth(error);
    }
    None
}

impl ImpactLaw for HalfSineImpact {
    const BATCHED: bool = false;

    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        Moreau.impulse(k, ux, uz, e, mu)
    }

    fn resolve(&self, impact: &mut Impact<'_>) -> Resolution {
        let Some(pulse) = self.pulse(impact) else {
            return Resolution::UseImpulse;
        };
        let found = integrate(&pulse, impact.motion.omega, impact.tolerance, pulse.time);
        let Some((turned, steps)) = found else {
            impact.breaks.unresolved += 1;
            return Resolution::UseImpulse;
        };
        impact.record.steps = steps;
        impact.record.peak_force = FRAC_PI_2 * pulse.impulse.z / pulse.time;
        let (motion, inertia) = (&mut *impact.motion, impact.shape.k);
        let before = motion.energy(inertia);
        pulse.apply(motion, impact.shape, turned, pulse.time);
        let (sin, cos) = sin_cos(motion.delta);
        motion.z = cos;
        let gained = motion.energy(inertia) > before * (1.0 + impact.tolerance);
        impact.breaks.energy_gains += u32::from(gained);
        if motion.vz + motion.omega * sin > 0.0 {
            return Resolution::Separates;
        }
        // gravity and rotation have used up the rebound
        Resolution::StaysInContact
    }

    fn resolve_until(&self, impact: &mut Impact<'_>, time: f64) {
        let Some(pulse) = self.pulse(impact) else {
            return;
        };
        let found = integrate(&pulse, impact.motion.omega, impact.tolerance, time);
        if let Some((turned, _)) = found {
            pulse.apply(impact.motion, impact.shape, turned, time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact_law::tests::impact;
    use crate::motion::tests::on_corner;
    use coinmc_core::Breaks;
    use coinmc_testkit::scene;

    fn law(time: f64, peak: Option<f64>) -> HalfSineImpact {
        HalfSineImpact {
            time: Time::Given(time),
            peak,
        }
    }

    fn pulse() -> Pulse {
        Pulse {
            delta: 0.4,
            inertia: 0.3,
            impulse: Impulse {
                x: 0.3,
                z: 1.2,
                sticks: false,
            },
            time: 0.5,
        }
    }

    /// The state at an instant is that instant's, in any step of the pulse: the time itself, and the angle to the
    /// tolerance.
    #[test]
    fn the_state_within_a_pulse_is_that_of_the_instant() {
        let pulse = pulse();
        let at = |until: f64, tolerance: f64| {
            let found = integrate(&pulse, 0.7, tolerance, until);
            found.expect("it is smooth").0
        };
        for share in [0.01, 0.3, 0.5, 0.9, 0.999] {
            let time = share * pulse.time;
            let [turned, omega, reached] = at(time, 1e-6);
            assert!((reached - time).abs() < 1e-14);
            let exact = at(time, 1e-12);
            // some ten steps of the tolerance times a speed of order 2
            assert!((turned - exact[0]).abs() < 1e-4 && (omega - exact[1]).abs() < 1e-4);
        }
    }

    /// The share of the impulse per time is half a sine: its integral is 1, and it is the same before and after its
    /// middle.
    #[test]
    fn a_pulse_gives_all_of_its_impulse() {
        let pulse = pulse();
        let points = 1000;
        let width = pulse.time / f64::from(points);
        let middle = |i: i32| (f64::from(i) + 0.5) * width;
        let sum: f64 = (0..points).map(|i| pulse.density(middle(i)) * width).sum();
        // the midpoint rule errs by (π/points)²/24
        assert!((sum - 1.0).abs() < 1e-6);
        for share in [0.1, 0.25, 0.4] {
            let (early, late) = (share * pulse.time, (1.0 - share) * pulse.time);
            assert!((pulse.density(early) - pulse.density(late)).abs() < 1e-14);
        }
        assert_eq!(pulse.density(-1.0), 0.0);
    }

    /// The first step, a tenth of the pulse, is taken if its error in the angular velocity is within the tolerance
    /// times the speed of the impact. (That in the angle, over the duration, is smaller here.)
    #[test]
    fn steps_are_as_long_as_the_angular_velocity_allows() {
        let (pulse, omega) = (pulse(), 0.7);
        let y = [0.0, omega, 0.0];
        let error = Step::take(&pulse, &y, &pulse.rates(&y), 0.1 * pulse.time).error;
        let speed = pulse.impulse.z + omega;
        assert!(2.0 * error[0].abs() < error[1].abs() * pulse.time);
        let steps = |share: f64| {
            let tolerance = error[1].abs() / speed / share;
            let found = integrate(&pulse, omega, tolerance, 1e-6 * pulse.time);
            found.expect("it is smooth").1
        };
        assert_eq!(steps(0.99), 1);
        assert!(steps(1.01) > 1);
    }

    /// Half a sine of the height N and the length t has the impulse 2 N t/pi: that is what a pulse gives which may not
    /// push more strongly, with friction in proportion. One that would sink in gets what stops the corner.
    #[test]
    fn a_limited_force_limits_the_impulse() {
        let shape = Shape::new(&scene(1.0, 0.5, 0.3).coin);
        let mut motion = on_corner(0, 0.3, 0.2, 0.1);
        motion.vz -= 0.7;
        let mut breaks = Breaks::default();
        let mut impact = impact(&mut motion, &shape, &mut breaks);
        let (sin, cos) = sin_cos(0.3);
        let matrix = ContactMatrix::new(sin, cos, shape.k);
        let velocity = (0.1, -0.7);
        let of = |e| Moreau.impulse(matrix, velocity.0, velocity.1, e, 0.3);
        let (wanted, least) = (of(0.5), of(0.0));
        let time = 0.02;
        let mut with_peak =
            |peak| law(time, peak).impulse_within_limits(matrix, velocity, &mut impact, time);
        assert_eq!(with_peak(None).z, wanted.z);
        let middle = 0.5 * (wanted.z + least.z);
        let limited = with_peak(Some(PI * middle / (2.0 * time)));
        assert!((limited.z - middle).abs() < 1e-14);
        assert!((limited.x / limited.z - wanted.x / wanted.z).abs() < 1e-14);
        assert_eq!(with_peak(Some(1e-3)).z, least.z);
        assert_eq!(with_peak(Some(1e6)).z, wanted.z);
        assert_eq!((breaks.sinkings, breaks.energy_gains), (1, 1));
    }

    /// The torque of the force at the corner, about the centre, at the angle that the coin has turned to.
    #[test]
    fn the_force_turns_the_coin_about_its_centre() {
        let pulse = pulse();
        for turned in [-0.2, 0.0, 0.3] {
            let rates = pulse.rates(&[turned, 0.7, 0.25]);
            let (sin, cos) = libm::sincos(0.4 + turned);
            // in the middle of the pulse the force is pi/2 of its mean
            let torque = FRAC_PI_2 / 0.5 * (sin * 1.2 - cos * 0.3);
            assert_eq!([rates[0], rates[2]], [0.7, 1.0]);
            assert!((rates[1] - torque / 0.3).abs() < 1e-13, "{turned}");
        }
    }

    /// A corner that rises after the pulse separates, though the centre may still come down; one whose rebound
    /// gravity has used up stays.
    #[test]
    fn the_corner_decides_whether_the_coin_separates() {
        let shape = Shape::new(&scene(1.0, 0.5, 0.3).coin);
        let resolution = |time: f64, restitution: f64, sign: f64| {
            let mut motion = on_corner(0, sign * 0.3, sign * 0.5, 0.0);
            motion.vz -= 0.5;
            let mut breaks = Breaks::default();
            let mut impact = impact(&mut motion, &shape, &mut breaks);
            (impact.restitution, impact.tolerance) = (restitution, 1e-9);
            let found = law(time, None).resolve(&mut impact);
            (found, motion.vz)
        };
        for sign in [1.0, -1.0] {
            let (found, centre) = resolution(1e-6, 0.2, sign);
            assert_eq!(found, Resolution::Separates);
            assert!(centre < 0.0);
            assert_eq!(resolution(0.02, 0.0, sign).0, Resolution::StaysInContact);
        }
    }

    /// A pulse in no time that gives back all of the speed keeps the energy to the tolerance, and that is no gain.
    #[test]
    fn a_lossless_pulse_gains_nothing() {
        let shape = Shape::new(&scene(1.0, 0.5, 0.3).coin);
        let mut motion = on_corner(0, 0.3, 0.2, 0.0);
        motion.vz -= 0.7;
        let before = motion.energy(shape.k);
        let mut breaks = Breaks::default();
        let mut impact = impact(&mut motion, &shape, &mut breaks);
        (impact.restitution, impact.friction, impact.tolerance) = (1.0, 0.0, 1e-4);
        assert_eq!(law(1e-7, None).resolve(&mut impact), Resolution::Separates);
        assert!((motion.energy(shape.k) / before - 1.0).abs() < 1e-5);
        assert_eq!(breaks.energy_gains, 0);
    }
}
