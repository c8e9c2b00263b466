//! Launches with extreme numbers, and tests that must not hang.

use crate::Dice;
use coinmc_core::Launch;
use std::sync::mpsc;
use std::time::Duration;

/// Numbers at and beyond the limits of any engine.
const EXTREME: [f64; 17] = [
    0.0,
    -0.0,
    1e-300,
    -1e-9,
    0.01,
    -3.0,
    30.0,
    1e4,
    -1e4,
    1e9,
    -1e9,
    1e150,
    1e300,
    -1e300,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// Moderate numbers, up to two of them replaced by extreme ones: with more, most tosses would end
/// at once.
pub fn replace_two<const N: usize>(dice: &mut Dice) -> [f64; N] {
    let mut numbers = [(); N].map(|()| dice.pick(&[0.01, 0.1, 1.0, 10.0]));
    let indices: [usize; N] = std::array::from_fn(|i| i);
    for _ in 0..2 {
        let which = dice.pick(&indices);
        numbers[which] = dice.pick(&EXTREME);
    }
    numbers
}

/// Whether every number of a launch but its axis is finite.
pub fn is_finite(launch: &Launch) -> bool {
    let vectors = [launch.velocity_m_s, launch.spin_rad_s];
    launch.height_m.is_finite() && vectors.iter().flatten().all(|number| number.is_finite())
}

/// Runs `work` on a thread and fails if it takes more than two minutes, so that a hang is a failure
/// and not a stuck test. `work` should take ten seconds at most.
///
/// # Panics
/// If the time is up, or if `work` panics.
pub fn within_two_minutes(work: impl FnOnce() + Send + 'static) {
    let (done, wait) = mpsc::channel();
    let worker = std::thread::spawn(move || {
        work();
        // the receiver is gone only after the time is up
        let _ = done.send(());
    });
    match wait.recv_timeout(Duration::from_mins(2)) {
        Err(mpsc::RecvTimeoutError::Timeout) => panic!("a toss hangs"),
        _ => worker.join().expect("no panic"),
    }
}
