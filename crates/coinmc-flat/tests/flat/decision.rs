//! The decision by an energy fraction compared with the decision by energy alone.

use crate::common::{Section, engine, engine_with, record};
use coinmc_core::{Ended, Engine, EventKind, Preset};
use coinmc_flat::{Decision, Settings};
use coinmc_testkit::{preset_launch, scene};

fn with_fraction(fraction: f64) -> Settings {
    Settings {
        decision: Decision::EnergyFraction(fraction),
        ..Settings::default()
    }
}

/// The early face is that of the well in which the coin is when its energy, after an impact or a
/// contact phase, is first at or below the fraction. It is overruled where the engine that decides
/// by energy alone ends the same toss on another face.
#[test]
fn the_early_face_is_the_well_at_that_time() {
    let mut overruled = 0;
    for (ratio, restitution, friction) in [
        (1.0, 0.5, 0.3),
        (1.5, 0.3, 0.0),
        (0.5, 0.0, 1.0),
        (2.0, 0.7, 0.3),
    ] {
        let scene = scene(ratio, restitution, friction);
        let section = Section::new(&scene);
        for fraction in [0.3, 0.05] {
            let early = engine_with(&scene, with_fraction(fraction));
            let by_energy = engine(&scene);
            for toss in 0..2_000 {
                let launch = preset_launch(Preset::CleanFlat, &scene, 110, toss);
                let (outcome, moments) = record(&early, &scene, &launch);
                let reference = by_energy.toss(&mut (), &launch, &mut ());
                let below = fraction * moments[0].energy(section.k);
                // a toss whose energy is within rounding of the threshold proves nothing
                if moments
                    .iter()
                    .any(|m| (m.energy(section.k) / below - 1.0).abs() < 1e-9)
                {
                    continue;
                }
                let first_below = moments.iter().find(|m| {
                    let is_checked = !matches!(
                        m.kind,
                        EventKind::Launched | EventKind::Sticking | EventKind::Sliding
                    );
                    is_checked && m.energy(section.k) <= below
                });
                let expected =
                    first_below.map_or(reference.ended, |m| Ended::Decided(section.face(m.theta)));
                assert_eq!(
                    outcome.ended, expected,
                    "{ratio} {restitution} {fraction} {toss}"
                );
                assert_eq!(outcome.overruled, outcome.ended != reference.ended);
                assert_eq!(outcome.impacts, reference.impacts);
                overruled += u32::from(outcome.overruled);
            }
        }
    }
    assert!(overruled > 100, "{overruled}");
}

/// From 1 m the energy is over 70 m g D. A fraction of 0.002 of up to 500 m g D lies below the
/// barrier, where energy alone has already decided the face.
#[test]
fn a_small_fraction_is_never_overruled() {
    for friction in [0.0, 0.3] {
        let scene = scene(1.0, 0.5, friction);
        let k = Section::new(&scene).k;
        let engine = engine_with(&scene, with_fraction(0.002));
        for toss in 0..5_000 {
            let launch = preset_launch(Preset::CleanFlat, &scene, 111, toss);
            let (outcome, moments) = record(&engine, &scene, &launch);
            assert!(moments[0].energy(k) < 500.0);
            assert!(!outcome.overruled && outcome.face().is_some());
        }
    }
}
