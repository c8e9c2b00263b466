//! The friction lengths in an impact: contour and pivoting friction against the final angular
//! velocities.
//!
//! Contour friction opposes ψ' = ω_a + ω_θ c/s, the rate at which the contact point rolls along the
//! rim, with |J_c| <= ρ_c p_z. For small s, ψ' and its inverse mass are huge. So the kernel uses
//! the horizontal angular velocity ω_x = s ψ' = s ω_a + c ω_θ and C = J_c/s, |C| <= (ρ_c/s) p_z.
//! Pivoting friction opposes ω_z = c ω_a − s ω_θ with P = J_p, |P| <= ρ_p p_z. (ω_x, ω_z) is (ω_a,
//! ω_θ) turned to the horizontal and the vertical, and
//!
//! slip_y⁺ = slip_y + K_yy p_y − a C − b P      a = sR/ka + ch/kt    b = cR/ka − sh/kt
//! ω_x⁺ = ω_x + a p_y − A C − F P               A = s²/ka + c²/kt    F = sc(1/ka − 1/kt)
//! ω_z⁺ = ω_z + b p_y − F C − G P               G = c²/ka + s²/kt
//!
//! Neither C nor P acts on ω_y, hence not on the normal velocity nor on slip_x.
//!
//! # The minimum over a box
//! The set-valued laws (C is at its limit with the sign of ω_x⁺, or inside with ω_x⁺ = 0; P and
//! ω_z⁺ likewise) are the conditions for a minimum: of the kinetic energy after the impact, a
//! strictly convex quadratic function, over the box |C| <= C_m, |P| <= P_m. In two dimensions three
//! clamps find it exactly. Let P* be the P of the minimum without limits. If only P is limited, its
//! minimum has P = clamp(P*): where P* > P_m, with P = P_m and the C that makes ω_x⁺ = 0, the
//! distance of the optimal P from P_m shrinks by the factor 1 − F²/(AG) > 0 but keeps its sign, so
//! P = P_m is right. With P minimal for each C, ω_x⁺ is monotone in C, so C only needs to be
//! clamped; then P follows from C. The box contains 0, so the energy never increases.

use super::ContactPoint;
use crate::body::{Body, Friction};
use coinmc_lanes::Lane;

/// The angular velocities that contour and pivoting friction oppose, and their inverse masses.
#[derive(Clone, Copy)]
pub(crate) struct RimRates<L> {
    /// ω_x = s ψ'.
    pub(crate) roll: L,
    /// ω_z.
    pub(crate) pivot: L,
    /// a, b, A, F, G of the module's text.
    pub(crate) roll_y: L,
    pub(crate) pivot_y: L,
    pub(crate) roll_roll: L,
    pub(crate) roll_pivot: L,
    pub(crate) pivot_pivot: L,
}

/// The limits of contour and pivoting friction per unit normal impulse, and the constants that
/// their solution needs.
#[derive(Clone, Copy)]
pub(crate) struct FrictionMoments<L> {
    rates: RimRates<L>,
    /// ρ_c/s.
    contour: L,
    /// ρ_p.
    pivoting: L,
    /// The angular momentum about z through the centre.
    momentum: L,
    rx: L,
    slip_y: L,
    /// The centre's velocity, y.
    centre: L,
    yy: L,
}

/// C = J_c/s and P = J_p, solved jointly with p_y.
#[derive(Clone, Copy)]
pub(crate) struct JointSolution<L> {
    pub(crate) contour: L,
    pub(crate) pivoting: L,
    /// slip_y with C and P but without p_y: p_y = −slip_y/(σ + K_yy).
    pub(crate) slip_y: L,
    /// Its derivative with respect to σ.
    pub(crate) slope: L,
}

/// The minimum over a box, in two dimensions: angular velocities before and inverse masses, with
/// p_y eliminated or given, and the P of the minimum without limits.
pub(crate) struct BoxProblem<L> {
    pub(crate) roll: L,
    pub(crate) pivot: L,
    pub(crate) roll_pivot: L,
    /// 1/A and 1/G, with p_y eliminated or given.
    pub(crate) roll_mass: L,
    pub(crate) pivot_mass: L,
    pub(crate) free: L,
}

/// An interval; of length 0 where the friction is given.
#[derive(Clone, Copy)]
pub(crate) struct Limits<L> {
    pub(crate) low: L,
    pub(crate) high: L,
}

impl<L: Lane> Limits<L> {
    #[inline(always)]
    pub(crate) fn within(limit: L) -> Self {
        Self {
            low: -limit,
            high: limit,
        }
    }

    #[inline(always)]
    fn clamp(self, value: L) -> L {
        value.max(self.low).min(self.high)
    }
}

impl<L: Lane> BoxProblem<L> {
    /// (C, P) of the minimum over a box: see the module's text.
    #[inline(always)]
    pub(crate) fn least(&self, contour: Limits<L>, pivoting: Limits<L>) -> (L, L) {
        let p = pivoting.clamp(self.free);
        let c = contour.clamp((self.roll - self.roll_pivot * p) * self.roll_mass);
        let p = pivoting.clamp((self.pivot - self.roll_pivot * c) * self.pivot_mass);
        (c, p)
    }
}

impl<L: Lane> RimRates<L> {
    #[inline(always)]
    pub(crate) fn rates(body: &Body, point: &ContactPoint<L>) -> Self {
        let (s, c) = (point.sin, point.cos);
        let (axial, across) = (L::splat(1.0 / body.ka), L::splat(1.0 / body.kt));
        let (radius, half) = if body.rim == 0.0 {
            (
                L::splat(body.radius / body.ka),
                L::splat(body.half / body.kt),
            )
        } else {
            let (radius, half) = point.levers(body);
            (radius * axial, half * across)
        };
        Self {
            roll: s * point.spin + c * point.turn,
            pivot: c * point.spin - s * point.turn,
            roll_y: s * radius + c * half,
            pivot_y: c * radius - s * half,
            roll_roll: s * s * axial + c * c * across,
            roll_pivot: s * c * (axial - across),
            pivot_pivot: c * c * axial + s * s * across,
        }
    }

    /// By how much C and P reduce slip_y.
    #[inline(always)]
    pub(crate) fn slip_y(&self, contour: L, pivoting: L) -> L {
        self.roll_y * contour + self.pivot_y * pivoting
    }

    /// Twice the energy that C and P add to that of p_y.
    #[inline(always)]
    pub(crate) fn work(&self, y: L, contour: L, pivoting: L) -> L {
        let two = L::splat(2.0);
        let roll = two * self.roll + self.roll_y * y
            - self.roll_roll * contour
            - self.roll_pivot * pivoting;
        let pivot = two * self.pivot + self.pivot_y * y
            - self.roll_pivot * contour
            - self.pivot_pivot * pivoting;
        -(contour * roll + pivoting * pivot)
    }
}

impl<L: Lane> FrictionMoments<L> {
    #[inline(always)]
    pub(crate) fn new(body: &Body, friction: &Friction, point: &ContactPoint<L>, yy: L) -> Self {
        let (radius, half) = point.levers(body);
        let (axial, across) = (
            L::splat(body.ka) * point.spin,
            L::splat(body.kt) * point.turn,
        );
        Self {
            rates: RimRates::rates(body, point),
            contour: L::splat(friction.contour) / point.sin,
            pivoting: L::splat(friction.pivoting),
            momentum: point.cos * axial - point.sin * across,
            rx: point.rx,
            slip_y: point.slip_y,
            centre: point.slip_y - radius * point.spin - half * point.turn,
            yy,
        }
    }

    /// C and P for a given p_y: the least energy within their limits.
    #[inline(always)]
    pub(crate) fn held(&self, y: L, z: L) -> (L, L) {
        let r = &self.rates;
        let one = L::splat(1.0);
        let reduced = BoxProblem {
            roll: r.roll + r.roll_y * y,
            pivot: r.pivot + r.pivot_y * y,
            roll_pivot: r.roll_pivot,
            roll_mass: one / r.roll_roll,
            pivot_mass: one / r.pivot_pivot,
            // without limits both angular velocities end at 0, and so does the angular momentum
            // about z
            free: self.momentum + self.rx * y,
        };
        self.least(&reduced, z.max(L::splat(0.0)))
    }

    /// C and P jointly with p_y = −slip_y⁺/σ, and the derivative with respect to σ. `dz` is the
    /// derivative of z, `inverse` is 1/(σ + K_yy) and `rigid` is 1/(1 + σ).
    #[inline(always)]
    pub(crate) fn joint(&self, sigma: L, inverse: L, rigid: L, z: L, dz: L) -> JointSolution<L> {
        let r = &self.rates;
        let (roll_y, pivot_y) = (r.roll_y * inverse, r.pivot_y * inverse);
        // both inverse masses times σ + K_yy, with one quotient for both
        let reach = sigma + self.yy;
        let roll = r.roll_roll * reach - r.roll_y * r.roll_y;
        let pivot = r.pivot_pivot * reach - r.pivot_y * r.pivot_y;
        let share = reach / (roll * pivot);
        // without limits the coin stops turning and the centre moves on with −σ p_y
        let drift = self.centre * rigid;
        let reduced = BoxProblem {
            roll: r.roll - roll_y * self.slip_y,
            pivot: r.pivot - pivot_y * self.slip_y,
            roll_pivot: r.roll_pivot - roll_y * r.pivot_y,
            roll_mass: pivot * share,
            pivot_mass: roll * share,
            free: self.momentum - self.rx * drift,
        };
        let positive = z.max(L::splat(0.0));
        let (contour, pivoting) = self.least(&reduced, positive);
        let slip_y = self.slip_y - r.slip_y(contour, pivoting);

        // the derivatives of the same three clamps: an impulse at its limit is proportional to z
        let (limit_c, limit_p) = (self.contour * positive, self.pivoting * positive);
        let (free_c, free_p) = (contour.abs().lt(limit_c), pivoting.abs().lt(limit_p));
        let dz = L::select(L::splat(0.0).lt(z), dz, L::splat(0.0));
        let side = |moment: L| L::splat(1.0).copysign(moment) * dz;
        let (at_c, at_p) = (self.contour * side(contour), self.pivoting * side(pivoting));
        let y = -slip_y * inverse;
        let dp = L::select(free_p, self.rx * drift * rigid, at_p);
        let dc = -(roll_y * y) - reduced.roll_pivot * dp;
        let dc = L::select(free_c, dc * reduced.roll_mass, at_c);
        let dp = -(pivot_y * y) - reduced.roll_pivot * dc;
        let dp = L::select(free_p, dp * reduced.pivot_mass, at_p);
        JointSolution {
            contour,
            pivoting,
            slip_y,
            slope: -r.slip_y(dc, dp),
        }
    }

    #[inline(always)]
    fn least(&self, reduced: &BoxProblem<L>, z: L) -> (L, L) {
        reduced.least(
            Limits::within(self.contour * z),
            Limits::within(self.pivoting * z),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Rigid;
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// The rates are ω_x and ω_z, and the inverse masses what an impulse along y and the torques about x and z change
    /// of them and of slip_y, as vectors have it.
    #[test]
    fn inverse_masses_are_answers_to_unit_torques() {
        for (rim, tilt) in [(0.0, 0.4), (0.0, 1.2), (0.15, 0.4), (0.15, 1.2)] {
            let body = Rigid::generic_body(rim);
            let (velocity, omega) = (Vector3::new(0.3, -0.7, -1.1), Vector3::new(1.7, -2.3, 0.9));
            let coin = Rigid::new(&body, tilt, velocity, omega);
            let (motion, spin) = coin.folded(1.0, 1.0);
            let point = motion.contact_point(&body, &spin);
            let r = RimRates::rates(&body, &point);
            let changes = |impulse, torque| {
                let after = coin.pushed(impulse, torque);
                let slip_y = after.at_contact().y - coin.at_contact().y;
                let turns = after.omega - omega;
                (slip_y, turns.x, turns.z)
            };
            let (slip_y, roll, pivot) = changes(Vector3::y(), Vector3::zeros());
            let (slip_c, roll_c, pivot_c) = changes(Vector3::zeros(), -Vector3::x());
            let (slip_p, roll_p, pivot_p) = changes(Vector3::zeros(), -Vector3::z());
            let (y, c, p) = (0.3, 0.07, -0.11);
            let moved = coin.pushed(Vector3::y() * y, Vector3::new(-c, 0.0, -p));
            let without = coin.pushed(Vector3::y() * y, Vector3::zeros());
            for (found, expected) in [
                (r.roll, omega.x),
                (r.pivot, omega.z),
                (r.roll_y, roll),
                (r.pivot_y, pivot),
                (-r.roll_roll, roll_c),
                (-r.roll_pivot, pivot_c),
                (-r.roll_pivot, roll_p),
                (-r.pivot_pivot, pivot_p),
                (-r.slip_y(1.0, 0.0), slip_c),
                (-r.slip_y(0.0, 1.0), slip_p),
                (point.matrix(&body).yy, slip_y),
                (
                    0.5 * r.work(y, c, p),
                    moved.kinetic() - without.kinetic() + y * r.slip_y(c, p) * 0.5,
                ),
            ] {
                assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            }
        }
    }

    /// Any coin that strikes, with friction lengths of this at most.
    fn drawn(dice: &mut Dice, most: f64) -> (Body, Friction, ContactPoint<f64>) {
        let coin = Coin::cylinder(libm::exp(dice.between(-2.0, 1.0)), 0.01);
        let body = Body::new(&coin.expect("a valid coin"));
        let friction = Friction {
            mu: 0.3,
            contour: dice.between(0.0, most),
            pivoting: dice.between(0.0, most),
        };
        let tilt = libm::sincos(dice.between(0.2, 1.5));
        let mut part = || dice.between(-1.0, 1.0);
        let point = ContactPoint::at(&body, tilt, [part(), part(), -1.0], [part(), part()]);
        (body, friction, point)
    }

    /// The derivative with respect to σ, with which Newton's method goes, is that of the solution itself,
    /// by differences over so little that no limit is reached between.
    #[test]
    fn the_slope_is_that_of_the_solution() {
        let mut kinds = [0; 4];
        for trial in 0..4000 {
            let mut dice = Dice::new(322, trial);
            let (body, friction, point) = drawn(&mut dice, 0.2);
            let yy = point.matrix(&body).yy;
            let moments = FrictionMoments::new(&body, &friction, &point, yy);
            let (at, z, dz) = (
                dice.between(0.0, 3.0),
                dice.between(0.1, 2.0),
                dice.between(-1.0, 1.0),
            );
            let solution = |sigma: f64| {
                let (inverse, rigid) = (1.0 / (sigma + yy), 1.0 / (1.0 + sigma));
                moments.joint(sigma, inverse, rigid, z + dz * (sigma - at), dz)
            };
            let limits = |one: &JointSolution<f64>, z: f64| {
                [
                    (one.contour, friction.contour / point.sin),
                    (one.pivoting, friction.pivoting),
                ]
                .map(|(value, limit)| value.abs() >= limit * z * (1.0 - 1e-12))
            };
            let small = 1e-5;
            let [before, now, after] = [-small, 0.0, small].map(|by| solution(at + by));
            let at_limits = limits(&now, z);
            if limits(&before, z - small * dz) != at_limits
                || limits(&after, z + small * dz) != at_limits
            {
                continue;
            }
            kinds[usize::from(at_limits[0]) + 2 * usize::from(at_limits[1])] += 1;
            let slope = (after.slip_y - before.slip_y) / (2.0 * small);
            assert!((now.slope - slope).abs() < 1e-8, "{} {slope}", now.slope);
        }
        assert!(kinds.iter().all(|kind| *kind > 50), "{kinds:?}");
    }

    /// What rolls or turns after the impact does so against friction at its limit, and what friction can hold stops,
    /// both at once: with a given impulse along y, too.
    #[test]
    fn held_friction_stops_what_it_can_and_opposes_what_it_cannot() {
        let mut kinds = [0; 4];
        for trial in 0..2000 {
            let mut dice = Dice::new(323, trial);
            let (body, friction, point) = drawn(&mut dice, 0.5);
            let yy = point.matrix(&body).yy;
            let (y, z) = (dice.between(-1.0, 1.0), dice.between(0.1, 2.0));
            let (c, p) = FrictionMoments::new(&body, &friction, &point, yy).held(y, z);
            let r = RimRates::rates(&body, &point);
            let roll = r.roll + r.roll_y * y - r.roll_roll * c - r.roll_pivot * p;
            let pivot = r.pivot + r.pivot_y * y - r.roll_pivot * c - r.pivot_pivot * p;
            let mut kind = 0;
            for (bit, value, limit, rate) in [
                (1, c, friction.contour / point.sin * z, roll),
                (2, p, friction.pivoting * z, pivot),
            ] {
                assert!(value.abs() <= limit);
                if value.abs() < limit {
                    assert!(rate.abs() < 1e-13, "{trial}: {value} of {limit}, {rate}");
                } else {
                    kind |= bit;
                    assert!(rate * value > -1e-13, "{trial}: {value} of {limit}, {rate}");
                }
            }
            kinds[kind] += 1;
        }
        assert!(kinds.iter().all(|kind| *kind > 50), "{kinds:?}");
    }
}
