//! The same tosses made in two ways.

use crate::survey::{side, volumetric};
use coinmc_bench::Case;
use coinmc_core::{Engine, Estimate, Face, Outcome, Tally};
use coinmc_volumetric::Settings;
use std::ops::{ControlFlow, Range};

/// 97.5 % quantile of the standard normal distribution.
const SIGMAS: f64 = 1.96;

/// How tosses differ between two settings.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Paired {
    pub(crate) first: Tally,
    pub(crate) second: Tally,
    /// On the side the first way only, and the second way only.
    pub(crate) gained: u64,
    pub(crate) lost: u64,
    /// With another outcome, heads and tails told apart.
    pub(crate) changed: u64,
}

impl Paired {
    /// Makes tosses of a case with two engines.
    pub(crate) fn of<E>(case: &Case, engines: [&E; 2], seed: u64, tosses: Range<u64>) -> Self
    where
        E: Engine<Workspace = ()>,
    {
        let [first, second] = engines.map(|engine| outcomes(case, engine, seed, &tosses));
        let mut paired = Self::default();
        for (first, second) in first.iter().zip(&second) {
            paired.add(first, second);
        }
        paired
    }

    /// Makes tosses of a case in space under two settings.
    pub(crate) fn in_space(
        case: &Case,
        settings: [&Settings; 2],
        seed: u64,
        tosses: Range<u64>,
    ) -> Self {
        let [first, second] = settings.map(|settings| volumetric(case, settings));
        Self::of(case, [&first, &second], seed, tosses)
    }

    fn add(&mut self, first: &Outcome, second: &Outcome) {
        let (now, other) = (
            first.face() == Some(Face::Side),
            second.face() == Some(Face::Side),
        );
        self.first.add(first);
        self.second.add(second);
        self.gained += u64::from(now && !other);
        self.lost += u64::from(other && !now);
        self.changed += u64::from(first.face() != second.face());
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.first.merge(&other.first);
        self.second.merge(&other.second);
        self.gained += other.gained;
        self.lost += other.lost;
        self.changed += other.changed;
    }

    /// P(side) the first way minus the second way.
    pub(crate) fn bias(&self) -> f64 {
        (self.gained as f64 - self.lost as f64) / self.first.tosses() as f64
    }

    /// Tosses that are on the side in one way only.
    pub(crate) fn discordant(&self) -> u64 {
        self.gained + self.lost
    }

    /// Standard error of the mean of differences that are −1, 0 or 1.
    pub(crate) fn std_error(&self) -> f64 {
        let n = self.first.tosses() as f64;
        let mean_square = self.discordant() as f64 / n;
        ((mean_square - self.bias().powi(2)).max(0.0) / n).sqrt()
    }

    /// |bias| in standard errors; 0 where no toss differs.
    pub(crate) fn z(&self) -> f64 {
        if self.discordant() == 0 {
            0.0
        } else {
            self.bias().abs() / self.std_error().max(f64::MIN_POSITIVE)
        }
    }

    /// The largest |bias| that these tosses leave possible, with 95 % confidence; without a
    /// discordant toss by the rule of three.
    pub(crate) fn numerical_error(&self) -> f64 {
        let rule_of_three = 3.0 / self.first.tosses() as f64;
        self.bias().abs() + (SIGMAS * self.std_error()).max(rule_of_three)
    }

    /// P(side) of the first way, with its 95 % interval.
    pub(crate) fn side(&self) -> Estimate {
        side(&self.first)
    }
}

/// The outcome of every toss, in the order of their numbers.
fn outcomes<E>(case: &Case, engine: &E, seed: u64, tosses: &Range<u64>) -> Vec<Outcome>
where
    E: Engine<Workspace = ()>,
{
    let (launches, stream) = (case.launches(), Case::stream(seed));
    let launches = launches.launches(&case.scene.coin, &stream, tosses.clone(), engine.lanes());
    let mut outcomes = Vec::new();
    engine.toss_all(&mut (), launches, |number, outcome| {
        outcomes.push((number, *outcome));
        ControlFlow::Continue(())
    });
    // tosses of a batch do not end in their order
    outcomes.sort_unstable_by_key(|(number, _)| *number);
    outcomes.into_iter().map(|(_, outcome)| outcome).collect()
}

/// "12 (time 3, never_settles 9)"; "0" where every toss has a face.
pub(crate) fn undecided(tally: &Tally) -> String {
    let kinds = [
        ("time", tally.time_limit),
        ("never_settles", tally.never_settles),
        ("impacts", tally.impact_limit),
        ("failed", tally.failed),
    ];
    let kinds: Vec<String> = kinds
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    if kinds.is_empty() {
        "0".to_owned()
    } else {
        format!("{} ({})", tally.undecided(), kinds.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_paired_difference_is_that_of_the_tosses_that_differ() {
        let (side, heads) = (Outcome::decided(Face::Side), Outcome::decided(Face::Heads));
        let mut paired = Paired::default();
        for _ in 0..91 {
            paired.add(&side, &side);
        }
        for _ in 0..8 {
            paired.add(&side, &heads);
        }
        paired.add(&heads, &side);
        let mut twice = paired;
        twice.merge(&paired);
        assert_eq!((paired.changed, paired.discordant()), (9, 9));
        assert!((paired.bias() - 0.07).abs() < 1e-15 && (twice.bias() - 0.07).abs() < 1e-15);
        // mean square 0.09, mean 0.07, n = 100
        let expected = ((0.09 - 0.0049) / 100.0_f64).sqrt();
        assert!((paired.std_error() - expected).abs() < 1e-15);
        assert!((paired.numerical_error() - 0.07 - SIGMAS * expected).abs() < 1e-15);
    }

    #[test]
    fn tosses_without_a_difference_bound_it_by_the_rule_of_three() {
        let mut paired = Paired::default();
        for _ in 0..300 {
            paired.add(&Outcome::decided(Face::Side), &Outcome::decided(Face::Side));
        }
        assert_eq!((paired.z(), paired.numerical_error()), (0.0, 0.01));
    }
}
