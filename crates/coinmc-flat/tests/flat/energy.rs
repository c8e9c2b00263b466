//! No impact, no contact and no toss ever gains energy.

use crate::common::{Section, engine_with, record};
use coinmc_core::{EventKind, Preset};
use coinmc_flat::Settings;
use coinmc_testkit::{preset_launch, scene};

/// Energies are sums of a few terms rounded to 1e-16 each, in rounded units: 1e-13 is a hundred
/// times their noise. Flights are checked in `flight` (1e-12).
#[test]
fn nothing_gains_energy() {
    let settings = Settings {
        max_impacts: 300,
        ..Settings::default()
    };
    let (mut worst, mut worst_toss, mut steps) = (0.0_f64, 0.0_f64, 0_u64);
    for restitution in [0.0, 0.3, 0.5, 0.8, 0.95, 1.0] {
        for friction in [0.0, 0.1, 0.3, 1.0, 10.0] {
            for ratio in [0.01, 0.1, 1.0, 10.0, 100.0] {
                let scene = scene(ratio, restitution, friction);
                let k = Section::new(&scene).k;
                let engine = engine_with(&scene, settings);
                for toss in 0..100 {
                    let launch = preset_launch(Preset::CleanFlat, &scene, 40, toss);
                    let (_, moments) = record(&engine, &scene, &launch);
                    let first = moments[0].energy(k);
                    for pair in moments.windows(2) {
                        let (before, after) = (pair[0].energy(k), pair[1].energy(k));
                        let gain = after / before - 1.0;
                        let from = pair[0].kind;
                        let flew = pair[1].kind == EventKind::Touching
                            && !matches!(from, EventKind::Sticking | EventKind::Sliding);
                        if !flew {
                            steps += 1;
                            worst = worst.max(gain);
                            assert!(
                                gain <= 1e-13,
                                "e {restitution} μ {friction} ratio {ratio} toss {toss}: {gain:e} {pair:?}"
                            );
                        }
                        worst_toss = worst_toss.max(after / first - 1.0);
                    }
                }
            }
        }
    }
    println!("{steps} impacts and contacts: {worst:e}, tosses {worst_toss:e}");
    assert!(steps > 500_000, "{steps}");
    assert!(worst_toss <= 1e-13, "{worst_toss:e}");
}
