//! Symmetries of the physics: heads and tails, left and right, size, gravity, mass.

use crate::common::{Start, engine};
use coinmc_core::{Engine, Preset};
use coinmc_testkit::{Dice, Scale, conformance, paired, preset_launch, scene, side};

const SCENES: [(f64, f64, f64); 7] = [
    (1.0, 0.0, 0.3),
    (1.5, 0.5, 0.3),
    (0.3, 0.0, 1.0),
    (3.0, 0.7, 0.1),
    (1.2, 0.3, 0.0),
    (0.05, 0.8, 10.0),
    (10.0, 0.0, 0.0),
];

#[test]
fn heads_and_tails_exchange_exactly() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let launch = |toss| preset_launch(Preset::CleanFlat, &scene, 70, toss);
        let launches: Vec<_> = (0..10_000).map(launch).collect();
        conformance::heads_and_tails_exchange(&engine(&scene), &launches);
    }
}

#[test]
fn the_time_of_the_launch_does_not_matter() {
    let mut short = 0;
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let launch = |toss| Start::lively(&mut Dice::new(74, toss)).launch(&scene);
        let launches: Vec<_> = (0..2_000).map(launch).collect();
        short += conformance::a_later_start_ends_alike(&engine(&scene), &launches, 40);
    }
    assert!(short > 1000, "{short}");
}

/// Left and right differ in rounding (1e-16), which an impact amplifies less than a thousandfold.
/// So tosses of up to three impacts without sliding agree: 1e-16·1e9 compared with launches within
/// 1e-7 of a change, of which 2000 contain 2e-4. The others agree on average: 4 standard errors,
/// false alarms 6e-5 per scene.
#[test]
fn left_and_right_are_alike() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let engine = engine(&scene);
        let mut differences = Vec::new();
        let mut short = 0;
        for toss in 0..10_000 {
            let start = Start::lively(&mut Dice::new(71, toss));
            let mirrored = Start {
                vx: -start.vx,
                theta: -start.theta,
                omega: -start.omega,
                ..start
            };
            let a = engine.toss(&mut (), &start.launch(&scene), &mut ());
            let b = engine.toss(&mut (), &mirrored.launch(&scene), &mut ());
            if a.impacts <= 3 && a.contact_steps <= 3 {
                short += 1;
                assert_eq!(
                    a.face(),
                    b.face(),
                    "{ratio} {restitution} {friction} {toss}"
                );
            }
            differences.push(side(&a) - side(&b));
        }
        let (mean, error) = paired(&differences);
        assert!(
            mean.abs() <= 4.0 * error,
            "{ratio} {restitution}: {mean} ± {error}"
        );
        assert!(
            short > 20 || restitution > 0.5 || ratio > 5.0,
            "{ratio} {restitution} {friction}: {short}"
        );
    }
}

/// Lengths × 4 with times × 2, gravity × 4 with times / 2, and any mass: powers of two, and a mass
/// that cancels, leave the dimensionless toss bit-identical.
#[test]
fn size_gravity_and_mass_do_not_matter() {
    let base = scene(1.3, 0.5, 0.3);
    let reference = engine(&base);
    for (length, time, mass_kg) in [
        (4.0, 2.0, 0.01),
        (1.0, 0.5, 0.01),
        (1.0, 1.0, 7.3),
        (0.25, 0.5, 0.3),
    ] {
        let scale = Scale { length, time };
        let mut other = scale.scene(&base);
        other.coin = other.coin.with_mass(mass_kg).unwrap();
        let engine = engine(&other);
        for toss in 0..5_000 {
            let launch = preset_launch(Preset::CleanFlat, &base, 72, toss);
            let a = reference.toss(&mut (), &launch, &mut ());
            let b = engine.toss(&mut (), &scale.launch(&launch), &mut ());
            assert_eq!(a, b, "{length} {time} {toss}");
        }
    }
}

/// Lengths × 3: rounding differs, and changes the face only of launches within about 1e-12 of a
/// change: none of 20,000 at e = 0 (three would mean that something else differs).
#[test]
fn an_odd_scale_does_not_matter() {
    let small = scene(1.3, 0.0, 0.3);
    let scale = Scale {
        length: 3.0,
        time: 3.0_f64.sqrt(),
    };
    let (a, b) = (engine(&small), engine(&scale.scene(&small)));
    let changed = (0..20_000).filter(|toss| {
        let launch = preset_launch(Preset::CleanFlat, &small, 73, *toss);
        let scaled = scale.launch(&launch);
        let outcomes = [
            a.toss(&mut (), &launch, &mut ()),
            b.toss(&mut (), &scaled, &mut ()),
        ];
        outcomes[0].face() != outcomes[1].face()
    });
    assert!(changed.count() < 3);
}
