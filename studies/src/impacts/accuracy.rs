//! Work and precision: error of the state after an impact, and of P(side), against run time.

use super::{distance, impact, line, materials, pulse, scene, touch};
use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Engine, Face, Launch, Preset, Scene};
use coinmc_flat::{Law, LineContact, PulseTime, Settings};
use coinmc_testkit::Dice;
use std::hint::black_box;
use std::time::Instant;

const TOLERANCES: [f64; 10] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12,
];

/// The quickest of so many counts: the others were disturbed.
const REPEATS: usize = 7;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct ImpactAccuracy {
    /// Impacts of each law at each tolerance
    #[arg(long, value_parser = number::count, default_value = "300", value_name = "N")]
    impacts: u64,

    /// Tosses of each law at each tolerance
    #[arg(long, value_parser = number::count, default_value = "300", value_name = "N")]
    tosses: u64,
}

/// A law, where it has friction.
struct Subject {
    name: &'static str,
    law: fn() -> Law,
    friction: f64,
}

const SUBJECTS: [Subject; 5] = [
    Subject {
        name: "moreau",
        law: || Law::Moreau,
        friction: 0.3,
    },
    Subject {
        name: "gaek-sukhov",
        law: || super::curves::gaek_sukhov(1e-3, coinmc_flat::Lever::Height),
        friction: 0.0,
    },
    Subject {
        name: "half-sine",
        law: || pulse(PulseTime::Contact(materials(1.0))),
        friction: 0.3,
    },
    Subject {
        name: "line-contact (no friction)",
        law: || line(materials(1.0), LineContact::mindlin(super::POISSON)),
        friction: 0.0,
    },
    Subject {
        name: "line-contact",
        law: || line(materials(1.0), LineContact::mindlin(super::POISSON)),
        friction: 0.3,
    },
];

/// A law's row at a tolerance.
struct Measured {
    median: f64,
    worst: f64,
    steps: f64,
    impact_us: f64,
    faces: Faces,
    toss_us: f64,
}

/// The same tosses at this tolerance and at the tightest.
struct Faces {
    p_side: f64,
    /// Tosses that end on another face.
    changed: usize,
    /// P(side) at this tolerance less that at the tightest.
    difference: f64,
    /// Its standard error: of tosses paired one by one, far below that of either.
    error: f64,
}

impl Faces {
    fn new(now: &[Option<Face>], tightest: &[Option<Face>]) -> Self {
        let n = now.len() as f64;
        let side = |face: &Option<Face>| f64::from(u8::from(*face == Some(Face::Side)));
        let pairs = || now.iter().zip(tightest);
        let difference = pairs().map(|(a, b)| side(a) - side(b)).sum::<f64>() / n;
        let square = pairs().map(|(a, b)| (side(a) - side(b)).abs()).sum::<f64>() / n;
        Self {
            p_side: now.iter().map(side).sum::<f64>() / n,
            changed: pairs().filter(|(a, b)| a != b).count(),
            difference,
            error: ((square - difference * difference) / n).sqrt(),
        }
    }
}

impl ImpactAccuracy {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let columns = [
            "law",
            "tolerance",
            "median_error",
            "worst_error",
            "steps",
            "impact_us",
            "order",
            "p_side",
            "changed_faces",
            "p_side_change",
            "p_side_change_se",
            "toss_us",
        ];
        let title = format!(
            "Error of the velocity after an impact over the speed of approach, {} impacts, and faces \
             of {} tosses (robot, H/R 1.2, e .5), against tolerance 1e-12",
            self.impacts, self.tosses
        );
        let mut record = Table::new(title, &columns);
        for (subject, rows) in SUBJECTS
            .iter()
            .zip(survey(&SUBJECTS, |subject| self.rows(subject, seed)))
        {
            let mut last: Option<&Measured> = None;
            for (tolerance, row) in TOLERANCES.iter().zip(&rows) {
                let order = last.filter(|last| row.median > 0.0 && last.steps < row.steps);
                let order = order.map_or_else(String::new, |last| {
                    let (fell, grew) = (last.median / row.median, row.steps / last.steps);
                    format!("{:.1}", libm::log(fell) / libm::log(grew))
                });
                record.push(vec![
                    subject.name.to_owned(),
                    format!("{tolerance:e}"),
                    number::tiny(row.median),
                    number::tiny(row.worst),
                    format!("{:.1}", row.steps),
                    format!("{:.2}", row.impact_us),
                    order,
                    number::probability(row.faces.p_side),
                    row.faces.changed.to_string(),
                    format!("{:+.4}", row.faces.difference),
                    format!("{:.4}", row.faces.error),
                    format!("{:.1}", row.toss_us),
                ]);
                last = Some(row);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "order: of the median error in the number of steps, since the row before (the pair's is \
             5). Laws without steps are exact to rounding. A toss of moreau uses the tolerance in \
             sliding contact only. changed_faces, p_side_change: against the same tosses at 1e-12; the \
             error is that of pairs.",
        );
        report
    }

    fn rows(&self, subject: &Subject, seed: u64) -> Vec<Measured> {
        let samples: Vec<(Scene, Launch, f64)> = (0..self.impacts)
            .map(|trial| sample(subject, seed, trial))
            .collect();
        let law = (subject.law)();
        let exact: Vec<_> = samples
            .iter()
            .map(|(scene, launch, _)| impact(scene, law, 1e-12, launch).after)
            .collect();
        let faces = self.faces(subject, 1e-12, seed).0;
        TOLERANCES
            .iter()
            .map(|&tolerance| {
                let mut impact_us = f64::INFINITY;
                let mut found = Vec::new();
                for _ in 0..REPEATS {
                    let begun = Instant::now();
                    let each = |(scene, launch, _): &(Scene, Launch, f64)| {
                        black_box(impact(scene, law, tolerance, launch))
                    };
                    found = samples.iter().map(each).collect();
                    let mean = begun.elapsed().as_secs_f64() * 1e6 / self.impacts as f64;
                    impact_us = impact_us.min(mean);
                }
                let errors: Vec<f64> = found
                    .iter()
                    .zip(&exact)
                    .zip(&samples)
                    .map(|((found, exact), (scene, _, speed))| {
                        distance(scene, &found.after, exact) / speed
                    })
                    .collect();
                let steps: u32 = found.iter().map(|found| found.steps).sum();
                let (now, toss_us) = self.faces(subject, tolerance, seed);
                Measured {
                    median: number::median(&errors),
                    worst: errors.iter().fold(0.0, |worst, e| e.max(worst)),
                    steps: f64::from(steps) / self.impacts as f64,
                    impact_us,
                    faces: Faces::new(&now, &faces),
                    toss_us,
                }
            })
            .collect()
    }

    /// The faces of the tosses, and the time of one.
    fn faces(&self, subject: &Subject, tolerance: f64, seed: u64) -> (Vec<Option<Face>>, f64) {
        let case = Case::new(Preset::Robot, 0.01, 1.2, 0.5, subject.friction);
        let settings = Settings {
            law: (subject.law)(),
            tolerance,
            ..Settings::default()
        };
        let engine = settings.engine(&case.scene).expect("settings are in range");
        let (launches, stream) = (case.launches(), Case::stream(seed));
        let begun = Instant::now();
        let faces = (0..self.tosses)
            .map(|toss| {
                let launch = launches.launch(&case.scene.coin, &mut stream.toss(toss));
                engine.toss(&mut (), &launch, &mut ()).face()
            })
            .collect();
        (
            faces,
            begun.elapsed().as_secs_f64() * 1e6 / self.tosses as f64,
        )
    }
}

/// An impact of a coin dropped from about 1 m.
fn sample(subject: &Subject, seed: u64, trial: u64) -> (Scene, Launch, f64) {
    let mut dice = Dice::new(seed, trial);
    let scene = scene(
        dice.scale(0.5, 2.0),
        dice.between(0.2, 0.9),
        subject.friction,
    );
    let speed = dice.between(2.0, 5.0);
    let launch = touch(
        dice.between(0.1, 1.5),
        dice.between(-1.0, 1.0),
        -speed,
        dice.between(-30.0, 30.0),
    );
    (scene, launch, speed)
}
