//! The state of the coin in units of D, sqrt(D/g) and m.

use crate::shape::{Quadrant, Shape, as_quadrant, next};
use coinmc_core::{Launch, Scene, State};
use coinmc_lanes::{Lane, Mask, sin_cos};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Position and velocity of the coin. Lengths in D, times in sqrt(D/g), so that g = 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) quadrant: Quadrant,
    /// Angle of the centre beyond the balance over the lowest corner (see [`Shape`]).
    pub(crate) delta: f64,
    pub(crate) omega: f64,
    pub(crate) x: f64,
    pub(crate) z: f64,
    pub(crate) vx: f64,
    pub(crate) vz: f64,
    pub(crate) time: f64,
}

/// The units of a scene: one dimensionless length and time in SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub(crate) length_m: f64,
    pub(crate) time_s: f64,
}

impl Units {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            length_m: scene.coin.rim_distance_m(),
            time_s: scene.time_scale_s(),
        }
    }

    fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }
}

impl Motion {
    /// The launch in dimensionless form. Components out of the xz plane are ignored. A coin that
    /// would start inside the surface is lifted until it touches.
    pub(crate) fn new(launch: &Launch, units: &Units, shape: &Shape) -> Self {
        let (x, z) = (launch.axis.x, launch.axis.z);
        // θ = q·90° + φ with φ from the two magnitudes alone: u and −u give the same φ
        let (quadrant, along, across) = if z > 0.0 && x >= 0.0 {
            (0, z, x)
        } else if x > 0.0 {
            (1, x, -z)
        } else if z < 0.0 {
            (2, -z, -x)
        } else {
            (3, -x, z)
        };
        let delta = libm::atan2(across, along) - shape.first_span(quadrant);
        let speed = units.speed_m_s();
        Self {
            quadrant,
            delta,
            omega: launch.spin_rad_s.y * units.time_s,
            x: 0.0,
            z: (launch.height_m / units.length_m).max(sin_cos(delta).1),
            vx: launch.velocity_m_s.x / speed,
            vz: launch.velocity_m_s.z / speed,
            time: 0.0,
        }
    }

    /// Mechanical energy in units of m g D, potential zero at the surface.
    #[inline]
    pub(crate) fn energy(&self, k: f64) -> f64 {
        self.energy_without_sliding(k) + 0.5 * self.vx * self.vx
    }

    /// Mechanical energy without that of horizontal motion.
    #[inline]
    pub(crate) fn energy_without_sliding(&self, k: f64) -> f64 {
        energy_without_sliding(k, [self.z, self.vz, self.omega])
    }

    /// Free flight for `t`, within the quadrant.
    #[inline]
    pub(crate) fn advance(&mut self, t: f64) {
        self.x += self.vx * t;
        self.z += t * (self.vz - 0.5 * t);
        self.vz -= t;
        self.delta += self.omega * t;
        self.time += t;
    }

    /// Enters the neighbouring quadrant: the corner across the flat edge becomes the lowest.
    #[inline]
    pub(crate) fn cross_flat(&mut self, shape: &Shape, forwards: bool) {
        self.quadrant = next(self.quadrant, forwards);
        // the new quadrant begins where the old one ended, measured from its own corner
        self.delta = if forwards {
            -shape.first_span(self.quadrant)
        } else {
            shape.last_angle(self.quadrant, 1.0)
        };
    }

    /// Turns by any angle, into any quadrant.
    pub(crate) fn turn(&mut self, shape: &Shape, by: f64) {
        let angle = self.delta + shape.first_span(self.quadrant) + by;
        if (0.0..=FRAC_PI_2).contains(&angle) {
            self.delta = (self.delta + by).clamp(
                -shape.first_span(self.quadrant),
                shape.last_angle(self.quadrant, 1.0),
            );
        } else {
            self.enter(shape, angle);
        }
    }

    /// Free flight for `t`, through any number of quadrants.
    #[inline]
    pub(crate) fn fly(&mut self, shape: &Shape, t: f64) {
        let angle = self.delta + shape.first_span(self.quadrant) + self.omega * t;
        self.advance(t);
        self.enter(shape, angle);
    }

    /// The quadrant and δ of an angle from flat at the start of the present quadrant.
    #[inline]
    fn enter(&mut self, shape: &Shape, angle: f64) {
        let (quadrant, delta) = shape.enter(f64::from(self.quadrant), angle);
        (self.quadrant, self.delta) = (as_quadrant(quadrant), delta);
    }

    /// Sets the coin on its lowest corner with angular velocity `omega`, the corner sliding at
    /// `slip`.
    #[inline]
    pub(crate) fn set_on_corner(&mut self, sin: f64, cos: f64, omega: f64, slip: f64) {
        self.z = cos;
        self.omega = omega;
        self.vx = slip + omega * cos;
        self.vz = -omega * sin;
    }

    /// Removes the energy that rounding and truncation have added since it was `before`: no contact
    /// gains energy. All velocities shrink by one factor, so every constraint on them still holds.
    #[inline]
    pub(crate) fn cap_energy(&mut self, k: f64, before: f64) {
        if let Some(scale) = cap(self.z, self.energy(k), before) {
            self.vx *= scale;
            self.vz *= scale;
            self.omega *= scale;
        }
    }

    /// The state in SI units and three dimensions.
    pub(crate) fn state(&self, units: &Units, shape: &Shape) -> State {
        let angle = self.delta + shape.first_span(self.quadrant);
        let (sin, cos) = libm::sincos(angle);
        let (x, z) = match self.quadrant {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        let speed = units.speed_m_s();
        State {
            time_s: self.time * units.time_s,
            position_m: Vector3::new(self.x, 0.0, self.z) * units.length_m,
            velocity_m_s: Vector3::new(self.vx, 0.0, self.vz) * speed,
            axis: UnitVector3::new_unchecked(Vector3::new(x, 0.0, z)),
            spin_rad_s: Vector3::new(0.0, self.omega / units.time_s, 0.0),
        }
    }
}

/// Energy at height `z` without that of horizontal motion.
#[inline(always)]
pub(crate) fn energy_without_sliding<L: Lane>(k: f64, [z, vz, omega]: [L; 3]) -> L {
    L::splat(0.5) * (vz * vz + L::splat(k) * omega * omega) + z
}

/// The factor by which all velocities shrink so that the energy `now`, at height `z`, is at most
/// `before`; `None` if no lane has gained energy.
#[inline(always)]
pub(crate) fn cap<L: Lane>(z: L, now: L, before: L) -> Option<L> {
    let gained = before.lt(now);
    gained.any().then(|| {
        let share = ((before - z) / (now - z)).max(L::splat(0.0));
        L::select(gained, share.sqrt(), L::splat(1.0))
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use coinmc_testkit::scene;

    /// A coin on its corner that turns at `omega` and slips at `slip`.
    pub(crate) fn on_corner(quadrant: u8, delta: f64, omega: f64, slip: f64) -> Motion {
        let (sin, cos) = sin_cos(delta);
        let mut motion = Motion {
            quadrant,
            delta,
            omega,
            x: 0.0,
            z: cos,
            vx: 0.0,
            vz: 0.0,
            time: 0.0,
        };
        motion.set_on_corner(sin, cos, omega, slip);
        motion
    }

    fn angle(motion: &Motion, units: &Units, shape: &Shape) -> f64 {
        let axis = motion.state(units, shape).axis;
        libm::atan2(axis.x, axis.z)
    }

    /// Through any number of quadrants, and either way, the axis turns by the angle that the coin turns by.
    #[test]
    fn turning_and_flying_turn_the_axis() {
        let scene = scene(1.0, 0.5, 0.3);
        let (units, shape) = (Units::new(&scene), Shape::new(&scene.coin));
        for quadrant in 0..4 {
            for by in [-9.0, -2.0, -0.1, 0.0, 0.1, 2.0, 9.0] {
                let start = Motion {
                    quadrant,
                    delta: -0.2,
                    omega: 4.0 * by,
                    x: 0.0,
                    z: 20.0,
                    vx: 0.0,
                    vz: 0.0,
                    time: 0.0,
                };
                let (mut turned, mut flown) = (start, start);
                turned.turn(&shape, by);
                flown.fly(&shape, 0.25);
                for motion in [turned, flown] {
                    let found = angle(&motion, &units, &shape) - angle(&start, &units, &shape);
                    assert!(libm::sin(0.5 * (found - by)).abs() < 1e-14, "{by}: {found}");
                    let end = shape.last_angle(motion.quadrant, 1.0);
                    assert!(motion.delta <= end && -motion.delta <= FRAC_PI_2 - end);
                }
            }
        }
    }

    /// Without a surface: x + v t, z + v t - t²/2, and the clock goes on.
    #[test]
    fn a_flight_is_a_parabola_and_takes_its_time() {
        let start = Motion {
            time: 2.0,
            ..on_corner(0, 0.1, 0.5, 0.25)
        };
        let mut motion = start;
        motion.advance(0.25);
        assert_eq!(motion.time, 2.25);
        assert_eq!(motion.x, start.x + 0.25 * start.vx);
        assert!((motion.z - (start.z + 0.25 * start.vz - 0.03125)).abs() < 1e-15);
        assert_eq!(motion.vz, start.vz - 0.25);
        assert_eq!(motion.delta, start.delta + 0.125);
    }
}
