//! The rules of decision beside each other.

use crate::common::{Tosser, paired, preset, scene, side};
use coinmc_core::Preset;
use coinmc_volumetric::{Decision, Settings};

/// Leaving out what cannot become tilt changes the side's share by less than .001 and 5 standard
/// errors of the paired difference; heads and tails are not exchanged.
#[test]
fn tilting_agrees_with_energy() {
    for (ratio, e, rho) in [(0.85, 0.5, 0.01), (0.85, 0.0, 0.01), (2.0, 0.0, 0.03)] {
        let scene = scene(ratio, e, 0.3, rho);
        let energy = Settings {
            decision: Decision::Energy,
            ..Settings::default()
        };
        let (a, b) = (Tosser::new(&scene), Tosser::with(&scene, &energy));
        let mut differences = Vec::new();
        let (mut undecided, mut differ) = (0, 0);
        for toss in 0..2500 {
            let launch = preset(Preset::Clean, &scene, 250, toss);
            let (a, b) = (a.toss(&launch), b.toss(&launch));
            undecided += u32::from(a.face().is_none() || b.face().is_none());
            differ += u32::from(a.face() != b.face());
            assert!(a.impacts <= b.impacts && a.contact_steps <= b.contact_steps);
            differences.push(side(&a) - side(&b));
        }
        let (mean, error) = paired(&differences);
        println!("{ratio} {e} {rho}: {differ} of 2500 differ, {mean} ± {error}");
        assert_eq!(undecided, 0, "{ratio} {e}");
        assert!(mean.abs() <= 0.001 + 5.0 * error, "{ratio} {e}: {mean}");
        assert!(differ <= 25, "{ratio} {e}: {differ}");
    }
}
