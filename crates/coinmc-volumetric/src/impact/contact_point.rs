//! The contact point just before an impact, and its inertia.

use crate::body::{Body, levers};
use coinmc_lanes::Lane;

/// The inverse mass K of the contact point: an impulse p changes its velocity by K p.
#[derive(Debug, Clone, Copy)]
pub struct ContactMatrix<L> {
    /// 1 + rz²/kt.
    pub xx: L,
    /// −rx rz/kt.
    pub xz: L,
    /// 1 + h²/kt + R²/ka.
    pub yy: L,
    /// 1 + rx²/kt.
    pub zz: L,
}

/// The contact matrix reduced to constant normal velocity.
#[derive(Clone, Copy)]
pub(crate) struct Condensed<L> {
    /// 1/K_zz.
    pub(crate) mass_z: L,
    /// K_xz/K_zz: a friction impulse p_x goes with a normal impulse of −coupling·p_x.
    pub(crate) coupling: L,
    /// α = K_xx − K_xz²/K_zz, the inverse mass along x.
    pub(crate) alpha: L,
}

impl<L: Lane> ContactMatrix<L> {
    /// In the xz plane K is the unit matrix plus a matrix of rank one, so its determinant there is
    /// K_xx + K_zz − 1, in which no digits cancel.
    #[inline(always)]
    pub(crate) fn condensed(&self) -> Condensed<L> {
        let mass_z = L::splat(1.0) / self.zz;
        Condensed {
            mass_z,
            coupling: self.xz * mass_z,
            alpha: (self.xx + self.zz - L::splat(1.0)) * mass_z,
        }
    }
}

/// The contact point of a coin just before an impact. Lengths in D = sqrt(R² + H²/4), times in
/// sqrt(D/g), in the frame whose z axis points up and whose x axis points along the horizontal part
/// of the axis u.
#[derive(Debug, Clone, Copy)]
pub struct ContactPoint<L> {
    /// s = sin of the tilt of u from the vertical, > 0.
    pub sin: L,
    /// c = cos of that tilt, >= 0: the frame is chosen so that u points up.
    pub cos: L,
    /// Position relative to the centre, x: c R − s h.
    pub rx: L,
    /// Position relative to the centre, z: −c h − s R, r less if the rims are rounded.
    pub rz: L,
    /// Velocity of the contact point, x.
    pub slip_x: L,
    /// Velocity of the contact point, y.
    pub slip_y: L,
    /// Velocity of the contact point, z: negative when it approaches.
    pub approach: L,
    /// Angular velocity about u.
    pub spin: L,
    /// Angular velocity about e_θ.
    pub turn: L,
}

impl<L: Lane> ContactPoint<L> {
    /// The inverse mass of this contact point.
    #[inline(always)]
    pub fn matrix(&self, body: &Body) -> ContactMatrix<L> {
        let one = L::splat(1.0);
        let inverse_kt = L::splat(1.0 / body.kt);
        let (x, z) = (self.rx * inverse_kt, self.rz * inverse_kt);
        ContactMatrix {
            xx: one + self.rz * z,
            xz: -(self.rx * z),
            yy: self.across(body),
            zz: one + self.rx * x,
        }
    }

    /// K_yy, which with sharp rims does not depend on the tilt.
    #[inline(always)]
    fn across(&self, body: &Body) -> L {
        if body.rim == 0.0 {
            return L::splat(
                1.0 + body.half * body.half / body.kt + body.radius * body.radius / body.ka,
            );
        }
        let (radius, half) = self.levers(body);
        let turn = half * half * L::splat(1.0 / body.kt);
        L::splat(1.0) + turn + radius * radius * L::splat(1.0 / body.ka)
    }

    /// The levers of a force along y about u and e_θ.
    #[inline(always)]
    pub(crate) fn levers(&self, body: &Body) -> (L, L) {
        levers(body, self.sin, self.cos)
    }

    /// The point in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, index: usize) -> ContactPoint<f64> {
        ContactPoint {
            sin: self.sin.lane(index),
            cos: self.cos.lane(index),
            rx: self.rx.lane(index),
            rz: self.rz.lane(index),
            slip_x: self.slip_x.lane(index),
            slip_y: self.slip_y.lane(index),
            approach: self.approach.lane(index),
            spin: self.spin.lane(index),
            turn: self.turn.lane(index),
        }
    }
}

#[cfg(test)]
impl ContactPoint<f64> {
    /// The lowest point of a sharp rim at a tilt of this sine and cosine, with its velocity along x, y and z, and these
    /// angular velocities about u and e_θ.
    pub(crate) fn at(
        body: &Body,
        (sin, cos): (f64, f64),
        [slip_x, slip_y, approach]: [f64; 3],
        [spin, turn]: [f64; 2],
    ) -> Self {
        Self {
            sin,
            cos,
            rx: body.radius * cos - body.half * sin,
            rz: -body.half * cos - body.radius * sin,
            slip_x,
            slip_y,
            approach,
            spin,
            turn,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Rigid;
    use nalgebra::Vector3;

    /// K is what impulses along x, y and z change of the contact point's velocity v + ω × r; at constant normal
    /// velocity along x the inverse mass is α.
    #[test]
    fn the_matrix_is_the_answer_to_unit_impulses() {
        for (rim, tilt) in [(0.0, 0.4), (0.0, 1.2), (0.15, 0.4), (0.15, 1.2)] {
            let body = Rigid::generic_body(rim);
            let coin = Rigid::new(&body, tilt, Vector3::zeros(), Vector3::zeros());
            let (motion, spin) = coin.folded(1.0, 1.0);
            let k = motion.contact_point(&body, &spin).matrix(&body);
            let answer = |impulse| coin.pushed(impulse, Vector3::zeros()).at_contact();
            for (impulse, expected) in [
                (Vector3::x(), Vector3::new(k.xx, 0.0, k.xz)),
                (Vector3::y(), Vector3::new(0.0, k.yy, 0.0)),
                (Vector3::z(), Vector3::new(k.xz, 0.0, k.zz)),
            ] {
                let wrong = answer(impulse) - expected;
                assert!(wrong.norm() < 1e-13, "{rim} {tilt}: {wrong}");
            }
            let Condensed {
                mass_z,
                coupling,
                alpha,
            } = k.condensed();
            let wrong = answer(Vector3::new(1.0, 0.0, -coupling)) - Vector3::new(alpha, 0.0, 0.0);
            assert!(wrong.norm() < 1e-13, "{rim} {tilt}: {wrong}");
            assert!((answer(Vector3::new(0.0, 0.0, mass_z)).z - 1.0).abs() < 1e-13);
        }
    }
}
