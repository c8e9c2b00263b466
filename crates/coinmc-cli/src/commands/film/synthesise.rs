//! `coinmc film synthesise`: a simulated film, in Tracker's text format.

use super::super::question::write_file;
use super::files::Direction;
use super::law::LawName;
use super::scene::SceneArguments;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc_film::Synthetic;
use coinmc_film::text::{Delimiter, Dialect, write};
use coinmc_recording::NewFile;
use serde_json::json;
use std::path::PathBuf;

/// Write the film of a simulated drop, as Tracker would export it
///
/// For trying `read` and `fit`, and for planning an experiment: how well would such a film
/// determine the parameters? The arguments are the true values.
#[derive(Debug, Args)]
#[command(mut_arg("restitution", |arg| arg.help("Restitution [default: 0.5]")))]
#[command(mut_arg("friction", |arg| arg.help("Friction [default: 0.3]")))]
#[command(mut_arg("floor_m", |arg| arg.help("Height of the surface in the film, m")))]
#[command(mut_arg("eta", |arg| arg.help("η of Gaek & Sukhov's law, N s [default: 0.001]")))]
pub(super) struct Synthesise {
    /// The new file
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    scene: SceneArguments,

    /// The impact law
    #[arg(long, value_enum, value_name = "NAME", default_value_t = LawName::Moreau)]
    law: LawName,

    /// Initial state: x, x', z, z', θ, θ' in m, m/s, m, m/s, degrees, degrees/s
    #[arg(long, value_name = "NUMBERS", num_args = 6, value_delimiter = ',')]
    #[arg(default_values_t = [0.0, 0.1, 0.2, 0.0, 23.0, 170.0], allow_negative_numbers = true)]
    start: Vec<f64>,

    /// Frame rate, 1/s
    #[arg(long, value_name = "HZ", default_value_t = 240.0)]
    rate: f64,

    /// Length of the film, s
    #[arg(long, value_name = "S", default_value_t = 0.6)]
    duration: f64,

    /// Standard deviation of marked positions, mm
    #[arg(long, value_name = "MM", default_value_t = 0.5)]
    noise_mm: f64,

    /// Standard deviation of marked angles, degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.5)]
    noise_deg: f64,

    /// Fraction of unmarked points
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    missing: f64,

    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// The direction that the angle measures
    #[arg(long, value_enum, default_value_t = Direction::Face)]
    angle_of: Direction,

    /// Separator between cells
    #[arg(long, value_enum, default_value_t = Between::Tab)]
    delimiter: Between,

    /// Write a comma as the decimal mark
    #[arg(long)]
    decimal_comma: bool,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Between {
    Tab,
    Semicolon,
    Comma,
}

impl Synthesise {
    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn execute(&self, _: &Console) -> Result<Outcome, Failure> {
        self.check()?;
        let file = NewFile::begin(&self.file)?;
        let (model, shared) = self.scene.model(self.law)?;
        let mut start = [0.0; 6];
        start.copy_from_slice(&self.start);
        (start[4], start[5]) = (start[4].to_radians(), start[5].to_radians());
        let film = Synthetic {
            seed: self.seed,
            shared,
            start,
            rate_hz: self.rate,
            duration_s: self.duration,
            position_noise_m: 1e-3 * self.noise_mm,
            angle_noise_rad: self.noise_deg.to_radians(),
            missing: self.missing,
        };
        let drop = film.film(&model).ok_or_else(|| {
            Failure::Input(anyhow!(
                "such a drop cannot be simulated: --start must be six numbers that are not far out of range, with \
                 the coin above the surface"
            ))
        })?;
        let dialect = Dialect {
            delimiter: match self.delimiter {
                Between::Tab => Delimiter::Tab,
                Between::Semicolon => Delimiter::Semicolon,
                Between::Comma => Delimiter::Comma,
            },
            decimal_comma: self.decimal_comma,
            ..Dialect::default()
        };
        let bytes = write(&drop, "coin", self.angle_of.into(), &dialect, Some(5));
        write_file(file, &bytes)?;
        let printed = match self.format {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "film_synthetic",
                "file": self.file.display().to_string(),
                "frames": drop.frames.len(),
            })),
            Format::Table => output::print(&format!(
                "{}: {} frames\n",
                self.file.display(),
                drop.frames.len()
            )),
        };
        printed.map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }

    fn check(&self) -> Result<(), Failure> {
        let refuse = |message: &str| Err(Failure::Input(anyhow!("{message}")));
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        if !(self.rate > 0.0 && self.rate.is_finite() && not_negative(self.duration)) {
            return refuse("--rate must be positive and --duration not negative");
        }
        if self.rate * self.duration > 99_999.0 {
            return refuse("a film has at most 100 000 frames: lower --rate or --duration");
        }
        if !(not_negative(self.noise_mm) && not_negative(self.noise_deg)) {
            return refuse("--noise-mm and --noise-deg must not be negative");
        }
        if !(0.0..1.0).contains(&self.missing) {
            return refuse("--missing must lie from 0 to below 1");
        }
        if self.delimiter == Between::Comma && self.decimal_comma {
            return refuse("commas between cells and decimal commas cannot be distinguished");
        }
        Ok(())
    }
}
