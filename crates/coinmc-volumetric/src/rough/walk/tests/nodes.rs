//! How far apart nodes lie, and the tracks between them.

use super::*;

/// Nodes lie farther apart on gentle ground alone, under a coin that leans far and rolls slowly, and where there
/// is friction to compare with.
#[test]
fn nodes_lie_farther_apart_where_bumps_take_less_than_rolling_friction() {
    let cases = [
        (0.3, 0.05, 0.003, 5e-5, 8.0),
        (0.02, 0.05, 0.003, 5e-5, 1.0),
        (0.3, 5.0, 0.003, 5e-5, 1.0),
        (0.3, 0.2, 0.1, 5e-5, 1.0),
        (0.3, 0.05, 0.003, 0.0, 1.0),
    ];
    for (lean, speed, slope, contour, expected) in cases {
        let rough = Rough {
            friction_m: [contour, 5e-6],
            ..Rough::of(0.7, slope)
        };
        let (scene, model) = (rough.scene(), rough.model());
        let ground = model.ground.expect("a rough ground");
        let launch = Start::Rolling(speed).launch(&scene.coin, lean);
        let mut toss = model.launch(&launch);
        let (mut usage, mut observer) = (Usage::default(), ());
        let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        assert_eq!(walk.stride(), expected, "{lean} {speed} {slope} {contour}");
    }
}

/// Nodes are so many times as far apart that bumps, which take energy in proportion to the square of the way between nodes, take
/// as much of it as rolling friction: ½ s²w² n² = ℓ ρ_c/R.
#[test]
fn between_nodes_bumps_take_as_much_as_rolling_friction() {
    for (speed, slope) in [(0.8, 0.003), (0.12, 0.01)] {
        let rough = Rough::of(0.7, slope);
        let (scene, model) = (rough.scene(), rough.model());
        let ground = model.ground.expect("a rough ground");
        let mut toss = model.launch(&Start::Rolling(speed).launch(&scene.coin, 0.3));
        let (mut usage, mut observer) = (Usage::default(), ());
        let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let [own, _] = rim_points(walk.body(), &walk.toss.motion, &walk.toss.spin);
        let [wx, wy] = own.velocity();
        let bumps = 0.5 * slope * slope * (wx * wx + wy * wy);
        let friction = ground.length * rough.friction_m[0] / scene.coin.radius_m();
        let stride = walk.stride();
        assert!(stride > 1.1 && stride < 7.9, "{stride}");
        assert!(
            (bumps * stride * stride / friction - 1.0).abs() < 1e-12,
            "{stride}"
        );
    }
}

/// Nodes lie no farther apart where the coin comes so upright before the next one that bumps may topple it: within half of the
/// lean at which it topples, at the rate at which its lean changes.
#[test]
fn nodes_lie_no_farther_apart_where_a_coin_may_come_upright() {
    let model = Rough::of(0.7, 1e-5).model();
    let ground = model.ground.expect("a rough ground");
    let upright = 0.5 * model.dynamics.body.half;
    for tilt in [0.0, 0.8, -0.8] {
        for (share, farther) in [(0.95, false), (1.05, true)] {
            let lean = share * (upright + f64::abs(tilt) * 0.05);
            let mut toss = leaning(&model, libm::asin(lean), [0.0; 3]);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            walk.tracks.interval = 0.05;
            let spin = Spin {
                tilt,
                ..Spin::still()
            };
            set_spin(&mut walk, spin);
            assert_eq!(walk.stride() > 1.0, farther, "{tilt} {share}");
        }
    }
}

/// Tracks lead to the ground under the lowest points of both rims where these will be: gone on at their velocity, and turned
/// with the coin about its centre. A rim high above the ground has the own track.
#[test]
fn tracks_lead_to_the_ground_where_the_rims_will_be() {
    let model = Rough::of(0.7, 0.05).model();
    let ground = model.ground.expect("a rough ground");
    let time = 0.04;
    for (angle, near) in [(0.01, true), (0.7, false)] {
        let mut toss = leaning(&model, angle, [0.4, -0.7, 0.1]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let rate = 1.9;
        let spin = Spin {
            axial: 0.8,
            turn: -rate * walk.toss.motion.sin,
            tilt: 0.3,
        };
        set_spin(&mut walk, spin);
        (walk.tracks.own.height, walk.tracks.other.height) = (0.004, 0.003);
        walk.tracks.other.near = near;
        walk.lay_out_tracks_for(time);
        assert_eq!([walk.tracks.left, walk.tracks.interval], [time; 2]);
        let m = walk.toss.motion;
        let curvature = m.sin / walk.body().radius;
        let mut then = walk.place;
        then.shift(m.vx * time, m.vy * time);
        let (sin, cos) = libm::sincos(rate * time);
        let points = rim_points(walk.body(), &m, &walk.toss.spin);
        let rates = points.map(|point| {
            let tilts = point.rz * 0.3 * time;
            // turned with the coin, and carried along x by its tilting
            let at = then.point(point.rx * cos + tilts, point.rx * sin);
            let mut turned = then;
            turned.align(cos, sin);
            ground
                .under_rim(at, turned.direction(0.0, 1.0), curvature)
                .height
        });
        let own = (rates[0] - 0.004) / time;
        assert!((walk.tracks.own.rate - own).abs() < 1e-9, "{own}");
        assert_eq!(walk.tracks.other.near, near);
        let other = if near { (rates[1] - 0.003) / time } else { own };
        assert!((walk.tracks.other.rate - other).abs() < 1e-9, "{other}");
    }
}

/// Nodes are a step apart at the pace of the faster rim, unless the coin would turn by more than .2 rad, or take more
/// than .1 sqrt(D/g).
#[test]
fn nodes_are_a_step_apart() {
    let pace = Tracks::time_at_pace;
    assert!((pace(0.02, 0.5, 0.1) - 0.04).abs() < 1e-15);
    assert!((pace(0.02, 0.5, -10.0) - 0.02).abs() < 1e-15);
    assert!((pace(0.02, 0.0, 0.0) - 0.1).abs() < 1e-15);
}

/// Between nodes the faster rim goes `ground_step` ℓ, or so many times as far as bumps matter less.
#[test]
fn the_faster_rim_goes_a_step_between_nodes() {
    for (slope, lean, stride) in [(0.05, 0.1, 1.0), (3e-4, 0.5, 8.0)] {
        let settings = Settings {
            ground_step: 0.02,
            ..Settings::default()
        };
        let scene = Rough::of(0.7, slope).scene();
        let model = Model::new(&scene, &settings, Moreau).expect("valid settings");
        let ground = model.ground.expect("a rough ground");
        let mut toss = leaning(&model, lean, [0.0, 0.9, 0.0]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        assert_eq!(walk.stride(), stride);
        let way = 0.9 * walk.time_between_nodes();
        assert!(
            (way / (0.02 * ground.length * stride) - 1.0).abs() < 1e-12,
            "{way}"
        );
    }
}

/// The track of a rim that comes near the ground begins at it, or at the rim where that would be in the ground.
#[test]
fn a_rim_that_comes_near_is_above_its_track() {
    let model = Rough::of(0.7, 0.05).model();
    let ground = model.ground.expect("a rough ground");
    let (mut free, mut cut) = (0, 0);
    for number in 0..60 {
        let mut dice = Dice::new(571, number);
        let mut toss = leaning(&model, dice.between(0.0, 0.004), [0.1, 0.2, 0.0]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        walk.place = Place::at([dice.between(0.0, 1.0), dice.between(0.0, 1.0)], [0.6, 0.8]);
        walk.put_down();
        assert!(!walk.tracks.other.near);
        walk.lay_out_tracks_for(1e-9);
        let [own, other] = rim_points(walk.body(), &walk.toss.motion, &walk.toss.spin);
        let rim = walk.tracks.own.height + (other.rz - own.rz);
        let under = carried_now(
            &ground,
            walk.body(),
            &walk.toss.motion,
            &walk.place,
            other.rx,
        )
        .0;
        assert!(
            (walk.tracks.other.height - under.min(rim)).abs() < 1e-9,
            "{under} {rim}"
        );
        *(if under < rim { &mut free } else { &mut cut }) += 1;
    }
    assert!(free > 10 && cut > 10, "{free} {cut}");
}
