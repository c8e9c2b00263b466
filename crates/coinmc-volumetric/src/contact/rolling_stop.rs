//! The end of straight rolling on the side, in closed form.

use super::dynamics::Dynamics;
use super::line::LineState;

/// Drag is neglected if its share of the deceleration is below this.
const NEGLIGIBLE_DRAG: f64 = 1e-12;

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
    pub(super) time: f64,
    dragged: bool,
}

impl RollingStop {
    pub(crate) fn new(dynamics: &Dynamics, state: &LineState) -> Self {
        let Dynamics {
            body,
            friction,
            drag,
            ..
        } = dynamics;
        let r2 = body.radius * body.radius;
        let a = friction.contour * body.radius / (body.ka + r2);
        let b = (drag.linear * r2 + drag.angular * body.ka) / (body.ka + r2);
        let speed = state[1].abs();
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

    /// Whether contour friction stops the coin.
    pub(crate) fn stops(&self) -> bool {
        self.a != 0.0
    }

    /// Whether drag slows the coin down.
    pub(super) fn slows(&self) -> bool {
        self.b > 0.0
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
    pub(super) fn pieces(&self) -> f64 {
        (10.0 * self.b * self.time).ceil().max(1.0)
    }
}
