//! What every engine promises, for any engine: its tests call these with scenes and launches that
//! reach all of its code.

use crate::{
    Extremes, Instants, Recorder, Sampler, batch_outcomes, count_until, counts, scalar_outcomes,
    turned,
};
use coinmc_core::{Engine, Event, Launch, Outcome, Scene};
use nalgebra::UnitVector3;
use std::thread;

/// The outcome depends on the launch alone: not on the tosses that the workspace made before, nor
/// on the thread.
///
/// # Panics
/// If an outcome differs.
pub fn outcomes_depend_on_the_launch_alone<E: Engine>(engine: &E, launches: &[Launch]) {
    let forwards = scalar_outcomes(engine, launches);
    let mut workspace = engine.workspace();
    for (number, launch) in launches.iter().enumerate().rev() {
        // every third in a fresh workspace
        if number % 3 == 0 {
            workspace = engine.workspace();
        }
        let outcome = engine.toss(&mut workspace, launch, &mut ());
        assert_eq!(outcome, forwards[number], "toss {number} backwards");
    }
    let piece = launches.len().div_ceil(4).max(1);
    let pieces: Vec<Vec<Outcome>> = thread::scope(|scope| {
        let threads = launches.chunks(piece);
        let threads = threads.map(|part| scope.spawn(|| scalar_outcomes(engine, part)));
        let threads: Vec<_> = threads.collect();
        let join = |thread: thread::ScopedJoinHandle<'_, Vec<Outcome>>| thread.join();
        threads
            .into_iter()
            .map(|t| join(t).expect("no panic"))
            .collect()
    });
    assert_eq!(pieces.concat(), forwards, "on several threads");
}

/// A batch is bit-identical to the scalar path, and so are its parts. Returns the outcomes.
///
/// # Panics
/// If an outcome differs.
pub fn batch_matches_scalar<E: Engine>(engine: &E, launches: &[Launch]) -> Vec<Outcome> {
    let scalar = scalar_outcomes(engine, launches);
    let batch = batch_outcomes(engine, launches);
    for (number, (batch, scalar)) in batch.iter().zip(&scalar).enumerate() {
        assert_eq!(batch, scalar, "toss {number}: {:?}", launches[number]);
    }
    scalar
}

/// A batch reports nothing after its caller stops it, and leaves the workspace as good as new.
///
/// # Panics
/// If it reports more, or if later tosses differ.
pub fn a_stopped_batch_leaves_nothing_behind<E: Engine>(
    engine: &E,
    launches: &[Launch],
    enough: u64,
) {
    let mut workspace = engine.workspace();
    let iterator = launches.iter().copied();
    assert_eq!(
        count_until(engine, &mut workspace, iterator, enough),
        enough
    );
    let fresh = scalar_outcomes(engine, launches);
    for (launch, expected) in launches.iter().zip(&fresh) {
        let outcome = engine.toss(&mut workspace, launch, &mut ());
        assert_eq!(outcome, *expected, "{launch:?}");
    }
}

/// An observer, with samples or without, changes neither the outcome nor the events. Returns the
/// number of samples.
///
/// # Panics
/// If it does.
pub fn observers_change_nothing<E: Engine>(
    engine: &E,
    launches: &[Launch],
    rates_hz: &[f64],
) -> usize {
    let mut workspace = engine.workspace();
    let mut samples = 0;
    for launch in launches {
        let expected = engine.toss(&mut workspace, launch, &mut ());
        let mut recorder = Recorder::default();
        let recorded = engine.toss(&mut workspace, launch, &mut recorder);
        assert_eq!(recorded, expected, "{launch:?}");
        assert!(recorder.0.len() >= 2, "{launch:?}");
        for rate_hz in rates_hz {
            let mut sampler = Sampler::new(*rate_hz);
            let sampled = engine.toss(&mut workspace, launch, &mut sampler);
            assert_eq!(sampled, expected, "{launch:?} at {rate_hz} Hz");
            assert_eq!(sampler.events, recorder.0, "{launch:?} at {rate_hz} Hz");
            samples += sampler.samples.len();
        }
    }
    samples
}

/// A sample is bit-identical whatever the other samples are, and there are samples up to the end of
/// the toss and no further. i/100 and 10i/1000 are the same number.
///
/// # Panics
/// If a sample differs or is missing.
pub fn samples_do_not_depend_on_the_rate<E: Engine>(engine: &E, launches: &[Launch]) {
    let mut workspace = engine.workspace();
    for launch in launches {
        let [slow, fast] = [100.0, 1000.0].map(|rate_hz| {
            let mut sampler = Sampler::new(rate_hz);
            engine.toss(&mut workspace, launch, &mut sampler);
            sampler
        });
        let tenth: Vec<Event> = fast.samples.iter().step_by(10).copied().collect();
        assert_eq!(tenth, slow.samples);
        let end = slow.events.last().expect("an end").state.time_s;
        assert!(f64::from(fast.taken - 1) < end * fast.rate_hz);
        assert!(f64::from(fast.taken) >= end * fast.rate_hz);
    }
}

/// The launch with the coin's faces exchanged.
#[must_use]
pub fn flipped(launch: &Launch) -> Launch {
    Launch {
        axis: UnitVector3::new_unchecked(-launch.axis.into_inner()),
        ..*launch
    }
}

/// The coin's two faces are alike: u → −u changes the name of the face and nothing else.
///
/// # Panics
/// If anything else differs.
pub fn heads_and_tails_exchange<E: Engine>(engine: &E, launches: &[Launch]) {
    let mut workspace = engine.workspace();
    for (toss, launch) in launches.iter().enumerate() {
        let a = engine.toss(&mut workspace, launch, &mut ());
        let b = engine.toss(&mut workspace, &flipped(launch), &mut ());
        assert_eq!(turned(a.face()), b.face(), "toss {toss}");
        assert_eq!(counts(&a), counts(&b), "toss {toss}");
    }
}

/// Physics does not depend on the time: a coin that is launched as another flies by ends as that one does. The
/// rounding of a flight (1e-15) grows less than a thousandfold with each impact, so tosses of up to two
/// impacts with little contact end alike; of all others at most `most` do not. Returns the number of short ones.
///
/// # Panics
/// If more end otherwise.
pub fn a_later_start_ends_alike<E: Engine>(engine: &E, launches: &[Launch], most: usize) -> usize {
    let mut workspace = engine.workspace();
    let (mut short, mut changed) = (0, 0);
    for (toss, launch) in launches.iter().enumerate() {
        let mut recorder = Recorder::default();
        let expected = engine.toss(&mut workspace, launch, &mut recorder);
        let lands_s = recorder.0.get(1).map_or(0.0, |event| event.state.time_s);
        let mut instants = Instants::new(vec![0.3 * lands_s, 0.7 * lands_s]);
        engine.toss(&mut workspace, launch, &mut instants);
        for state in instants.seen {
            let later = Launch {
                height_m: state.position_m.z,
                velocity_m_s: state.velocity_m_s,
                axis: state.axis,
                spin_rad_s: state.spin_rad_s,
            };
            let found = engine.toss(&mut workspace, &later, &mut ());
            let differs = found.face() != expected.face();
            if expected.impacts <= 2 && expected.contact_steps < 50 {
                short += 1;
                assert!(!differs, "toss {toss}: {launch:?}");
            }
            changed += usize::from(differs);
        }
    }
    assert!(
        changed <= most,
        "{changed} of {} differ",
        2 * launches.len()
    );
    short
}

/// No impact and no contact phase gains more than `most` of the energy before it, and no flight
/// changes it by more than `most_drift`.
///
/// # Panics
/// If one does.
pub fn nothing_gains_energy<E: Engine>(
    engine: &E,
    scene: &Scene,
    launches: &[Launch],
    [most, most_drift]: [f64; 2],
) {
    let mut workspace = engine.workspace();
    for launch in launches {
        let mut extremes = Extremes::new(scene);
        engine.toss(&mut workspace, launch, &mut extremes);
        assert!(extremes.gain <= most, "{launch:?}: {extremes:?}");
        assert!(extremes.drift <= most_drift, "{launch:?}: {extremes:?}");
    }
}
