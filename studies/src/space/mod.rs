//! Studies of the toss in space, one a file.

mod balance;
mod convergence;
mod decision;
mod energy;
mod flight;
mod grid;
mod laws;
mod missed;
mod paired;
mod peers;
mod references;
mod sequential;
mod stress;
mod stress_box;

pub(crate) use convergence::SpaceConvergence;
pub(crate) use decision::SpaceDecision;
pub(crate) use energy::SpaceEnergy;
pub(crate) use flight::Leg;
pub(crate) use laws::SpaceLaws;
pub(crate) use missed::SpaceMissed;
pub(crate) use peers::SpacePeers;
pub(crate) use references::SpaceReferences;
pub(crate) use stress::SpaceStress;
pub(crate) use stress_box::Sample;

use crate::survey::{EXAMINED_IMPACTS, Examiner, survey};
use coinmc_bench::Case;
use coinmc_core::{Coin, DynEngine, Engine, State, Tally, run_tosses};
use coinmc_volumetric::Settings;
use nalgebra::Vector3;
use std::ops::Range;

/// Coulomb friction of the scenes that vary everything else.
const FRICTION: f64 = 0.3;

/// Tosses that one thread makes at a time: scenes differ a hundredfold in what a toss costs.
pub(super) const PART: u64 = 20_000;

/// Titles of the cells of [`cells`].
const COLUMNS: [&str; 5] = ["preset", "ratio", "restitution", "friction", "rho_over_r"];

/// The cells that say which case a row is about.
fn cells(case: &Case) -> Vec<String> {
    let (coin, surface) = (&case.scene.coin, &case.scene.surface);
    vec![
        case.preset.to_string(),
        coin.ratio().to_string(),
        surface.restitution().to_string(),
        surface.friction().to_string(),
        case.rho_over_r().to_string(),
    ]
}

/// The case's columns followed by these.
fn columns(more: &[&'static str]) -> Vec<&'static str> {
    COLUMNS.iter().chain(more).copied().collect()
}

/// Every setting that trades error for time, tightened tenfold.
fn tightened(settings: &Settings) -> Settings {
    Settings {
        zeno: settings.zeno / 10.0,
        tolerance: settings.tolerance / 10.0,
        stick_speed: settings.stick_speed / 10.0,
        smoothing_time: settings.smoothing_time / 10.0,
        ..*settings
    }
}

/// The engine of `settings.law`.
fn engine(case: &Case, settings: &Settings) -> DynEngine {
    settings.engine(&case.scene).expect("settings are in range")
}

/// Tallies tosses of a case by an engine.
fn tally<E>(case: &Case, engine: &E, seed: u64, tosses: Range<u64>) -> Tally
where
    E: Engine<Workspace = ()>,
{
    let (launches, stream) = (case.launches(), Case::stream(seed));
    run_tosses(engine, &mut (), &case.scene, &launches, &stream, tosses)
}

/// Makes the first tosses of every item in parts, on all cores, and merges what the parts find, in
/// the order of the items.
fn survey_tosses<T: Sync, R: Send + Clone>(
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

/// Tosses of a case, from number 0, until `quota` things are examined, or that many are made.
fn examine(case: &Case, settings: &Settings, seed: u64, quota: u64, examiner: &mut impl Examiner) {
    let settings = Settings {
        max_impacts: EXAMINED_IMPACTS,
        ..*settings
    };
    let engine = engine(case, &settings);
    let (launches, stream) = (case.launches(), Case::stream(seed));
    for number in 0..quota {
        if examiner.examined() >= quota {
            break;
        }
        examiner.begin(number);
        let launch = launches.launch(&case.scene.coin, &mut stream.toss(number));
        engine.toss(&mut (), &launch, examiner);
    }
}

/// Angular momentum about the centre per mass, m²/s.
fn angular_momentum(coin: &Coin, state: &State) -> Vector3<f64> {
    let axis = state.axis.into_inner();
    let along = axis * state.spin_rad_s.dot(&axis);
    along * coin.axial_gyration_m2() + (state.spin_rad_s - along) * coin.transverse_gyration_m2()
}
