//! A toss in the plane without friction agrees with the flat engine.

use crate::common::{Start, Tosser};
use coinmc_core::{Engine, Event, EventKind, Launch, Observer, Outcome, Scene};
use coinmc_flat::{FlatEngine, Moreau, Settings};
use coinmc_testkit::{Dice, paired, rolling_scene, side};
use nalgebra::Vector3;

/// Times and normal speeds of the impacts.
#[derive(Default)]
struct Impacts(Vec<(f64, f64)>);

impl Observer for Impacts {
    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::Touching {
            let state = &event.state;
            self.0.push((state.time_s, state.velocity_m_s.z));
        }
    }
}

/// u in the xz plane, spin about y.
fn planar(dice: &mut Dice) -> Start {
    let (sin, cos) = libm::sincos(dice.between(0.0, std::f64::consts::TAU));
    Start {
        z: dice.between(1.5, 4.0),
        velocity: Vector3::new(dice.between(-1.0, 1.0), 0.0, dice.between(-1.0, 1.0)),
        axis: Vector3::new(sin, 0.0, cos),
        spin: Vector3::new(0.0, dice.between(-3.0, 3.0), 0.0),
    }
}

struct Both {
    space: Tosser,
    flat: FlatEngine<Moreau>,
}

impl Both {
    fn new(scene: &Scene) -> Self {
        Self {
            space: Tosser::new(scene),
            flat: FlatEngine::new(scene, &Settings::default(), Moreau).expect("valid settings"),
        }
    }

    fn toss(&self, launch: &Launch) -> [(Outcome, Impacts); 2] {
        let mut seen = [Impacts::default(), Impacts::default()];
        let [a, b] = &mut seen;
        let outcomes = [
            self.space.observe(launch, a),
            self.flat.toss(&mut (), launch, b),
        ];
        let [a, b] = seen;
        [(outcomes[0], a), (outcomes[1], b)]
    }
}

/// The first three impacts agree in time and speed to 1e-9 of their units (rounding, amplified by
/// up to 1000 per impact; an approach slower than zeno starts contact instead). Faces may differ
/// only where the engines have different bounds for when bounces become contact: the paired
/// probabilities of the side agree within 5 standard errors (false alarms 6e-7 per scene) plus
/// 0.003.
#[test]
fn planar_tosses_agree_with_the_flat_engine() {
    for e in [0.0, 0.3, 0.7] {
        for ratio in [0.3, 1.0, 1.5, 3.0] {
            let scene = rolling_scene(ratio, e, 0.0, 0.0);
            let both = Both::new(&scene);
            let (length, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
            let mut differences = Vec::new();
            let (mut compared, mut undecided, mut differ) = (0, 0, 0);
            for toss in 0..1000 {
                let launch = planar(&mut Dice::new(240, toss)).launch(&scene);
                let [(a, seen_a), (b, seen_b)] = both.toss(&launch);
                for ((ta, va), (tb, vb)) in seen_a.0.iter().zip(&seen_b.0).take(3) {
                    let off = ((ta - tb) / time)
                        .abs()
                        .max((va - vb).abs() * time / length);
                    if e == 0.0 && compared > 0 && off > 1e-9 {
                        // contact came between, which is integrated with an error of its own
                        break;
                    }
                    compared += 1;
                    assert!(off < 1e-9, "{e} {ratio} {toss}: {off:e}");
                }
                undecided += u32::from(a.face().is_none());
                differ += u32::from(a.face() != b.face());
                differences.push(side(&a) - side(&b));
            }
            let (mean, error) = paired(&differences);
            println!(
                "e {e} ratio {ratio}: {differ} differ, {undecided} undecided, {mean} ± {error}"
            );
            assert_eq!(undecided, 0, "{e} {ratio}");
            assert!(
                mean.abs() < 5.0 * error + 0.003,
                "{e} {ratio}: {mean} {error}"
            );
        }
    }
}
