//! The section of the coin, a rectangle 2R × H, in units of D.

use coinmc_core::{Coin, Face};
use coinmc_lanes::Lane;
use std::f64::consts::FRAC_PI_2;

/// A quarter turn: 0 starts with heads up, 1 with heads to the right, 2 with tails up, 3 with heads
/// to the left.
pub(crate) type Quadrant = u8;

/// The coin's section in units in which D = sqrt(R² + H²/4) = 1.
///
/// In quadrant q (θ from q·90° to (q+1)·90°, u = (sin θ, cos θ)) one corner is lowest. δ is the
/// angle of the centre beyond the balance over that corner, so the centre is cos δ above it. The
/// quadrant spans δ from −`span[q mod 2]` to +`span[1 − q mod 2]`, from one edge flat on the
/// ground to the next. The pair (q, δ) alone describes the orientation: heads and tails differ only
/// in q, so the results for them are bit-identical.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    /// I_t/(m D²).
    pub(crate) k: f64,
    /// Angle from the balance to flat on a face (even) and on the side (odd).
    span: [f64; 2],
    /// Height of the centre when flat: H/2D on a face, R/D on the side.
    flat_height: [f64; 2],
}

impl Shape {
    pub(crate) fn new(coin: &Coin) -> Self {
        let half = coin.ratio() / 2.0;
        let hypotenuse = (1.0 + half * half).sqrt();
        let d = coin.rim_distance_m();
        Self {
            k: coin.transverse_gyration_m2() / (d * d),
            span: [libm::atan2(1.0, half), libm::atan2(half, 1.0)],
            flat_height: [half / hypotenuse, 1.0 / hypotenuse],
        }
    }

    /// The quadrant's last δ for a coin that turns in the direction of `omega`.
    #[inline]
    pub(crate) fn last_angle(&self, quadrant: Quadrant, omega: f64) -> f64 {
        if omega > 0.0 {
            self.span[end(quadrant)]
        } else {
            -self.span[start(quadrant)]
        }
    }

    /// Angle from the quadrant's start to its balance: −δ at the start.
    #[inline]
    pub(crate) fn first_span(&self, quadrant: Quadrant) -> f64 {
        self.span[start(quadrant)]
    }

    /// Angle from the start of a quadrant to its balance: [`first_span`](Self::first_span) over
    /// lanes, with the quadrant as a floating-point number.
    #[inline(always)]
    pub(crate) fn first_span_lanes<L: Lane>(&self, quadrant: L) -> L {
        L::select(
            is_odd(quadrant),
            L::splat(self.span[1]),
            L::splat(self.span[0]),
        )
    }

    /// The quadrant's last δ and the height of the centre there, for a coin that turns in the
    /// direction of `omega`: [`last_angle`](Self::last_angle) over lanes.
    #[inline(always)]
    pub(crate) fn quadrant_end<L: Lane>(&self, quadrant: L, omega: L) -> (L, L) {
        let (odd, forwards) = (is_odd(quadrant), L::splat(0.0).lt(omega));
        // flat on a face at the start of even quadrants and at the end of odd ones
        let on_face = (odd & forwards) | !(odd | forwards);
        let pick = |[face, side]: [f64; 2]| L::select(on_face, L::splat(face), L::splat(side));
        let span = pick(self.span);
        (L::select(forwards, span, -span), pick(self.flat_height))
    }

    /// The quadrant and δ of an angle from flat at the start of `quadrant`.
    #[inline(always)]
    pub(crate) fn enter<L: Lane>(&self, quadrant: L, angle: L) -> (L, L) {
        let (zero, four, quarter) = (L::splat(0.0), L::splat(4.0), L::splat(FRAC_PI_2));
        let turned = (angle / quarter).floor();
        // an angle too large for its digits to tell the quadrant still gives one of the four
        let on = quadrant + (turned - (turned * L::splat(0.25)).floor() * four);
        let entered = L::select(four.le(on), on - four, on);
        let within = angle - turned * quarter;
        // NaN stays NaN
        let within = L::select(within.lt(zero), zero, within);
        let within = L::select(quarter.lt(within), quarter, within);
        (entered, within - self.first_span_lanes(entered))
    }

    /// Angle to the nearer flat position, and whether that is the quadrant's end.
    #[inline]
    pub(crate) fn gap(&self, quadrant: Quadrant, delta: f64) -> (f64, bool) {
        let to_start = delta + self.span[start(quadrant)];
        let to_end = self.span[end(quadrant)] - delta;
        if to_end < to_start {
            (to_end, true)
        } else {
            (to_start, false)
        }
    }

    /// (height of the centre, half width of the base) when flat at the start or end.
    pub(crate) fn base(&self, quadrant: Quadrant, at_end: bool) -> (f64, f64) {
        let edge = if at_end {
            end(quadrant)
        } else {
            start(quadrant)
        };
        (self.flat_height[edge], self.flat_height[1 - edge])
    }

    /// The direction (+1: growing θ) in which a coin in this quadrant turns to lie on a face, and
    /// the angle until it does.
    pub(crate) fn face_tilt(&self, quadrant: Quadrant, delta: f64) -> (f64, f64) {
        if quadrant & 1 == 0 {
            (-1.0, delta + self.span[0])
        } else {
            (1.0, self.span[0] - delta)
        }
    }

    /// The face on which the coin comes to rest in the well it is in: it falls to the edge on δ's
    /// side of the balance.
    #[inline]
    pub(crate) fn face(quadrant: Quadrant, delta: f64) -> Face {
        // the flat positions in order of θ/90°: heads up, side, tails up, side
        let flat = if delta < 0.0 {
            quadrant
        } else {
            next(quadrant, true)
        };
        match flat {
            0 => Face::Heads,
            2 => Face::Tails,
            _ => Face::Side,
        }
    }
}

/// The quadrant with this number.
#[inline]
pub(crate) fn as_quadrant(number: f64) -> Quadrant {
    // NaN becomes quadrant 0
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let quadrant = number as Quadrant;
    quadrant & 3
}

/// Whether a quadrant's number is odd.
#[inline(always)]
fn is_odd<L: Lane>(quadrant: L) -> L::Mask {
    let from_two = (quadrant - L::splat(2.0)).abs();
    L::splat(0.5).lt(from_two) & from_two.lt(L::splat(1.5))
}

fn start(quadrant: Quadrant) -> usize {
    usize::from(quadrant & 1)
}

fn end(quadrant: Quadrant) -> usize {
    1 - start(quadrant)
}

/// The next quadrant in the direction of growing θ (`forwards`) or of falling θ.
#[inline]
pub(crate) fn next(quadrant: Quadrant, forwards: bool) -> Quadrant {
    (if forwards { quadrant + 1 } else { quadrant + 3 }) & 3
}
