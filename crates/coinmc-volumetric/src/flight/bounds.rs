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
