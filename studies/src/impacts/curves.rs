//! P(side) against H/R and the fair ratio under every law of impact: the paper's over its two
//! constants, and the others beside it.

use clap::Args;
use coinmc::results::{Results, Row, fair_ratios};
use coinmc_bench::runs::{plan, run_once};
use coinmc_bench::{Report, Table, number};
use coinmc_core::Tally;
use coinmc_flat::{GaekSukhov, Law, Lever};

/// η: a coin of 10 g has such momenta at 0.01 to 3 m/s, the robot's at 3 m/s.
const ETAS_N_S: [f64; 6] = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
/// √k.
const RESTITUTIONS: [f64; 3] = [0.3, 0.5, 0.7];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct ImpactCurves {
    /// Tosses of each ratio
    #[arg(long, value_parser = number::count, default_value = "5_000", value_name = "N")]
    tosses: u64,

    /// Tosses of each ratio under the line contact, which costs a hundred times as much
    #[arg(long, value_parser = number::count, default_value = "2_000", value_name = "N")]
    line_tosses: u64,
}

/// Gaek & Sukhov's law with this constant.
pub(super) fn gaek_sukhov(eta_n_s: f64, lever: Lever) -> Law {
    Law::GaekSukhov(GaekSukhov { eta_n_s, lever })
}

/// A curve: its law in words and as a config, restitution, friction.
struct Curve {
    name: String,
    law: String,
    restitution: f64,
    friction: f64,
}

fn curves() -> Vec<Curve> {
    let contact = format!(
        "coin_young_pa = {}, coin_poisson = {1}, surface_young_pa = {2}, surface_poisson = {1}, \
         length_m = {3}",
        super::COIN_YOUNG_PA,
        super::POISSON,
        super::SURFACE_YOUNG_PA,
        super::LENGTH_M
    );
    let mut curves = Vec::new();
    let mut push = |name: String, law: String, restitution: f64, friction: f64| {
        curves.push(Curve {
            name,
            law,
            restitution,
            friction,
        });
    };
    for restitution in RESTITUTIONS {
        for lever in [Lever::Height, Lever::Corner] {
            for eta in ETAS_N_S {
                let lever = lever.name();
                let law = format!("{{ gaek-sukhov = {{ eta_n_s = {eta:e}, lever = '{lever}' }} }}");
                push(
                    format!("gaek-sukhov {lever} {eta:e}"),
                    law,
                    restitution,
                    0.0,
                );
            }
        }
        for friction in [0.0, 0.3] {
            push(
                "moreau".to_owned(),
                "'moreau'".to_owned(),
                restitution,
                friction,
            );
            for time in ["1e-3", "1e-4"] {
                let law = format!("{{ half-sine = {{ time_s = {time} }} }}");
                push(format!("half-sine {time} s"), law, restitution, friction);
            }
            let law = format!("{{ line-contact = {{ {contact} }} }}");
            push("line-contact".to_owned(), law, restitution, friction);
        }
    }
    curves
}

impl ImpactCurves {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let columns = [
            "law",
            "restitution",
            "friction",
            "ratio",
            "p_side",
            "p_side_lo",
            "p_side_hi",
            "undecided",
            "broken_impacts",
            "fair_ratio",
            "fair_ratio_lo",
            "fair_ratio_hi",
            "crossings",
        ];
        let title = format!(
            "P(side): preset robot, coin of 10 g and R = 1 cm, {} tosses each ({} under the line \
             contact); 95 % intervals",
            self.tosses, self.line_tosses
        );
        let mut record = Table::new(title, &columns);
        let mut firsts = Vec::new();
        let mut count = 0;
        for curve in curves() {
            let results = run_once(&plan(&self.config(seed, &curve))?, None)?.results;
            firsts.push(count);
            for row in &results.rows {
                record.push(cells(&curve, row, &results));
                count += 1;
            }
        }
        let shown = record.select("The first ratio of each curve, and its fair ratio", firsts);
        let mut report = Report::new(record);
        report.show(shown);
        report.remark(
            "law: of the paper, lever and eta in N s. broken_impacts: share of impacts at which a \
             fallback stood in or energy was taken back. Published: 1.5 ± 0.05 (Gaek & Sukhov, arXiv \
             2401.03557). fair_ratio: the first, where P(side) crosses 1/3 more than once.",
        );
        Ok(report)
    }

    fn config(&self, seed: u64, curve: &Curve) -> String {
        let tosses = if curve.name == "line-contact" {
            self.line_tosses
        } else {
            self.tosses
        };
        format!(
            "seed = {seed}\npaired = true\ncoin.ratio = {{ from = 0.5, to = 2.5, steps = 11 }}\n\
             surface.restitution = {}\nsurface.friction = {}\nlaunch.preset = 'robot'\n\
             engine.flat = {{ law = {}, tolerance = 1e-4 }}\nstop.tosses = {tosses}\n",
            curve.restitution, curve.friction, curve.law
        )
    }
}

fn cells(curve: &Curve, row: &Row, results: &Results) -> Vec<String> {
    let fair = fair_ratios(results, 1.0 / 3.0);
    let ratio = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    let only = fair.first();
    vec![
        curve.name.clone(),
        curve.restitution.to_string(),
        curve.friction.to_string(),
        row.parameter("ratio").unwrap_or_default().to_string(),
        number::probability(row.side.p),
        number::probability(row.side.lo),
        number::probability(row.side.hi),
        row.tally.undecided().to_string(),
        number::probability(broken(&row.tally)),
        ratio(only.map(|fair| fair.ratio)),
        ratio(only.and_then(|fair| fair.lo)),
        ratio(only.and_then(|fair| fair.hi)),
        fair.len().to_string(),
    ]
}

/// Share of impacts with a fallback; a gain of energy is part of a negative height where there is
/// one.
fn broken(tally: &Tally) -> f64 {
    let heights = tally.negative_heights.max(tally.energy_gains);
    (heights + tally.sinkings + tally.unresolved) as f64 / tally.impacts as f64
}
