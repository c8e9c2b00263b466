//! Moreau's law against impulses that Clarabel and SciPy found from its definition (`make.py`).

use crate::common::{Case, body, parts, point};
use coinmc_volumetric::{Friction, Law};
use std::{env, fs};

/// A table of more states, by `make.py --count N --out FILE`.
const TABLE: &str = "COINMC_IMPULSES";

/// The state of a row of the table, and the impulse.
fn read(line: &str) -> (Case, [f64; 5]) {
    let numbers: Vec<f64> = line
        .split(',')
        .map(|cell| cell.parse().expect("a number"))
        .collect();
    let [
        ratio,
        sin,
        mu,
        contour,
        pivoting,
        e,
        x,
        y,
        approach,
        spin,
        turn,
        p @ ..,
    ] = &numbers[..]
    else {
        panic!("too few columns: {line}");
    };
    let body = body(*ratio);
    let friction = Friction {
        mu: *mu,
        contour: *contour,
        pivoting: *pivoting,
    };
    let point = point(&body, *sin, [*x, *y, *approach], [*spin, *turn]);
    let case = Case {
        body,
        friction,
        point,
        e: *e,
    };
    (case, p.try_into().expect("five parts of an impulse"))
}

/// To 1e-9 of the velocities: the table obeys the law to 1e-12 of them, and its least stiff directions are a
/// thousand times softer.
#[test]
fn moreaus_impulses_are_those_of_a_conic_solver() {
    let table = env::var(TABLE).map_or_else(
        |_| include_str!("impulses.csv").to_owned(),
        |path| fs::read_to_string(path).expect("the table of COINMC_IMPULSES"),
    );
    let (mut compared, mut slipping, mut worst) = (0, 0, 0.0_f64);
    for line in table.lines().skip(1) {
        let (case, expected) = read(line);
        let p = case.impulse(Law::Moreau);
        for (ours, theirs) in parts(&p).into_iter().zip(expected) {
            let off = (ours - theirs).abs() / case.size();
            worst = worst.max(off);
            assert!(off < 1e-9, "{line}\n{:?}", parts(&p));
        }
        compared += 1;
        slipping += usize::from(libm::hypot(p.x, p.y) > 0.999 * case.friction.mu * p.z);
    }
    println!("{compared} compared, {slipping} of them slip; they differ by {worst:.1e} at most");
    assert!(compared >= 300 && slipping > compared / 10 && slipping < compared);
}
