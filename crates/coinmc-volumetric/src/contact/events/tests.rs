//! Events within a step, against the same motion in short steps, and against conservation.

use super::*;
use crate::body::Friction;
use crate::contact::Dynamics;
use crate::contact::integrator::{is_accepted, step};
use crate::contact::rim::{OMEGA_A, OMEGA_T, SLIP_X, SLIP_Y};
use crate::contact::rules::{ContactRules, Usage};
use crate::contact::tests::{STILL, dynamics};
use crate::toss::tests::model;
use coinmc_testkit::Dice;

const LENGTH: f64 = 0.2;

fn friction(mu: f64) -> Friction {
    Friction {
        mu,
        contour: 0.0,
        pivoting: 0.0,
    }
}

fn phase(dynamics: &Dynamics, state: RimState<f64>, mode: Mode) -> Phase {
    Phase {
        state,
        mode,
        now: dynamics.rates(&state, mode),
        ..Phase::none()
    }
}

/// The state a time `t` after the start of a phase, in steps so short that their error does not count.
fn after(dynamics: &Dynamics, phase: &Phase, t: f64) -> RimState<f64> {
    let mut state = phase.state;
    for _ in 0..50 {
        let rates = |at: &RimState<f64>| dynamics.rates(at, phase.mode).state;
        state = step(&state, &rates(&state), t / 50.0, 1.0, rates).state;
    }
    state
}

/// The time before `high` at which `passed` becomes true.
fn first_time(high: f64, passed: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, high);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if passed(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// A coin on a smooth surface, the tilt of which rises and, as the coin spins, turns halfway through a step; the
/// time when it turns, and the tilt then.
fn turning(trial: u64) -> Option<(Dynamics, Phase, f64, f64)> {
    let mut dice = Dice::new(845, trial);
    let dynamics = dynamics(dice.between(0.3, 2.0), friction(0.0), STILL, true);
    let mut part = || dice.between(-2.0, 2.0);
    let mut state = [0.0, 0.0, part(), part(), part(), part()];
    state[TILT] = dice.between(0.9, 1.4);
    let slows = -dynamics.rates(&state, Mode::Slip).state[OMEGA_Y];
    if slows < 0.5 {
        return None;
    }
    state[OMEGA_Y] = 0.5 * LENGTH * slows;
    let phase = phase(&dynamics, state, Mode::Slip);
    if phase.now.press < 0.1 {
        return None;
    }
    let time = first_time(LENGTH, |t| after(&dynamics, &phase, t)[OMEGA_Y] < 0.0);
    let end = after(&dynamics, &phase, LENGTH);
    let highest = after(&dynamics, &phase, time)[TILT];
    let returns = end[TILT] < state[TILT] + 0.2 * (highest - state[TILT]);
    (returns && holds(&dynamics, Mode::Slip, &dynamics.rates(&end, Mode::Slip)))
        .then_some((dynamics, phase, time, highest))
}

fn solver<'a>(rules: ContactRules<'a>, dynamics: &'a Dynamics, side: f64) -> ContactSolver<'a> {
    ContactSolver {
        rules: ContactRules {
            dynamics,
            side,
            ..rules
        },
        usage: Usage::default(),
    }
}

/// The other rim is not missed if it touches and has risen again by the end of the step, or by when the mode ends;
/// where the tilt turns before, the step goes on and the turning point counts.
#[test]
fn a_rim_that_touches_within_a_step_ends_it_there() {
    let model = model();
    let mut checked = 0;
    for trial in 0..400 {
        let Some((dynamics, start, turns, highest)) = turning(trial) else {
            continue;
        };
        checked += 1;
        let share = Dice::new(846, trial).between(0.3, 0.95);
        let side = start.state[TILT] + share * (highest - start.state[TILT]);
        let touches = first_time(turns, |t| after(&dynamics, &start, t)[TILT] > side);
        let there = after(&dynamics, &start, touches);
        let mut solver = solver(model.contact_rules(), &dynamics, side);
        for length in [LENGTH, 1.02 * turns] {
            let (tried, mut now) = solver.try_step(&start, length);
            let mut phase = start;
            solver.usage.steps = 0;
            let (next, time) = if length == LENGTH {
                solver.accept(&mut phase, &tried, &now, length, 0.3)
            } else {
                // the mode ends with the step
                now.press = 0.0;
                solver.end_mode(&mut phase, &tried, &now, length, 0.3)
            };
            assert!(matches!(next, PhaseTransition::Leave(Exit::OtherRim)));
            assert!((time - touches).abs() < 1e-5 * LENGTH, "{time} {touches}");
            assert_eq!(phase.state[TILT].to_bits(), side.to_bits());
            let off = (0..6).map(|i| (phase.state[i] - there[i]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-4);
            assert!((1..20).contains(&solver.usage.steps));
        }

        solver.rules.side = highest + 0.1 * (highest - start.state[TILT]);
        let (tried, now) = solver.try_step(&start, LENGTH);
        let mut phase = start;
        let (next, time) = solver.accept(&mut phase, &tried, &now, LENGTH, 0.3);
        assert!(matches!(next, PhaseTransition::Stay));
        assert_eq!((time, phase.length, phase.turning_points), (LENGTH, 0.3, 1));
        assert_eq!(phase.state, tried.state);
        assert!(phase.tilts.iter().all(|tilt| (tilt - highest).abs() < 1e-4));
    }
    assert!(checked > 30, "{checked}");
}

/// A mode ends when the coin no longer presses, or when friction can no longer hold it: to a few thousandths of the
/// step, and not before.
#[test]
fn a_mode_ends_within_its_step() {
    let model = model();
    let mut ends = [0; 2];
    for trial in 0..4_000 {
        let mut dice = Dice::new(847, trial);
        let sticks = dice.chance();
        let (mu, mode) = if sticks {
            (0.3, Mode::Stick)
        } else {
            (0.0, Mode::Slip)
        };
        let dynamics = dynamics(dice.between(0.3, 2.0), friction(mu), STILL, true);
        let mut part = || dice.between(-1.5, 1.5);
        let mut state = [0.9, part(), part(), part(), 0.0, 0.0];
        state[TILT] += 0.2 * part();
        let start = phase(&dynamics, state, mode);
        let excess = |t: f64| {
            let now = dynamics.rates(&after(&dynamics, &start, t), mode);
            let held = mu * now.normal - libm::hypot(now.friction[0], now.friction[1]);
            if sticks {
                held.min(now.press)
            } else {
                now.press
            }
        };
        if excess(0.0) < 0.02 || excess(LENGTH) > -0.02 {
            continue;
        }
        let end = first_time(LENGTH, |t| excess(t) < 0.0);
        let mut solver = solver(model.contact_rules(), &dynamics, 10.0);
        let (tried, now) = solver.try_step(&start, LENGTH);
        if !is_accepted(tried.error) {
            continue;
        }
        let mut left = start;
        let (next, time) = solver.accept(&mut left, &tried, &now, LENGTH, 0.3);
        let late = (time - end) / LENGTH;
        assert!((-1e-3..6e-3).contains(&late), "{trial} {late}");
        let there = after(&dynamics, &start, time);
        let off = (0..6).map(|i| (left.state[i] - there[i]).abs());
        assert!(off.fold(0.0, f64::max) < 1e-3);
        assert_eq!(left.length, 0.3);
        let lifts = dynamics.rates(&there, mode).press <= 0.0;
        ends[usize::from(sticks)] += 1;
        if lifts {
            assert!(matches!(next, PhaseTransition::Leave(Exit::LiftOff)));
        } else {
            assert!(matches!(next, PhaseTransition::ChangeMode));
        }
    }
    assert!(ends.iter().all(|count| *count > 20), "{ends:?}");
}

/// A smooth coin's tilt goes between two tilts of the same energy, with the spin and the vertical angular momentum that
/// it has: at the third turning point the toss is known to repeat itself, and decided if both lie in one well.
#[test]
fn a_motion_that_repeats_itself_turns_where_its_energy_is_all_potential() {
    let mut model = model();
    model.dynamics.friction = friction(0.0);
    let (body, half) = (model.dynamics.body, model.rule.balance());
    let mut checked = 0;
    for trial in 0..300 {
        let mut dice = Dice::new(848, trial);
        let tilt = dice.between(0.5, 1.4);
        let (s, c) = libm::sincos(tilt);
        let [wy, wa, wt] = [0.5, 4.0, 4.0].map(|size| dice.between(-size, size));
        let mut state = [tilt, wy, wa, wt, 0.0, 0.0];
        // the centre does not move along
        state[SLIP_X] = -wy * (body.half * c + body.radius * s);
        state[SLIP_Y] = body.radius * wa + body.half * wt;
        let mut phase = phase(&model.dynamics, state, Mode::Slip);
        phase.length = 0.1;
        let mut solver = model.contact_solver(Usage::default());
        let exit = (0..1_000).find_map(|_| match solver.take_step(&mut phase).0 {
            PhaseTransition::Leave(exit) => Some(exit),
            _ => None,
        });
        if phase.turning_points < 3 {
            continue;
        }
        checked += 1;
        let vertical = body.ka * wa * c - body.kt * wt * s;
        let energy = |tilt: f64| {
            let (s, c) = libm::sincos(tilt);
            let turn = (body.ka * wa * c - vertical) / (body.kt * s);
            body.half * c + body.radius * s + 0.5 * body.kt * turn * turn
        };
        let rx = body.radius * c - body.half * s;
        let whole = energy(tilt) + 0.5 * (body.kt + rx * rx) * wy * wy;
        for at in phase.tilts {
            assert!(
                (energy(at) / whole - 1.0).abs() < 2e-3,
                "{trial} {at} {tilt}"
            );
        }
        let [least, most] = phase.tilts.map(libm::cos);
        assert!(phase.tilts[0] <= tilt + 1e-3 && tilt <= phase.tilts[1] + 1e-3);
        let expected = if least < half {
            Exit::Decided(Decided::Side)
        } else if most > half {
            Exit::Decided(Decided::Face)
        } else {
            Exit::NeverSettles
        };
        assert_eq!(exit, Some(expected), "{:?}", phase.tilts);
    }
    assert!(checked > 30, "{checked}");
}

/// Two extremes in one well decide the face; those in both, or too close to the balance to tell, do not.
#[test]
fn a_motion_that_repeats_itself_in_one_well_is_decided() {
    let model = model();
    let mut solver = model.contact_solver(Usage::default());
    let balance = libm::acos(model.rule.balance());
    let exit = |solver: &ContactSolver<'_>, tilts: [f64; 2]| {
        let mut phase = Phase::none();
        for tilt in tilts.into_iter().chain([tilts[0]]) {
            phase.count_turning_point(balance + tilt);
        }
        match solver.after_step(&phase) {
            PhaseTransition::Leave(exit) => exit,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(exit(&solver, [0.01, 0.2]), Exit::Decided(Decided::Side));
    assert_eq!(exit(&solver, [-0.2, -0.01]), Exit::Decided(Decided::Face));
    assert_eq!(exit(&solver, [0.1, -0.1]), Exit::NeverSettles);
    let near = 0.5 * BALANCE_ERROR;
    assert_eq!(exit(&solver, [near, 0.2]), Exit::NeverSettles);
    assert_eq!(exit(&solver, [-near, -0.2]), Exit::NeverSettles);
    let scene = coinmc_testkit::scene(0.4, 0.5, 0.3);
    let whole = coinmc_core::DecisionRule::new(&scene, false, 1e-3);
    solver.rules.rule = &whole;
    assert_eq!(exit(&solver, [0.01, 0.2]), Exit::NeverSettles);
}

/// A tilt that stays as it is has no turning point.
#[test]
fn a_coin_that_does_not_tilt_does_not_turn() {
    let model = model();
    let state = [1.2, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut phase = phase(&model.dynamics, state, Mode::Stick);
    let mut solver = model.contact_solver(Usage::default());
    let tried = step(&state, &[0.0; 6], 0.1, 1.0, |_: &_| [0.0; 6]);
    let now = phase.now;
    for _ in 0..5 {
        let (next, _) = solver.accept(&mut phase, &tried, &now, 0.1, 0.1);
        assert!(matches!(next, PhaseTransition::Stay));
    }
    assert_eq!(phase.turning_points, 0);
}

/// A slip ends where it is slow, slows down and friction can hold the point, or where it is so slow that its direction
/// is lost.
#[test]
fn a_slip_ends_where_it_slows_down_and_can_stick() {
    let model = model();
    let solver = model.contact_solver(Usage::default());
    let mut smooth = model.dynamics;
    smooth.friction.mu = 0.0;
    let slow = solver.rules.stick_speed;
    let mut held = [0; 2];
    for trial in 0..500 {
        let mut dice = Dice::new(849, trial);
        let mut part = || dice.between(-1.0, 1.0);
        let state = [1.0 + 0.4 * part(), part(), part(), part(), 0.0, 0.0];
        let direction = part();
        let (sin, cos) = libm::sincos(4.0 * direction);
        let ends = |speed: f64, along: f64| {
            let mut state = state;
            (state[SLIP_X], state[SLIP_Y]) = (speed * slow * cos, speed * slow * sin);
            let mut slips = phase(&model.dynamics, state, Mode::Slip);
            // across as well
            slips.now.state[SLIP_X] = along * cos - 0.7 * sin;
            slips.now.state[SLIP_Y] = along * sin + 0.7 * cos;
            slips
        };
        let can = can_stick(&model.dynamics, &model.dynamics.rates(&state, Mode::Stick));
        let found = [1.01, 0.5, 0.11, 0.09].map(|speed| solver.slip_ends(&ends(speed, -0.3)));
        // the slip that is taken away changes the forces a little
        let sure = [0.5, 0.11].map(|speed| {
            let without = change_slip(&model.dynamics, &ends(speed, 0.0).state, 0.0, 0.0);
            can_stick(
                &model.dynamics,
                &model.dynamics.rates(&without, Mode::Stick),
            ) == can
        });
        if sure == [true; 2] {
            held[usize::from(can)] += 1;
            assert_eq!(found, [false, can, can, true]);
        }
        assert!(
            ![1.01, 0.5, 0.09]
                .iter()
                .any(|v| solver.slip_ends(&ends(*v, 0.3)))
        );
        let smooth = ContactSolver {
            rules: ContactRules {
                dynamics: &smooth,
                ..solver.rules
            },
            usage: Usage::default(),
        };
        assert!(!smooth.slip_ends(&ends(0.05, -0.3)));
    }
    assert!(held.iter().all(|count| *count > 50), "{held:?}");
}

/// A tilt with a constant acceleration turns where its rate has gone, whether it rises or falls before.
#[test]
fn a_tilt_turns_where_its_rate_vanishes() {
    for trial in 0..200 {
        let mut dice = Dice::new(850, trial);
        let turns = dice.between(0.02, 0.98) * LENGTH;
        let rate = dice.between(-1.0, 1.0);
        let slows = rate / turns;
        let start = [0.8, rate, 0.1, 0.2, 0.3, 0.4];
        let rates = |at: &RimState<f64>| [at[OMEGA_Y], -slows, 0.0, 0.0, 0.0, 0.0];
        let tried = step(&start, &rates(&start), LENGTH, 1.0, rates);
        let mut phase = Phase::none();
        phase.state = start;
        let (fraction, state) = turning_point(&phase, &tried);
        let late = fraction - turns / LENGTH;
        assert!((-1e-12..=TURNING_POINT_WIDTH).contains(&late), "{late}");
        let t = fraction * LENGTH;
        assert!((state[TILT] - 0.8 - t * (rate - 0.5 * slows * t)).abs() < 1e-13);
        assert!((state[OMEGA_Y] - rate + slows * t).abs() < 1e-13);
        assert!((state[OMEGA_A] - 0.1).abs() < 1e-15 && (state[OMEGA_T] - 0.2).abs() < 1e-15);
    }
}
