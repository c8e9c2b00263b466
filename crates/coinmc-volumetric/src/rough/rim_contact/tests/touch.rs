//! When the other rim touches its track.

use super::*;

/// A step of contact of this length.
fn tried<I>(model: &Model<I>, contact: &Contact, length: f64) -> Trial<f64, 6> {
    let step = ScalarStep {
        state: &contact.state,
        now: &contact.now,
        mode: contact.mode,
        length,
        tolerance: 1e-6,
    };
    step.run_ahead(&model.dynamics, 0.0).0
}

/// The time at which the other rim comes down to its track, of a coin that tilts upright in a step: where 2h cos θ is the
/// difference of the tracks. At once where it is there already and approaches; never where it stays above.
#[test]
fn the_other_rim_touches_where_the_lean_is_that_of_the_tracks() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let (half, length) = (model.dynamics.body.half, 0.04);
    for (start, rates, expected) in [
        (0.003, [0.02, -0.01], Some(true)),
        (0.003, [-0.03, 0.02], Some(true)),
        (0.0, [0.0, 0.0], Some(false)),
        (0.1, [0.0, 0.0], None),
    ] {
        let mut toss = leaning(&model, 0.05, [0.0; 3]);
        let spin = Spin {
            tilt: 0.9,
            ..ROLLING
        };
        set_motion(&mut toss, &model, spin, [0.0, -0.4]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let contact = walk.contact();
        // the other rim starts so high above its track
        let above = 2.0 * half * walk.toss.motion.cos;
        (walk.tracks.own.height, walk.tracks.other.height) = (0.01, 0.01 + above - start);
        [walk.tracks.own.rate, walk.tracks.other.rate] = rates;
        let trial = tried(&model, &contact, length);
        let found = walk.touch_of_other(&contact, &trial, length);
        let Some(within) = expected else {
            assert_eq!(found, None);
            continue;
        };
        let time = found.expect("a touch");
        assert_eq!(time > 0.0, within, "{time}");
        let tilt = trial.between(&contact.state, time / length)[TILT];
        let [own, other] = [
            walk.tracks.own.height + rates[0] * time,
            walk.tracks.other.height + rates[1] * time,
        ];
        let gap = 2.0 * half * libm::cos(tilt) + own - other;
        assert!(gap.abs() <= 2.0 * TOUCH && time < length, "{gap:e}");
    }
}

/// Where both rims are at their tracks at the start of a step and the other one comes down in it, it touches at once only if it
/// approaches its track at once: by its own fall, by that of the own rim, or as its track rises.
#[test]
fn a_rim_that_first_rises_from_its_track_touches_it_later() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let (half, length) = (model.dynamics.body.half, 0.04);
    for (tilt, rates, at_once) in [
        (0.02, [0.0, 0.0], true),
        (-0.02, [0.0, 0.0], false),
        (-0.02, [0.0, 0.04], true),
        (-0.02, [-0.04, 0.0], true),
        (0.02, [0.03, 0.0], false),
        (0.02, [0.0, -0.03], false),
    ] {
        let mut toss = leaning(&model, 0.2, [0.0; 3]);
        set_motion(&mut toss, &model, Spin { tilt, ..ROLLING }, [0.0, -0.4]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let contact = walk.contact();
        let above = 2.0 * half * walk.toss.motion.cos;
        walk.tracks.other.height = above;
        [walk.tracks.own.rate, walk.tracks.other.rate] = rates;
        let mut trial = tried(&model, &contact, length);
        // it has come down at the end of the step
        trial.state[TILT] = contact.state[TILT] + 0.02;
        let time = walk.touch_of_other(&contact, &trial, length);
        let time = time.expect("a touch");
        assert_eq!(time == 0.0, at_once, "{tilt} {rates:?}: {time:e}");
    }
}

/// A step in which the other rim comes down to its track ends there: with that rim as the own one, and both at their tracks.
#[test]
fn a_step_ends_where_the_other_rim_touches() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.05, [0.0; 3]);
    let spin = Spin {
        tilt: 0.9,
        ..ROLLING
    };
    set_motion(&mut toss, &model, spin, [0.0, 0.0]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    (walk.tracks.left, walk.tracks.interval) = (0.04, 0.04);
    walk.tracks.other.height = walk.gap_of_other() - 0.003;
    let contact = &mut walk.contact();
    let mut wanted = walk.tracks.left;
    let mut next = None;
    while next.is_none() {
        next = walk.step_on_rim(contact, &mut wanted);
    }
    assert_eq!(next, Some(Next::Impact));
    assert!(walk.usage.time > 1e-3 && walk.usage.time < 0.03);
    assert!(walk.toss.motion.cos < 0.0, "the other rim is the own one");
    assert!(
        walk.gap_of_other().abs() < 1e-9,
        "{:e}",
        walk.gap_of_other()
    );
}
