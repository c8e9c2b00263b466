//! The gap between the lowest point of the coin and the surface, along a flight.

use super::orbit::Orbit;
use super::profile::Profile;
use crate::motion::LEAST_SIN;
use coinmc_lanes::Lane;

/// The gap f = z − (height of the centre at which the lowest point touches), with everything that
/// the search for its root needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gap<L> {
    pub(crate) z: L,
    pub(crate) vz: L,
    /// Horizontal and vertical parts of u.
    pub(crate) sin: L,
    pub(crate) uz: L,
    /// Rate of change of `uz`.
    pub(crate) uz_rate: L,
    /// Horizontal part of u as a vector, and its rate of change.
    pub(crate) across: [L; 2],
    pub(crate) across_rate: [L; 2],
    /// Rate of change of `sin`, the length of that vector.
    pub(crate) sin_rate: L,
    /// f, f' and f''.
    pub(crate) height: L,
    pub(crate) slope: L,
    pub(crate) curvature: L,
}

impl<L: Lane> Orbit<L> {
    /// The gap at time `t`.
    #[inline(always)]
    pub(crate) fn gap(&self, body: &impl Profile, t: L) -> Gap<L> {
        self.gap_at(body, self.phase(t), self.fall(t))
    }

    /// The gap at t = 0, where the phase is known to be 0.
    #[inline(always)]
    pub(crate) fn first_gap(&self, body: &impl Profile) -> Gap<L> {
        let phase = (L::splat(0.0), L::splat(1.0), self.state.rate);
        self.gap_at(body, phase, (self.state.z, self.state.vz))
    }

    #[inline(always)]
    fn gap_at(&self, body: &impl Profile, (s, c, rate): (L, L, L), (z, vz): (L, L)) -> Gap<L> {
        let at = |i: usize| self.state.a[i] + (self.state.b[i] * c + self.state.d[i] * s);
        let (ux, uy, uz) = (at(0), at(1), at(2));
        let sin = (ux * ux + uy * uy).sqrt().max(L::splat(LEAST_SIN));
        let uz_rate = rate * (self.state.d[2] * c - self.state.b[2] * s);
        let mut uz_curve = -(rate * rate) * (uz - self.state.a[2]);
        let mut fall_curve = L::splat(-1.0);
        if self.drag.acts() {
            uz_curve -= L::splat(self.drag.angular) * uz_rate;
            fall_curve -= L::splat(self.drag.linear) * vz;
        }
        let radius = L::splat(body.radius());
        // h = half|uz| + radius·sin; only this form of sin' keeps its digits near sin = 0
        let inverse = L::splat(1.0) / sin;
        let across_rate = [
            rate * (self.state.d[0] * c - self.state.b[0] * s),
            rate * (self.state.d[1] * c - self.state.b[1] * s),
        ];
        let sin_rate = (ux * across_rate[0] + uy * across_rate[1]) * inverse;
        // and sin'' = −(uz uz'' + uz'²/sin²)/sin
        let lever = body.lever(uz) - radius * uz * inverse;
        let bend = radius * uz_rate * uz_rate * (inverse * inverse * inverse);
        Gap {
            z,
            vz,
            sin,
            uz,
            uz_rate,
            across: [ux, uy],
            across_rate,
            sin_rate,
            height: z - (body.lift(uz) + radius * sin),
            slope: vz - (body.lever(uz) * uz_rate + radius * sin_rate),
            curvature: fall_curve - uz_curve * lever + bend,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::drag::Drag;
    use crate::flight::OneRim;
    use crate::flight::tests::motion;
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;
    use nalgebra::{Rotation3, Vector3};

    /// The derivative of several numbers at once.
    fn rates<const N: usize>(t: f64, of: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let h = 1e-4;
        let [two, one, minus_one, minus_two] = [2.0, 1.0, -1.0, -2.0].map(|i| of(t + i * h));
        std::array::from_fn(|i| {
            (8.0 * (one[i] - minus_one[i]) - (two[i] - minus_two[i])) / (12.0 * h)
        })
    }

    /// The axis turns about Ω, the gap is the height of the lowest point of both rims, or of the one rim, and its rates are
    /// those that differences give, in air and without.
    #[test]
    fn the_gap_and_its_rates_are_those_of_the_lowest_point() {
        for trial in 0..300 {
            let mut dice = Dice::new(851, trial);
            let body = Body::new(&Coin::cylinder(dice.scale(0.1, 5.0), 0.01).expect("a good coin"));
            let mut start = motion(&body, trial, false);
            for spin in [&mut start.ox, &mut start.oy, &mut start.oz] {
                *spin = dice.between(-3.0, 3.0);
            }
            let drag = Drag {
                linear: dice.between(-0.7, 0.7).max(0.0),
                angular: dice.between(-0.7, 0.7).max(0.0),
            };
            let orbit = Orbit::new(&start, drag);
            let t = dice.between(0.1, 1.0);
            let now = orbit.gap(&body, t);
            if now.sin < 0.1 || now.uz.abs() < 0.01 {
                continue;
            }
            let turned = if drag.angular > 0.0 {
                -libm::expm1(-drag.angular * t) / drag.angular
            } else {
                t
            };
            let about = Vector3::new(start.ox, start.oy, start.oz);
            let axis = Rotation3::new(about * turned) * Vector3::new(start.sin, 0.0, start.cos);
            let seen = Vector3::new(now.across[0], now.across[1], now.uz);
            assert!((axis - seen).norm() < 1e-12 && (now.sin - axis.xy().norm()).abs() < 1e-12);
            let (z, vz) = orbit.fall(t);
            assert_eq!((now.z, now.vz), (z, vz));
            let edge = body.radius * now.sin;
            assert!((now.height - (z - body.half * now.uz.abs() - edge)).abs() < 1e-14 * (1.0 + z));

            let end = if dice.chance() { 1.0 } else { -1.0 };
            let one = OneRim {
                radius: 0.8,
                half: 0.3,
                end,
            };
            let other = orbit.gap(&one, t);
            let low = z - end * 0.3 * now.uz - 0.8 * now.sin;
            assert!((other.height - low).abs() < 1e-14 * (1.0 + z));

            let numbers = |gap: &Gap<f64>| {
                let [x, y] = gap.across;
                [gap.height, gap.slope, gap.uz, gap.sin, x, y]
            };
            let given = |gap: &Gap<f64>| {
                let [x, y] = gap.across_rate;
                [gap.slope, gap.curvature, gap.uz_rate, gap.sin_rate, x, y]
            };
            for (found, expected) in [
                (given(&now), rates(t, |t| numbers(&orbit.gap(&body, t)))),
                (given(&other), rates(t, |t| numbers(&orbit.gap(&one, t)))),
            ] {
                for (found, expected) in found.into_iter().zip(expected) {
                    let size = 1.0 + about.norm().powi(2) / (now.sin * now.sin);
                    assert!((found - expected).abs() < 1e-8 * size, "{found} {expected}");
                }
            }
            let (first, at_start) = (orbit.first_gap(&body), orbit.gap(&body, 0.0));
            let off = (0..6).map(|i| (given(&first)[i] - given(&at_start)[i]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-14 * (1.0 + at_start.curvature.abs()));
        }
    }
}
