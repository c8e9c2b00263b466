//! The four reference values of an earlier study, under the law that it solved and under ours.
//!
//! Both demand the same of an impact: friction against the final slip, contour and pivoting
//! friction against their final rates. Ours ([`Moreau`](coinmc_volumetric::Moreau)) solves these
//! conditions together; the earlier study solved friction without the lengths and then added these
//! in a few sweeps ([`Sequential`]).

use super::sequential::Sequential;
use crate::survey::{FRICTION, side, survey_tosses, tally, volumetric};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Preset, Tally};
use coinmc_volumetric::{Settings, VolumetricEngine};

/// A published value.
struct Reference {
    ratio: f64,
    restitution: f64,
    rho: f64,
    p_side: f64,
    error: f64,
}

const REFERENCES: [Reference; 4] = [
    Reference::new(0.25, 0.5, 0.01, 0.0306, 0.0004),
    Reference::new(0.85, 0.0, 0.01, 0.0611, 0.0005),
    Reference::new(0.85, 0.5, 0.01, 0.1468, 0.0008),
    Reference::new(2.0, 0.0, 0.003, 0.9061, 0.0007),
];

/// Sweeps of the sequential law; `None` is the joint law.
const LAWS: [Option<u32>; 8] = [
    Some(1),
    Some(2),
    Some(3),
    Some(4),
    Some(5),
    Some(6),
    Some(10),
    None,
];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceReferences {
    /// Tosses of each scene under each law
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    tosses: u64,
}

impl Reference {
    const fn new(ratio: f64, restitution: f64, rho: f64, p_side: f64, error: f64) -> Self {
        Self {
            ratio,
            restitution,
            rho,
            p_side,
            error,
        }
    }

    fn case(&self) -> Case {
        let case = Case::new(Preset::Clean, 0.01, self.ratio, self.restitution, FRICTION);
        case.rolling(self.rho)
    }

    /// The difference of a tally in standard errors, ours and theirs.
    fn z(&self, tally: &Tally) -> f64 {
        let (p, n) = (side(tally).p, tally.tosses() as f64);
        (p - self.p_side) / (p * (1.0 - p) / n + self.error * self.error).sqrt()
    }
}

impl SpaceReferences {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let with_laws = |scene: &'static Reference| LAWS.map(|law| (scene, law));
        let jobs: Vec<(&Reference, Option<u32>)> = REFERENCES.iter().flat_map(with_laws).collect();
        let tallies = survey_tosses(
            &jobs,
            self.tosses,
            |(scene, sweeps), tosses| {
                let (case, settings) = (scene.case(), Settings::default());
                match *sweeps {
                    Some(sweeps) => {
                        let law = Sequential { sweeps };
                        let engine = VolumetricEngine::new(&case.scene, &settings, law);
                        let engine = engine.expect("the defaults are in range");
                        tally(&case, &engine, seed, tosses)
                    }
                    None => tally(&case, &volumetric(&case, &settings), seed, tosses),
                }
            },
            Tally::merge,
        );
        let columns = [
            "ratio",
            "restitution",
            "rho_over_r",
            "law",
            "p_side",
            "p_side_lo",
            "p_side_hi",
            "published",
            "its_error",
            "z",
        ];
        let title = format!(
            "The reference values (clean, mu = {FRICTION}), {} tosses a scene and law, 95 % intervals",
            self.tosses
        );
        let mut record = Table::new(title, &columns);
        for ((scene, law), tally) in jobs.iter().zip(&tallies) {
            let estimate = side(tally);
            record.push(vec![
                scene.ratio.to_string(),
                scene.restitution.to_string(),
                scene.rho.to_string(),
                law.map_or("joint".to_owned(), |sweeps| format!("sequential {sweeps}")),
                number::probability(estimate.p),
                number::probability(estimate.lo),
                number::probability(estimate.hi),
                format!("{:.4}", scene.p_side),
                format!("{:.4}", scene.error),
                format!("{:+.1}", scene.z(tally)),
            ]);
        }
        let mut report = Report::new(record);
        report.remark(Self::summary(&tallies));
        report.remark(
            "joint: the engine's law, all conditions of an impact solved together. sequential n: \
             friction without the lengths, then n sweeps over contour, pivoting and, where the \
             contact sticks, sideways friction, as the earlier study did. z: difference from the \
             published value in standard errors of both.",
        );
        report
    }

    /// Each law over the four scenes.
    fn summary(tallies: &[Tally]) -> String {
        let chi2 = |law: usize| -> f64 {
            let scenes = REFERENCES.iter().zip(tallies.chunks(LAWS.len()));
            scenes
                .map(|(scene, laws)| scene.z(&laws[law]).powi(2))
                .sum()
        };
        let laws: Vec<String> = (0..LAWS.len())
            .map(|law| {
                let name = LAWS[law].map_or("joint".to_owned(), |sweeps| sweeps.to_string());
                format!("{name}: {:.1}", chi2(law))
            })
            .collect();
        format!(
            "Sum of z² over the four scenes (95 % of right laws are below 9.5), by number of sweeps: {}",
            laws.join(", ")
        )
    }
}
