//! The atlas: networks fitted to the tosses of a design, and how wrong they are at points that were not fitted.

mod points;

use anyhow::Context;
use clap::Args;
use coinmc::run::stored_report;
use coinmc_atlas::{Atlas as Part, Design, Training, fit};
use coinmc_bench::{Report, Table, number};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// 95 % of a normal distribution.
const Z95: f64 = 1.96;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Atlas {
    /// Run directories of a design of `crates/coinmc-atlas/designs`, with a seed each, or tables of points
    #[arg(required = true, value_name = "PATH")]
    designs: Vec<PathBuf>,

    /// Its launch
    #[arg(long, value_name = "NAME")]
    launch: String,

    /// File of networks to write; read, if there is one
    #[arg(long, value_name = "FILE")]
    networks: PathBuf,

    /// Parquet file of the points to write
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,

    /// The same of a seed of which nothing was fitted
    #[arg(long, value_name = "PATH")]
    fresh: Option<PathBuf>,

    /// Times that every point is looked at
    #[arg(long, value_name = "N", default_value_t = Training::default().epochs)]
    epochs: u32,

    /// Units of each hidden layer
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_values_t = Training::default().hidden)]
    hidden: Vec<usize>,

    /// Largest step of a weight
    #[arg(long, value_name = "R", default_value_t = Training::default().rate)]
    rate: f32,
}

impl Atlas {
    pub(crate) fn execute(&self) -> anyhow::Result<Report> {
        let mut designs = Vec::new();
        for path in &self.designs {
            designs.extend(tossed(path)?);
        }
        if let Some(path) = &self.points {
            points::write_points(&designs, &mut File::create_new(path)?)?;
        }
        let title = format!("The atlas for the launch `{}`", self.launch);
        let mut table = Table::new(title, &["what", "value"]);
        let mut row = |what: &str, value: String| table.push(vec![what.to_owned(), value]);
        let part = if self.networks.exists() {
            Part::read(&std::fs::read(&self.networks)?)?
        } else {
            let begun = Instant::now();
            let training = Training {
                hidden: self.hidden.clone(),
                epochs: self.epochs,
                rate: self.rate,
            };
            let part = fit(&self.launch, &designs, &training, 2, &|| true)?;
            let part = part.context("the fit was stopped")?;
            std::fs::write(&self.networks, part.bytes())?;
            row(
                "time of the fit, s",
                format!("{:.0}", begun.elapsed().as_secs_f64()),
            );
            part
        };
        row("points", part.points().to_string());
        row("tosses", part.tosses().to_string());
        if let Some(path) = &self.fresh {
            for (what, value) in checked(&part, &tossed(path)?)? {
                row(what, value);
            }
        }
        Ok(Report::new(table))
    }
}

/// The designs of a run directory or of a table of points.
fn tossed(path: &Path) -> anyhow::Result<Vec<Design>> {
    if path.is_dir() {
        let (_, report) = stored_report(path, &())?;
        return Ok(vec![Design::of(&report.results)?]);
    }
    points::read_points(path).with_context(|| path.display().to_string())
}

/// P(side) of a part against the counts at fresh points.
fn checked(part: &Part, fresh: &[Design]) -> anyhow::Result<Vec<(&'static str, String)>> {
    let (mut squares, mut claimed, mut covered, mut points, mut worst) =
        (0.0, 0.0, 0_u64, 0.0, 0.0_f64);
    let begun = Instant::now();
    for (place, counts) in fresh.iter().flat_map(Design::points) {
        let faces = part.faces(place)?;
        let (p, error) = (faces.p[2], faces.error[2]);
        let n = counts.faces.iter().sum::<u64>() as f64;
        let share = counts.faces[2] as f64 / n;
        // the binomial variance of the share at the fitted p; unbiased at the share itself for the squares
        let noise = p * (1.0 - p) / n;
        let off = share - p;
        squares += off * off - share * (1.0 - share) / (n - 1.0);
        claimed += error * error;
        covered += u64::from(off.abs() <= Z95 * (error * error + noise).sqrt() + 0.5 / n);
        worst = worst.max(off.abs() - Z95 * noise.sqrt());
        points += 1.0;
    }
    let each_us = 1e6 * begun.elapsed().as_secs_f64() / points;
    Ok(vec![
        ("fresh points", format!("{points}")),
        (
            "root mean square error of P(side)",
            number::probability((squares / points).max(0.0).sqrt()),
        ),
        (
            "the error that it states, root mean square",
            number::probability((claimed / points).sqrt()),
        ),
        (
            "share of fresh counts within 95 %",
            number::probability(covered as f64 / points),
        ),
        (
            "largest error beyond the noise of counts",
            number::probability(worst),
        ),
        ("time of an answer, us", format!("{each_us:.1}")),
    ])
}
