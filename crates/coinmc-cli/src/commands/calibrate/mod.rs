//! `coinmc calibrate`: a surface from what a person can measure, and what a coin does on it.

mod report;

use super::question::{AnswerArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc::config::Override;
use coinmc_calibrate::{
    Calibration, CalibrationError, Model, Observations, Settings, columns, csv, document,
    write_parquet,
};
use coinmc_recording::NewFile;
use std::io::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  coinmc calibrate examples/calibrate/thick-coin.toml
  coinmc calibrate my-coin.toml --posterior draws.parquet
  coinmc calibrate my-coin.toml --set coin.ratio=1.2      … another coin (give counts their own `coin`)
  coinmc calibrate my-coin.toml --format json

How to measure, and the tables of the config: docs/guide/calibrate.md.";

/// Find restitution and friction of a surface from measurements, and P(face) on it
///
/// Takes counts of tosses, filmed drops, rolls from a ramp, the angle of sliding, a spin that slows
/// down, the pitch of a whirring coin and the times of bounces, any of them together. Says what is then
/// known of the surface, what a coin does on it with every error apart, how thick a fair coin is, and
/// which further measurement would help most.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Calibrate {
    /// The config (TOML): a scene, and tables of measurements
    config: PathBuf,

    /// Replace or add a value of the config, as in `coin.ratio=1.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// New file for the draws of the posterior, .parquet or .csv
    #[arg(long, value_name = "FILE")]
    posterior: Option<PathBuf>,

    /// Draws of the posterior
    #[arg(long, value_name = "N", default_value = "4000", value_parser = super::count)]
    draws: u64,

    /// Surfaces, drawn from the prior, on which coins are tossed
    #[arg(long, value_name = "N", default_value = "1024", value_parser = super::count)]
    points: u64,

    /// Tosses on each of them
    #[arg(long, value_name = "N", default_value = "256", value_parser = super::count)]
    tosses: u64,

    /// Tosses of the prediction
    #[arg(long, value_name = "N", default_value = "32_768", value_parser = super::count)]
    predicted: u64,

    #[command(flatten)]
    answer: AnswerArgs,
}

impl Calibrate {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let file = self.posterior.as_deref().map(begin).transpose()?;
        let observed = Observations::load(&self.config, &self.overrides)?;
        let settings = Settings {
            points: self.points,
            tosses: self.tosses,
            draws: self.draws,
            predicted: self.predicted,
            ..Settings::default()
        };
        let (model, calibration) = ask(console, &self.answer, |workers| {
            let model = Model::new(observed, settings, workers)?;
            let calibration = Calibration::of(&model, workers)?;
            Ok::<_, CalibrationError>((model, calibration))
        })?;
        if let (Some(file), Some(path)) = (file, &self.posterior) {
            write(file, path, &model, &calibration)?;
        }
        match console.format() {
            Format::Json => output::print_json(&document(&model, &calibration)),
            Format::Table => output::print(&report::text(&model, &calibration, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }
}

fn ending(path: &Path) -> &str {
    path.extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or("")
}

/// Begins the file of the draws, before the work.
fn begin(path: &Path) -> Result<NewFile, Failure> {
    if !["csv", "parquet"].contains(&ending(path)) {
        return Err(Failure::Input(anyhow!(
            "--posterior {}: the name must end in .parquet or .csv",
            path.display()
        )));
    }
    Ok(NewFile::begin(path)?)
}

fn write(
    mut file: NewFile,
    path: &Path,
    model: &Model,
    calibration: &Calibration,
) -> Result<(), Failure> {
    let columns = columns(model, calibration);
    let written = match ending(path) {
        "csv" => file.write_all(csv(&columns).as_bytes()),
        _ => write_parquet(&columns, &document(model, calibration), &mut file),
    };
    written
        .and_then(|()| file.flush())
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
    file.finish()?;
    Ok(())
}
