//! Coins whose heads and tails differ, by a conical edge or a load: the volumetric engine against the
//! time-stepping oracle at the same launches, face by face.

use crate::survey::{FRICTION, survey, volumetric};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Coin, Engine, Face, Preset};
use coinmc_oracle::{StepperSettings, TimeStepper};
use coinmc_volumetric::Settings;

/// A scene of the preset clean, with R = 1 cm and μ = 0.3.
struct Unlike {
    ratio: f64,
    draft_deg: f64,
    /// The centre of mass from the middle, over H.
    centre: f64,
    restitution: f64,
    /// Friction lengths over R.
    length: f64,
}

const fn drafted(ratio: f64, draft_deg: f64, restitution: f64, length: f64) -> Unlike {
    Unlike {
        ratio,
        draft_deg,
        centre: 0.0,
        restitution,
        length,
    }
}

const fn loaded(ratio: f64, centre: f64, restitution: f64, length: f64) -> Unlike {
    Unlike {
        ratio,
        draft_deg: 0.0,
        centre,
        restitution,
        length,
    }
}

const DRAFTED: [Unlike; 7] = [
    drafted(0.85, 10.0, 0.5, 0.01),
    drafted(0.85, -10.0, 0.5, 0.01),
    drafted(0.85, 10.0, 0.0, 0.01),
    drafted(0.85, 15.0, 0.5, 0.003),
    drafted(0.25, 3.0, 0.5, 0.01),
    drafted(2.0, 8.0, 0.5, 0.01),
    drafted(0.6, 7.0, 0.5, 0.01),
];

const LOADED: [Unlike; 6] = [
    loaded(0.85, 0.2, 0.5, 0.01),
    loaded(0.85, -0.2, 0.5, 0.01),
    loaded(0.85, 0.1, 0.0, 0.003),
    loaded(0.25, 0.25, 0.5, 0.01),
    loaded(2.0, 0.15, 0.5, 0.01),
    loaded(0.6, 0.15, 0.5, 0.01),
];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Conical {
    /// Tosses of the engine in each scene
    #[arg(long, value_parser = number::count, default_value = "20_000", value_name = "N")]
    tosses: u64,

    /// Tosses of the oracle, the first of the engine's
    #[arg(long, value_parser = number::count, default_value = "1500", value_name = "N")]
    oracle_tosses: u64,

    /// Loaded cylinders instead of coins with a conical edge
    #[arg(long)]
    loaded: bool,

    /// Only coins of these ratios [default: all]
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    ratios: Vec<f64>,
}

/// Tosses by their face.
#[derive(Debug, Clone, Copy, Default)]
struct Shown {
    tosses: u64,
    faces: [u64; 3],
}

impl Shown {
    fn add(&mut self, face: Option<Face>) {
        self.tosses += 1;
        if let Some(face) = face {
            self.faces[face as usize] += 1;
        }
    }

    fn share(&self, face: Face) -> f64 {
        self.faces[face as usize] as f64 / self.tosses as f64
    }

    /// One standard error of the share.
    fn error(&self, face: Face) -> f64 {
        let p = self.share(face);
        (p * (1.0 - p) / self.tosses as f64).sqrt()
    }
}

/// What engine and oracle show, and how many of the oracle's tosses end with the engine's face.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    engine: Shown,
    oracle: Shown,
    alike: u64,
}

impl Found {
    /// The largest difference of a face, in standard errors of independent tosses.
    fn z(&self) -> f64 {
        let faces = [Face::Heads, Face::Tails, Face::Side].into_iter();
        let z = faces.map(|face| {
            let change = self.engine.share(face) - self.oracle.share(face);
            let (one, other) = (self.engine.error(face), self.oracle.error(face));
            change.abs() / (one * one + other * other).sqrt()
        });
        z.fold(0.0, f64::max)
    }
}

impl Conical {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let (all, unlike): (&[Unlike], _) = if self.loaded {
            (&LOADED, "centre")
        } else {
            (&DRAFTED, "draft_deg")
        };
        let asked = |scene: &&Unlike| self.ratios.is_empty() || self.ratios.contains(&scene.ratio);
        let scenes: Vec<&Unlike> = all.iter().filter(asked).collect();
        let found = survey(&scenes, |scene| self.compare(&case_of(scene), seed));
        let mut record = Table::new(
            format!(
                "Faces of coins whose heads and tails differ: {} tosses of the engine, {} of the oracle at the \
                 first of its launches",
                self.tosses, self.oracle_tosses
            ),
            &[
                "ratio",
                unlike,
                "restitution",
                "length",
                "heads",
                "tails",
                "side",
                "oracle_heads",
                "oracle_tails",
                "oracle_side",
                "oracle_error",
                "alike",
            ],
        );
        for (scene, found) in scenes.iter().zip(&found) {
            record.push(row(scene, found));
        }
        let worst = found.iter().map(Found::z).fold(0.0, f64::max);
        let mut report = Report::new(record);
        report.remark(format!(
            "Largest difference of a face: {worst:.1} standard errors."
        ));
        report.remark(
            "centre: of mass from the middle, over H. length: both friction lengths over R. oracle_error: one \
             standard error of oracle_side. alike: per cent of the oracle's tosses that show the engine's face.",
        );
        report
    }

    fn compare(&self, case: &Case, seed: u64) -> Found {
        let engine = volumetric(case, &Settings::default());
        let mut oracle = TimeStepper::new(&case.scene, StepperSettings::default());
        let mut found = Found::default();
        for toss in 0..self.tosses.max(self.oracle_tosses) {
            let launch = case.launch(seed, toss);
            let face = engine
                .toss(&mut engine.workspace(), &launch, &mut ())
                .face();
            if toss < self.tosses {
                found.engine.add(face);
            }
            if toss < self.oracle_tosses {
                let other = oracle.toss(&launch).face;
                found.oracle.add(other);
                found.alike += u64::from(face == other);
            }
        }
        found
    }
}

fn case_of(scene: &Unlike) -> Case {
    let Unlike {
        ratio,
        draft_deg,
        centre,
        restitution,
        length,
    } = *scene;
    let mut case = Case::new(Preset::Clean, 0.01, ratio, restitution, FRICTION).rolling(length);
    let coin = Coin::cylinder(ratio, 0.01)
        .and_then(|coin| coin.with_draft(draft_deg))
        .and_then(|coin| coin.with_centre_of_mass(centre, None, None));
    case.scene.coin = coin.expect("scenes of the study can be");
    case
}

fn row(scene: &Unlike, found: &Found) -> Vec<String> {
    let mut cells: Vec<String> = [
        scene.ratio,
        // the one that is not 0
        scene.draft_deg + scene.centre,
        scene.restitution,
        scene.length,
    ]
    .map(|number| number.to_string())
    .into();
    for shown in [&found.engine, &found.oracle] {
        let faces = [Face::Heads, Face::Tails, Face::Side];
        cells.extend(faces.map(|face| format!("{:.3}", shown.share(face))));
    }
    cells.push(format!("{:.3}", found.oracle.error(Face::Side)));
    cells.push(format!(
        "{:.1}",
        100.0 * found.alike as f64 / found.oracle.tosses as f64
    ));
    cells
}
