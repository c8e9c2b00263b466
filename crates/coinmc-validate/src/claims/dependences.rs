//! On what P(side) depends.

use super::scenes::{hand, robot, unity};
use crate::tosser::{Scene, Tosser};
use crate::trend::{LEVEL, Trend, p_same};
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc::results::{Results, Row};

/// A scene in which a number is varied: its name, the sweep, and the tosses of a quick and a full validation.
struct Varied {
    name: &'static str,
    scene: Scene,
    /// The number, in words.
    number: &'static str,
    /// As in `--set`.
    sweep: &'static str,
    tosses: [u64; 2],
}

impl Varied {
    fn toss(&self, tosser: &Tosser<'_>) -> Result<Results, ValidateError> {
        let [quick, full] = self.tosses;
        tosser.toss(&self.scene.clone().with(self.sweep), quick, full)
    }

    /// P(side) at each value.
    fn evidence(&self, results: &Results) -> Vec<Evidence> {
        let at = |row: &Row| {
            let value = results.axes.last().and_then(|axis| row.parameter(axis));
            format!(
                "{}, {} = {}",
                self.name,
                self.number,
                value.unwrap_or(f64::NAN)
            )
        };
        results
            .rows
            .iter()
            .map(|row| Evidence::p_side(at(row), row))
            .collect()
    }
}

fn thick_by_hand(name: &str) -> Scene {
    hand(name).with("coin.ratio=0.8")
}

pub(super) fn restitution(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    falls(
        tosser,
        &[
            Varied {
                name: "Unity's scene, H/R = 1",
                scene: unity("claims/restitution-unity"),
                number: "e",
                sweep: "surface.restitution=[0.1, 0.3, 0.5, 0.7]",
                tosses: [2000, 50_000],
            },
            Varied {
                name: "hand on wood, H/R = 0.8",
                scene: thick_by_hand("claims/restitution-hand"),
                number: "e",
                sweep: "surface.restitution=[0.3, 0.5, 0.7, 0.85]",
                tosses: [2000, 50_000],
            },
            Varied {
                name: "robot, flat, μ = 0, H/R = 1.5",
                scene: robot("claims/restitution-robot")
                    .with("coin.ratio=1.5")
                    .with("surface.friction=0.0"),
                number: "e",
                sweep: "surface.restitution=[0.3, 0.5, 0.7]",
                tosses: [10_000, 200_000],
            },
        ],
    )
}

pub(super) fn friction(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    falls(
        tosser,
        &[
            Varied {
                name: "Unity's scene, H/R = 1",
                scene: unity("claims/friction-unity"),
                number: "μ",
                sweep: "surface.friction=[0.1, 0.3, 1.0, 10.0]",
                tosses: [2000, 50_000],
            },
            Varied {
                name: "hand on wood, H/R = 0.8",
                scene: thick_by_hand("claims/friction-hand"),
                number: "μ",
                sweep: "surface.friction=[0.1, 0.3, 0.6]",
                tosses: [2000, 50_000],
            },
            Varied {
                name: "robot, flat, H/R = 1.5",
                scene: robot("claims/friction-robot").with("coin.ratio=1.5"),
                number: "μ",
                sweep: "surface.friction=[0.0, 0.1, 0.3]",
                tosses: [10_000, 200_000],
            },
        ],
    )
}

/// The claim that P(side) falls: with the way that it goes in each scene.
fn falls(tosser: &Tosser<'_>, scenes: &[Varied]) -> Result<Finding, ValidateError> {
    let (mut evidence, mut falling) = (vec![], vec![]);
    for varied in scenes {
        let results = varied.toss(tosser)?;
        let trend = Trend::of(&results);
        if trend == Trend::Falls {
            falling.push(varied.name.to_owned());
        }
        let mut numbers = varied.evidence(&results);
        if let Some(last) = numbers.last_mut() {
            last.what
                .push_str(&[" (", trend.name(), " from the first value to this)"].concat());
        }
        evidence.extend(numbers);
    }
    let verdict = Verdict::of_cases(&falling, scenes.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn height(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    const HEIGHTS: &str = "launch.height_m=[0.25, 0.5, 1.0, 2.0]";
    let scenes = [
        Varied {
            name: "Unity's scene, H/R = 1",
            scene: unity("claims/height-unity"),
            number: "height, m",
            sweep: "launch.height_m=[2.5, 5.0, 10.0]",
            tosses: [2000, 50_000],
        },
        Varied {
            name: "hand on wood, H/R = 0.8",
            scene: thick_by_hand("claims/height-hand"),
            number: "height, m",
            sweep: HEIGHTS,
            tosses: [2000, 50_000],
        },
        Varied {
            name: "robot, flat, H/R = 1.5",
            scene: robot("claims/height-robot").with("coin.ratio=1.5"),
            number: "height, m",
            sweep: HEIGHTS,
            tosses: [10_000, 200_000],
        },
    ];
    let (mut evidence, mut same) = (vec![], vec![]);
    for varied in &scenes {
        let results = varied.toss(tosser)?;
        evidence.extend(varied.evidence(&results));
        let p = p_same(results.rows.iter());
        if p >= LEVEL {
            same.push(varied.name.to_owned());
        }
        let what = format!(
            "p-value of the same P(side) at all heights, {}",
            varied.name
        );
        evidence.push(Evidence::exact(what, p));
    }
    let verdict = Verdict::of_cases(&same, scenes.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn spin(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let scenes = [
        Varied {
            name: "hand on wood, H/R = 0.8",
            scene: thick_by_hand("claims/spin-hand"),
            number: "mean spin, rad/s",
            sweep: "launch.spin.precessing.rate_rad_s.normal.mean=[60.0, 120.0, 240.0]",
            tosses: [2000, 50_000],
        },
        Varied {
            name: "robot, flat, H/R = 1.5",
            scene: robot("claims/spin-robot").with("coin.ratio=1.5"),
            number: "spin, rad/s",
            sweep: "launch.spin.about.rate_rad_s=[0.0, 10.0, 30.0, 100.0]",
            tosses: [10_000, 200_000],
        },
    ];
    let mut evidence = vec![];
    for varied in &scenes {
        let results = varied.toss(tosser)?;
        evidence.extend(varied.evidence(&results));
        let what = format!("p-value of the same P(side) at every spin, {}", varied.name);
        evidence.push(Evidence::exact(what, p_same(results.rows.iter())));
    }
    let verdict = Verdict::NotValidated(
        "the paper's figure of it is not to be had; what is found here is the evidence".to_owned(),
    );
    Ok(Finding { verdict, evidence })
}

pub(super) fn mass(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    const MASSES: &str = "coin.mass_kg=[0.001, 0.01, 0.1]";
    let paired = |scene: Scene| scene.with("paired=true").with(MASSES);
    let given = "given as a number";
    let cases = [
        (
            format!("the restitution is {given} (flat, Moreau's law)"),
            paired(robot("claims/mass-moreau").with("coin.ratio=1.5")),
        ),
        (
            format!("the restitution is {given} (by hand on wood)"),
            paired(thick_by_hand("claims/mass-hand")),
        ),
        (
            "η of the paper's own law is fixed at 1e-3 N s".to_owned(),
            paired(
                robot("claims/mass-eta")
                    .with("coin.ratio=1.5")
                    .with("surface.friction=0.0")
                    .with("engine.flat.law={ gaek-sukhov = { eta_n_s = 1e-3 } }"),
            ),
        ),
    ];
    let (mut evidence, mut same) = (vec![], vec![]);
    for (name, scene) in &cases {
        let results = tosser.toss(scene, 2000, 50_000)?;
        // the same launches: where the mass has no effect, every toss ends the same
        let first = results.rows[0].tally;
        if results.rows.iter().all(|row| row.tally == first) {
            same.push(name.clone());
        }
        for row in &results.rows {
            let grams = 1e3 * row.parameter("mass_kg").unwrap_or(f64::NAN);
            evidence.push(Evidence::p_side(format!("{grams} g, {name}"), row));
        }
    }
    let verdict = Verdict::of_cases(&same, cases.len());
    Ok(Finding { verdict, evidence })
}
