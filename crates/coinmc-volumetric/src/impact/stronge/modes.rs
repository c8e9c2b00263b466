//! What friction does at one moment: sliding or sticking, turning against its limit or held.

use super::super::twist::{Limits, Reduced, Twist};
use coinmc_lanes::{Lane, Mask};

/// Contour or pivoting friction: its rate runs with a sign, or is 0.
#[derive(Clone, Copy)]
pub(super) struct Rate<L: Lane> {
    /// The rate is 0: friction holds it if it can.
    pub(super) zero: L::Mask,
    /// Its sign if not.
    pub(super) sign: L,
    /// The limit of friction per unit normal impulse.
    pub(super) limit: L,
}

impl<L: Lane> Rate<L> {
    #[inline(always)]
    pub(super) fn new(rate: L, limit: L) -> Self {
        Self {
            zero: rate.abs().le(L::splat(0.0)),
            sign: L::splat(1.0).copysign(rate),
            limit,
        }
    }

    #[inline(always)]
    fn limits(&self) -> Limits<L> {
        let full = self.sign * self.limit;
        Limits {
            low: L::select(self.zero, -self.limit, full),
            high: L::select(self.zero, self.limit, full),
        }
    }

    /// The rate stays 0 where `friction` is inside its limit, else it leaves with that sign.
    #[inline(always)]
    fn settle(&mut self, friction: L, on: L::Mask) {
        let held = self.zero & friction.abs().lt(self.limit);
        let leaves = on & self.zero & !held;
        self.sign = L::select(leaves, L::splat(1.0).copysign(friction), self.sign);
        self.zero = (self.zero & !on) | (held & on);
    }

    /// Reached 0 where it ran, or the limit where it was held.
    #[inline(always)]
    pub(super) fn switch(&mut self, on: L::Mask, friction: L) {
        let breaks = on & self.zero;
        self.sign = L::select(breaks, L::splat(1.0).copysign(friction), self.sign);
        self.zero = (self.zero & !on) | (!self.zero & on);
    }
}

/// Contour and pivoting friction per unit normal impulse, as far as they follow f_y:
/// t = by_y·f_y + rest.
#[derive(Clone, Copy)]
pub(super) struct Torque<L> {
    pub(super) by_y: L,
    pub(super) rest: L,
}

/// Both rates.
#[derive(Clone, Copy)]
pub(super) struct Rates<L: Lane> {
    pub(super) roll: Rate<L>,
    pub(super) pivot: Rate<L>,
}

/// The contact point at rest: the friction that keeps it so, or that with which it starts to slip.
pub(super) struct Still<L: Lane> {
    pub(super) x: L,
    pub(super) y: L,
    pub(super) sticks: L::Mask,
}

/// Constants of the impact that the modes need.
#[derive(Clone, Copy)]
pub(super) struct Couplings<L> {
    pub(super) twist: Twist<L>,
    pub(super) xx: L,
    pub(super) xz: L,
    pub(super) yy: L,
    pub(super) rx: L,
    pub(super) rz: L,
    pub(super) mu: L,
}

impl<L: Lane> Rates<L> {
    /// The friction of both rates beside a given f_y; decides which rates are held.
    #[inline(always)]
    pub(super) fn beside(&mut self, k: &Couplings<L>, y: L, on: L::Mask) -> (Torque<L>, Torque<L>) {
        let t = &k.twist;
        let reduced = Reduced {
            roll: t.roll_y * y,
            pivot: t.pivot_y * y,
            roll_pivot: t.roll_pivot,
            roll_mass: L::splat(1.0) / t.roll_roll,
            pivot_mass: L::splat(1.0) / t.pivot_pivot,
            free: k.rx * y,
        };
        let (c, p) = reduced.least(self.roll.limits(), self.pivot.limits());
        self.roll.settle(c, on);
        self.pivot.settle(p, on);
        self.torques(k, c, p)
    }

    /// How the torques follow f_y while the modes last.
    #[inline(always)]
    fn torques(&self, k: &Couplings<L>, c: L, p: L) -> (Torque<L>, Torque<L>) {
        let (t, zero) = (&k.twist, L::splat(0.0));
        let (roll, pivot) = (self.roll.zero, self.pivot.zero);
        let both = roll & pivot;
        // both held, the coin does not turn about u nor e_θ: the torques are those of f_y
        let contour = Torque {
            by_y: L::select(both, -k.rz, L::select(roll, t.roll_y / t.roll_roll, zero)),
            rest: L::select(
                both,
                zero,
                L::select(roll, -(t.roll_pivot * p) / t.roll_roll, c),
            ),
        };
        let pivoting = Torque {
            by_y: L::select(
                both,
                k.rx,
                L::select(pivot, t.pivot_y / t.pivot_pivot, zero),
            ),
            rest: L::select(
                both,
                zero,
                L::select(pivot, -(t.roll_pivot * c) / t.pivot_pivot, p),
            ),
        };
        (contour, pivoting)
    }

    /// f_y of a contact point at rest whose slip would change by −σ f.
    #[inline(always)]
    fn sideways(&self, k: &Couplings<L>, sigma: L) -> L {
        let t = &k.twist;
        let one = L::splat(1.0);
        let inverse = one / (sigma + k.yy);
        let (roll_y, pivot_y) = (t.roll_y * inverse, t.pivot_y * inverse);
        let zero = L::splat(0.0);
        let reduced = Reduced {
            roll: zero,
            pivot: zero,
            roll_pivot: t.roll_pivot - roll_y * t.pivot_y,
            roll_mass: one / (t.roll_roll - roll_y * t.roll_y),
            pivot_mass: one / (t.pivot_pivot - pivot_y * t.pivot_y),
            free: zero,
        };
        let (c, p) = reduced.least(self.roll.limits(), self.pivot.limits());
        roll_y * c + pivot_y * p
    }

    /// The friction of a contact point at rest: σ = 0 if that is inside the cone, else σ > 0 with
    /// |f| = μ, and slip starts along −f.
    #[inline(always)]
    pub(super) fn still(&self, k: &Couplings<L>, on: L::Mask, twists: bool) -> Still<L> {
        let zero = L::splat(0.0);
        let excess = |sigma: L| {
            let x = k.xz / (sigma + k.xx);
            let y = if twists {
                self.sideways(k, sigma)
            } else {
                zero
            };
            x * x + y * y - k.mu * k.mu
        };
        let sticks = excess(zero).le(zero);
        let slips = on & !sticks;
        let mut sigma = zero;
        if slips.any() {
            // the root without friction lengths
            let plain = (k.xz.abs() / k.mu - k.xx).max(zero);
            sigma = if twists {
                bisect(plain, slips, excess)
            } else {
                plain
            };
            sigma = L::select(slips, sigma, zero);
        }
        let y = if twists {
            self.sideways(k, sigma)
        } else {
            zero
        };
        Still {
            x: -(k.xz / (sigma + k.xx)),
            y,
            sticks,
        }
    }
}

/// The root of a falling function above `low`, where it is not negative.
#[inline(always)]
fn bisect<L: Lane>(mut low: L, on: L::Mask, function: impl Fn(L) -> L) -> L {
    let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
    let mut high = low + one;
    let mut open = on & zero.lt(function(high));
    for _ in 0..200 {
        if !open.any() {
            break;
        }
        low = L::select(open, high, low);
        high = L::select(open, high * two, high);
        open = open & zero.lt(function(high));
    }
    for _ in 0..60 {
        let middle = (low + high) / two;
        let above = zero.lt(function(middle));
        low = L::select(above, middle, low);
        high = L::select(above, high, middle);
    }
    high
}
