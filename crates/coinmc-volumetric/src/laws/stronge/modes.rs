//! The modes of friction at one moment: the contact point slips or sticks, and each of the two
//! angular velocities runs or is held at 0.

use crate::impact::friction_moments::{BoxProblem, Limits, RimRates};

/// The angular velocity that contour or pivoting friction opposes: it has a sign, or is 0.
#[derive(Clone, Copy)]
pub(super) struct Rate {
    /// The rate is 0: friction keeps it at 0 if it can.
    pub(super) zero: bool,
    /// Its sign if not.
    pub(super) sign: f64,
    /// The limit of friction per unit normal impulse.
    pub(super) limit: f64,
}

impl Rate {
    pub(super) fn new(rate: f64, limit: f64) -> Self {
        Self {
            zero: rate == 0.0,
            sign: 1_f64.copysign(rate),
            limit,
        }
    }

    fn limits(&self) -> Limits<f64> {
        if self.zero {
            return Limits::within(self.limit);
        }
        let full = self.sign * self.limit;
        Limits {
            low: full,
            high: full,
        }
    }

    /// A rate of 0 remains 0 if `friction` is inside its limit, and otherwise takes its sign.
    fn hold_or_release(&mut self, friction: f64) {
        if self.zero {
            self.zero = friction.abs() < self.limit;
            if !self.zero {
                self.sign = 1_f64.copysign(friction);
            }
        }
    }

    /// Changes the mode: the rate has come to 0, or the friction that kept it at 0 has reached its
    /// limit.
    pub(super) fn switch(&mut self, friction: f64) {
        if self.zero {
            self.sign = 1_f64.copysign(friction);
        }
        self.zero = !self.zero;
    }
}

/// Contour or pivoting friction per unit normal impulse, as a function of f_y: t = by_y·f_y + rest.
#[derive(Clone, Copy)]
pub(super) struct Torque {
    pub(super) by_y: f64,
    pub(super) rest: f64,
}

impl Torque {
    pub(super) const NONE: Self = Self {
        by_y: 0.0,
        rest: 0.0,
    };
}

/// Both rates.
#[derive(Clone, Copy)]
pub(super) struct Rates {
    pub(super) roll: Rate,
    pub(super) pivot: Rate,
}

/// A contact point without slip: the friction that makes it stick, or with which it starts to slip.
pub(super) struct Still {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) sticks: bool,
}

/// The constants of an impact that the modes depend on.
#[derive(Clone, Copy)]
pub(super) struct Couplings {
    pub(super) rates: RimRates<f64>,
    pub(super) xx: f64,
    pub(super) xz: f64,
    pub(super) yy: f64,
    pub(super) rx: f64,
    pub(super) rz: f64,
    pub(super) mu: f64,
}

impl Rates {
    /// The friction against both rates for a given f_y; determines which rates are kept at 0.
    pub(super) fn beside(&mut self, k: &Couplings, y: f64) -> (Torque, Torque) {
        let t = &k.rates;
        let reduced = BoxProblem {
            roll: t.roll_y * y,
            pivot: t.pivot_y * y,
            roll_pivot: t.roll_pivot,
            roll_mass: 1.0 / t.roll_roll,
            pivot_mass: 1.0 / t.pivot_pivot,
            free: k.rx * y,
        };
        let (c, p) = reduced.least(self.roll.limits(), self.pivot.limits());
        self.roll.hold_or_release(c);
        self.pivot.hold_or_release(p);
        self.torques(k, c, p)
    }

    /// The torques as functions of f_y while the modes last.
    fn torques(&self, k: &Couplings, c: f64, p: f64) -> (Torque, Torque) {
        let t = &k.rates;
        let constant = |rest| Torque { by_y: 0.0, rest };
        match (self.roll.zero, self.pivot.zero) {
            // the coin turns neither about u nor about e_θ: the torques balance f_y
            (true, true) => {
                let proportional = |by_y| Torque { by_y, rest: 0.0 };
                (proportional(-k.rz), proportional(k.rx))
            }
            (true, false) => {
                let contour = Torque {
                    by_y: t.roll_y / t.roll_roll,
                    rest: -(t.roll_pivot * p) / t.roll_roll,
                };
                (contour, constant(p))
            }
            (false, true) => {
                let pivoting = Torque {
                    by_y: t.pivot_y / t.pivot_pivot,
                    rest: -(t.roll_pivot * c) / t.pivot_pivot,
                };
                (constant(c), pivoting)
            }
            (false, false) => (constant(c), constant(p)),
        }
    }

    /// f_y at a contact point without slip whose slip changes by −σ f.
    fn sideways(&self, k: &Couplings, sigma: f64) -> f64 {
        let t = &k.rates;
        let inverse = 1.0 / (sigma + k.yy);
        let (roll_y, pivot_y) = (t.roll_y * inverse, t.pivot_y * inverse);
        let reduced = BoxProblem {
            roll: 0.0,
            pivot: 0.0,
            roll_pivot: t.roll_pivot - roll_y * t.pivot_y,
            roll_mass: 1.0 / (t.roll_roll - roll_y * t.roll_y),
            pivot_mass: 1.0 / (t.pivot_pivot - pivot_y * t.pivot_y),
            free: 0.0,
        };
        let (c, p) = reduced.least(self.roll.limits(), self.pivot.limits());
        roll_y * c + pivot_y * p
    }

    /// The friction at a contact point without slip: σ = 0 if its f is inside the cone; otherwise
    /// σ > 0 with |f| = μ, and slip starts along −f.
    pub(super) fn still(&self, k: &Couplings, has_lengths: bool) -> Still {
        let sideways = |sigma| {
            if has_lengths {
                self.sideways(k, sigma)
            } else {
                0.0
            }
        };
        let excess = |sigma: f64| {
            let (x, y) = (k.xz / (sigma + k.xx), sideways(sigma));
            x * x + y * y - k.mu * k.mu
        };
        let sticks = excess(0.0) <= 0.0;
        // the root without friction lengths
        let plain = (k.xz.abs() / k.mu - k.xx).max(0.0);
        let sigma = match (sticks, has_lengths) {
            (true, _) => 0.0,
            (false, true) => bisect(plain, excess),
            (false, false) => plain,
        };
        Still {
            x: -(k.xz / (sigma + k.xx)),
            y: sideways(sigma),
            sticks,
        }
    }
}

/// The root of a decreasing function above `low`, where it is not negative.
fn bisect(mut low: f64, function: impl Fn(f64) -> f64) -> f64 {
    let is_below = |at| 0.0 < function(at);
    let mut high = low + 1.0;
    for _ in 0..200 {
        if !is_below(high) {
            break;
        }
        (low, high) = (high, high * 2.0);
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_rest() -> Rates {
        Rates {
            roll: Rate::new(0.0, 0.1),
            pivot: Rate::new(0.0, 0.1),
        }
    }

    /// Where friction within its cone can, it holds a point without slip; else it has the size μ, and opposes the slip
    /// that starts.
    #[test]
    fn a_point_without_slip_sticks_or_starts_against_friction() {
        let mu = 0.3;
        for (xz, sticks) in [(0.5, true), (-0.5, true), (2.0, false), (-2.0, false)] {
            let none = RimRates {
                roll: 0.0,
                pivot: 0.0,
                roll_y: 0.0,
                pivot_y: 0.0,
                roll_roll: 1.0,
                roll_pivot: 0.0,
                pivot_pivot: 1.0,
            };
            let couplings = Couplings {
                rates: none,
                xx: 2.5,
                xz,
                yy: 3.0,
                rx: 0.0,
                rz: 0.0,
                mu,
            };
            for has_lengths in [false, true] {
                let still = at_rest().still(&couplings, has_lengths);
                assert_eq!((still.sticks, still.y), (sticks, 0.0));
                let starts = couplings.xx * still.x + xz;
                if sticks {
                    assert!(starts.abs() < 1e-15, "{starts}");
                } else {
                    assert!((still.x.abs() - mu).abs() < 1e-12 && starts * still.x < 0.0);
                }
            }
        }
    }

    /// A rate of 0 is held by friction within its limit, and released in the direction of what exceeds it; a rate
    /// that runs has friction at its limit until it comes to 0.
    #[test]
    fn rates_are_held_within_the_limit() {
        let mut rate = Rate::new(0.0, 0.1);
        rate.hold_or_release(-0.05);
        assert!(rate.zero && (rate.limits().low, rate.limits().high) == (-0.1, 0.1));
        rate.hold_or_release(-0.2);
        assert!(!rate.zero && (rate.limits().low, rate.limits().high) == (-0.1, -0.1));
        rate.hold_or_release(0.2);
        assert_eq!(rate.sign, -1.0, "a rate that runs keeps its sign");
        rate.switch(0.3);
        assert!(rate.zero);
        rate.switch(0.3);
        assert!(!rate.zero && rate.sign == 1.0);
    }
}
