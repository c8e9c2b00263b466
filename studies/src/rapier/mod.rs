//! Studies of the engine in time steps, one a file.

mod energy;
mod restitution;
mod step;
mod stress;
mod trend;

pub(crate) use energy::RapierEnergy;
pub(crate) use restitution::RapierRestitution;
pub(crate) use step::RapierStep;
pub(crate) use stress::RapierStress;

use coinmc_core::Tally;
use coinmc_rapier::Flaw;

/// Steps, s, from the one of Unity to where a toss costs a second.
const STEPS: [f64; 9] = [2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5];

/// How many tosses went wrong in which way, and how many had no end.
#[derive(Debug, Clone, Copy, Default)]
struct Flaws {
    tunnelled: u64,
    sunk: u64,
    exploded: u64,
    not_finite: u64,
}

impl Flaws {
    const COLUMNS: [&'static str; 5] = ["tunnelled", "sunk", "exploded", "not_finite", "undecided"];

    fn add(&mut self, flaw: Option<Flaw>) {
        match flaw {
            Some(Flaw::Tunnelled) => self.tunnelled += 1,
            Some(Flaw::Sunk) => self.sunk += 1,
            Some(Flaw::Exploded) => self.exploded += 1,
            Some(Flaw::NotFinite) => self.not_finite += 1,
            None => {}
        }
    }

    fn merge(&mut self, other: &Self) {
        self.tunnelled += other.tunnelled;
        self.sunk += other.sunk;
        self.exploded += other.exploded;
        self.not_finite += other.not_finite;
    }

    /// The cells under [`Flaws::COLUMNS`]; undecided are those that hit a limit.
    fn cells(&self, tally: &Tally) -> Vec<String> {
        let limits = tally.undecided() - tally.failed;
        [
            self.tunnelled,
            self.sunk,
            self.exploded,
            self.not_finite,
            limits,
        ]
        .map(|count| count.to_string())
        .to_vec()
    }
}
