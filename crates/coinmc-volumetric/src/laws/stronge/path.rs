//! A piece of the path of an impact: the impulses as functions of a parameter.

/// Order of the Taylor series.
const ORDER: usize = 18;

/// Truncation error of a piece, relative to the slip at its start.
const TRUNCATION: f64 = 1e-11;

/// What drives the slip: slip' = (K_xx f_x + b_x, K_yy f_y + b_y) with f = −μ slip/|slip|.
pub(super) struct Drive {
    pub(super) mu: f64,
    pub(super) xx: f64,
    pub(super) yy: f64,
    pub(super) bx: f64,
    pub(super) by: f64,
}

/// How u_z depends on the impulses: its value, and its derivatives with respect to z and x.
pub(super) struct Normal {
    pub(super) now: f64,
    pub(super) zz: f64,
    pub(super) xz: f64,
}

/// What a piece adds to the impulses.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
    /// To W = ∫u_z dτ.
    pub(super) work: f64,
}

/// A piece of the path, over a parameter from 0 to `end`.
pub(super) struct Path {
    pub(super) end: f64,
    shape: Shape,
}

// Only one exists at a time, briefly.
#[expect(clippy::large_enum_variant)]
enum Shape {
    Line(Line),
    Curve(Curve),
}

/// A piece with a constant f; the parameter is τ.
pub(super) struct Line {
    pub(super) x: f64,
    pub(super) y: f64,
    /// u_z, and half its derivative.
    pub(super) normal: f64,
    pub(super) half_gain: f64,
}

/// A piece with a slip that turns. Series in ξ, where dτ = |slip| ds and s = ξ·scale: the terms of
/// ξ, ξ², … As a function of s the slip obeys slip' = −μ diag(K_xx, K_yy) slip + b|slip|, which is
/// smooth even where the slip nearly vanishes.
struct Curve([Step; ORDER]);

/// One term of the series of the slip and of its size.
#[derive(Clone, Copy, Default)]
struct Slip {
    x: f64,
    y: f64,
    size: f64,
}

impl Step {
    const NONE: Self = Self {
        x: 0.0,
        y: 0.0,
        z: 0.0,
        work: 0.0,
    };
}

impl Line {
    fn step(&self, at: f64) -> Step {
        Step {
            x: self.x * at,
            y: self.y * at,
            z: at,
            work: at * (self.normal + at * self.half_gain),
        }
    }
}

impl Curve {
    /// The series that starts at the slip (gx, gy), and the largest ξ at which it is accurate.
    /// Unless `length` is NaN, τ goes little beyond it.
    fn new(drive: &Drive, normal: &Normal, gx: f64, gy: f64, length: f64) -> (Self, f64) {
        let mut terms = [Step::NONE; ORDER];
        let mut slips = [Slip::default(); ORDER + 1];
        let mut normals = [0.0; ORDER + 1];
        let first = (gx * gx + gy * gy).sqrt();
        slips[0] = Slip {
            x: gx,
            y: gy,
            size: first,
        };
        normals[0] = normal.now;
        let over = 1.0 / first;
        let (ax, ay) = (drive.mu * drive.xx, drive.mu * drive.yy);
        // |slip'| <= speed·|slip|: the series converge up to about 1/speed
        let speed = ax.max(ay) + (drive.bx * drive.bx + drive.by * drive.by).sqrt();
        let mut scale = 2.0 / speed;
        let needed = length * over;
        if 0.0 < needed && needed < scale {
            scale = needed;
        }
        for k in 0..ORDER {
            let step = scale * (1.0 / (k + 1) as f64);
            let mut power = 0.0;
            for (normal, slip) in normals[..=k].iter().zip(slips[..=k].iter().rev()) {
                power += normal * slip.size;
            }
            let now = slips[k];
            let term = Step {
                x: -(drive.mu * now.x) * step,
                y: -(drive.mu * now.y) * step,
                z: now.size * step,
                work: power * step,
            };
            let x = (drive.bx * now.size - ax * now.x) * step;
            let y = (drive.by * now.size - ay * now.y) * step;
            normals[k + 1] = normal.zz * term.z + normal.xz * term.x;
            terms[k] = term;
            // |slip|² = x² + y², term k + 1
            let mut sum = 2.0 * (gx * x + gy * y);
            let between = &slips[1..=k];
            for (a, b) in between.iter().zip(between.iter().rev()) {
                sum += a.x * b.x + a.y * b.y - a.size * b.size;
            }
            let size = sum * over * 0.5;
            slips[k + 1] = Slip { x, y, size };
        }
        let work = 1.0 / (normal.now.abs() + first);
        let size = |k: usize| {
            let slip = &slips[k];
            slip.x.abs() + slip.y.abs() + slip.size.abs() + terms[k - 1].work.abs() * work
        };
        let last = size(ORDER).max(size(ORDER - 1));
        (Self(terms), reach(last, TRUNCATION * first))
    }

    /// Evaluated by Horner's rule.
    fn step(&self, at: f64) -> Step {
        let Self(terms) = self;
        let mut sum = terms[ORDER - 1];
        for term in terms[..ORDER - 1].iter().rev() {
            sum = Step {
                x: sum.x * at + term.x,
                y: sum.y * at + term.y,
                z: sum.z * at + term.z,
                work: sum.work * at + term.work,
            };
        }
        Step {
            x: sum.x * at,
            y: sum.y * at,
            z: sum.z * at,
            work: sum.work * at,
        }
    }
}

/// The largest of 1, .8, .64, … at which the last term is below `allowed`; its size at 1 is `term`.
fn reach(mut term: f64, allowed: f64) -> f64 {
    const SHRINK: f64 = 0.8;
    // SHRINK^(ORDER − 1)
    const LESS: f64 = 0.022_517_998_136_852_48;
    let mut at = 1.0;
    let mut count = 0;
    while allowed < term && count < 40 {
        at *= SHRINK;
        term *= LESS;
        count += 1;
    }
    at
}

impl Path {
    /// A piece with a constant friction, up to a normal impulse of `length`.
    pub(super) fn straight(line: Line, length: f64) -> Self {
        Self {
            end: length,
            shape: Shape::Line(line),
        }
    }

    /// A piece with a slip that turns, from (gx, gy) on: as long as it is accurate, or little
    /// beyond `length`.
    pub(super) fn turning(
        drive: &Drive,
        normal: &Normal,
        (gx, gy): (f64, f64),
        length: f64,
    ) -> Self {
        let (curve, end) = Curve::new(drive, normal, gx, gy, length);
        Self {
            end,
            shape: Shape::Curve(curve),
        }
    }

    /// What the piece adds up to `at`.
    pub(super) fn step(&self, at: f64) -> Step {
        match &self.shape {
            Shape::Line(line) => line.step(at),
            Shape::Curve(curve) => curve.step(at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows a slip for a given s in equal pieces. Returns the slip, τ and ∫u dτ at the end.
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
            let step = curve.step(at);
            work += step.work;
            tau += step.z;
            px += step.x;
            py += step.y;
            x = 0.4 + xx * px + xz * tau;
            y = 1.0 + yy * py + 0.2 * tau;
        }
        [x, y, tau, work]
    }

    /// Halving the pieces divides the error by 2^ORDER. This is visible between where the series
    /// just converges and where rounding dominates.
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

    /// A piece of the length that is allowed has no more than the allowed truncation error.
    #[test]
    fn a_piece_within_its_reach_is_accurate() {
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

    /// A step is the sum of the terms of ξ, ξ², … up to ξ¹⁸.
    #[test]
    fn a_step_is_the_sum_of_the_series() {
        let mut terms = [Step::NONE; ORDER];
        for (i, term) in terms.iter_mut().enumerate() {
            let one = 1.0 + i as f64;
            *term = Step {
                x: 1.0 / one,
                y: -0.3,
                z: one,
                work: 0.7 - 0.1 * one,
            };
        }
        let step = Curve(terms).step(0.7);
        let mut sum = [0.0; 4];
        let mut power = 0.7;
        for term in &terms {
            for (sum, term) in sum.iter_mut().zip([term.x, term.y, term.z, term.work]) {
                *sum += power * term;
            }
            power *= 0.7;
        }
        for (found, expected) in [step.x, step.y, step.z, step.work].into_iter().zip(sum) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    /// A piece reaches as far as its last term, which falls with the power ORDER − 1, allows, to within a fifth; where
    /// it is not finite still somewhere.
    #[test]
    fn the_reach_is_the_largest_that_is_allowed() {
        let allowed = 1e-11;
        for term in [1e-12, 3e-11, 2e-8, 0.7, 4e3] {
            let at = reach(term, allowed);
            let last = |at: f64| term * at.powi(17);
            assert!(last(at) <= allowed, "{term}: {at}");
            assert!(at == 1.0 || last(at / 0.8) > allowed, "{term}: {at}");
        }
        let least = reach(f64::INFINITY, allowed);
        assert!((1e-6..1e-3).contains(&least), "{least}");
    }
}
