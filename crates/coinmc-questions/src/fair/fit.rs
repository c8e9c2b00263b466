//! A smooth curve through counts: logistic regression near a root.
//!
//! # Model
//! Of n tosses at the value u, k show the face, binomial with the probability P. Near a root, in a
//! window of half width h around u₀, the log odds are a parabola in t = (u − u₀)/h,
//!
//! ```text
//! ln(P/(1 − P)) = b₀ + b₁ t + b₂ t².
//! ```
//!
//! b₂ is held back by a normal prior of mean 0 and the standard deviation ½ κ |b₁| h: log odds that
//! bend by the share κ of their own slope per unit of u. So the fit is a straight line in a window
//! too narrow to see a bend and a parabola in a wide one, and its covariance holds what is not known
//! of the bend.
//!
//! Counts that scatter about the fit by more than chance say that the curve has steps of its own in the window
//! ([`Fit::excess`]): few of real scenes, where a coin hardly bounces.
//!
//! The fit maximises the posterior by Newton's method (McCullagh & Nelder, *Generalized Linear
//! Models*, 1989, § 4.4), which is Fisher scoring here.

use nalgebra::{Matrix3, Vector3};

/// Bend of the log odds per unit of u that is expected at most, as a share of their slope. For the
/// closed forms, with u = ln(H/R), it is below 0.5 for .2 < P(side) < .8.
const BEND: f64 = 1.0;
/// Newton's method takes fewer steps than this unless it fails.
const MOST_STEPS: u32 = 50;
/// Longest Newton step in the log odds: far from the maximum the second order is wrong.
const LONGEST: f64 = 2.0;

/// Tosses at one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counts {
    /// Where, in the variable u.
    pub(super) u: f64,
    /// Tosses.
    pub(super) tosses: u64,
    /// Those that show the face.
    pub(super) shown: u64,
}

/// How far from the middle of its window a fit uses counts, in half widths: those of wider windows before.
pub(super) const USED: f64 = 4.0;
/// Standard normal deviate of one in a hundred, beyond which a scatter is more than chance: a window that is narrowed
/// in vain costs tosses, and a step that is overlooked the answer.
const RARE: f64 = 2.33;

/// The window of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    pub(super) middle: f64,
    pub(super) half: f64,
}

impl Window {
    fn place(&self, counts: &Counts) -> f64 {
        (counts.u - self.middle) / self.half
    }

    /// The counts at most so many half widths from the middle.
    pub(super) fn uses(self, counts: &[Counts], reach: f64) -> impl Iterator<Item = &Counts> {
        let near = move |counts: &&Counts| self.place(counts).abs() <= reach && counts.tosses > 0;
        counts.iter().filter(near)
    }
}

/// The log odds of a face near a root, with their covariance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    window: Window,
    b: Vector3<f64>,
    covariance: Matrix3<f64>,
}

/// The log odds of a probability.
pub(super) fn log_odds(p: f64) -> f64 {
    libm::log(p / (1.0 - p))
}

fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-log_odds))
}

impl Fit {
    /// The fit to all counts that the window [uses](Window::uses); `None` without at least two different values there.
    pub(super) fn new(counts: &[Counts], window: Window, reach: f64) -> Option<Self> {
        let t = |counts: &Counts| window.place(counts);
        let used: Vec<Counts> = window.uses(counts, reach).copied().collect();
        let first = used.first()?;
        if used.iter().all(|counts| counts.u == first.u) {
            return None;
        }
        // the prior depends on the slope, which the fit with the prior of before gives
        let mut bend = f64::INFINITY;
        let mut fit = None;
        for _ in 0..3 {
            let (b, covariance) = maximise(&used, t, bend)?;
            bend = (0.5 * BEND * window.half * b[1].abs()).max(1e-6);
            fit = Some(Self {
                window,
                b,
                covariance,
            });
        }
        fit
    }

    /// By how many times the counts scatter about the fit as much as chance lets them, as a ratio of standard deviations;
    /// 1 where that may be chance, but for one in a hundred (Wilson & Hilferty, PNAS 17 (1931) 684).
    pub(super) fn excess(&self, counts: &[Counts], reach: f64) -> f64 {
        let (mut chi_squared, mut freedom): (f64, f64) = (0.0, -2.0);
        for counts in self.window.uses(counts, reach) {
            let (p, n) = (probability(self.at(counts.u).0), counts.tosses as f64);
            let (off, variance) = (counts.shown as f64 - n * p, n * p * (1.0 - p));
            // next to 0 or 1 it may round to nothing
            chi_squared += off * off / variance.max(f64::EPSILON);
            freedom += 1.0;
        }
        if freedom < 1.0 {
            return 1.0;
        }
        let spread = 2.0 / (9.0 * freedom);
        let most = freedom * (1.0 - spread + RARE * spread.sqrt()).powi(3);
        if chi_squared > most {
            (chi_squared / freedom).sqrt()
        } else {
            1.0
        }
    }

    fn features(&self, u: f64) -> Vector3<f64> {
        let t = (u - self.window.middle) / self.window.half;
        Vector3::new(1.0, t, t * t)
    }

    /// The log odds at u, and their standard error.
    pub(super) fn at(&self, u: f64) -> (f64, f64) {
        let x = self.features(u);
        let variance = (x.transpose() * self.covariance * x)[0];
        (self.b.dot(&x), variance.max(0.0).sqrt())
    }

    /// The slope of the log odds at u, per unit of u, and its standard error.
    pub(super) fn slope(&self, u: f64) -> (f64, f64) {
        let t = (u - self.window.middle) / self.window.half;
        let x = Vector3::new(0.0, 1.0, 2.0 * t) / self.window.half;
        let variance = (x.transpose() * self.covariance * x)[0];
        (self.b.dot(&x), variance.max(0.0).sqrt())
    }

    /// Where the log odds are `target`, the root nearest to the middle; `None` if they never are
    /// near the window.
    pub(super) fn root(&self, target: f64) -> Option<f64> {
        let [c, b, a] = [self.b[0] - target, self.b[1], self.b[2]];
        let discriminant = b * b - 4.0 * a * c;
        if discriminant < 0.0 || b == 0.0 {
            return None;
        }
        // the form without cancellation, which is also that of a straight line
        let t = -2.0 * c / (b + discriminant.sqrt().copysign(b));
        t.is_finite()
            .then_some(self.window.middle + t * self.window.half)
    }

    /// The stretch around `root` on which `target` is within `z` standard errors and the additional
    /// `allowance` of the log odds. An end that is not within `reach` of the root is `None`.
    pub(super) fn interval(
        &self,
        root: f64,
        target: f64,
        z: f64,
        allowance: f64,
        reach: f64,
    ) -> [Option<f64>; 2] {
        let within = |u: f64| {
            let (value, error) = self.at(u);
            (value - target).abs() <= z * error + allowance
        };
        [-1.0, 1.0].map(|side| {
            const STEPS: u32 = 256;
            let place = |share: f64| root + side * reach * share;
            let outside = (1..=STEPS)
                .map(|step| f64::from(step) / f64::from(STEPS))
                .find(|&share| !within(place(share)))?;
            let (mut inner, mut outer) = (outside - 1.0 / f64::from(STEPS), outside);
            for _ in 0..40 {
                let middle = 0.5 * (inner + outer);
                if within(place(middle)) {
                    inner = middle;
                } else {
                    outer = middle;
                }
            }
            Some(place(outer))
        })
    }
}

/// The coefficients of the largest posterior, and their covariance, with a prior of standard
/// deviation `bend` of the last one. (At first no bend is known: then there is none.)
fn maximise(
    counts: &[Counts],
    t: impl Fn(&Counts) -> f64,
    bend: f64,
) -> Option<(Vector3<f64>, Matrix3<f64>)> {
    /// Precision that stands for a coefficient held at 0, and for one about which nothing is known.
    const HELD: f64 = 1e12;
    const FREE: f64 = 1e-6;
    let held = if bend.is_finite() {
        1.0 / (bend * bend)
    } else {
        HELD
    };
    let prior = Matrix3::from_diagonal(&Vector3::new(FREE, FREE, held));
    let (shown, tosses) = counts.iter().fold((0.5, 1.0), |(k, n), c| {
        (k + c.shown as f64, n + c.tosses as f64)
    });
    let mut b = Vector3::new(log_odds(shown / tosses), 0.0, 0.0);
    for _ in 0..MOST_STEPS {
        let (mut pull, mut precision) = (-prior * b, prior);
        for counts in counts {
            let t = t(counts);
            let x = Vector3::new(1.0, t, t * t);
            let (p, n) = (probability(b.dot(&x)), counts.tosses as f64);
            pull += x * (counts.shown as f64 - n * p);
            precision += x * x.transpose() * (n * p * (1.0 - p));
        }
        let covariance = precision.try_inverse()?;
        let step = covariance * pull;
        let length = step.abs().max();
        b += step * (LONGEST / length).min(1.0);
        if length < 1e-10 {
            return Some((b, covariance));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts without noise: as many as expected.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // positive, below 2^53
    fn expected(log_odds: impl Fn(f64) -> f64, tosses: u64) -> Vec<Counts> {
        let count = |u: f64| Counts {
            u,
            tosses,
            shown: (tosses as f64 * probability(log_odds(u))).round() as u64,
        };
        [-0.1, -0.03, 0.04, 0.1].map(count).to_vec()
    }

    const WINDOW: Window = Window {
        middle: 0.0,
        half: 0.1,
    };

    #[test]
    fn a_line_is_recovered() {
        let counts = expected(|u| -0.5 + 3.0 * u, 1 << 40);
        let fit = Fit::new(&counts, WINDOW, USED).expect("four values");
        assert!((fit.at(0.02).0 + 0.44).abs() < 1e-5);
        assert!((fit.slope(0.0).0 - 3.0).abs() < 1e-4);
        assert!((fit.root(-0.5).expect("a root")).abs() < 1e-5);
    }

    /// Many tosses outweigh the prior, few do not: the bend is then in the error.
    #[test]
    fn a_bend_is_seen_or_allowed_for() {
        let bent = |u: f64| -0.5 + 3.0 * u + 1.5 * u * u;
        let fit = Fit::new(&expected(bent, 1 << 40), WINDOW, USED).expect("four values");
        assert!((fit.at(0.0).0 + 0.5).abs() < 1e-5);
        let fit = Fit::new(&expected(bent, 100_000), WINDOW, USED).expect("four values");
        let (value, error) = fit.at(0.0);
        assert!((value + 0.5).abs() < error, "{value} {error}");
    }

    /// One toss more or less of the face in n moves the log odds by 1/(n p (1 − p)): at the centre
    /// of mass of the values the error of a line is 1/sqrt(Σ n p (1 − p)).
    #[test]
    fn the_error_is_that_of_binomial_counts() {
        let fit = Fit::new(&expected(|_| 0.0, 10_000), WINDOW, USED).expect("four values");
        let error = fit.at(0.0025).1;
        assert!(
            (error - 1.0 / (4.0 * 2_500.0_f64).sqrt()).abs() < 1e-5,
            "{error}"
        );
    }

    #[test]
    fn one_value_gives_no_curve() {
        let one = Counts {
            u: 0.0,
            tosses: 10,
            shown: 3,
        };
        assert!(Fit::new(&[one, one], WINDOW, USED).is_none());
        assert!(Fit::new(&[], WINDOW, USED).is_none());
    }

    /// Counts about a smooth curve scatter by chance; those of a step in the window by more.
    #[test]
    fn a_step_in_the_window_is_no_chance() {
        let smooth = expected(|u| -0.5 + 3.0 * u, 4000);
        let fit = Fit::new(&smooth, WINDOW, USED).expect("four values");
        assert_eq!(fit.excess(&smooth, USED), 1.0);
        let step = |u: f64| if u < 0.0 { -0.8 } else { -0.4 };
        let stepped: Vec<Counts> = [0.1, 0.06, 0.03]
            .into_iter()
            .flat_map(|width| {
                expected(step, 4000).into_iter().map(move |counts| Counts {
                    u: counts.u * width / 0.1,
                    ..counts
                })
            })
            .collect();
        let fit = Fit::new(&stepped, WINDOW, USED).expect("values");
        let excess = fit.excess(&stepped, USED);
        assert!(excess > 1.5 && excess < 4.0, "{excess}");
        // of the narrowest alone, two values
        assert_eq!(fit.excess(&stepped, 0.1), 1.0);
    }

    #[test]
    fn the_interval_holds_what_the_error_allows() {
        let fit = Fit::new(&expected(|u| 4.0 * u, 10_000), WINDOW, USED).expect("four values");
        let [lo, hi] = fit.interval(0.0, 0.0, 1.96, 0.0, 0.1);
        let (lo, hi) = (lo.expect("an end"), hi.expect("an end"));
        let arm = 1.96 * fit.at(0.0).1 / 4.0;
        assert!((hi - arm).abs() < 0.1 * arm && (lo + arm).abs() < 0.1 * arm);
        // so little that both ends lie beyond the reach
        assert_eq!(fit.interval(0.0, 0.0, 1.96, 0.0, 0.5 * arm), [None, None]);
    }
}
