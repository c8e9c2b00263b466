//! The end of straight rolling on the side, in closed form.

use super::dynamics::Dynamics;

/// Drag is neglected if its share of the deceleration is below this.
const NEGLIGIBLE_DRAG: f64 = 1e-12;
/// Below this share the way is expanded in powers of it: the closed form cancels.
const SMALL_DRAG: f64 = 1e-5;

/// Straight rolling that contour friction and drag bring to rest.
///
/// v' = −a sgn v − bv with a = ρ_c R/(k_a + R²) and b = (kR² + k_a k_ω)/(k_a + R²), where k and k_ω
/// are the rates of drag. With x = b|v₀|/a, v = v₀ [1 + (1 + 1/x)(e^(−bt) − 1)].
pub(crate) struct RollingStop {
    a: f64,
    b: f64,
    /// |v₀|.
    speed: f64,
    /// Time until the coin rests.
    pub(crate) time: f64,
    dragged: bool,
}

impl RollingStop {
    /// Rolling that begins at this speed.
    pub(crate) fn new(dynamics: &Dynamics, speed: f64) -> Self {
        let Dynamics {
            body,
            friction,
            drag,
            ..
        } = dynamics;
        let radius = body.outer_radius();
        let r2 = radius * radius;
        let a = friction.contour * radius / (body.ka + r2);
        let b = (drag.linear * r2 + drag.angular * body.ka) / (body.ka + r2);
        Self::with(a, b, speed)
    }

    /// Rolling that slows down at a + bv.
    pub(crate) fn with(a: f64, b: f64, speed: f64) -> Self {
        let dragged = b * speed >= NEGLIGIBLE_DRAG * a;
        let time = if dragged {
            libm::log1p(b * speed / a) / b
        } else {
            speed / a
        };
        Self {
            a,
            b,
            speed,
            time,
            dragged,
        }
    }

    /// The same on a slope whose pull along the way changes the speed at the rate `gained`; `None` if
    /// contour friction cannot hold the coin there: it rolls for ever.
    pub(super) fn pulled(self, gained: f64) -> Option<Self> {
        let a = self.a - gained;
        let holds = gained.abs() <= self.a && a > 0.0;
        holds.then(|| Self::with(a, self.b, self.speed))
    }

    /// Whether contour friction stops the coin.
    pub(crate) fn stops(&self) -> bool {
        self.a != 0.0
    }

    /// Whether drag slows the coin down.
    pub(crate) fn slows(&self) -> bool {
        self.b > 0.0
    }

    /// The way until the coin rests.
    pub(crate) fn distance(&self) -> f64 {
        way_to_rest(self.a, self.b, self.speed)
    }

    /// The fraction of the velocities that is left at time `t`.
    pub(crate) fn left(&self, t: f64) -> f64 {
        let lost = if self.dragged {
            -(1.0 + self.a / (self.b * self.speed)) * libm::expm1(-self.b * t)
        } else {
            t / self.time
        };
        (1.0 - lost).max(0.0)
    }

    /// A number of equal pieces over which an observer's position can be found by Simpson's rule:
    /// exact without drag.
    pub(crate) fn pieces(&self) -> f64 {
        (10.0 * self.b * self.time).ceil().max(1.0)
    }
}

/// The way to rest of a speed v > 0 that falls at the rate a + bv: v²/2a, with drag
/// v/b − (a/b²) ln(1 + bv/a); infinite if nothing stops it.
pub(crate) fn way_to_rest(a: f64, b: f64, speed: f64) -> f64 {
    if a == 0.0 {
        return speed / b;
    }
    let x = b * speed / a;
    if x < SMALL_DRAG {
        // the next term of the series is x²/2 of this
        speed * speed / (2.0 * a) * (1.0 - x * (2.0 / 3.0))
    } else {
        speed / b - a / (b * b) * libm::log1p(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rolling(a: f64, b: f64) -> RollingStop {
        RollingStop::with(a, b, 1.0)
    }

    #[test]
    fn friction_holds_a_coin_on_a_gentle_slope_only() {
        let stop = |gained: f64| rolling(0.5, 0.0).pulled(gained).map(|stop| stop.distance());
        assert_eq!(stop(0.25), Some(2.0));
        assert_eq!(stop(-0.5), Some(0.5));
        for steep in [0.5, 0.6, -0.6] {
            assert_eq!(stop(steep), None, "{steep}");
        }
    }

    /// In a unit of length of any size it takes the same time, and goes as far.
    #[test]
    fn a_stop_does_not_depend_on_the_unit_of_length() {
        for b in [0.0, 1e-9, 1e-3, 1.0] {
            let stop = RollingStop::with(0.5, b, 0.7);
            for unit in [1e-9, 1e-4, 1e4, 1e9] {
                let other = RollingStop::with(0.5 * unit, b, 0.7 * unit);
                for (found, expected) in [
                    (other.time, stop.time),
                    (other.distance() / unit, stop.distance()),
                    (other.left(0.5 * other.time), stop.left(0.5 * stop.time)),
                ] {
                    assert!((found / expected - 1.0).abs() < 1e-11, "{b} {unit}");
                }
            }
        }
    }

    /// The way is the integral of the speed, here by Simpson's rule.
    #[test]
    fn the_way_is_the_integral_of_the_speed() {
        for b in [0.0, 1e-9, 1e-7, 1e-5, 1e-3, 1.0, 100.0] {
            let rolling = rolling(0.5, b);
            let pieces = 20_000;
            let sum: f64 = (0..=pieces)
                .map(|i| {
                    let weight = match i {
                        _ if i == 0 || i == pieces => 1.0,
                        _ if i % 2 == 1 => 4.0,
                        _ => 2.0,
                    };
                    weight * rolling.left(rolling.time * f64::from(i) / f64::from(pieces))
                })
                .sum();
            let expected = sum * rolling.time / f64::from(3 * pieces);
            let off = (rolling.distance() / expected - 1.0).abs();
            // x − ln(1 + x) cancels down to x²/2 at the least x that is not expanded
            assert!(off < 1e-10, "{b}: {off:e}");
        }
        assert_eq!(rolling(0.0, 0.25).distance(), 4.0);
        assert_eq!(rolling(0.0, 0.0).distance(), f64::INFINITY);
    }
}
