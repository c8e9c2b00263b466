//! How a launch first touches the ground: what decides where nothing bounces high.

use coinmc_core::{Coin, Launch};
use libm::{cos, fabs, sin, sqrt};

/// Steps of the search for the first touch: each leaves at most the share v/(v + ωD) of the gap, of a
/// coin that falls with v and turns with ω. Fewer tell the inclination less well, but never wrongly
/// how likely the face is (see the module).
const STEPS: usize = 64;
/// The gap at which the coin touches, by its radius.
const NEAR: f64 = 1e-3;

/// |cos| of the angle between the axis and the vertical when the coin first touches the ground: 0 on its
/// rim, 1 flat. By free flight of a sharp-edged uniform cylinder without drag, whatever the scene has.
pub(super) fn inclination(coin: &Coin, launch: &Launch, gravity_m_s2: f64) -> f64 {
    let (radius, half) = (coin.radius_m(), 0.5 * coin.height_m());
    let top = sqrt(radius * radius + half * half);
    let motion = Motion::of(coin, launch);
    let [mut z, mut fall] = [launch.height_m, -launch.velocity_m_s.z];
    let mut t = 0.0;
    // the coin can touch only below the height of its corner
    if z > top && gravity_m_s2 > 0.0 {
        let rise = sqrt(fall * fall + 2.0 * gravity_m_s2 * (z - top));
        t = (rise - fall) / gravity_m_s2;
        (z, fall) = (top, rise);
    }
    let mut c = fabs(motion.axis_z(t));
    for _ in 0..STEPS {
        let gap = z - radius * sqrt((1.0 - c * c).max(0.0)) - half * c;
        if gap <= NEAR * radius {
            break;
        }
        // the gap closes no faster than the coin falls and its corner turns
        let fastest = fall.max(0.0) + sqrt(2.0 * gravity_m_s2 * gap) + motion.rate * top;
        let step = gap / fastest;
        if !(step > 0.0 && step.is_finite()) {
            break;
        }
        t += step;
        z -= fall * step + 0.5 * gravity_m_s2 * step * step;
        fall += gravity_m_s2 * step;
        c = fabs(motion.axis_z(t));
    }
    c
}

/// The height of the axis' tip in free flight: the axis turns about the angular momentum L of a
/// symmetric top at the rate |L|/I, I its transverse moment of inertia.
struct Motion {
    /// Along L, across it, and across both: their z components.
    parts: [f64; 3],
    /// |L|/I, rad/s.
    rate: f64,
}

impl Motion {
    fn of(coin: &Coin, launch: &Launch) -> Self {
        let axis = launch.axis.into_inner();
        let spin = launch.spin_rad_s;
        let about_axis = axis * spin.dot(&axis);
        // L/I
        let momentum = (spin - about_axis)
            + about_axis * (coin.axial_gyration_m2() / coin.transverse_gyration_m2());
        let rate = momentum.norm();
        if rate == 0.0 {
            return Self {
                parts: [axis.z, 0.0, 0.0],
                rate,
            };
        }
        let direction = momentum / rate;
        let along = direction * axis.dot(&direction);
        Self {
            parts: [along.z, axis.z - along.z, direction.cross(&axis).z],
            rate,
        }
    }

    fn axis_z(&self, t: f64) -> f64 {
        let [along, across, both] = self.parts;
        let angle = self.rate * t;
        (along + across * cos(angle) + both * sin(angle)).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitVector3, Vector3};

    const GRAVITY: f64 = 9.81;

    fn coin() -> Coin {
        Coin::cylinder(0.2, 0.01).expect("a coin")
    }

    fn launch(tilt: f64, rate: f64) -> Launch {
        Launch {
            height_m: 0.3,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(Vector3::new(sin(tilt), 0.0, cos(tilt))),
            spin_rad_s: Vector3::new(0.0, rate, 0.0),
        }
    }

    #[test]
    fn a_coin_without_spin_lands_as_it_was_let_go() {
        for tilt in [0.0, 0.3, 1.2, 2.9] {
            let found = inclination(&coin(), &launch(tilt, 0.0), GRAVITY);
            assert!((found - fabs(cos(tilt))).abs() < 1e-12, "{tilt}");
        }
    }

    /// By small steps: until the lowest point is at the ground.
    #[test]
    fn a_spinning_coin_lands_as_small_steps_say() {
        for (tilt, rate) in [(0.4, 20.0), (1.0, -35.0), (0.1, 150.0)] {
            let (radius, half) = (0.01, 0.001);
            let mut t = 0.0;
            let stepped = loop {
                let angle = tilt + rate * t;
                let [c, s] = [fabs(cos(angle)), fabs(sin(angle))];
                if 0.3 - 0.5 * GRAVITY * t * t <= radius * s + half * c {
                    break c;
                }
                t += 1e-7;
            };
            let found = inclination(&coin(), &launch(tilt, rate), GRAVITY);
            // a gap of R/1000 is a hundredth of the way that a rim turns while it falls by R/10
            assert!((found - stepped).abs() < 0.01, "{found} {stepped}");
        }
    }

    /// The axis of a precessing top keeps its angle to L, and its z comes back after a turn about it.
    #[test]
    fn the_axis_turns_about_the_angular_momentum() {
        let launch = Launch {
            spin_rad_s: Vector3::new(3.0, 5.0, -7.0),
            ..launch(0.8, 0.0)
        };
        let motion = Motion::of(&coin(), &launch);
        let turn = 2.0 * std::f64::consts::PI / motion.rate;
        assert!((motion.axis_z(0.0) - cos(0.8)).abs() < 1e-12);
        assert!((motion.axis_z(turn) - cos(0.8)).abs() < 1e-12);
        // d(axis)/dt = spin × axis
        let slope = (motion.axis_z(1e-6) - motion.axis_z(-1e-6)) / 2e-6;
        let known = launch.spin_rad_s.cross(&launch.axis).z;
        assert!((slope - known).abs() < 1e-6, "{slope} {known}");
    }
}
