//! Error against evaluations, and against time, of the ways to answer a scene: where the first
//! contact decides, and where the coin bounces.

mod ways;

use clap::Args;
use coinmc_bench::{Case, Report, Stopwatch, Table, number};
use coinmc_core::{LaunchDistribution, Marginal, Orientation, Preset, Spin};
use ways::{Subject, Way};

/// Evaluations of the first column, and by how much they grow.
const FIRST: u64 = 1 << 10;
const GROWTH: u64 = 8;
/// Evaluations of what stands for the truth, over those of the largest estimate.
const TRUTH: u64 = 16;

/// Variance of rounding alone.
const EXACT: f64 = 1e-24;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Integration {
    /// Estimates of each way and number of evaluations, whose errors are averaged
    #[arg(long, value_parser = number::count, default_value = "32", value_name = "N")]
    estimates: u64,
    /// Evaluations of the largest
    #[arg(long, value_parser = number::count, default_value = "65_536", value_name = "N")]
    most: u64,
}

impl Integration {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let columns = [
            "scene",
            "method",
            "way",
            "evaluations",
            "error",
            "us_an_evaluation",
            "variance_gain",
            "time_gain",
        ];
        let title = format!(
            "P(heads) of a coin of ratio 1 that stays where it lands (and, last, of one that bounces): \
             root mean square error of {} estimates; gains over as many random tosses, and over \
             random tosses for as long",
            self.estimates
        );
        let mut record = Table::new(title, &columns);
        for (name, subject) in subjects() {
            let truth = subject.heads(Way::Auto, u64::MAX, TRUTH.saturating_mul(self.most));
            let mut evaluations = FIRST;
            while evaluations <= self.most {
                self.rows(&subject, name, truth, evaluations, seed, &mut record);
                evaluations *= GROWTH;
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "variance_gain: how many times as many random tosses have the same error. A way that \
             gains less than 1.5 is not offered.",
        );
        report
    }

    fn rows(
        &self,
        subject: &Subject,
        name: &str,
        truth: f64,
        evaluations: u64,
        seed: u64,
        record: &mut Table,
    ) {
        let mut random = (0.0, 0.0);
        for &way in subject.ways() {
            let watch = Stopwatch::start();
            let first = seed.wrapping_mul(self.estimates);
            let square: f64 = (0..self.estimates)
                .map(|number| {
                    let p = subject.heads(way, first.wrapping_add(number), evaluations);
                    (p - truth).powi(2)
                })
                .sum();
            let seconds = watch.seconds();
            let variance = square / self.estimates as f64;
            if way == Way::Random {
                random = (variance, seconds);
            }
            let gain = random.0 / variance;
            let shown = |gain: f64| {
                if variance < EXACT {
                    "exact".to_owned()
                } else {
                    format!("{gain:.1}")
                }
            };
            let each = seconds / (self.estimates * evaluations) as f64;
            record.push(vec![
                name.to_owned(),
                subject.method().name().to_owned(),
                way.name().to_owned(),
                evaluations.to_string(),
                number::tiny(variance.sqrt()),
                format!("{:.2}", each * 1e6),
                shown(gain),
                shown(gain * random.1 / seconds.max(1e-9)),
            ]);
        }
    }
}

/// One scene for each method that leaves something to points, one that is exact, two that bounce.
fn subjects() -> Vec<(&'static str, Subject)> {
    let adhesive = Case::new(Preset::Clean, 0.01, 1.0, 0.0, 0.0).adhesive();
    let lands = |(name, launches)| (name, Subject::new(adhesive.scene, launches));
    let mut subjects: Vec<_> = launches().into_iter().map(lands).collect();
    for (name, preset) in [
        ("clean, e = 0.5", Preset::Clean),
        ("robot, e = 0.5", Preset::Robot),
    ] {
        let case = Case::new(preset, 0.01, 1.0, 0.5, 0.3).rolling(0.01);
        subjects.push((name, Subject::new(case.scene, case.launches())));
    }
    subjects
}

/// Launches of the scenes that the first contact decides.
fn launches() -> Vec<(&'static str, LaunchDistribution)> {
    let normal = |mean, sd| Marginal::Normal { mean, sd };
    let clean = Preset::Clean.distribution();
    let spinning = Spin::Components([normal(5.0, 4.0), normal(5.0, 4.0), normal(5.0, 20.0)]);
    let uneven = LaunchDistribution {
        spin: spinning,
        ..clean
    };
    let tilted = LaunchDistribution {
        orientation: Orientation::Tilt(normal(0.0, 0.3)),
        ..uneven
    };
    let low = LaunchDistribution {
        height_m: Marginal::Constant(0.005),
        ..Preset::Robot.distribution()
    };
    vec![
        ("clean", clean),
        ("robot", Preset::Robot.distribution()),
        ("hand", Preset::Hand.distribution()),
        ("table1", Preset::Table1.distribution()),
        ("uneven spin", uneven),
        ("tilted", tilted),
        ("low", low),
    ]
}
