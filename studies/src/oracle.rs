//! The volumetric engine against the time-stepping oracle, toss by toss.

use crate::survey::{FRICTION, survey, volumetric};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Engine, Face, Preset};
use coinmc_oracle::{StepperSettings, TimeStepper};
use coinmc_volumetric::Settings;

/// (H/R, e, friction lengths in R) of the scenes, all with μ = 0.3 and the preset clean.
const SCENES: [(f64, f64, f64); 7] = [
    (0.25, 0.0, 0.01),
    (0.85, 0.0, 0.01),
    (2.0, 0.0, 0.003),
    (0.25, 0.5, 0.01),
    (0.85, 0.3, 0.01),
    (0.85, 0.5, 0.01),
    (2.0, 0.8, 0.01),
];

/// The same of thin coins, on whose side rolling and pivoting friction hold: see
/// docs/methods/space.md.
const THIN: [(f64, f64, f64); 6] = [
    (0.01, 0.5, 0.003),
    (0.02, 0.5, 0.003),
    (0.05, 0.5, 0.003),
    (0.02, 0.5, 0.01),
    (0.05, 0.5, 0.01),
    (0.1, 0.5, 0.01),
];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Oracle {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "20_000", value_name = "N")]
    tosses: u64,

    /// The oracle's step in sustained contact, in sqrt(D/g)
    #[arg(long, default_value_t = StepperSettings::default().step, value_name = "STEP")]
    step: f64,

    /// Coins of H/R = 0.01 to 0.1 instead of 0.25 to 2
    #[arg(long)]
    thin: bool,
}

/// How the engine's tosses differ from the oracle's.
#[derive(Debug, Clone, Copy, Default)]
struct Differences {
    tosses: u64,
    /// On the side with the oracle.
    side: u64,
    /// On the side with the engine only, and with the oracle only.
    gained: u64,
    lost: u64,
    /// With another face, heads and tails told apart.
    changed: u64,
    undecided: u64,
    /// Tosses that the engine decides within two impacts, and those of them that are changed.
    short: u64,
    short_changed: u64,
}

impl Oracle {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let scenes: &[_] = if self.thin { &THIN } else { &SCENES };
        let cases: Vec<Case> = scenes.iter().map(|&scene| case_of(scene)).collect();
        let found = survey(&cases, |case| self.compare(case, seed));
        let mut record = Table::new(
            format!(
                "P(side) of the engine minus that of the time-stepping oracle (step {}), {} tosses \
                 a scene, paired",
                self.step, self.tosses
            ),
            &columns(),
        );
        for (case, found) in cases.iter().zip(&found) {
            record.push(row(case, found));
        }
        let worst = found.iter().map(Differences::z).fold(0.0, f64::max);
        let (short, changed) = found.iter().fold((0, 0), |(short, changed), found| {
            (short + found.short, changed + found.short_changed)
        });
        let mut report = Report::new(record);
        report.remark(format!(
            "Largest |bias|/std_error: {worst:.1}. Of {short} tosses decided within two impacts \
             {changed} name another face."
        ));
        report.remark(
            "bias: mean difference toss by toss, std_error its standard error. changed: share of \
             tosses with another face, heads and tails told apart: at e > 0 rounding grows with \
             every bounce.",
        );
        report
    }

    fn compare(&self, case: &Case, seed: u64) -> Differences {
        let engine = volumetric(case, &Settings::default());
        let settings = StepperSettings {
            step: self.step,
            ..StepperSettings::default()
        };
        let mut oracle = TimeStepper::new(&case.scene, settings);
        let mut differences = Differences::default();
        for toss in 0..self.tosses {
            let launch = case.launch(seed, toss);
            let outcome = engine.toss(&mut engine.workspace(), &launch, &mut ());
            let (face, other) = (outcome.face(), oracle.toss(&launch).face);
            differences.add(face, other, outcome.impacts <= 2);
        }
        differences
    }
}

/// The case of a row of [`SCENES`].
fn case_of((ratio, e, rho): (f64, f64, f64)) -> Case {
    Case::new(Preset::Clean, 0.01, ratio, e, FRICTION).rolling(rho)
}

impl Differences {
    fn add(&mut self, face: Option<Face>, other: Option<Face>, short: bool) {
        let (side, other_side) = (face == Some(Face::Side), other == Some(Face::Side));
        let changed = face != other;
        self.tosses += 1;
        self.side += u64::from(other_side);
        self.gained += u64::from(side && !other_side);
        self.lost += u64::from(other_side && !side);
        self.changed += u64::from(changed);
        self.undecided += u64::from(face.is_none() || other.is_none());
        self.short += u64::from(short);
        self.short_changed += u64::from(short && changed);
    }

    fn bias(&self) -> f64 {
        (self.gained as f64 - self.lost as f64) / self.tosses as f64
    }

    /// Standard error of the mean of differences that are −1, 0 or 1.
    fn std_error(&self) -> f64 {
        let n = self.tosses as f64;
        (((self.gained + self.lost) as f64 / n - self.bias().powi(2)).max(0.0) / n).sqrt()
    }

    /// |bias| in standard errors; 0 where no toss differs.
    fn z(&self) -> f64 {
        if self.gained + self.lost == 0 {
            0.0
        } else {
            self.bias().abs() / self.std_error().max(f64::MIN_POSITIVE)
        }
    }
}

fn columns() -> Vec<&'static str> {
    let columns = [
        "oracle_p_side",
        "bias",
        "std_error",
        "changed",
        "undecided",
        "short",
        "short_changed",
    ];
    Case::columns(&columns)
}

fn row(case: &Case, found: &Differences) -> Vec<String> {
    let share = |count: u64| number::probability(count as f64 / found.tosses as f64);
    let mut cells = case.cells();
    cells.extend([
        share(found.side),
        number::difference(found.bias()),
        number::probability(found.std_error()),
        share(found.changed),
        found.undecided.to_string(),
        found.short.to_string(),
        found.short_changed.to_string(),
    ]);
    cells
}
