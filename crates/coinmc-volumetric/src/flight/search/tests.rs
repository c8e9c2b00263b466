//! The bounds of the search against the flights that they bound.

use super::*;
use crate::drag::Drag;
use crate::flight::OneRim;
use crate::flight::tests::motion;
use coinmc_core::Coin;
use coinmc_testkit::Dice;

const AIRLESS: Drag = Drag {
    linear: 0.0,
    angular: 0.0,
};

fn body(ratio: f64) -> Body {
    Body::new(&Coin::cylinder(ratio, 0.01).expect("a good coin"))
}

fn bounds_of(orbit: &Orbit<f64>, body: &Body) -> Bounds<f64> {
    orbit.bounds(&orbit.extent(body))
}

/// A step of the lower bounds passes no contact of its rim, in air and without, flat or upright.
#[test]
fn no_rim_touches_within_its_step() {
    let mut steps = 0;
    for trial in 0..2_000 {
        let mut dice = Dice::new(856, trial);
        let body = body(dice.scale(0.05, 5.0));
        let mut start = motion(&body, trial, dice.chance());
        if dice.chance() {
            let sin = dice.scale(1e-4, 0.05);
            start.set_tilt(sin, (1.0 - sin * sin).sqrt());
        }
        let drag = Drag {
            linear: dice.between(-2.0, 2.0).max(0.0),
            angular: dice.between(-2.0, 2.0).max(0.0),
        };
        let orbit = Orbit::new(&start, drag);
        let bounds = bounds_of(&orbit, &body);
        let from = dice.between(-0.5, 0.5).max(0.0);
        let now = orbit.gap(&body, from);
        if now.height < 0.0 {
            continue;
        }
        let (own, other) = lower_bound_steps(&orbit, &body, &bounds, &now);
        for (step, end) in [(own, 1.0), (other, -1.0)] {
            steps += usize::from(step > 1e-3);
            for i in 1..=40 {
                let then = orbit.gap(&body, from + step.min(20.0) * f64::from(i) / 40.0);
                let uz = then.uz * end * 1.0_f64.copysign(now.uz);
                let gap = then.z - body.half * uz - body.radius * then.sin;
                assert!(
                    gap > -1e-12 * (1.0 + then.z.abs()),
                    "{trial} {end} {gap:e} {step}"
                );
            }
        }
    }
    assert!(steps > 1_000, "{steps}");
}

/// The steps are close to the time of contact where they have to be: for a flat coin that hardly turns, for one whose
/// axis comes to the vertical along a radius, for one that tilts from it, and for one that has just lifted off.
#[test]
fn steps_come_close_to_the_contact() {
    let body = body(0.4);
    // sine, ω_y, speed of the rim's gap, gap
    for (sin, tilts, speed, height) in [
        (0.02, -0.01, 0.0, 0.1),
        (0.02, 0.01, 0.05, 0.1),
        (0.001, -1.0, -0.05, 1e-5),
        (0.0, 0.7, -0.6, 1e-3),
    ] {
        let mut start = Motion::still();
        start.set_tilt(sin, 1.0);
        start.oy = tilts;
        start.vz = speed + tilts * body.radius;
        start.z = start.rest_height(&body) + height;
        if sin == 0.0 {
            start.vz = speed;
        }
        let orbit = Orbit::new(&start, AIRLESS);
        let bounds = bounds_of(&orbit, &body);
        let now = orbit.first_gap(&body);
        let (own, _) = lower_bound_steps(&orbit, &body, &bounds, &now);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if orbit.gap(&body, middle).height > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let share = own / low;
        assert!((0.97..=1.0 + 1e-6).contains(&share), "{sin} {own} {low}");
    }
    let lifts = lifting(&body, AIRLESS);
    let now = lifts.first_gap(&body);
    assert!(now.height.abs() < 1e-15 && now.slope.abs() < 1e-15 && now.curvature > 0.5);
    let (own, _) = lower_bound_steps(&lifts, &body, &bounds_of(&lifts, &body), &now);
    assert!(own > 0.01, "{own}");
}

/// A gap that widens from 0 stays open until the bound of its third derivative could have closed it: where
/// f' t + f'' t²/2 = J t³/6.
#[test]
fn a_widening_gap_stays_open_as_long_as_its_third_derivative_allows() {
    let body = body(0.4);
    let orbit = lifting(&body, AIRLESS);
    let bounds = bounds_of(&orbit, &body);
    for (slope, curvature) in [(0.0, 0.03), (0.0, 0.2), (1e-3, 0.03)] {
        let now = Gap {
            slope,
            curvature,
            ..orbit.first_gap(&body)
        };
        let (jerk, until) = bounds.jerk(&body, now.sin, 1.0 / now.sin);
        let step = widening_step(&body, &bounds, &now, 1.0 / now.sin);
        assert!(0.0 < step && step < until, "{step} {until}");
        let closes = now.slope + step * (now.curvature / 2.0 - step * jerk / 6.0);
        assert!(closes.abs() < 1e-12, "{slope} {closes}");
    }
}

/// A coin whose lowest point leaves the surface by its acceleration alone.
fn lifting(body: &Body, drag: Drag) -> Orbit<f64> {
    let mut start = Motion::still();
    start.set_tilt(0.6, 0.8);
    (start.ox, start.oy, start.oz) = (0.3, 2.0, -0.2);
    start.z = start.rest_height(body);
    start.vz = start.oy * (body.radius * 0.8 - body.half * 0.6);
    Orbit::new(&start, drag)
}

/// Near the surface each step doubles the least one; a point that sinks by no more than rounding recedes, one that
/// sinks faster touches, and after a launch every one that sinks.
#[test]
fn a_point_that_recedes_is_left_in_growing_steps() {
    let body = body(0.4);
    let air = Drag {
        linear: 0.2,
        angular: 0.1,
    };
    let mut orbit = lifting(&body, air);
    let extent = orbit.extent(&body);
    let bounds = orbit.bounds(&extent);
    let now = Gap {
        slope: 0.0,
        height: 0.0,
        ..orbit.first_gap(&body)
    };
    let begun = |orbit: &mut Orbit<f64>, launched| Search::new(orbit, &extent, launched, 1e-6);
    let mut search = begun(&mut orbit, false);
    for total in [1e-6, 3e-6, 7e-6, 15e-6] {
        search.approach(&orbit, &body, &bounds, &now);
        assert!((search.time / total - 1.0).abs() < 1e-9 && search.active);
    }
    assert!((search.least / 16e-6 - 1.0).abs() < 1e-12);

    let rounding = 1e-13 * (now.vz.abs() + bounds.wander);
    for (launched, time, slope, touches) in [
        (false, 0.0, -1e-3, false),
        (false, 1e-3, -0.9 * rounding, false),
        (false, 1e-3, -1.1 * rounding, true),
        (true, 1e-3, -0.9 * rounding, true),
        (true, 0.0, -1e-3, true),
        (true, 0.0, 1e-3, false),
        (false, 1e-3, 1e-3, false),
    ] {
        let mut search = begun(&mut orbit, launched);
        search.time = time;
        search.approach(&orbit, &body, &bounds, &Gap { slope, ..now });
        assert_eq!(!search.active, touches, "{launched} {time} {slope}");
        assert!(touches || search.time > time);
    }
}

/// A bracket holds one root, and the gap sinks throughout; that of a coin that does not turn ends at the contact.
#[test]
fn a_bracket_holds_the_only_root() {
    let mut bracketed = 0;
    for trial in 0..1_000 {
        let mut dice = Dice::new(857, trial);
        let body = body(dice.scale(0.05, 5.0));
        let mut start = motion(&body, trial, false);
        let still = dice.chance();
        if still {
            (start.ox, start.oy, start.oz) = (0.0, 0.0, 0.0);
        }
        let orbit = Orbit::new(&start, AIRLESS);
        let extent = orbit.extent(&body);
        let bounds = orbit.bounds(&extent);
        let mut search = Search::new(&mut orbit.clone(), &extent, true, 1e-9);
        search.time = dice.between(0.0, 0.5);
        let now = orbit.gap(&body, search.time);
        if now.height <= 0.0 {
            continue;
        }
        search.bracket(&orbit, &bounds, &now, now.slope < 0.0);
        if !search.bracketed {
            assert!(!still || now.slope >= 0.0);
            continue;
        }
        bracketed += 1;
        assert_eq!(search.low, search.time);
        let end = orbit.gap(&body, search.high);
        assert!(end.height <= 1e-13 * (1.0 + now.height));
        for i in 0..=50 {
            let t = search.low + (search.high - search.low) * f64::from(i) / 50.0;
            assert!(orbit.gap(&body, t).slope < 1e-12);
        }
        assert!(!still || end.height.abs() < 1e-11 * (1.0 + now.height));
    }
    assert!(bracketed > 200, "{bracketed}");
}

/// A short Newton step ends the search, but not beyond the kink where the other rim becomes the lowest (a rim alone has
/// none); a step out of the bracket is replaced by its middle.
#[test]
fn a_search_closes_in_by_newtons_method_or_halves() {
    let body = body(0.4);
    let orbit = lifting(&body, AIRLESS);
    let one = OneRim {
        radius: 0.8,
        half: 0.3,
        end: 1.0,
    };
    let gap = Gap {
        height: 2e-6,
        slope: -1.0,
        curvature: -0.5,
        uz: 0.3,
        uz_rate: -2.0,
        ..orbit.first_gap(&one)
    };
    let open = Search {
        time: 0.5,
        low: 0.4,
        high: 1.0,
        bracketed: true,
        active: true,
        least: 1e-6,
        departs: false,
        launched: true,
    };
    // 2e-6 = t + t²/4
    let root = 2e-6 - 1e-12;
    for (uz, resolved) in [(0.3, true), (3e-6, false), (-0.3, true)] {
        let mut search = open;
        search.close_in(&orbit, &Gap { uz, ..gap });
        assert_eq!(!search.active, resolved, "{uz}");
        assert!((search.time - 0.5 - root).abs() < 1e-15);
        assert_eq!((search.low, search.high), (0.5, 1.0));
        let mut alone = open;
        alone.close_in_on::<OneRim>(&orbit, &Gap { uz, ..gap });
        assert!(!alone.active);
    }
    for (height, slope, ends) in [(0.2, 0.1, (0.5, 1.0)), (-0.2, -0.1, (0.4, 0.5))] {
        let mut search = open;
        search.close_in(
            &orbit,
            &Gap {
                height,
                slope,
                ..gap
            },
        );
        assert_eq!((search.low, search.high), ends);
        let middle = 0.5 * (ends.0 + ends.1);
        assert!(search.active && (height < 0.0 || search.time > 0.5));
        assert!(search.time >= ends.0 && search.time <= ends.1, "{middle}");
    }
}

/// Over half of its way to the vertical, at the speed that it has, the horizontal part of the axis grows at the chord's
/// rate on average.
#[test]
fn the_chord_spans_half_of_the_way() {
    let orbit = lifting(&body(0.4), AIRLESS);
    for trial in 0..100 {
        let mut dice = Dice::new(858, trial);
        let mut part = || dice.between(-0.7, 0.7);
        let (across, across_rate) = ([part(), part()], [4.0 * part(), 4.0 * part()]);
        let sin = libm::hypot(across[0], across[1]);
        let now = Gap {
            sin,
            across,
            across_rate,
            ..orbit.first_gap(&body(0.4))
        };
        let (slope, until) = chord(&now);
        let speed = libm::hypot(across_rate[0], across_rate[1]);
        assert!((speed * until - 0.5 * sin).abs() < 1e-15);
        let [x, y] = [0, 1].map(|i| across[i] + across_rate[i] * until);
        let grows = libm::hypot(x, y) - sin;
        assert!((slope * until - grows).abs() < 3e-15 && slope * until >= grows - 1e-16);
    }
}

/// The first root is where the parabola crosses zero downwards for the first time, if it does.
#[test]
fn the_first_root_is_the_first_crossing() {
    let mut never = 0;
    for trial in 0..500 {
        let mut dice = Dice::new(859, trial);
        let (gap, slope) = (dice.between(0.0, 1.0), dice.between(-1.0, 1.0));
        let bend = dice.between(-2.0, 2.0);
        let at = |t: f64| gap + t * (slope - 0.5 * bend * t);
        let root = first_root(gap, slope, bend);
        never += i32::from(root == NEVER);
        if root < NEVER {
            assert!(at(root).abs() < 1e-12 * (1.0 + root * root) && slope < bend * root);
        }
        for i in 0..100 {
            assert!(at(root.min(50.0) * 0.01 * f64::from(i)) > 0.0);
        }
    }
    assert!((50..400).contains(&never), "{never}");
}
