//! Flight: no contact is missed, energy is conserved, contacts are located exactly.

use crate::common::{Moment, Section, engine, record};
use coinmc_core::{EventKind, Preset};
use coinmc_testkit::{preset_launch, scene};

/// Height of the lowest point after a flight of `t`.
fn gap(from: &Moment, section: &Section, t: f64) -> f64 {
    from.z + t * (from.vz - 0.5 * t) - section.reach(from.theta + from.omega * t)
}

/// The lowest gap between `begin` and `end`: 400 samples, and a ternary search about each sample
/// that is lower than its neighbours and near the surface.
fn lowest_gap(from: &Moment, section: &Section, begin: f64, end: f64) -> f64 {
    const SAMPLES: u32 = 400;
    let at = |i: u32| begin + (end - begin) * f64::from(i) / f64::from(SAMPLES);
    let heights: Vec<f64> = (0..=SAMPLES).map(|i| gap(from, section, at(i))).collect();
    let mut lowest = f64::INFINITY;
    for i in 0..=SAMPLES {
        let here = heights[i as usize];
        lowest = lowest.min(here);
        let dips = i > 0
            && i < SAMPLES
            && here <= heights[i as usize - 1]
            && here <= heights[i as usize + 1];
        if dips && here < 0.05 {
            let (mut low, mut high) = (at(i - 1), at(i + 1));
            for _ in 0..40 {
                let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if gap(from, section, a) < gap(from, section, b) {
                    high = b;
                } else {
                    low = a;
                }
            }
            lowest = lowest.min(gap(from, section, low));
        }
    }
    lowest
}

/// Times are known to an ulp (a few 1e-14 late in a toss) and corners move at up to 15 sqrt(gD), so
/// a gap is known to about 1e-13: 1e-12 is not noise, and a contact missed by more is detected.
/// Energy likewise: ulps of a height of 100 D compared with an energy of 100.
#[test]
fn no_contact_is_missed_and_energy_is_conserved() {
    let mut flights = 0;
    let (mut worst_gap, mut worst_energy, mut worst_touch) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (number, (ratio, restitution, friction)) in [
        (1.0, 0.5, 0.3),
        (0.1, 0.3, 0.3),
        (1.5, 0.0, 0.3),
        (4.0, 0.7, 1.0),
        (0.01, 0.8, 0.1),
        (100.0, 0.5, 10.0),
        (1.2, 0.5, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        let scene = scene(ratio, restitution, friction);
        let (engine, section) = (engine(&scene), Section::new(&scene));
        for toss in 0..3_000 {
            let launches = [Preset::Robot, Preset::CleanFlat][(toss % 2) as usize];
            let launch = preset_launch(launches, &scene, 30 + number as u64, toss);
            let (_, moments) = record(&engine, &scene, &launch);
            for pair in moments.windows(2) {
                let [from, to] = pair else { unreachable!() };
                let leaves = matches!(
                    from.kind,
                    EventKind::Launched | EventKind::Impact | EventKind::LiftOff
                );
                if !leaves || to.kind != EventKind::Touching {
                    continue;
                }
                flights += 1;
                let t = to.time - from.time;
                // above 1 nothing can touch: sample only where the centre falls below 1 for good
                let fall = (from.vz * from.vz + 2.0 * (from.z - 1.0)).max(0.0).sqrt();
                let rises = from.vz - fall > 0.0;
                let begin = if rises {
                    0.0
                } else {
                    (from.vz + fall).clamp(0.0, t)
                };
                let lowest = lowest_gap(from, &section, begin, t);
                worst_gap = worst_gap.min(lowest);
                worst_touch = worst_touch.max((to.z - section.reach(to.theta)).abs());
                let (before, after) = (from.energy(section.k), to.energy(section.k));
                worst_energy = worst_energy.max((after / before - 1.0).abs());
            }
        }
    }
    println!("{flights} flights: gap {worst_gap:e} touch {worst_touch:e} energy {worst_energy:e}");
    assert!(flights > 100_000, "{flights}");
    assert!(worst_gap > -1e-12, "{worst_gap:e}");
    assert!(worst_touch < 1e-12, "{worst_touch:e}");
    assert!(worst_energy < 1e-12, "{worst_energy:e}");
}
