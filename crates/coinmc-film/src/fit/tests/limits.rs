//! What is fitted at all: sizes, ranges, and unknowns that the film determines.

use super::{aloft, at_the_truth, model};
use crate::drop::{Coordinate, FilmedDrop};
use crate::fit::covariance::is_determined;
use crate::fit::problem::{Problem, Task, Unknown};
use crate::fit::{FitError, Loss, MAX_DROPS, MAX_FRAMES, Options, check, check_points, fit};
use crate::parameter::{Parameter, Shared};
use crate::path::start_scales;
use crate::synthetic::Synthetic;

/// The units of the search are those of a coin that falls by its own size.
#[test]
fn units_of_the_search_are_those_of_the_coin() {
    let d = (0.01_f64 * 0.01 + 0.005 * 0.005).sqrt();
    let speed = (9.81 * d).sqrt();
    let units = start_scales(&model());
    for (unit, expected) in units.into_iter().zip([d, speed, d, speed, 1.0, speed / d]) {
        assert!((unit / expected - 1.0).abs() < 1e-12);
    }
}

/// An unknown is moved by a multiple of its unit, as far as its range goes.
#[test]
fn steps_end_at_the_end_of_a_range() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let mut problem = at_the_truth(&task, &[Parameter::Restitution, Parameter::Floor]);
    let units = start_scales(&model());
    let before = problem.clone();
    problem.shift(&[0.25, 2.0, 1.0, 0.0, 0.0, 3.0, 0.0, -1.0], 0.5);
    assert!((problem.point.shared.restitution - 0.625).abs() < 1e-15);
    assert!((problem.point.shared.floor_m - units[0]).abs() < 1e-15);
    let by = [0.5, 0.0, 0.0, 1.5, 0.0, -0.5];
    for place in 0..6 {
        let moved = problem.point.starts[0][place] - before.point.starts[0][place];
        assert!((moved - by[place] * units[place]).abs() < 1e-15);
    }
    problem.shift(&[1.0; 8], 0.5);
    assert_eq!(problem.point.shared.restitution, 1.0);
    assert_eq!([7, 8, 60].map(|usual| before.tries(usual)), [7, 8, 60]);
    let hasty = Problem {
        thorough: false,
        ..before
    };
    assert_eq!([7, 8, 60].map(|usual| hasty.tries(usual)), [1, 1, 8]);
}

/// A parameter is determined if all points together move by more than a standard deviation over the whole of its range, and a
/// state if they do over a thousand units.
#[test]
fn what_moves_nothing_is_not_determined() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let free = [Parameter::Friction, Parameter::PulseTime, Parameter::Floor];
    let problem = at_the_truth(&task, &free);
    let unit = Parameter::PulseTime.scale(&model().coin, 9.81);
    for (j, width) in [(0, 10.0), (1, (1.0 - 1e-7) / unit), (2, 1e3), (3, 1e3)] {
        let least = 1.0 / (width * width);
        assert!(is_determined(&problem, j, 1.001 * least), "{j}");
        assert!(!is_determined(&problem, j, 0.999 * least), "{j}");
    }
    for end in [0.0, 10.0] {
        let mut problem = problem.clone();
        problem.point.shared.friction = end;
        assert!(!is_determined(&problem, 0, 1e9));
    }
}

/// Which fits are refused before anything is computed: at the limits themselves none.
#[test]
fn only_fits_beyond_the_limits_are_refused() {
    let drop = aloft(1, 0.05);
    let checked = |drops: &[FilmedDrop], options: &Options| {
        let task = Task::new(model(), drops, Loss::Square);
        check(&task, options)
    };
    let options = Options::default();
    let few = |count| vec![drop.clone(); count];
    assert_eq!(checked(&few(1), &options), Ok(()));
    assert_eq!(checked(&few(MAX_DROPS), &options), Ok(()));
    assert_eq!(checked(&few(0), &options), Err(FitError::Drops(0)));
    assert_eq!(checked(&few(65), &options), Err(FitError::Drops(65)));
    assert_eq!(checked(&few(70), &options), Err(FitError::Drops(70)));
    for (confidence, fine) in [
        (0.0, false),
        (1.0, false),
        (1.5, false),
        (-0.5, false),
        (f64::NAN, false),
        (0.01, true),
    ] {
        let options = Options {
            confidence,
            ..Options::default()
        };
        assert_eq!(checked(&few(1), &options).is_ok(), fine, "{confidence}");
    }
    let long = |count: usize| {
        let frames = drop.frames.iter().copied().cycle().take(count).collect();
        FilmedDrop {
            name: "long".to_owned(),
            frames,
        }
    };
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    assert_eq!(checked(&[long(MAX_FRAMES)], &options), Ok(()));
    let too_long = FitError::TooLong {
        name: "long".to_owned(),
        frames: MAX_FRAMES + 1,
        max: MAX_FRAMES,
    };
    assert_eq!(checked(&[long(MAX_FRAMES + 1)], &options), Err(too_long));
    // 3 coordinates of 1,111,111 frames in 12 columns are the last to have fewer than 40 million derivatives
    let two = |frames| checked(&vec![long(frames); 8], &options);
    assert_eq!(two(34_722), Ok(()));
    assert_eq!(two(34_723), Err(FitError::TooLarge { frames: 8 * 34_723 }));
}

/// Where x was never marked, where the coin began is not asked for; its speed changes what friction does.
#[test]
fn a_place_that_was_not_marked_is_not_fitted() {
    let mut drops = [aloft(1, 0.05), aloft(2, 0.05)];
    for frame in &mut drops[0].frames {
        frame.seen[0] = None;
    }
    let task = Task::new(model(), &drops, Loss::Square);
    let of_first = (1..6).map(|place| Unknown::Start(0, place));
    let of_second = (0..6).map(|place| Unknown::Start(1, place));
    let expected: Vec<Unknown> = of_first.chain(of_second).collect();
    assert_eq!(at_the_truth(&task, &[]).unknowns, expected);
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    let fit = fit(&model(), &drops[..1], &options).unwrap();
    let coordinates: Vec<_> = fit.noise.iter().map(|noise| noise.coordinate).collect();
    assert_eq!(coordinates, [Coordinate::Z, Coordinate::Theta]);
    assert_eq!((fit.n, fit.fitted), (2 * 13, 5 + 2));
}

/// Of a film in wrong units, or with a wrong floor, the coin is through the floor from the beginning: no fit, and no panic.
#[test]
fn a_film_in_wrong_units_is_told_to_be_so() {
    let film = |length: f64| {
        let mut drop = Synthetic::default().film(&model()).expect("a film");
        for frame in &mut drop.frames {
            let [x, z, theta] = frame.seen;
            let scaled = |value: Option<f64>| value.map(|value| length * value);
            frame.seen = [scaled(x), scaled(z), theta];
        }
        drop
    };
    let wrong_floor = Options {
        shared: Shared {
            floor_m: 0.2,
            ..Shared::default()
        },
        ..Options::default()
    };
    for (length, options) in [(1e-3, Options::default()), (1.0, wrong_floor)] {
        let error = fit(&model(), &[film(length)], &options).unwrap_err();
        assert!(error.to_string().contains("check coin, units"), "{error}");
    }
}

/// As many points as fitted values are met by any law: of two frames, 6 points for a start of 6 numbers and 3 noises.
#[test]
fn more_points_are_needed_than_values_fitted() {
    let drops = [aloft(1, 0.05)];
    let task = Task::new(model(), &drops, Loss::Square);
    let checked = |frames| {
        let mut problem = at_the_truth(&task, &[]);
        problem.weighing.frames = vec![frames];
        check_points(&problem)
    };
    let few = |points| FitError::TooFew { points, fitted: 9 };
    assert_eq!(checked(2), Err(few(6)));
    assert_eq!(checked(3), Err(few(9)));
    assert_eq!(checked(4), Ok(()));
    let short = Options {
        until_s: 1e-4,
        ..Options::default()
    };
    let error = fit(&model(), &drops, &short).unwrap_err();
    assert!(
        matches!(error, FitError::TooFew { points: 3, .. }),
        "{error}"
    );
}
