//! Tests of sustained contact of one rim on rough ground.

mod touch;

use super::super::test_scenes::{Rough, leaning};
use super::*;
use crate::contact::Usage;
use crate::laws::Moreau;
use crate::model::Model;
use crate::toss::Toss;
use coinmc_core::{Event, State};
use nalgebra::Vector3;

/// Gives a coin in contact this spin, and the velocity of its centre with which the contact point slips like this.
fn set_motion(toss: &mut Toss, model: &Model<Moreau>, spin: Spin<f64>, slip: [f64; 2]) {
    let (body, m) = (&model.dynamics.body, &mut toss.motion);
    toss.spin = spin;
    (m.vx, m.vy, m.vz) = (0.0, 0.0, 0.0);
    let point = m.contact_point(body, &spin);
    m.vx = slip[0] - point.slip_x;
    m.vy = slip[1] - point.slip_y;
    m.vz = -point.approach;
    m.set_spin(&spin, model.dynamics.axial_factor);
}

const ROLLING: Spin<f64> = Spin {
    axial: 0.9,
    turn: -0.2,
    tilt: 0.1,
};

/// Momentum, and angular momentum about the lowest point of the own rim.
fn momenta(walk: &Walk<'_, Moreau, ()>) -> [Vector3<f64>; 2] {
    let (m, spin, body) = (&walk.toss.motion, &walk.toss.spin, walk.body());
    let own = Vector3::new(m.sin, 0.0, m.cos) * (body.ka * spin.axial)
        + Vector3::new(m.cos, 0.0, -m.sin) * (body.kt * spin.turn)
        + Vector3::y() * (body.kt * spin.tilt);
    let velocity = Vector3::new(m.vx, m.vy, m.vz);
    let point = m.contact_point(body, spin);
    let centre = -Vector3::new(point.rx, 0.0, point.rz);
    [velocity, own + centre.cross(&velocity)]
}

/// An impulse at the contact point that changes its normal velocity by so much leaves its slip and the angular momentum
/// about it as they were.
#[test]
fn a_bend_changes_the_normal_velocity_of_the_contact_point_alone() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.4, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.2, -0.3]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    for change in [0.07, -0.04] {
        let point = |walk: &Walk<'_, Moreau, ()>| {
            walk.toss.motion.contact_point(walk.body(), &walk.toss.spin)
        };
        let (before, [_, angular]) = (point(&walk), momenta(&walk));
        walk.change_normal_velocity(change);
        let (after, [_, now]) = (point(&walk), momenta(&walk));
        assert!((after.approach - before.approach - change).abs() < 1e-13);
        assert!((after.slip_x - before.slip_x).abs() < 1e-13);
        assert!((after.slip_y - before.slip_y).abs() < 1e-13);
        assert!((now - angular).norm() < 1e-13, "{now} {angular}");
    }
}

/// Downwards a rim follows a bend while it would fall faster by itself, and else leaves the ground. Upwards it follows what a
/// hollow of its own curvature has, w²κ t, and the rest is an impact.
#[test]
fn a_rim_follows_bends_that_it_can() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let (time, press) = (0.05, 0.8);
    let follows = Next::Goes(Touch::Rim);
    for (share, upwards, expected) in [
        (0.98, false, follows),
        (1.02, false, Next::Goes(Touch::Nothing)),
        (0.98, true, follows),
        (1.02, true, Next::Impact),
    ] {
        let mut toss = leaning(&model, 0.05, [0.0; 3]);
        set_motion(&mut toss, &model, ROLLING, [0.0, -0.4]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let [own, _] = rim_points(walk.body(), &walk.toss.motion, &walk.toss.spin);
        let [wx, wy] = own.velocity();
        let curvature = walk.toss.motion.sin / walk.body().radius;
        let smooth = (wx * wx + wy * wy) * curvature * time;
        let bend = share * if upwards { smooth } else { -press * time };
        let before = walk.approach();
        walk.budget = walk.energy() + 0.1;
        walk.lead = -0.1;
        assert_eq!(
            walk.follow_bend(bend, press, time),
            expected,
            "{share} {upwards}"
        );
        let followed = before - walk.approach();
        match expected {
            Next::Impact => assert!((followed - smooth).abs() < 1e-12, "{followed} {smooth}"),
            Next::Goes(Touch::Rim) => {
                assert!((followed / bend - 1.0).abs() < 0.05, "{followed} {bend}");
            }
            _ => assert!(followed.abs() < 1e-12),
        }
    }
}

/// A coin that leans and that friction cannot hold begins to slip against the friction that would, as fast as a slip may be
/// that counts as none. One that slips already, though slowly, goes on slipping as it does.
#[test]
fn a_coin_that_friction_cannot_hold_begins_to_slip_against_it() {
    let rough = Rough {
        friction: 0.02,
        ..Rough::of(0.7, 0.02)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    let stick = model.contact_rules().stick_speed;
    let mut toss = leaning(&model, 0.3, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.0, 0.0]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let held = rim_state(&model.dynamics, &walk.toss.motion, &walk.toss.spin);
    let [fx, fy] = model.dynamics.rates(&held, Mode::Stick).friction;
    let contact = walk.contact();
    let [x, y] = [contact.state[SLIP_X], contact.state[SLIP_Y]];
    assert_eq!(contact.mode, Mode::Slip);
    assert!((slip_speed(&contact.state) / stick - 1.0).abs() < 1e-9);
    assert!((x * fy - y * fx).abs() < 1e-9 * stick && x * fx + y * fy < 0.0);
    let mut toss = leaning(&model, 0.3, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.3 * stick, 0.4 * stick]);
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let contact = walk.contact();
    assert_eq!(contact.mode, Mode::Slip);
    assert!((slip_speed(&contact.state) / stick - 0.5).abs() < 1e-9);
}

/// What is asked of the slip is what it is then, and the point neither rises nor falls for it; the angular momentum about it
/// is what it was.
#[test]
fn a_given_slip_comes_by_an_impulse_at_the_contact_point() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.4, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.2, -0.3]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let [_, angular] = momenta(&walk);
    let state = walk.with_slip(0.05, 0.07);
    assert_eq!([state[SLIP_X], state[SLIP_Y]], [0.05, 0.07]);
    let (mut motion, mut spin) = (Motion::still(), Spin::still());
    place_unfolded(&model.dynamics, &state, &mut motion, &mut spin);
    (walk.toss.motion, walk.toss.spin) = (motion, spin);
    let point = motion.contact_point(walk.body(), &spin);
    let [_, now] = momenta(&walk);
    assert!(point.approach.abs() < 1e-13, "{}", point.approach);
    assert!((point.slip_x - 0.05).abs() < 1e-12 && (point.slip_y - 0.07).abs() < 1e-12);
    assert!((now - angular).norm() < 1e-12, "{now} {angular}");
}

/// Rocking over a gap counts as none where, thrown up at the rate at which the gap grows, the rim comes no higher than a
/// twentieth of the unevenness before its weight brings it down (on smoother ground, than rocking that is neglected on a plane):
/// the top of a parabola, here from many points of it.
#[test]
fn rocking_that_the_ground_outweighs_stays_below_its_unevenness() {
    let mut seen = [0; 2];
    for (slope, wavelength_m, uneven) in [(0.1, 0.03, true), (0.01, 3e-3, false)] {
        let rough = Rough {
            wavelength_m,
            ..Rough::of(0.7, slope)
        };
        let model = rough.model();
        let ground = model.ground.expect("a rough ground");
        let half = model.dynamics.body.half;
        let [one, plane] = [
            0.05 * ground.unevenness(),
            2.0 * half * half * model.negligible_rocking,
        ];
        assert_eq!(one > plane, uneven, "{one} {plane}");
        let most = one.max(plane);
        for number in 0..300 {
            let mut dice = coinmc_testkit::Dice::new(541, number);
            let mut toss = leaning(
                &model,
                dice.between(0.0, 2.0) * most / (2.0 * half),
                [0.0; 3],
            );
            let tilt = dice.between(-0.7, 0.7) * most.sqrt();
            set_motion(&mut toss, &model, Spin { tilt, ..ROLLING }, [0.0; 2]);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            [walk.tracks.own.rate, walk.tracks.other.rate] =
                [0, 1].map(|_| dice.between(-0.5, 0.5) * most.sqrt());
            let rise = dice.between(-0.5, 0.5) * most;
            walk.tracks.other.height = rise;
            let contact = walk.contact();
            // the gap and its first two rates, as 2h cos θ and the tracks have them
            let (sin, cos) = libm::sincos(contact.state[TILT]);
            let gap = (2.0 * half * cos - rise).max(0.0);
            let rate = -2.0 * half * sin * contact.state[OMEGA_Y] + walk.tracks.own.rate
                - walk.tracks.other.rate;
            let fall = 2.0 * half * sin * contact.now.state[OMEGA_Y];
            let top = (0..=4_000)
                .map(|i| {
                    let t = (f64::from(i) - 2_000.0) * 1e-2 * most.sqrt();
                    gap + rate * t - 0.5 * fall * t * t
                })
                .fold(f64::NEG_INFINITY, f64::max);
            if (top - most).abs() > 1e-3 * most {
                let expected = top < most;
                seen[usize::from(expected)] += 1;
                assert_eq!(walk.barely_rocks(&contact), expected, "{gap} {rate} {fall}");
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 80), "{seen:?}");
}

/// A jam ends the slip at once: the contact point sticks, and it counts.
#[test]
fn a_jam_ends_the_slip() {
    let rough = Rough {
        friction: 1.5,
        ..Rough::of(8.0, 0.02)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    let mut jams = 0;
    for number in 1..30 {
        let mut toss = leaning(&model, 0.05 * f64::from(number), [0.0; 3]);
        for sign in [-1.0, 1.0] {
            set_motion(&mut toss, &model, Spin::still(), [0.3 * sign, 0.0]);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let energy = walk.energy();
            let contact = walk.contact();
            let point = walk.toss.motion.contact_point(walk.body(), &walk.toss.spin);
            if walk.usage.jams > 0 {
                jams += 1;
                assert_eq!((walk.usage.jams, contact.mode), (1, Mode::Stick));
                assert!(libm::hypot(point.slip_x, point.slip_y) < 1e-9);
                assert!(walk.energy() < energy);
            } else {
                assert_eq!(contact.mode, Mode::Slip);
            }
        }
    }
    assert!(jams > 5, "{jams}");
}

/// Looks at the coin ten times in a second.
struct Looks(Vec<State>);

impl Observer for Looks {
    fn event(&mut self, _: &Event) {}

    fn wants_at_s(&self) -> f64 {
        0.1 * self.0.len() as f64 * 1e-2
    }

    fn sample(&mut self, state: &State) {
        self.0.push(*state);
    }
}

/// An observer sees the velocities of a step go straight from those before it to those after it.
#[test]
fn a_step_is_shown_along_a_straight_line() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.4, [0.0; 3]);
    set_motion(&mut toss, &model, Spin::still(), [0.2, -0.3]);
    let (before, time) = ((toss.motion, toss.spin), 0.3);
    let (mut usage, mut observer) = (Usage::default(), Looks(Vec::new()));
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    walk.toss.motion.vz += 0.5;
    walk.toss.motion.z += 0.2;
    walk.show(before, time);
    let units = &model.units;
    let rises = before.0.vz * units.speed_m_s();
    assert!(observer.0.len() > 5, "{}", observer.0.len());
    for state in &observer.0 {
        let share = state.time_s / (time * units.time_s);
        let speed = rises + 0.5 * share * units.speed_m_s();
        assert!((state.velocity_m_s.z - speed).abs() < 1e-12, "{share}");
        let height = (before.0.z + 0.2 * share) * units.length_m;
        assert!((state.position_m.z - height).abs() < 1e-12, "{share}");
    }
}

/// After a step a coin that is nearly flat goes on as on a plane; one that nothing presses onto the ground leaves it; slip that
/// friction brings to an end, and is slow, ends; all else goes on.
#[test]
fn a_step_ends_contact_or_slip_where_they_end() {
    let of = |friction: f64| Rough {
        friction,
        ..Rough::of(0.7, 0.02)
    };
    let stick = of(0.3).model().contact_rules().stick_speed;
    let (flat, free, rim) = (
        Some(Next::Ends(Transition::Contact)),
        Some(Next::Goes(Touch::Nothing)),
        Some(Next::Goes(Touch::Rim)),
    );
    for (friction, sin, press, slip, slows, expected) in [
        (0.3, 0.19, 1.0, [0.2, -0.3], true, flat),
        (0.3, 0.9, -0.1, [0.2, -0.3], true, free),
        (0.3, 0.9, 0.1, [0.2, -0.3], true, None),
        (0.3, 0.9, 0.1, [0.5 * stick, -0.7 * stick], true, rim),
        (0.3, 0.9, 0.1, [0.5 * stick, -0.7 * stick], false, None),
        (0.3, 0.9, 0.1, [0.9 * stick, -0.7 * stick], true, None),
        (0.0, 0.9, 0.1, [0.5 * stick, -0.7 * stick], true, None),
    ] {
        let model = of(friction).model();
        let ground = model.ground.expect("a rough ground");
        let mut toss = leaning(&model, 0.4, [0.0; 3]);
        set_motion(&mut toss, &model, ROLLING, [0.2, -0.3]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let mut contact = walk.contact();
        assert_eq!(contact.mode, Mode::Slip);
        (contact.state[SLIP_X], contact.state[SLIP_Y]) = (slip[0], slip[1]);
        contact.now.press = press;
        let sign = if slows { -1.0 } else { 1.0 };
        // mostly along y: along x alone the slip would grow, or slow down
        contact.now.state[SLIP_X] = -sign * slip[0];
        contact.now.state[SLIP_Y] = 3.0 * sign * slip[1];
        walk.toss.motion.sin = sin;
        assert_eq!(
            walk.after_step(&contact),
            expected,
            "{friction} {sin} {press} {slip:?}"
        );
    }
}

/// Many short steps of one rim take the time that they take, one try each at least.
#[test]
fn steps_of_a_rim_count_and_take_their_time() {
    let model = Rough::of(0.7, 0.001).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.2, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.0, 0.0]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    walk.usage.time = 3.0;
    walk.usage.steps = 7;
    (walk.tracks.left, walk.tracks.interval) = (0.02, 0.02);
    walk.budget = walk.energy();
    let energy = walk.energy();
    let mut contact = walk.contact();
    let mut wanted = walk.tracks.left;
    let mut rounds = 0;
    while !walk.tracks.at_node() {
        walk.step_on_rim(&mut contact, &mut wanted);
        rounds += 1;
    }
    assert!(
        (walk.usage.time - 3.02).abs() < 1e-12,
        "{}",
        walk.usage.time
    );
    assert!((7 + rounds..30).contains(&walk.usage.steps));
    // what rolling and pivoting friction take, and no more, is lost of the energy
    assert!(
        walk.budget < energy && walk.budget > energy - 0.02 * 0.02,
        "{}",
        walk.budget
    );
    assert!((walk.energy() - walk.budget).abs() < 1e-9);
}

/// At a node half of the pull of the slopes ahead is given at once: the lead is what the coin then has beyond its budget.
#[test]
fn the_lead_is_what_a_coin_has_beyond_its_budget() {
    let rough = Rough {
        friction_m: [1e-9, 1e-9],
        ..Rough::of(0.7, 0.02)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.2, [0.0; 3]);
    set_motion(&mut toss, &model, ROLLING, [0.0, 0.0]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    walk.begin_tracks();
    walk.budget = walk.energy();
    let contact = walk.contact();
    walk.pass_node(&contact, [0.02, 0.15]);
    assert!(walk.lead.abs() > 1e-5, "{}", walk.lead);
    assert!(
        (walk.energy() - walk.budget - walk.lead).abs() < 1e-9,
        "{}",
        walk.lead
    );
}
