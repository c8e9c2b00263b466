//! The coin on compliant corners: positions, forces, and the margins that events break.
//!
//! Units of m, D and sqrt(D/g). Displacements and times start at the touch, so that rounding does
//! no harm however stiff the contact. Corner i is r_i from the centre; turning by φ moves it by
//! r_i(φ) − r_i = (r_z, −r_x) sin φ − 2 r sin²(φ/2), and its velocity is (v_x + ω r_z, v_z − ω
//! r_x).
//!
//! * **Normal force** N = K δⁿ (1 + c δ') of Hunt & Crossley, never a pull.
//! * **Friction** F = −k_t s, s a spring between corner and surface: it follows the corner,
//!   s' = u_x, as long as |k_t s| < μN, and slides at that bound otherwise. A spring in series with
//!   a dry slider: it takes F·(u_x − s') >= 0 and gives back ½ k_t s². k_t is constant in an
//!   impact, because a stiffness that changes with the load would create energy.

use crate::dormand_prince::System;
use crate::laws::palmgren::{EXPONENT, ninth_root, power};
use coinmc_lanes::sin_cos;
use std::f64::consts::FRAC_PI_2;

/// x, z, φ since the touch; v_x, v_z, ω; the four springs s; the energy that damping and friction
/// have taken.
pub(super) type State = [f64; 11];

pub(super) const CORNERS: usize = 4;
const SPRING: usize = 6;
pub(super) const LOST: usize = 10;

/// How a corner touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Grip {
    /// Clear of the surface.
    Apart,
    /// Touches, without friction.
    Smooth,
    /// Slides in this direction, ±1.
    Slides(f64),
    /// Stretches its spring.
    Sticks,
}

/// A corner of the coin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    /// r at the touch.
    pub(super) x: f64,
    pub(super) z: f64,
    /// Height above the surface at the touch.
    pub(super) gap: f64,
    pub(super) grip: Grip,
    /// c of the damping, set when the corner touches.
    pub(super) damping: f64,
}

/// The coin, its corners and the parameters of this impact.
pub(super) struct Body {
    /// I/mD².
    pub(super) inertia: f64,
    /// K in m g/D^(10/9).
    pub(super) stiffness: f64,
    pub(super) mu: f64,
    /// k_t in m g/D.
    pub(super) tangential: f64,
    pub(super) corners: [Corner; CORNERS],
}

/// A corner at an instant.
#[derive(Clone, Copy, Default)]
pub(super) struct Place {
    pub(super) rx: f64,
    pub(super) rz: f64,
    /// δ, the depth below the surface.
    pub(super) depth: f64,
    /// δ'.
    pub(super) rate: f64,
    /// Horizontal velocity.
    pub(super) slip: f64,
}

/// sin φ and 1 − cos φ of any angle, without cancellation for small ones.
#[inline]
fn turned(angle: f64) -> (f64, f64) {
    let half = 0.5 * angle;
    let (sin, cos) = if half.abs() < FRAC_PI_2 {
        sin_cos(half)
    } else {
        libm::sincos(half)
    };
    (2.0 * sin * cos, 2.0 * sin * sin)
}

impl Body {
    /// Where a corner is.
    pub(super) fn place(&self, y: &State, which: usize) -> Place {
        self.placed(y, which, turned(y[2]))
    }

    #[inline]
    fn placed(&self, y: &State, which: usize, (sin, versine): (f64, f64)) -> Place {
        let corner = &self.corners[which];
        let (dx, dz) = (
            corner.z * sin - corner.x * versine,
            -corner.x * sin - corner.z * versine,
        );
        let (rx, rz) = (corner.x + dx, corner.z + dz);
        Place {
            rx,
            rz,
            depth: -(corner.gap + y[1] + dz),
            rate: y[5] * rx - y[4],
            slip: y[3] + y[5] * rz,
        }
    }

    /// The effective mass of a corner along the normal: the inverse of K_zz.
    pub(super) fn mass(&self, at: &Place) -> f64 {
        1.0 / (1.0 + at.rx * at.rx / self.inertia)
    }

    /// Normal force on a corner.
    #[inline]
    pub(super) fn normal(&self, which: usize, at: &Place) -> f64 {
        self.stiffness * power(at.depth) * self.damped(which, at)
    }

    /// 1 + c δ', at least zero.
    #[inline]
    fn damped(&self, which: usize, at: &Place) -> f64 {
        (1.0 + self.corners[which].damping * at.rate).max(0.0)
    }

    /// Energy stored in the compression of a corner.
    pub(super) fn stored(&self, at: &Place) -> f64 {
        self.stiffness * power(at.depth) * at.depth.max(0.0) / (EXPONENT + 1.0)
    }

    /// Friction on a corner.
    #[inline]
    fn friction(&self, y: &State, which: usize, normal: f64) -> f64 {
        match self.corners[which].grip {
            Grip::Apart | Grip::Smooth => 0.0,
            Grip::Slides(direction) => -direction * self.mu * normal,
            Grip::Sticks => -self.tangential * y[SPRING + which],
        }
    }

    /// The stretch of the spring of a corner.
    pub(super) fn spring(y: &mut State, which: usize) -> &mut f64 {
        &mut y[SPRING + which]
    }

    /// Rate of the normal force, from the corner's acceleration.
    fn loading(&self, rates: &State, y: &State, which: usize, at: &Place) -> f64 {
        let c = self.corners[which].damping;
        let damped = 1.0 + c * at.rate;
        if damped <= 0.0 || at.depth <= 0.0 {
            return 0.0;
        }
        // the corner's upward acceleration is v_z' − ω' r_x − ω² r_z
        let closing = -(rates[4] - rates[5] * at.rx - y[5] * y[5] * at.rz);
        let spring = EXPONENT * ninth_root(at.depth) * at.rate * damped;
        self.stiffness * (spring + power(at.depth) * c * closing)
    }

    /// The margin of the normal direction, positive while the corner stays clear (its height) or in
    /// touch (its depth).
    pub(super) fn clearance(&self, y: &State, which: usize) -> f64 {
        let depth = self.place(y, which).depth;
        match self.corners[which].grip {
            Grip::Apart => -depth,
            _ => depth,
        }
    }

    /// The margin of friction, positive while the corner keeps sliding (its speed relative to the
    /// spring) or sticking (the friction to spare).
    pub(super) fn hold(&self, y: &State, which: usize) -> f64 {
        match self.corners[which].grip {
            Grip::Apart | Grip::Smooth => f64::INFINITY,
            Grip::Slides(direction) => {
                let at = self.place(y, which);
                let loading = self.loading(&self.rates(y), y, which, &at);
                direction * at.slip - self.mu * loading / self.tangential
            }
            Grip::Sticks => {
                let pull = self.tangential * y[SPRING + which].abs();
                self.mu * self.normal(which, &self.place(y, which)) - pull
            }
        }
    }
}

impl System<11> for Body {
    #[inline]
    fn rates(&self, y: &State) -> State {
        let mut rates = [0.0; 11];
        rates[..3].copy_from_slice(&y[3..6]);
        rates[4] = -1.0;
        let turned = turned(y[2]);
        for (which, corner) in self.corners.iter().enumerate() {
            if corner.grip == Grip::Apart {
                continue;
            }
            let at = self.placed(y, which, turned);
            let elastic = self.stiffness * power(at.depth);
            let normal = elastic * self.damped(which, &at);
            let friction = self.friction(y, which, normal);
            rates[3] += friction;
            rates[4] += normal;
            rates[5] += (at.rz * friction - at.rx * normal) / self.inertia;
            if corner.grip == Grip::Sticks {
                rates[SPRING + which] = at.slip;
            }
            rates[LOST] += (normal - elastic) * at.rate - friction * at.slip;
        }
        rates
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A coin with its corners here, all as high above the surface.
    pub(in crate::laws::line_contact) fn body(
        mu: f64,
        corners: [(f64, f64); CORNERS],
        gap: f64,
        grip: Grip,
    ) -> Body {
        Body {
            inertia: 0.3,
            stiffness: 1e6,
            mu,
            tangential: 0.0,
            corners: corners.map(|(x, z)| Corner {
                x,
                z,
                gap,
                grip,
                damping: 0.0,
            }),
        }
    }

    /// Also beyond half a turn, where the polynomials of flight do not hold.
    #[test]
    fn any_angle_has_its_sine_and_versine() {
        for step in -200..=200 {
            let angle = 0.1 * f64::from(step);
            let (sin, versine) = turned(angle);
            assert!((sin - libm::sin(angle)).abs() < 1e-15, "{angle}");
            assert!(
                (versine - (1.0 - libm::cos(angle))).abs() < 1e-15,
                "{angle}"
            );
        }
        // without cancellation
        assert!((turned(1e-9).1 / 5e-19 - 1.0).abs() < 1e-15);
    }

    /// The mass of a corner along the normal is the inverse of K_zz of its contact.
    #[test]
    fn the_mass_of_a_corner_is_that_of_its_contact() {
        let body = body(0.3, [(0.0, -1.0); CORNERS], 0.0, Grip::Apart);
        for delta in [-0.9, 0.0, 0.4] {
            let (sin, cos) = sin_cos(delta);
            let at = Place {
                rx: -sin,
                rz: -cos,
                ..Place::default()
            };
            let matrix = crate::ContactMatrix::new(sin, cos, body.inertia);
            assert!((body.mass(&at) * matrix.zz - 1.0).abs() < 1e-15);
        }
    }
}
