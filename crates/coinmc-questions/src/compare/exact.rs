//! Exact tests of counts of heads, tails and side against a model.
//!
//! Two cases. A model whose probabilities are *known* gives the counts k of n tosses the multinomial
//! probability n! Π p_j^k_j/k_j!. A model that was itself tossed, with the counts m, is a second sample: given
//! the sums c = k + m, the counts have the hypergeometric probability Π C(c_j, k_j)/C(Σc, n), whatever
//! the common probabilities are (Freeman & Halton, Biometrika 38 (1951) 141). Either way ln w(k) = Σ g_j(k_j) +
//! const with concave g_j, which are sums of their steps,
//!
//! ```text
//! g_j(k + 1) − g_j(k) = ln(n s/(k + 1)),    s = p_j, or of two samples (c_j − k)/Σc:
//! ```
//!
//! no logarithm of a factorial, which would lose the digits that tell counts apart where a model has 1e9 tosses. (The
//! terms in n and Σc alone are the same for all counts, and drop out of the probabilities.) The p-value is the probability of all counts that are no more probable than those
//! seen.
//!
//! As the g_j are concave, w has one peak over the number of heads for each number on the side, and one over the
//! number on the side. So the sum goes out from the peak until what is left is negligible: its cost grows with n,
//! not with n².

use libm::{exp, log};

/// Counts whose probability is this many natural logarithms below that of the most probable ones are left out: all
/// of them together have less than n² e⁻⁶⁰.
const NEGLIGIBLE: f64 = 60.0;
/// Logarithms of probabilities that differ by less count as equal; rounding is below it up to n = 1e6, whatever the
/// tosses of the model.
const TIE: f64 = 1e-7;

/// What counts are compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reference {
    /// Probabilities without error.
    Known([f64; 3]),
    /// The counts of a model that was tossed.
    Counted([u64; 3]),
}

/// The p-value of `seen`: the probability, if the reference is true, of counts that are no more probable.
pub(super) fn p_value(reference: &Reference, seen: [u64; 3]) -> f64 {
    let weights = Weights::new(reference, seen);
    let Some(seen) = weights.of(seen) else {
        return 0.0;
    };
    let sides = weights.sides();
    let best = peak(&sides, |side| weights.at(weights.best(side)));
    let top = weights.at(weights.best(best));
    let mut sums = Sums {
        top,
        limit: seen + TIE,
        all: 0.0,
        tail: 0.0,
    };
    outwards(&sides, best, |side| {
        let heads = weights.heads(side);
        let [middle, _, _] = weights.best(side);
        outwards(&heads, middle, |heads| {
            sums.add(weights.at(weights.counts(heads, side)))
        })
    });
    sums.tail / sums.all
}

/// Sums of probabilities, relative to the largest.
struct Sums {
    top: f64,
    limit: f64,
    all: f64,
    tail: f64,
}

impl Sums {
    /// Whether the probability is worth adding.
    fn add(&mut self, weight: f64) -> bool {
        let share = exp(weight - self.top);
        self.all += share;
        if weight <= self.limit {
            self.tail += share;
        }
        weight >= self.top - NEGLIGIBLE
    }
}

/// The g_j at all counts that are possible.
struct Weights {
    g: [Vec<f64>; 3],
    n: usize,
}

/// The possible counts of a face, both ends included.
type Span = (usize, usize);

impl Weights {
    fn new(reference: &Reference, seen: [u64; 3]) -> Self {
        let n: u64 = seen.iter().sum();
        let face = |j: usize| match reference {
            Reference::Known(p) => {
                let most = if p[j] > 0.0 { n } else { 0 };
                sums(most, n, |_| p[j])
            }
            Reference::Counted(model) => {
                let both = model[j] + seen[j];
                let all = model.iter().sum::<u64>() + n;
                sums(both.min(n), n, |k| (both - k) as f64 / all as f64)
            }
        };
        Self {
            g: [face(0), face(1), face(2)],
            n: index(n),
        }
    }

    fn most(&self, face: usize) -> usize {
        self.g[face].len() - 1
    }

    /// ln w; `None` if the counts are impossible.
    fn of(&self, counts: [u64; 3]) -> Option<f64> {
        let g = self.g.iter().zip(counts);
        g.map(|(g, count)| g.get(index(count)).copied()).sum()
    }

    fn at(&self, [heads, tails, side]: [usize; 3]) -> f64 {
        self.g[0][heads] + self.g[1][tails] + self.g[2][side]
    }

    fn counts(&self, heads: usize, side: usize) -> [usize; 3] {
        [heads, self.n - side - heads, side]
    }

    fn sides(&self) -> Span {
        let faces = (self.most(0) + self.most(1)).min(self.n);
        (self.n - faces, self.most(2))
    }

    fn heads(&self, side: usize) -> Span {
        let rest = self.n - side;
        (rest - self.most(1).min(rest), self.most(0).min(rest))
    }

    /// The most probable counts with so many on the side.
    fn best(&self, side: usize) -> [usize; 3] {
        let heads = peak(&self.heads(side), |heads| self.at(self.counts(heads, side)));
        self.counts(heads, side)
    }
}

/// Where a function with one peak is largest.
fn peak(&(mut low, mut high): &Span, value: impl Fn(usize) -> f64) -> usize {
    while low < high {
        let middle = low + (high - low) / 2;
        if value(middle + 1) > value(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// Visits all from `middle` on in both directions, each until one is negligible; tells whether the middle
/// was worth it.
fn outwards(&(low, high): &Span, middle: usize, mut visit: impl FnMut(usize) -> bool) -> bool {
    if !visit(middle) {
        return false;
    }
    let _ = (middle + 1..=high).all(&mut visit);
    let _ = (low..middle).rev().all(&mut visit);
    true
}

fn index(count: u64) -> usize {
    usize::try_from(count).expect("counts are bounded")
}

/// g at 0 to `most`, the sums of ln(n share(k)/(k + 1)), with the rounding of each sum carried over to the next
/// (Kahan, Communications of the ACM 8 (1965) 40).
fn sums(most: u64, n: u64, share: impl Fn(u64) -> f64) -> Vec<f64> {
    let (mut sum, mut lost) = (0.0, 0.0);
    let mut g = vec![sum];
    g.extend((0..most).map(|k| {
        let step = log(n as f64 * share(k) / (k + 1) as f64) - lost;
        let next = sum + step;
        lost = (next - sum) - step;
        sum = next;
        sum
    }));
    g
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::lgamma;

    fn ln_factorial(n: u64) -> f64 {
        lgamma(n as f64 + 1.0)
    }

    /// By hand: of 4 tosses with the probabilities 1/2, 1/4, 1/4, all 15 counts.
    #[test]
    fn a_multinomial_tail_is_the_sum_of_its_terms() {
        let p = [0.5, 0.25, 0.25];
        let known = Reference::Known(p);
        let factorial = [1.0, 1.0, 2.0, 6.0, 24.0];
        let probability = |k: [usize; 3]| {
            24.0 * (0..3)
                .map(|j| p[j].powi(i32::try_from(k[j]).expect("small")) / factorial[k[j]])
                .product::<f64>()
        };
        for h in 0..=4 {
            for t in 0..=4 - h {
                let seen = [h, t, 4 - h - t];
                let mut tail = 0.0;
                for a in 0..=4 {
                    for b in 0..=4 - a {
                        let other = probability([a, b, 4 - a - b]);
                        if other <= probability(seen) * 1.000_001 {
                            tail += other;
                        }
                    }
                }
                let found = p_value(&known, seen.map(|count| count as u64));
                assert!((found - tail).abs() < 1e-12, "{seen:?} {found} {tail}");
            }
        }
    }

    /// Sums of all tables in whole numbers, C(c, k), without rounding (a few lines of Python).
    const TABLES: [([u64; 3], [u64; 3], f64); 3] = [
        ([210, 190, 100], [2100, 2050, 850], 0.184_778_153_666_664_5),
        ([3, 1, 6], [20, 25, 15], 0.060_898_704_429_309_405),
        ([8, 0, 2], [5, 9, 0], 0.001_530_141_909_062_356),
    ];

    #[test]
    fn two_samples_are_compared_as_in_whole_numbers() {
        for (seen, model, expected) in TABLES {
            let found = p_value(&Reference::Counted(model), seen);
            assert!((found / expected - 1.0).abs() < 1e-9, "{seen:?} {found}");
        }
    }

    /// The same in whole numbers, of models with 1e9 to 1e15 tosses.
    #[test]
    fn large_models_are_compared_as_in_whole_numbers() {
        let third = 333_333_333_333_333;
        for (seen, model, expected) in [
            (
                [26, 24, 10],
                [400_000_000, 400_000_000, 200_000_000],
                0.814_015_764_047_236_4,
            ),
            (
                [30, 22, 8],
                [450, 400, 150].map(|share| share * 1_000_000_000_000),
                0.773_756_601_192_716_2,
            ),
            (
                [1, 1, 40],
                [300, 400, 200].map(|share| share * 1_000_000_000_000),
                3.928_849_220_967_547e-24,
            ),
            // other counts are as probable as these
            ([25, 20, 15], [third; 3], 0.309_972_427_578_941_3),
        ] {
            let found = p_value(&Reference::Counted(model), seen);
            assert!((found / expected - 1.0).abs() < 1e-9, "{seen:?} {found}");
        }
    }

    /// A million tosses against 1e15; by Stirling's series with 60 digits.
    #[test]
    fn weights_of_many_tosses_differ_as_with_sixty_digits() {
        let seen = [450_500, 399_800, 149_700];
        let model = [450, 400, 150].map(|share| share * 1_000_000_000_000);
        let weights = Weights::new(&Reference::Counted(model), seen);
        let of = |counts: [u64; 3]| weights.of(counts).expect("possible counts");
        for (counts, expected) in [
            ([450_000, 400_000, 150_000], 0.627_187_673_565_575_6),
            ([460_000, 395_000, 145_000], -225.313_687_785_785_7),
            ([451_000, 399_600, 149_400], -1.883_376_832_809_871_5),
        ] {
            let found = of(counts) - of(seen);
            assert!((found - expected).abs() < 0.01 * TIE, "{counts:?} {found}");
        }
    }

    /// Under the model the p-value is at most α in at most the share α of experiments (all of them added up).
    #[test]
    fn the_false_alarm_rate_holds() {
        let p = [0.45, 0.4, 0.15];
        let n = 30;
        for alpha in [0.01, 0.05, 0.2] {
            let mut rate = 0.0;
            for h in 0..=n {
                for t in 0..=n - h {
                    let counts = [h, t, n - h - t];
                    if p_value(&Reference::Known(p), counts) <= alpha {
                        let ln = |j: usize| counts[j] as f64 * log(p[j]) - ln_factorial(counts[j]);
                        rate += exp(ln_factorial(n) + ln(0) + ln(1) + ln(2));
                    }
                }
            }
            assert!(rate <= alpha && rate > 0.6 * alpha, "{alpha}: {rate}");
        }
    }

    /// A million tosses against a million: as χ², whose tail beyond c is e^(−c/2).
    #[test]
    fn large_counts_agree_with_the_limit() {
        let seen = [450_500, 399_800, 149_700];
        let model = [450_000, 400_000, 150_000];
        let chi_squared: f64 = (0..3)
            .map(|j| {
                let mean = 0.5 * (seen[j] + model[j]) as f64;
                2.0 * (seen[j] as f64 - mean) * (seen[j] as f64 - mean) / mean
            })
            .sum();
        let found = p_value(&Reference::Counted(model), seen);
        let limit = exp(-0.5 * chi_squared);
        assert!((found / limit - 1.0).abs() < 1e-3, "{found} {limit}");
    }

    #[test]
    fn what_cannot_be_has_no_chance() {
        assert_eq!(p_value(&Reference::Known([0.5, 0.5, 0.0]), [3, 4, 1]), 0.0);
        assert_eq!(p_value(&Reference::Known([0.5, 0.5, 0.0]), [4, 4, 0]), 1.0);
        assert!(p_value(&Reference::Known([0.0, 0.0, 1.0]), [0, 0, 9]) == 1.0);
        assert!(p_value(&Reference::Counted([1_000_000, 0, 0]), [0, 0, 500]) < 1e-15);
        assert_eq!(p_value(&Reference::Counted([0, 0, 0]), [1, 2, 3]), 1.0);
    }
}
