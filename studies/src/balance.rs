//! A phase of sustained contact, followed again by other means.
//!
//! The equations of motion and of contact as one linear system in the laboratory frame (the
//! oracle's), with a fixed-step Runge–Kutta method: it keeps E + ∫power as exactly as its step
//! allows, so the energy that it ends with is the one that the engine's phase should end with.

use coinmc_core::{Scene, State};
use coinmc_oracle::newton_euler::{Contact, Twist, rates, runge_kutta, slip, twist_rates};
use coinmc_oracle::{Model, Motion};
use nalgebra::{Vector2, Vector3};

/// Longest step, sqrt(D/g), and most of it by the fastest rate of the motion.
const STEP: f64 = 1e-3;
const TURN: f64 = 5e-3;
/// Most by which a step changes the slip, of the slip.
const BRAKE: f64 = 0.05;
/// Most by which a step changes the sine of the tilt, of the sine: a coin that falls level turns
/// ever faster.
const FALL: f64 = 0.05;
/// Most steps of a phase.
const STEPS: u32 = 200_000;

/// Follows phases of one scene.
pub(crate) struct Reference {
    model: Model,
    scene: Scene,
    /// The engine's setting of that name: the time over which friction ends the last of a rotation.
    smoothing_time: f64,
}

impl Reference {
    pub(crate) fn new(scene: &Scene, smoothing_time: f64) -> Self {
        Self {
            model: Model::new(scene),
            scene: *scene,
            smoothing_time,
        }
    }

    /// The energy, in m g D, of a state.
    pub(crate) fn energy(&self, state: &State) -> f64 {
        motion(&self.scene, state).energy(&self.model)
    }

    /// The energy, in m g D, with which a phase that begins in `start` ends after `duration`
    /// seconds; `None` if that takes too many steps, or ends level, where the equations have no
    /// value.
    pub(crate) fn energy_after(&self, start: &State, sticks: bool, duration: f64) -> Option<f64> {
        let unit = self.scene.time_scale_s();
        let mut motion = motion(&self.scene, start);
        let mut left = duration / unit;
        for _ in 0..STEPS {
            let step = self.step(&motion, sticks);
            let h = step.min(left);
            motion = runge_kutta(&self.model, &motion, h, |at| self.mode(at, sticks));
            left -= h;
            if left <= 0.0 {
                let energy = motion.energy(&self.model);
                return energy.is_finite().then_some(energy);
            }
        }
        None
    }

    fn mode(&self, motion: &Motion, sticks: bool) -> (Contact, Twist) {
        let contact = if sticks {
            Contact::Stick
        } else {
            Contact::Slip(direction(&slip(&self.model, motion)))
        };
        (contact, self.twist(motion))
    }

    /// Dry friction that fades linearly where it would end the rotation within the time
    /// `smoothing_time`.
    fn twist(&self, motion: &Motion) -> Twist {
        let model = &self.model;
        let s = motion.sine();
        let inverse = |length: f64, axis: &Vector3<f64>| {
            length * axis.dot(&(model.inverse_inertia(&motion.axis) * axis))
        };
        let (contour, pivoting) = twist_rates(motion);
        let level = Vector3::new(motion.axis.x, motion.axis.y, 0.0) / s;
        let share = |rate: f64, braking: f64| {
            (rate / (braking * self.smoothing_time).max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0)
        };
        Twist {
            // ω along the horizontal part of u is s ψ', and the torque on it ρ_c N/s
            contour: share(s * contour, inverse(model.contour / s, &level)),
            pivoting: share(pivoting, inverse(model.pivoting, &Vector3::z())),
        }
    }

    fn step(&self, motion: &Motion, sticks: bool) -> f64 {
        let wander = twist_rates(motion).0;
        let rate = (motion.spin.norm_squared() + wander * wander).sqrt();
        let (u, spin) = (&motion.axis, &motion.spin);
        let s = motion.sine();
        let fall = u.z * (spin.x * u.y - spin.y * u.x) / s;
        let step = STEP.min(TURN / rate).min(FALL * s / fall.abs());
        if sticks {
            return step;
        }
        let slip = slip(&self.model, motion);
        let (contact, twist) = self.mode(motion, sticks);
        let change = rates(&self.model, motion, contact, twist).slip.norm();
        step.min(BRAKE * slip.norm() / change.max(f64::MIN_POSITIVE))
    }
}

fn direction(slip: &Vector2<f64>) -> Vector2<f64> {
    let size = slip.norm();
    if size > 0.0 {
        slip / size
    } else {
        Vector2::x()
    }
}

/// The oracle's words for a state.
fn motion(scene: &Scene, state: &State) -> Motion {
    let (d, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
    Motion {
        position: state.position_m / d,
        velocity: state.velocity_m_s * (time / d),
        axis: state.axis.into_inner(),
        spin: state.spin_rad_s * time,
    }
}
