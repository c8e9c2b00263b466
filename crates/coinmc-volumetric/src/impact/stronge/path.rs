//! A piece of the path: the impulses as functions of a parameter.

use coinmc_lanes::{Lane, Mask};

/// Order of the Taylor series.
pub(super) const ORDER: usize = 18;

/// Truncation error of a piece, relative to the slip it starts from.
const TRUNCATION: f64 = 1e-11;

type Series<L> = [L; ORDER + 1];

/// The drive of the slip: slip' = (K_xx f_x + b_x, K_yy f_y + b_y) with f = −μ slip/|slip|.
pub(super) struct Drive<L> {
    pub(super) mu: L,
    pub(super) xx: L,
    pub(super) yy: L,
    pub(super) bx: L,
    pub(super) by: L,
}

/// How u_z follows the impulses: its value, and by z and by x.
pub(super) struct Normal<L> {
    pub(super) now: L,
    pub(super) zz: L,
    pub(super) xz: L,
}

/// What a piece adds.
#[derive(Clone, Copy)]
pub(super) struct Step<L> {
    pub(super) x: L,
    pub(super) y: L,
    pub(super) z: L,
    /// Of ∫u_z dτ.
    pub(super) work: L,
}

/// A piece of the path over a parameter from 0 to `end`.
pub(super) struct Path<L: Lane> {
    pub(super) end: L,
    turning: L::Mask,
    curve: Curve<L>,
    line: Line<L>,
}

/// A piece with a constant f; the parameter is τ.
pub(super) struct Line<L> {
    pub(super) x: L,
    pub(super) y: L,
    /// u_z, and half its derivative.
    pub(super) normal: L,
    pub(super) half_gain: L,
}

/// Series in ξ, where dτ = |slip| ds and s = ξ·scale. By s the slip obeys
/// slip' = −μ diag(K_xx, K_yy) slip + b|slip|, smooth even where slip nearly vanishes.
struct Curve<L> {
    x: Series<L>,
    y: Series<L>,
    z: Series<L>,
    work: Series<L>,
}

#[inline(always)]
fn horner<L: Lane>(series: &Series<L>, at: L) -> L {
    let mut sum = series[ORDER];
    for k in (1..ORDER).rev() {
        sum = sum * at + series[k];
    }
    sum * at
}

impl<L: Lane> Curve<L> {
    fn none() -> Self {
        let zero = [L::splat(0.0); ORDER + 1];
        Self {
            x: zero,
            y: zero,
            z: zero,
            work: zero,
        }
    }

    /// The series from slip (gx, gy) on and the largest ξ at which it is accurate; where `length`
    /// is a number, τ goes little beyond it.
    fn new(drive: &Drive<L>, normal: &Normal<L>, gx: L, gy: L, length: L) -> (Self, L) {
        let zero = L::splat(0.0);
        let mut out = Self::none();
        let mut x = [zero; ORDER + 1];
        let (mut y, mut r, mut u) = (x, x, x);
        (x[0], y[0], u[0]) = (gx, gy, normal.now);
        let square = gx * gx + gy * gy;
        r[0] = square.sqrt();
        let over = L::splat(1.0) / r[0];
        let (ax, ay) = (drive.mu * drive.xx, drive.mu * drive.yy);
        // |slip'| <= speed·|slip|: the series converge up to about that time
        let speed = ax.max(ay) + (drive.bx * drive.bx + drive.by * drive.by).sqrt();
        let scale = L::splat(2.0) / speed;
        let needed = length * over;
        let scale = L::select(zero.lt(needed), needed.min(scale), scale);
        for k in 0..ORDER {
            let step = scale * L::splat(1.0 / (k + 1) as f64);
            out.x[k + 1] = -(drive.mu * x[k]) * step;
            out.y[k + 1] = -(drive.mu * y[k]) * step;
            out.z[k + 1] = r[k] * step;
            x[k + 1] = (drive.bx * r[k] - ax * x[k]) * step;
            y[k + 1] = (drive.by * r[k] - ay * y[k]) * step;
            u[k + 1] = normal.zz * out.z[k + 1] + normal.xz * out.x[k + 1];
            let mut power = zero;
            for i in 0..=k {
                power += u[i] * r[k - i];
            }
            out.work[k + 1] = power * step;
            // r² = x² + y², term k + 1
            let mut sum = L::splat(2.0) * (x[0] * x[k + 1] + y[0] * y[k + 1]);
            for i in 1..=k {
                let j = k + 1 - i;
                sum += x[i] * x[j] + y[i] * y[j] - r[i] * r[j];
            }
            r[k + 1] = sum * over * L::splat(0.5);
        }
        let work = L::splat(1.0) / (normal.now.abs() + r[0]);
        let term = |k: usize| x[k].abs() + y[k].abs() + r[k].abs() + out.work[k].abs() * work;
        let last = term(ORDER).max(term(ORDER - 1));
        let end = reach(last, L::splat(TRUNCATION) * r[0]);
        (out, end)
    }
}

/// The largest of 1, .8, .64, … at which a last term of size `term` at 1 is below `allowed`.
#[inline(always)]
fn reach<L: Lane>(mut term: L, allowed: L) -> L {
    const SHRINK: f64 = 0.8;
    // SHRINK^(ORDER − 1)
    const LESS: f64 = 0.022_517_998_136_852_48;
    let mut at = L::splat(1.0);
    for _ in 0..40 {
        let long = allowed.lt(term);
        if !long.any() {
            break;
        }
        at = L::select(long, at * L::splat(SHRINK), at);
        term = L::select(long, term * L::splat(LESS), term);
    }
    at
}

impl<L: Lane> Path<L> {
    /// A path that turns where `turning` is set, from `slip` on; else the line up to `length`.
    #[inline(always)]
    pub(super) fn new(
        turning: L::Mask,
        drive: &Drive<L>,
        normal: &Normal<L>,
        slip: (L, L),
        line: Line<L>,
        length: L,
    ) -> Self {
        let (curve, end) = if turning.any() {
            Curve::new(drive, normal, slip.0, slip.1, length)
        } else {
            (Curve::none(), length)
        };
        Self {
            end: L::select(turning, end, length),
            turning,
            curve,
            line,
        }
    }

    /// What the piece adds up to `at`.
    #[inline(always)]
    pub(super) fn step(&self, at: L) -> Step<L> {
        let line = Step {
            x: self.line.x * at,
            y: self.line.y * at,
            z: at,
            work: at * (self.line.normal + at * self.line.half_gain),
        };
        if !self.turning.any() {
            return line;
        }
        let pick = |series: &Series<L>, line: L| L::select(self.turning, horner(series, at), line);
        Step {
            x: pick(&self.curve.x, line.x),
            y: pick(&self.curve.y, line.y),
            z: pick(&self.curve.z, line.z),
            work: pick(&self.curve.work, line.work),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows a slip for a given s in equal pieces; the slip, τ and ∫u dτ at the end.
    fn follow(pieces: u32, total: f64) -> [f64; 4] {
        let (xx, xz, zz, yy, mu) = (2.7, 1.1, 1.9, 3.6, 0.8);
        let drive = Drive {
            mu,
            xx,
            yy,
            bx: xz,
            by: 0.2,
        };
        let (mut x, mut y, mut tau, mut work) = (0.4, 1.0, 0.0, 0.0);
        let (mut px, mut py) = (0.0, 0.0);
        // ξ = 1 is s = 2/speed, with speed as the series have it
        let speed = f64::max(mu * xx, mu * yy) + libm::hypot(xz, 0.2);
        let at = total * speed / 2.0 / f64::from(pieces);
        for _ in 0..pieces {
            let normal = Normal {
                now: -1.0 + zz * tau + xz * px,
                zz,
                xz,
            };
            let (curve, _) = Curve::new(&drive, &normal, x, y, f64::NAN);
            work += horner(&curve.work, at);
            tau += horner(&curve.z, at);
            px += horner(&curve.x, at);
            py += horner(&curve.y, at);
            x = 0.4 + xx * px + xz * tau;
            y = 1.0 + yy * py + 0.2 * tau;
        }
        [x, y, tau, work]
    }

    /// Halving the pieces divides the error by 2^ORDER: seen between where the series just
    /// converge and where rounding takes over.
    #[test]
    fn the_error_falls_with_the_order_of_the_series() {
        let exact = follow(64, 1.0);
        let error = |pieces: u32| {
            let at = follow(pieces, 1.0);
            (0..4).map(|i| (at[i] - exact[i]).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(2), error(4));
        let order = libm::log2(coarse / fine);
        println!("errors {coarse:e} {fine:e}, order {order:.1}");
        assert!(fine > 1e-15, "{fine:e}");
        assert!((order - ORDER as f64).abs() < 3.0, "{order}");
    }

    /// The allowed truncation is what a piece of the reach it allows loses.
    #[test]
    fn a_piece_within_its_reach_is_right() {
        let normal = Normal {
            now: -1.0,
            zz: 1.9,
            xz: 1.1,
        };
        let drive = Drive {
            mu: 0.8,
            xx: 2.7,
            yy: 3.6,
            bx: 1.1,
            by: 0.2,
        };
        let (_, end) = Curve::new(&drive, &normal, 0.4, 1.0, f64::NAN);
        let speed = 0.8 * 3.6 + libm::hypot(1.1, 0.2);
        let total = end * 2.0 / speed;
        let (one, many) = (follow(1, total), follow(16, total));
        for i in 0..4 {
            assert!(
                (one[i] - many[i]).abs() <= 2.0 * TRUNCATION,
                "{one:?} {many:?}"
            );
        }
    }
}
