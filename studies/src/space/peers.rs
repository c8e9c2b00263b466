//! Our P(side) beside what other engines give in the same scenes.

use super::tightened;
use crate::paired::{Paired, undecided};
use crate::survey::{FRICTION, survey_tosses};
use anyhow::Context;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::Preset;
use coinmc_volumetric::Settings;

const PUBLISHED: &str = include_str!("../../../data/peer-engines.csv");

/// Friction lengths in radii; the peers' engines have none.
const RHOS: [f64; 4] = [0.0, 0.001, 0.003, 0.01];
/// H/R of both scenes.
const RATIO: f64 = 1.0;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpacePeers {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "200_000", value_name = "N")]
    tosses: u64,
}

/// A row of the data.
#[derive(Debug, PartialEq)]
struct Peer<'a> {
    engine: &'a str,
    version: &'a str,
    scene: &'a str,
    step_s: &'a str,
    p_side: &'a str,
    half_width: &'a str,
}

/// Ours: a case, and what is special about it.
struct Ours {
    scene: &'static str,
    variant: String,
    case: Case,
}

impl SpacePeers {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let peers = peers(PUBLISHED)?;
        let ours = ours();
        let default = Settings::default();
        let tight = tightened(&default);
        let found = survey_tosses(
            &ours,
            self.tosses,
            |one, tosses| Paired::in_space(&one.case, [&default, &tight], seed, tosses),
            Paired::merge,
        );
        let columns = [
            "scene",
            "engine",
            "variant",
            "p_side",
            "error",
            "bias",
            "undecided",
        ];
        let title = format!(
            "P(side) at H/R = {RATIO}: ours from {} tosses (95 %, statistical and numerical error \
             together), and others' as measured",
            self.tosses
        );
        let mut record = Table::new(title, &columns);
        for scene in ["clean", "table1"] {
            for (one, found) in ours
                .iter()
                .zip(&found)
                .filter(|(one, _)| one.scene == scene)
            {
                let error = found.side().half_width() + found.numerical_error();
                record.push(vec![
                    scene.to_owned(),
                    "coinmc".to_owned(),
                    one.variant.clone(),
                    number::probability(found.side().p),
                    number::probability(error),
                    number::difference(found.bias()),
                    undecided(&found.first),
                ]);
            }
            for peer in peers.iter().filter(|peer| peer.scene == scene) {
                let engine = format!("{} {}", peer.engine, peer.version);
                record.push(vec![
                    scene.to_owned(),
                    engine.trim_end().to_owned(),
                    format!("step {} s", peer.step_s),
                    peer.p_side.to_owned(),
                    peer.half_width.to_owned(),
                    String::new(),
                    String::new(),
                ]);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "No agreement is expected: the other engines solve contact in fixed steps, have no \
             friction lengths, and change with their step by more than their error. \
             clean: R = 1 cm, e = 0.5, mu = 0.3, from rest at 1 m. table1: the Unity scene. \
             bias: ours, default settings minus all of them ten times as tight.",
        );
        Ok(report)
    }
}

fn ours() -> Vec<Ours> {
    let clean = Case::new(Preset::Clean, 0.01, RATIO, 0.5, FRICTION);
    let table1 = Case::table1(RATIO);
    let mut all: Vec<Ours> = [("clean", clean), ("table1", table1)]
        .into_iter()
        .flat_map(|(scene, case)| {
            RHOS.map(|rho| Ours {
                scene,
                variant: format!("rho/R = {rho}"),
                case: case.rolling(rho),
            })
        })
        .collect();
    let mut gyroscopic = table1;
    gyroscopic.scene = gyroscopic.scene.with_gyroscopic_torque(true);
    all.push(Ours {
        scene: "table1",
        variant: "rho/R = 0 with gyroscopic torque".to_owned(),
        case: gyroscopic,
    });
    let surface = table1.scene.surface.with_restitution_threshold(0.0);
    let mut bouncing = table1;
    bouncing.scene.surface = surface.expect("0 is allowed");
    all.push(Ours {
        scene: "table1",
        variant: "rho/R = 0 without bounce threshold".to_owned(),
        case: bouncing,
    });
    all
}

/// The published values of engines in space.
fn peers(text: &str) -> anyhow::Result<Vec<Peer<'_>>> {
    let mut lines = text.lines();
    let titles = "engine,version,scene,step_s,p_side,half_width,tosses_per_cpu_s";
    anyhow::ensure!(
        lines.next() == Some(titles),
        "other columns than `{titles}`"
    );
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let [engine, version, scene, step_s, p_side, half_width, _] = cells[..] else {
                return Err(anyhow::anyhow!("`{line}` has not seven cells"));
            };
            let value: f64 = p_side.parse().with_context(|| format!("`{line}`"))?;
            anyhow::ensure!((0.0..=1.0).contains(&value), "`{line}` is no probability");
            Ok(Peer {
                engine,
                version,
                scene,
                step_s,
                p_side,
                half_width,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_data_are_of_the_two_scenes() {
        let peers = peers(PUBLISHED).unwrap();
        let of = |scene| peers.iter().filter(|peer| peer.scene == scene).count();
        assert_eq!((of("table1"), of("clean")), (4, 12));
        assert_eq!(of("table1") + of("clean"), peers.len());
    }

    #[test]
    fn other_columns_and_lines_are_refused() {
        assert!(peers("engine,p_side\nX,0.1\n").is_err());
        let titles = PUBLISHED.lines().next().unwrap();
        assert!(peers(&format!("{titles}\nX,1,clean,0.1,1.5,,\n")).is_err());
        assert!(peers(&format!("{titles}\nX,1,clean\n")).is_err());
    }
}
