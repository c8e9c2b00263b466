//! What the engine requires of every law: determinism, mirror symmetry, no gain of energy, an end.

use crate::common::{engine, gaek_sukhov, line, materials, pulse};
use coinmc_core::{
    Domain, Engine, Event, Face, Observer, Preset, Scene, Stream, Tally, run_tosses,
};
use coinmc_flat::{HalfSine, Law, Lever, PulseTime};
use coinmc_testkit::scene;
use nalgebra::UnitVector3;

/// A law and the friction of its scenes.
fn laws() -> Vec<(Law, f64)> {
    let capped = HalfSine {
        time: PulseTime::Contact(materials(3e9)),
        peak_n: Some(300.0),
    };
    vec![
        (gaek_sukhov(3e-3, Lever::Height), 0.0),
        (gaek_sukhov(3e-3, Lever::Corner), 0.0),
        (pulse(1e-4), 0.3),
        (Law::HalfSine(capped), 0.3),
        (line(3e9), 0.3),
        (line(1e6), 0.3),
        (line(3e9), 0.0),
    ]
}

/// Configs and results know each law by these words.
#[test]
fn laws_have_their_names() {
    let rigid = Law::RIGID.map(Law::name);
    assert_eq!(rigid, ["moreau", "chatterjee-ruina"]);
    let lasting = [gaek_sukhov(3e-3, Lever::Height), pulse(1e-4), line(3e9)];
    let names = lasting.map(Law::name);
    assert_eq!(names, ["gaek-sukhov", "half-sine", "line-contact"]);
}

const RATIOS: [f64; 3] = [0.3, 1.2, 3.0];

fn stream() -> Stream {
    Stream::new(230, Domain::Launch, 0)
}

fn scenes(friction: f64) -> impl Iterator<Item = Scene> {
    RATIOS
        .into_iter()
        .zip([0.6, 0.3, 0.8])
        .map(move |(ratio, e)| scene(ratio, e, friction))
}

#[test]
fn a_toss_is_bit_identical_in_its_batch_and_all_are_decided() {
    let launches = Preset::Robot.distribution();
    for (law, friction) in laws() {
        for scene in scenes(friction) {
            let engine = engine(&scene, law);
            let run = |range| run_tosses(&engine, &mut (), &scene, &launches, &stream(), range);
            let whole = run(0..60);
            let mut one_by_one = Tally::default();
            for toss in (0..60).rev() {
                one_by_one.merge(&run(toss..toss + 1));
            }
            assert_eq!(whole, one_by_one, "{law:?}");
            assert_eq!(whole.undecided(), 0, "{law:?}: {whole:?}");
        }
    }
}

/// The computation is bit-identical for the two faces.
#[test]
fn heads_and_tails_exchange_exactly() {
    let launches = Preset::CleanFlat.distribution();
    for (law, friction) in laws() {
        for scene in scenes(friction) {
            let engine = engine(&scene, law);
            for toss in 0..60 {
                let launch = launches.launch(&scene.coin, &mut stream().toss(toss));
                let mut flipped = launch;
                flipped.axis = UnitVector3::new_unchecked(-launch.axis.into_inner());
                let mut a = engine.toss(&mut (), &launch, &mut ());
                let b = engine.toss(&mut (), &flipped, &mut ());
                a.ended = match a.ended {
                    coinmc_core::Ended::Decided(Face::Heads) => {
                        coinmc_core::Ended::Decided(Face::Tails)
                    }
                    coinmc_core::Ended::Decided(Face::Tails) => {
                        coinmc_core::Ended::Decided(Face::Heads)
                    }
                    other => other,
                };
                assert_eq!(a, b, "{law:?} {toss}");
            }
        }
    }
}

/// The largest relative gain of energy from event to event.
struct Ledger<'a> {
    scene: &'a Scene,
    last: f64,
    worst: f64,
}

impl Observer for Ledger<'_> {
    fn event(&mut self, event: &Event) {
        let energy = event.state.energy_j_kg(self.scene);
        self.worst = self.worst.max(energy / self.last - 1.0);
        self.last = energy;
    }
}

/// From event to event the energy grows by no more than the rounding of states in SI units.
#[test]
fn no_toss_gains_energy() {
    let launches = Preset::Robot.distribution();
    for (law, friction) in laws() {
        for scene in scenes(friction) {
            let engine = engine(&scene, law);
            for toss in 0..60 {
                let launch = launches.launch(&scene.coin, &mut stream().toss(toss));
                let mut ledger = Ledger {
                    scene: &scene,
                    last: f64::INFINITY,
                    worst: 0.0,
                };
                let observed = engine.toss(&mut (), &launch, &mut ledger);
                assert!(ledger.worst < 1e-13, "{law:?} {toss}: {}", ledger.worst);
                assert_eq!(observed, engine.toss(&mut (), &launch, &mut ()));
            }
        }
    }
}

/// With e = 0 every law decides every toss.
#[test]
fn tosses_without_rebound_are_decided() {
    let launches = Preset::CleanFlat.distribution();
    for law in [line(3e9), pulse(1e-5)] {
        let plastic = scene(1.0, 0.0, 0.3);
        let moreau = engine(&plastic, Law::Moreau);
        let other = engine(&plastic, law);
        for toss in 0..200 {
            let launch = launches.launch(&plastic.coin, &mut stream().toss(toss));
            let (a, b) = (
                moreau.toss(&mut (), &launch, &mut ()),
                other.toss(&mut (), &launch, &mut ()),
            );
            assert!(b.face().is_some(), "{toss}: {a:?} {b:?}");
        }
    }
}
