//! How much of P(side) is due to the engine's own settings.
//!
//! Every toss is made with each variant of the settings and with a reference whose tolerances and
//! Zeno rule are all ten times as tight as the defaults. The bias is the mean of the differences,
//! toss by toss, so its standard error is that of the few tosses that differ.

use crate::grid::Grid;
use crate::paired::{Paired, undecided};
use crate::space::tightened;
use crate::survey::{EventDriven, survey_tosses, volumetric};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use std::ops::Range;

/// The project's bound on |bias|.
const BOUND: f64 = 0.0005;

const ZENO: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.003, 0.001];
const TOLERANCE: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-8];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Convergence {
    /// The engine
    #[arg(long, value_enum, default_value_t = EventDriven::Flat)]
    engine: EventDriven,

    /// Tosses of each scene with each variant
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,

    #[command(flatten)]
    grid: Grid,
}

/// Settings that are compared with the tight ones.
struct Variant {
    name: String,
    settings: Settings,
}

#[derive(Debug, Clone, Copy)]
enum Settings {
    Flat(coinmc_flat::Settings),
    Volumetric(coinmc_volumetric::Settings),
}

impl Settings {
    /// The same tosses with these settings and with the tight ones.
    fn pair(&self, case: &Case, seed: u64, tosses: Range<u64>) -> Paired {
        match self {
            Self::Flat(settings) => {
                let default = coinmc_flat::Settings::default();
                let tight = coinmc_flat::Settings {
                    zeno: default.zeno / 10.0,
                    tolerance: default.tolerance / 10.0,
                    ..default
                };
                let engines = [settings, &tight].map(|settings| case.engine(settings));
                Paired::of(case, [&engines[0], &engines[1]], seed, tosses)
            }
            Self::Volumetric(settings) => {
                let tight = tightened(&coinmc_volumetric::Settings::default());
                let engines = [settings, &tight].map(|settings| volumetric(case, settings));
                Paired::of(case, [&engines[0], &engines[1]], seed, tosses)
            }
        }
    }
}

impl Convergence {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let (cases, variants) = (self.grid.cases_of(self.engine), self.variants());
        let jobs: Vec<(&Case, &Variant)> = cases
            .iter()
            .flat_map(|case| variants.iter().map(move |variant| (case, variant)))
            .collect();
        let found = survey_tosses(
            &jobs,
            self.tosses,
            |(case, variant), tosses| variant.settings.pair(case, seed, tosses),
            Paired::merge,
        );
        let title = format!(
            "P(side) with a variant of the settings, and its difference from all tolerances ten \
             times as tight as the defaults; {} tosses a scene, paired, 95 % intervals",
            self.tosses
        );
        let more = [
            "setting",
            "p_side",
            "half_width",
            "bias",
            "std_error",
            "discordant",
            "changed",
            "total_error",
            "undecided",
            "undecided_tight",
        ];
        let mut record = Table::new(title, &Case::columns(&more));
        for ((case, variant), found) in jobs.iter().zip(&found) {
            record.push([case.cells(), vec![variant.name.clone()], cells_of(found)].concat());
        }
        let defaults = (0..cases.len()).map(|case| case * variants.len());
        let of_defaults: Vec<Paired> = defaults.clone().map(|i| found[i]).collect();
        let shown = record.select("The defaults, scene by scene", defaults);
        let mut report = Report::new(record);
        if variants.len() > 1 {
            report.show(summary(&cases, &variants, &found));
        }
        report.show(shown);
        report.remark(conclusion(&of_defaults));
        report.remark(
            "half_width: of the statistical interval, undecided tosses counted either way. bias: \
             variant minus tight; std_error its standard error, from the tosses that are on the \
             side in one of the two only (discordant). total_error: half_width + |bias| + 1.96 \
             std_error. changed: share of tosses with another face: a single toss is chaotic, a \
             probability is not.",
        );
        report.remark(format!(
            "A scene in which none of {} tosses changed has |bias| < {:.0e} with 95 % confidence.",
            self.tosses,
            3.0 / self.tosses as f64
        ));
        report
    }

    /// The defaults first; in the plane, where tosses are fast, then each setting by itself.
    fn variants(&self) -> Vec<Variant> {
        let default = coinmc_flat::Settings::default();
        let named = |name: String, settings| Variant { name, settings };
        if self.engine == EventDriven::Volumetric {
            let settings = Settings::Volumetric(coinmc_volumetric::Settings::default());
            return vec![named("default".to_owned(), settings)];
        }
        let mut variants = vec![named("default".to_owned(), Settings::Flat(default))];
        variants.extend(ZENO.map(|zeno| {
            let settings = coinmc_flat::Settings { zeno, ..default };
            named(format!("zeno {zeno}"), Settings::Flat(settings))
        }));
        variants.extend(TOLERANCE.map(|tolerance| {
            let settings = coinmc_flat::Settings {
                tolerance,
                ..default
            };
            named(format!("tolerance {tolerance:e}"), Settings::Flat(settings))
        }));
        variants
    }
}

fn share(count: u64, found: &Paired) -> f64 {
    count as f64 / found.first.tosses() as f64
}

fn cells_of(found: &Paired) -> Vec<String> {
    let half_width = found.side().half_width();
    vec![
        number::probability(found.side().p),
        number::probability(half_width),
        number::difference(found.bias()),
        number::probability(found.std_error()),
        found.discordant().to_string(),
        number::probability(share(found.changed, found)),
        number::probability(half_width + found.numerical_error()),
        undecided(&found.first),
        undecided(&found.second),
    ]
}

/// Root mean square of bias/std_error over the scenes in which any toss landed otherwise.
fn rms<'a>(found: impl Iterator<Item = &'a Paired>) -> Option<f64> {
    let discordant = found.filter(|found| found.discordant() > 0);
    let scores: Vec<f64> = discordant.map(|found| found.z().powi(2)).collect();
    let mean = scores.iter().sum::<f64>() / scores.len() as f64;
    (!scores.is_empty()).then(|| mean.sqrt())
}

fn conclusion(found: &[Paired]) -> String {
    let largest = found.iter().map(|f| f.bias().abs()).fold(0.0, f64::max);
    let above = found.iter().filter(|f| f.bias().abs() >= BOUND).count();
    let significant = found.iter().filter(|f| {
        let excess = f.bias().abs() - BOUND;
        excess > 1.96 * f.std_error()
    });
    format!(
        "defaults: largest |bias| {largest:.5} (bound {BOUND}); at or above it in {above} of {} \
         scenes, beyond its own error in {}; rms of bias/std_error {} (1: nothing but chance)",
        found.len(),
        significant.count(),
        rms(found.iter()).map_or("none".to_owned(), |rms| format!("{rms:.2}")),
    )
}

/// One row per variant: its worst scene, and all scenes together.
fn summary(cases: &[Case], variants: &[Variant], found: &[Paired]) -> Table {
    let mut table = Table::new(
        "Variants of the settings (all others at their defaults)",
        &[
            "setting",
            "largest_bias",
            "std_error",
            "where",
            "rms",
            "changed",
            "steps_a_toss",
        ],
    );
    for (v, variant) in variants.iter().enumerate() {
        let of_cases = || found.iter().skip(v).step_by(variants.len());
        let pairs = cases.iter().zip(of_cases());
        let largest = pairs.max_by(|a, b| a.1.bias().abs().total_cmp(&b.1.bias().abs()));
        let Some((case, worst)) = largest else {
            continue;
        };
        let mut total = Paired::default();
        for found in of_cases() {
            total.merge(found);
        }
        let place = if worst.changed == 0 {
            String::new()
        } else {
            case.to_string()
        };
        let steps = total.first.impacts + total.first.contact_steps;
        table.push(vec![
            variant.name.clone(),
            number::difference(worst.bias()),
            number::probability(worst.std_error()),
            place,
            rms(of_cases()).map_or("none".to_owned(), |rms| format!("{rms:.2}")),
            number::probability(share(total.changed, &total)),
            format!("{:.2}", share(steps, &total)),
        ]);
    }
    table
}
