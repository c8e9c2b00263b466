//! What studies share: surveys of scenes on all cores, engines, tallies.

use crate::worst::Worst;
use clap::ValueEnum;
use coinmc_bench::{Case, number};
use coinmc_core::{
    DynEngine, Engine, Estimate, IntervalMethod, Observer, Preset, Tally, run_tosses,
};
use rayon::prelude::*;
use std::fmt;
use std::io::{IsTerminal, stderr};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Coulomb friction of the scenes that vary everything else.
pub(crate) const FRICTION: f64 = 0.3;

/// Tosses that one thread makes at a time: the cost of a toss varies a hundredfold between scenes.
pub(crate) const PART: u64 = 20_000;

/// The event-driven engines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EventDriven {
    /// In the plane
    Flat,
    /// In space
    Volumetric,
}

impl fmt::Display for EventDriven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Flat => "flat",
            Self::Volumetric => "volumetric",
        })
    }
}

/// The volumetric engine of `settings.law`.
pub(crate) fn volumetric(case: &Case, settings: &coinmc_volumetric::Settings) -> DynEngine {
    settings.engine(&case.scene).expect("settings are in range")
}

/// Does something for every item, on all cores, in the order of the items; shows progress on a
/// terminal.
pub(crate) fn survey<'a, T: Sync, R: Send>(
    items: &'a [T],
    each: impl Fn(&'a T) -> R + Sync,
) -> Vec<R> {
    let results: Vec<_> = items.iter().map(|_| Mutex::new(None)).collect();
    spread(items.len(), &|index| {
        let result = each(&items[index]);
        *results[index].lock().expect("no item panicked") = Some(result);
    });
    let result = |one: Mutex<Option<R>>| one.into_inner().expect("no item panicked");
    results
        .into_iter()
        .map(|one| result(one).expect("every item has its result"))
        .collect()
}

/// Does something for every number below `of`, on all cores, and shows progress on a terminal. One
/// function for whatever is done: rayon's code, which is large, is compiled once.
fn spread(of: usize, each: &(dyn Fn(usize) + Sync)) {
    let done = AtomicUsize::new(0);
    let terminal = stderr().is_terminal();
    (0..of).into_par_iter().with_max_len(1).for_each(|index| {
        each(index);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if terminal {
            eprint!("\r{done} of {of} done");
        }
    });
    if terminal {
        eprintln!();
    }
}

/// Makes the first tosses of every item in parts, on all cores, and merges the findings of the
/// parts, in the order of the items.
pub(crate) fn survey_tosses<T: Sync, R: Send + Clone>(
    items: &[T],
    tosses: u64,
    each: impl Fn(&T, Range<u64>) -> R + Sync,
    merge: impl Fn(&mut R, &R),
) -> Vec<R> {
    let parts: Vec<(usize, Range<u64>)> = (0..items.len())
        .flat_map(|item| {
            let starts = (0..tosses.div_ceil(PART)).map(|part| part * PART);
            starts.map(move |start| (item, start..(start + PART).min(tosses)))
        })
        .collect();
    let found = survey(&parts, |(item, range)| each(&items[*item], range.clone()));
    let mut merged: Vec<Option<R>> = vec![None; items.len()];
    for ((item, _), found) in parts.iter().zip(&found) {
        match &mut merged[*item] {
            Some(sum) => merge(sum, found),
            empty => *empty = Some(found.clone()),
        }
    }
    merged.into_iter().flatten().collect()
}

/// Tallies tosses of a case.
pub(crate) fn tally<E>(case: &Case, engine: &E, seed: u64, tosses: Range<u64>) -> Tally
where
    E: Engine<Workspace = ()>,
{
    let (launches, stream) = (case.launches(), Case::stream(seed));
    run_tosses(engine, &mut (), &case.scene, &launches, &stream, tosses)
}

/// P(side) with its 95 % interval.
pub(crate) fn side(tally: &Tally) -> Estimate {
    let (n, method) = (tally.tosses(), IntervalMethod::Wilson);
    Estimate::new(tally.side, tally.undecided(), n, 0.95, method)
}

/// The scenes in which a planar study looks for trouble: every mixture of bouncy and dull, smooth
/// and rough, thin and thick.
pub(crate) fn planar_stress(presets: &[Preset], restitutions: &[f64]) -> Vec<Case> {
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

/// Impacts after which a toss under examination is given up: one without losses would never end.
pub(crate) const EXAMINED_IMPACTS: u32 = 1000;

/// Tosses, from number 0, until `quota` things are examined, or that many tosses are made.
pub(crate) fn examine<E>(
    case: &Case,
    engine: &E,
    seed: u64,
    quota: u64,
    examiner: &mut impl Examiner,
) where
    E: Engine<Workspace = ()>,
{
    for toss in 0..quota {
        if examiner.examined() >= quota {
            break;
        }
        examiner.begin(toss);
        engine.toss(&mut (), &case.launch(seed, toss), examiner);
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
