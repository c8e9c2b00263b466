//! What studies share: a survey of scenes on all cores, tallies, tables.

use crate::worst::Worst;
use coinmc_bench::{Case, number};
use coinmc_core::{Engine, Estimate, IntervalMethod, Observer, Preset, Tally, run_tosses};
use coinmc_flat::Settings;
use rayon::prelude::*;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Does something for every item, on all cores, in the order of the items; says on a terminal
/// how far it is.
pub(crate) fn survey<'a, T: Sync, R: Send>(
    items: &'a [T],
    each: impl Fn(&'a T) -> R + Sync,
) -> Vec<R> {
    let (done, of) = (AtomicUsize::new(0), items.len());
    let terminal = stderr().is_terminal();
    let results = items
        .par_iter()
        .with_max_len(1)
        .map(|item| {
            let result = each(item);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if terminal {
                eprint!("\r{done} of {of} scenes");
            }
            result
        })
        .collect();
    if terminal {
        eprintln!();
    }
    results
}

/// Tallies the first tosses of a case.
pub(crate) fn tally(case: &Case, settings: &Settings, seed: u64, tosses: u64) -> Tally {
    let engine = case.engine(settings);
    let (launches, stream) = (case.launches(), Case::stream(seed));
    run_tosses(
        &engine,
        &mut engine.workspace(),
        &case.scene,
        &launches,
        &stream,
        0..tosses,
    )
}

/// P(side) with its 95 % interval.
pub(crate) fn side(tally: &Tally) -> Estimate {
    Estimate::new(
        tally.side,
        tally.undecided(),
        tally.tosses(),
        0.95,
        IntervalMethod::Wilson,
    )
}

/// The box in which a study looks for trouble: every mixture of bouncy and dull, smooth and rough,
/// thin and thick.
pub(crate) fn stress_box(presets: &[Preset], restitutions: &[f64]) -> Vec<Case> {
    let (frictions, ratios) = ([0.0, 0.1, 0.3, 1.0, 10.0], [0.01, 0.1, 1.0, 10.0, 100.0]);
    Case::grid(presets, restitutions, &frictions, &ratios)
}

/// An observer of a part of a toss, used for many tosses of one case.
pub(crate) trait Examiner: Observer {
    /// A toss of this number begins.
    fn begin(&mut self, toss: u64);

    /// How much has been examined so far.
    fn examined(&self) -> u64;
}

/// Impacts after which a toss under examination is given up: one without losses would go on for
/// ever, and no other would get its turn.
pub(crate) const EXAMINED_IMPACTS: u32 = 1000;

/// Tosses, from number 0, until `quota` things are examined, or that many tosses are made.
pub(crate) fn examine(case: &Case, seed: u64, quota: u64, examiner: &mut impl Examiner) {
    let settings = Settings {
        max_impacts: EXAMINED_IMPACTS,
        ..Settings::default()
    };
    let engine = case.engine(&settings);
    let (launches, stream) = (case.launches(), Case::stream(seed));
    for toss in 0..quota {
        if examiner.examined() >= quota {
            break;
        }
        examiner.begin(toss);
        let launch = launches.launch(&case.scene.coin, &mut stream.toss(toss));
        engine.toss(&mut (), &launch, examiner);
    }
}

/// "1.2e-16 (robot R=0.01 x=1 e=0.5 mu=0.3, toss 17)".
pub(crate) fn worst_text(worst: Option<(&Case, Worst)>) -> String {
    match worst {
        Some((case, worst)) if worst.value != f64::NEG_INFINITY => {
            format!(
                "{} ({case}, toss {})",
                number::tiny(worst.value),
                worst.toss
            )
        }
        _ => "none seen".to_owned(),
    }
}

/// The cells that say which case a row is about, under [`CASE_COLUMNS`].
pub(crate) fn case_cells(case: &Case) -> Vec<String> {
    let (coin, surface) = (&case.scene.coin, &case.scene.surface);
    vec![
        case.preset.to_string(),
        surface.restitution().to_string(),
        surface.friction().to_string(),
        coin.ratio().to_string(),
    ]
}

/// Titles of the cells of [`case_cells`].
pub(crate) const CASE_COLUMNS: [&str; 4] = ["preset", "restitution", "friction", "ratio"];

/// The case's columns followed by these.
pub(crate) fn with_case_columns(columns: &[&'static str]) -> Vec<&'static str> {
    CASE_COLUMNS.iter().chain(columns).copied().collect()
}
