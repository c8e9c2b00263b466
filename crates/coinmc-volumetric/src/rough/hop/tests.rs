//! Tests of low hops: where a rim first touches, and the tracks of both rims then.

use super::super::test_scenes::{Rough, leaning, set_spin};
use super::*;
use crate::contact::Usage;
use crate::laws::Moreau;
use crate::motion::Spin;
use coinmc_testkit::Dice;

/// A flight that begins as the coin moves, on these tracks.
fn hop(walk: &Walk<'_, Moreau, ()>, tracked: [bool; 2]) -> Hop {
    let orbit = Orbit::new(&walk.toss.motion, walk.model.dynamics.drag);
    Hop {
        bounds: orbit.bounds(&orbit.extent(walk.body())),
        orbit,
        since: 0.0,
        tracked,
    }
}

/// A rim that is above its track at both nodes may still touch it in between, where a coin turns fast: the first touch is
/// where the first of 2,000 looks finds a rim below its track, and there is none where none does.
#[test]
fn a_rim_touches_where_looks_along_the_flight_find_it_below_its_track() {
    let (mut ends_below, mut dips, mut clear) = (0, 0, 0);
    let model = Rough::of(0.7, 0.02).model();
    let (ground, body) = (model.ground.expect("a rough ground"), &model.dynamics.body);
    for number in 0..400 {
        let mut dice = Dice::new(581, number);
        let mut toss = leaning(&model, dice.between(0.0, 1.2), [0.0; 3]);
        toss.motion.vz = dice.between(-0.1, 0.3);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let spin = Spin {
            axial: dice.between(-1.0, 1.0),
            turn: dice.between(-1.0, 1.0),
            tilt: dice.between(-5.0, 5.0),
        };
        set_spin(&mut walk, spin);
        let hop = hop(&walk, [true; 2]);
        let now = RimsInFlight::new(body, &hop.orbit, 0.0);
        let time = dice.between(0.1, 0.4);
        let next = now.at(&hop.orbit, time);
        (walk.tracks.left, walk.tracks.interval) = (time, time);
        for rim in Rim::BOTH {
            let track = walk.tracks.of_mut(rim);
            *track = Track::level(now.height(rim) - dice.between(0.001, 0.03));
            track.rate = dice.between(-0.05, 0.05);
        }
        let lowest = |t: f64| {
            let there = now.at(&hop.orbit, t);
            let gap = |rim| there.gap_above(rim, walk.tracks.of(rim), 0.0).height;
            gap(Rim::Own).min(gap(Rim::Other))
        };
        let looks = 2_000;
        let step = time / f64::from(looks);
        let gaps: Vec<f64> = (0..=looks).map(|i| lowest(f64::from(i) * step)).collect();
        let found = walk.first_touch(&hop, now, &next);
        // between two looks a gap that bends by less than 50 may be this much lower
        let missed = 50.0 * step * step / 8.0;
        let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let below = gaps.iter().position(|gap| *gap < -TOUCH);
        match below {
            None if least > missed => {
                clear += 1;
                assert!(found.is_none(), "{number}");
            }
            Some(below) if least < -missed => {
                let (at, rim) = found.expect("a touch");
                let first = f64::from(u32::try_from(below).expect("a few looks")) * step;
                assert!(
                    (first - step..=first).contains(&at.time),
                    "{number}: {first}"
                );
                let gap = at.gap_above(rim, walk.tracks.of(rim), 0.0);
                assert!(gap.height.abs() <= TOUCH && gap.rate < 0.0, "{number}");
                if lowest(time) > 0.0 {
                    dips += 1;
                } else {
                    ends_below += 1;
                }
            }
            _ => {}
        }
    }
    let seen = [ends_below, dips, clear];
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

/// Where one rim touches after the first node, the other one has a track of its own if it is near the ground: if the axis leans
/// by less than that, or would before the next node at the rate at which the lean changes. Else it has the same track.
#[test]
fn the_other_rim_has_a_track_of_its_own_where_it_may_come_near() {
    let model = Rough::of(0.7, 0.01).model();
    let (ground, body) = (model.ground.expect("a rough ground"), &model.dynamics.body);
    let (since, interval) = (1e-9, 0.05);
    for rate in [0.0, 0.8, 1.9, -1.9] {
        for (share, near) in [(0.95, true), (1.05, false)] {
            let lean = share * (ground.near + f64::abs(rate) * interval);
            let mut toss = leaning(&model, libm::asin(lean), [0.1, -0.2, 0.1]);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let spin = Spin {
                tilt: rate,
                ..Spin::still()
            };
            set_spin(&mut walk, spin);
            let mut hop = hop(&walk, [true, false]);
            hop.since = since;
            let [now, at, next] = [since, 0.01, since + interval]
                .map(|time| RimsInFlight::new(body, &hop.orbit, time));
            (walk.tracks.left, walk.tracks.interval) = (interval, interval);
            (walk.tracks.own.rate, walk.tracks.own.near) = (0.03, true);
            walk.touch_down(&hop, at, Rim::Own, [&now, &next]);
            let Tracks { own, other, .. } = walk.tracks;
            assert!((own.height - 0.03 * 0.01).abs() < 1e-9);
            assert_eq!(other.near, near, "{rate} {share}");
            let alike = (other.height, other.rate) == (own.height, own.rate);
            assert_eq!(alike, !near, "{rate} {share}");
        }
    }
}
