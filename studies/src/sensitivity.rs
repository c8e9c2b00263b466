//! What the fair ratio depends on: one parameter at a time, around a robot's toss.

use clap::Args;
use coinmc::results::{FairRatio, Results, Row, fair_ratios};
use coinmc_bench::runs::{plan, run_once};
use coinmc_bench::{Report, Table, number};

/// What is swept: its name in a config, and the values.
const AXES: [(&str, &str); 3] = [
    (
        "launch.height_m",
        "[0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0]",
    ),
    ("surface.restitution", "{ from = 0.1, to = 0.9, steps = 9 }"),
    (
        "surface.friction",
        "[0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0]",
    ),
];
/// Ratios at which P(side) is shown.
const SHOWN: [f64; 3] = [1.0, 1.5, 2.0];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Sensitivity {
    /// Tosses of each point
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,
}

impl Sensitivity {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let columns = [
            "parameter",
            "value",
            "fair_ratio",
            "fair_ratio_lo",
            "fair_ratio_hi",
            "p_side_1.0",
            "p_side_1.5",
            "p_side_2.0",
        ];
        let title = format!(
            "Ratio at which P(side) = 1/3: preset robot, R = 1 cm, drop 0.5 m, e = 0.5, mu = 0.3 \
             unless varied; ratios 0.5 to 3 in steps of 0.1, {} tosses each (95 % intervals)",
            self.tosses
        );
        let mut record = Table::new(title, &columns);
        for (parameter, values) in AXES {
            let results = run_once(&plan(&self.config(seed, parameter, values))?, None)?.results;
            for row in rows(parameter, &results) {
                record.push(row);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "Without a fair_ratio P(side) does not cross 1/3 in that range; more than one row of a \
             value: it crosses more than once.",
        );
        Ok(report)
    }

    fn config(&self, seed: u64, parameter: &str, values: &str) -> String {
        let base = [
            ("seed", seed.to_string()),
            (
                "coin.ratio",
                "{ from = 0.5, to = 3.0, steps = 26 }".to_owned(),
            ),
            ("coin.radius_m", "0.01".to_owned()),
            ("surface.restitution", "0.5".to_owned()),
            ("surface.friction", "0.3".to_owned()),
            ("launch.preset", "'robot'".to_owned()),
            ("engine.flat.law", "'moreau'".to_owned()),
            ("stop.tosses", self.tosses.to_string()),
        ];
        let kept = base.into_iter().filter(|(key, _)| *key != parameter);
        let lines = kept.map(|(key, value)| format!("{key} = {value}"));
        let lines = lines.chain([format!("{parameter} = {values}")]);
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// One row for each value of the parameter and each crossing.
fn rows(parameter: &str, results: &Results) -> Vec<Vec<String>> {
    let name = results.axes.iter().find(|name| *name != "ratio");
    let name = name.map_or("", String::as_str);
    let mut values: Vec<f64> = results
        .rows
        .iter()
        .filter_map(|row| row.parameter(name))
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let fair = fair_ratios(results, 1.0 / 3.0);
    let mut rows = Vec::new();
    for value in values {
        let at_value = |fair: &&FairRatio| fair.at.iter().any(|(_, v)| *v == value);
        let mut crossings: Vec<Option<&FairRatio>> =
            fair.iter().filter(at_value).map(Some).collect();
        if crossings.is_empty() {
            crossings.push(None);
        }
        let of_value = |row: &&Row| row.parameter(name) == Some(value);
        let sides = SHOWN.map(|ratio| {
            let mut rows = results.rows.iter().filter(of_value);
            let row = rows.find(|row| row.parameter("ratio") == Some(ratio));
            row.map_or_else(String::new, |row| number::probability(row.side.p))
        });
        for crossing in crossings {
            let mut cells = vec![parameter.to_owned(), value.to_string()];
            cells.extend(ratio_cells(crossing));
            cells.extend(sides.clone());
            rows.push(cells);
        }
    }
    rows
}

fn ratio_cells(fair: Option<&FairRatio>) -> [String; 3] {
    let ratio = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    match fair {
        Some(fair) => [ratio(Some(fair.ratio)), ratio(fair.lo), ratio(fair.hi)],
        None => [const { String::new() }; 3],
    }
}
