//! Free flight in closed form, and how far it is proven to be free of contact.
//!
//! # Closed form
//! A free symmetric top turns about its angular momentum: u turns about the fixed Ω = L/I_t with the
//! rate |Ω|, where Ω_a = ω_a I_a/I_t along u and Ω = ω across it. Without gyroscopic torque ω itself
//! is fixed, and the same holds with Ω_a = ω_a. With angular drag k the direction of Ω stays and the
//! phase is |Ω|t·p(kt); with linear drag the centre moves by vt·p(kt) and falls by t²·q(kt), where
//! p(x) = (1 − e^(−x))/x and q(x) = (x − 1 + e^(−x))/x².
//!
//! # No contact before
//! The gap is f = z − max over the rims of (±h u_z + R s), h = H/2 and s the horizontal part of u.
//! In the time τ from any moment the centre falls at most ½pτ² below its straight path, with
//! p = 1 + k·max(v_z, 0), and f stays above each of
//!
//! * z + v_z τ − ½pτ² − (the highest the centre can be while the coin touches, over all tilts that u
//!   reaches): for most of a high flight;
//! * f + (v_z − w)τ − ½pτ², with w the rate at which u moves, as the lowest point is at the distance
//!   D = 1 from the centre;
//! * for either rim, f_b + f_b' τ − ½(p + h·swing + R·spread/s)τ² with swing >= |u_z''| and
//!   spread >= ½|(s²)''|, as s <= √(s² + (s²)'τ + ½(s²)''τ²) and the root is concave: for a coin
//!   that leaves the surface.
//!
//! The flight advances to the latest of their first roots, again and again, and is proven to be free
//! of contact up to each. Bounds that are not sharp cost evaluations (some 30 ns each), but never
//! miss a contact.

use crate::motion::Motion;
use crate::scaled::Scaled;
use coinmc_core::Body;
use nalgebra::Vector3;

/// One flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flight<'a> {
    scaled: &'a Scaled,
    start: Motion,
    /// u(φ) = a + b cos φ + d sin φ.
    a: Vector3<f64>,
    b: Vector3<f64>,
    d: Vector3<f64>,
    /// |Ω|, and ω = Ω + `extra`·u.
    rate: f64,
    omega: Vector3<f64>,
    extra: f64,
    /// Bounds over the flight: of |u'|, of u_z'' and of ½(s²)''.
    wander: f64,
    swing: f64,
    spread: f64,
    /// Height of the centre above which there is no contact.
    clear: f64,
}

/// Where the proof of a free flight ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clear {
    /// Time from the start of the flight.
    pub(crate) time: f64,
    pub(crate) end: Bound,
}

/// What ends a proof.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bound {
    /// The gap is below the one that counts as touching.
    Touch,
    /// Progress is below the one that counts as none.
    Grain,
    /// The time asked for is reached.
    Horizon,
    /// The limit of evaluations is reached.
    Evaluations,
}

impl<'a> Flight<'a> {
    pub(crate) fn new(start: &Motion, scaled: &'a Scaled) -> Self {
        let axial = start.axial();
        let turning = scaled.axial_factor * axial;
        let omega = start.spin + start.axis * (turning - axial);
        let rate = omega.norm();
        let e = if rate > 0.0 {
            omega / rate
        } else {
            Vector3::zeros()
        };
        let a = e * e.dot(&start.axis);
        let (b, d) = (start.axis - a, e.cross(&start.axis));
        let amplitude = (b.z * b.z + d.z * d.z).sqrt();
        let swing = rate * (rate + scaled.angular_drag) * amplitude;
        Self {
            scaled,
            start: *start,
            a,
            b,
            d,
            rate,
            omega,
            extra: axial - turning,
            wander: rate * b.norm(),
            swing,
            spread: swing * (a.z.abs() + amplitude),
            clear: highest(scaled, a.z.abs(), amplitude),
        }
    }

    /// The coin after the time `t`.
    pub(crate) fn at(&self, t: f64) -> Motion {
        let scaled = self.scaled;
        let (p, q) = decay(scaled.linear_drag * t);
        let (turned, _) = decay(scaled.angular_drag * t);
        let linear = remains(scaled.linear_drag * t);
        let angular = remains(scaled.angular_drag * t);
        let (s, c) = libm::sincos(self.rate * t * turned);
        let axis = self.a + self.b * c + self.d * s;
        // of length 1 but for rounding, which must not build up over thousands of flights
        let axis = axis * (1.5 - 0.5 * axis.norm_squared());
        let down = Vector3::new(0.0, 0.0, 1.0);
        Motion {
            position: self.start.position + self.start.velocity * (t * p) - down * (t * t * q),
            velocity: self.start.velocity * linear - down * (t * p),
            axis,
            spin: (self.omega + axis * self.extra) * angular,
        }
    }

    /// The latest time, up to `horizon`, before which no contact is possible. Stops where progress
    /// falls below `grain` or the gap below `touch`.
    pub(crate) fn clear_until(&self, horizon: f64, grain: f64, touch: f64) -> Clear {
        const MOST_EVALUATIONS: u32 = 400;
        let mut time = 0.0;
        for _ in 0..MOST_EVALUATIONS {
            let now = self.at(time);
            let step = self.safe_time(&now);
            let end = if time > 0.0 && now.gap(self.scaled) <= touch {
                Bound::Touch
            } else if step < grain || step.is_nan() {
                Bound::Grain
            } else if time + step >= horizon {
                time = horizon;
                Bound::Horizon
            } else {
                time += step;
                continue;
            };
            return Clear { time, end };
        }
        Clear {
            time,
            end: Bound::Evaluations,
        }
    }

    /// A time from `now` on in which no contact is possible.
    fn safe_time(&self, now: &Motion) -> f64 {
        let Body { radius, half, .. } = self.scaled.body;
        let (z, vz, up) = (now.position.z, now.velocity.z, now.axis.z);
        let pull = 1.0 + self.scaled.linear_drag * vz.max(0.0);
        let sine = now.tilt_sine();
        let gap = z - (half * up.abs() + radius * sine);
        let high = first_root(z - self.clear, vz, pull);
        let coarse = first_root(gap, vz - self.wander, pull);
        if sine == 0.0 {
            return high.max(coarse);
        }
        let up_rate = now.spin.x * now.axis.y - now.spin.y * now.axis.x;
        let slope = vz + radius * up * up_rate / sine;
        let bend = pull + half * self.swing + radius * self.spread / sine;
        let rim = |b: f64| {
            first_root(
                z - (b * half * up + radius * sine),
                slope - b * half * up_rate,
                bend,
            )
        };
        high.max(coarse).max(rim(1.0).min(rim(-1.0)))
    }
}

/// The largest height of the centre at which the lowest point can touch while u_z stays within
/// `amplitude` of ±`middle`: it grows up to |u_z| = h, where it is 1, and falls beyond.
fn highest(scaled: &Scaled, middle: f64, amplitude: f64) -> f64 {
    let low = (middle - amplitude).max(0.0);
    let high = (middle + amplitude).min(1.0);
    // a little more than the rounding of either term
    scaled.rest_height(scaled.body.half.max(low).min(high)) * (1.0 + 1e-15)
}

/// The first root of gap + slope·t − ½ bend t² where it falls; 0 if it is below already.
fn first_root(gap: f64, slope: f64, bend: f64) -> f64 {
    let root = (slope * slope + 2.0 * gap.max(0.0) * bend).sqrt();
    if gap < 0.0 {
        0.0
    } else if slope >= 0.0 {
        (slope + root) / bend
    } else {
        2.0 * gap / (root - slope)
    }
}

/// p(x) and q(x) of the module's text.
fn decay(x: f64) -> (f64, f64) {
    if x == 0.0 {
        return (1.0, 0.5);
    }
    let lost = -libm::expm1(-x);
    let p = lost / x;
    // for small x, x − lost loses its digits
    let q = if x < 1e-2 {
        0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0))))
    } else {
        (x - lost) / (x * x)
    };
    (p, q)
}

/// e^(−x).
fn remains(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::exp(-x) }
}
