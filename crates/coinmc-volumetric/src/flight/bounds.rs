//! Upper bounds of the motion along a flight: what makes the search for the first contact safe.

use super::orbit::Orbit;
use super::profile::Profile;
use coinmc_lanes::Lane;

/// Fraction of its distance from the vertical that u may travel while [`Bounds::jerk`] holds.
const REACH: f64 = 0.25;

/// Bounds of a whole flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent<L> {
    /// Amplitude of uz.
    amplitude: L,
    /// No contact is possible while the centre is above this height.
    pub(crate) clear: L,
    /// [`REACH`] divided by the greatest speed of u.
    reach: L,
}

impl<T: Copy> Extent<T> {
    /// Numbers of an extent.
    pub(crate) const COLUMNS: usize = 3;

    /// The extent as an array, for memory.
    #[inline(always)]
    pub(crate) fn columns(&self) -> [T; 3] {
        [self.amplitude, self.clear, self.reach]
    }

    /// The extent of [`columns`](Self::columns).
    #[inline(always)]
    pub(crate) fn from_columns(&[amplitude, clear, reach]: &[T; 3]) -> Self {
        Self {
            amplitude,
            clear,
            reach,
        }
    }
}

/// Upper bounds that hold from t = 0 to the end of the flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds<L> {
    /// Of the rate w at which u turns.
    rate: L,
    /// Of |uz''|.
    pub(crate) swing: L,
    /// Of ½(sin²)''.
    pub(crate) spread: L,
    /// Of the speed of the horizontal part of u.
    pub(crate) wander: L,
    /// Of the acceleration of the horizontal part of u.
    pub(crate) bend: L,
    /// Of the upward acceleration of any point of the coin relative to the centre.
    pub(crate) climb: L,
    /// Of the height of the centre at any contact.
    pub(crate) clear: L,
    /// As in [`Extent`].
    reach: L,
}

impl<L: Lane> Bounds<L> {
    /// An upper bound of |f'''| of a rim without drag, and the time for which it holds: while the
    /// distance of u from the vertical is at least 1 − [`REACH`] of `sin`, its value now. Derived
    /// in `search`, under *Lower bounds of f*.
    #[inline(always)]
    pub(crate) fn jerk(&self, body: &impl Profile, sin: L, inverse_sin: L) -> (L, L) {
        const CROSS: f64 = 3.0 / (1.0 - REACH);
        // 3·2/√27 over (1 − REACH)², a rounding up
        const CUBE: f64 = 1.154_701 / ((1.0 - REACH) * (1.0 - REACH));
        let turns = self.wander * inverse_sin;
        let bends =
            self.rate * self.rate + turns * (L::splat(CROSS) * self.rate + L::splat(CUBE) * turns);
        let jerk = L::splat(body.half()) * self.rate * self.swing
            + L::splat(body.radius()) * self.wander * bends;
        (jerk, self.reach * sin)
    }
}

impl<L: Lane> Orbit<L> {
    /// Bounds of the whole flight.
    #[inline(always)]
    pub(crate) fn extent(&self, body: &impl Profile) -> Extent<L> {
        let amplitude =
            (self.state.b[2] * self.state.b[2] + self.state.d[2] * self.state.d[2]).sqrt();
        Extent {
            amplitude,
            clear: highest(body, self.state.a[2].abs(), amplitude),
            reach: L::splat(REACH) / self.state.across,
        }
    }

    /// Bounds of the flight from t = 0 on.
    #[inline(always)]
    pub(crate) fn bounds(&self, extent: &Extent<L>) -> Bounds<L> {
        let amplitude = extent.amplitude;
        let faster = self.state.rate + L::splat(self.drag.angular);
        let swing = self.state.rate * faster * amplitude;
        Bounds {
            rate: self.state.rate,
            swing,
            spread: swing * (self.state.a[2].abs() + amplitude),
            wander: self.state.across,
            bend: faster * self.state.across,
            climb: self.state.horizontal * faster,
            clear: extent.clear,
            reach: extent.reach,
        }
    }
}

/// The largest height h(uz) of the centre at which the lowest point can touch, while uz stays
/// within `amplitude` of ±`middle`. h increases up to |uz| = half, where it is 1, and decreases
/// beyond.
#[inline(always)]
fn highest<L: Lane, P: Profile>(body: &P, middle: L, amplitude: L) -> L {
    let (one, half) = (L::splat(1.0), L::splat(body.half()));
    if P::ALONE {
        // of whichever face is up: never too low
        let distance = body.half() * body.half() + body.radius() * body.radius();
        return L::splat(distance.sqrt() * (1.0 + 1e-15));
    }
    let low = (middle - amplitude).max(L::splat(0.0));
    let high = (middle + amplitude).min(one);
    let nearest = half.max(low).min(high);
    let sin = ((one - nearest) * (one + nearest))
        .max(L::splat(0.0))
        .sqrt();
    // a margin for one rounding of each term: the bound must not be too low
    (half * nearest + L::splat(body.radius()) * sin) * L::splat(1.0 + 1e-15)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::drag::Drag;
    use crate::flight::tests::motion;
    use crate::flight::{Gap, OneRim};
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;
    use std::f64::consts::TAU;

    /// The largest height of the centre at which a rim touches, of all that the axis may have: never lower than any, and
    /// no higher than need be.
    #[test]
    fn no_contact_is_higher_than_the_highest() {
        for trial in 0..200 {
            let mut dice = Dice::new(852, trial);
            let body = Body::new(&Coin::cylinder(dice.scale(0.1, 5.0), 0.01).expect("a good coin"));
            let (middle, amplitude) = (dice.between(0.0, 1.0), dice.between(0.0, 1.0));
            let (low, high) = ((middle - amplitude).max(0.0), (middle + amplitude).min(1.0));
            let touches = |uz: f64| body.half * uz + body.radius * (1.0 - uz * uz).sqrt();
            let mut most: f64 = 0.0;
            for i in 0..=4_000 {
                most = most.max(touches(low + (high - low) * f64::from(i) / 4_000.0));
            }
            if low <= body.half && body.half <= high {
                most = most.max(touches(body.half));
            }
            let found = highest(&body, middle, amplitude);
            assert!(found >= most && found - most < 1e-14, "{found} {most}");

            let one = OneRim {
                radius: dice.between(0.2, 1.0),
                half: dice.between(0.2, 1.0),
                end: -1.0,
            };
            let highest = highest(&one, middle, amplitude);
            let far = libm::hypot(one.radius, one.half);
            assert!((highest - far).abs() < 4e-15 && highest >= far * (1.0 + 5e-16));
        }
    }

    /// What bounds a whole flight bounds all of it: the axis, its speeds and accelerations, and the acceleration of every
    /// point of the coin. Without drag those that one turn attains are attained.
    #[test]
    fn the_bounds_of_a_flight_hold_throughout() {
        for trial in 0..200 {
            let mut dice = Dice::new(853, trial);
            let body = Body::new(&Coin::cylinder(dice.scale(0.1, 5.0), 0.01).expect("a good coin"));
            let mut start = motion(&body, trial, false);
            for spin in [&mut start.ox, &mut start.oy, &mut start.oz] {
                *spin = dice.between(-4.0, 4.0);
            }
            let angular = dice.between(-0.7, 0.7).max(0.0);
            let drag = Drag {
                linear: 0.0,
                angular,
            };
            let orbit = Orbit::new(&start, drag);
            let bounds = orbit.bounds(&orbit.extent(&body));
            let rate = libm::hypot(libm::hypot(start.ox, start.oy), start.oz);
            let h = 1e-4 / rate;
            // uz'', half the second rate of sin², the speed and the acceleration of the horizontal part of u
            let mut most = [0.0; 4];
            for i in 1..=400 {
                let t = f64::from(i) / 400.0 * TAU / rate;
                let [before, now, after] = [t - h, t, t + h].map(|t| orbit.gap(&body, t));
                let bends = |of: fn(&Gap<f64>) -> f64| (of(&after) - of(&before)) / (2.0 * h);
                let found = [
                    bends(|gap| gap.uz_rate).abs(),
                    bends(|gap| gap.sin * gap.sin_rate),
                    libm::hypot(now.across_rate[0], now.across_rate[1]),
                    libm::hypot(
                        bends(|gap| gap.across_rate[0]),
                        bends(|gap| gap.across_rate[1]),
                    ),
                ];
                for (most, found) in most.iter_mut().zip(found) {
                    *most = f64::max(*most, found);
                }
            }
            let limits = [bounds.swing, bounds.spread, bounds.wander, bounds.bend];
            for (most, limit) in most.into_iter().zip(limits) {
                assert!(most <= limit * (1.0 + 1e-6) + 1e-9, "{most} {limit}");
            }
            // of a point at the distance 1 in the worst direction
            let about = Vector3::new(start.ox, start.oy, start.oz);
            let lifts =
                about.cross(&about.cross(&Vector3::z())) - Vector3::z().cross(&about) * angular;
            assert!(lifts.norm() <= bounds.climb * (1.0 + 1e-12));
            if angular == 0.0 {
                let attained = most.into_iter().zip(limits);
                assert!(
                    attained.clone().all(|(most, limit)| most > 0.999 * limit),
                    "{attained:?}"
                );
                assert!((lifts.norm() / bounds.climb - 1.0).abs() < 1e-12);
            }
        }
    }

    /// The bound of the third rate of a rim's gap is the sum of what its terms are at most, found by trying all ways in
    /// which the axis may move at its greatest speed.
    #[test]
    fn the_jerk_is_the_sum_of_what_its_terms_are_at_most() {
        let (rate, swing, wander, sin) = (2.3, 1.7, 1.9, 0.35);
        let bounds = Bounds {
            rate,
            swing,
            spread: 0.0,
            wander,
            bend: 0.0,
            climb: 0.0,
            clear: 0.0,
            reach: REACH / wander,
        };
        let body = OneRim {
            radius: 0.8,
            half: 0.45,
            end: 1.0,
        };
        // u comes this close to the vertical at most
        let nearest = 0.75 * sin;
        let mut cubes: f64 = 0.0;
        for i in 0..10_000 {
            let (across, along) = libm::sincos(f64::from(i) * 1e-4 * TAU);
            cubes = cubes.max(3.0 * (wander * across).powi(2) * wander * along);
        }
        let turns = rate * rate * wander + 3.0 * wander * (rate * wander) / nearest;
        let most = 0.45 * rate * swing + 0.8 * (turns + cubes / (nearest * nearest));
        let (jerk, until) = bounds.jerk(&body, sin, 1.0 / sin);
        assert!((jerk / most - 1.0).abs() < 1e-5, "{jerk} {most}");
        assert!((until * wander - (sin - nearest)).abs() < 1e-15);
    }
}
