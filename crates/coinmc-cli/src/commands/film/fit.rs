//! `coinmc film fit`: fitting laws to drops.

use super::super::question::write_file;
use super::files::{Columns, begin_new};
use super::law::LawName;
use super::report;
use super::scene::SceneArguments;
use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc_film::{
    Fit as Fitted, Loss, Model, Options, Parameter, compare, fit_all, residuals_csv, residuals_svg,
};
use coinmc_recording::NewFile;
use std::path::PathBuf;

/// Fit impact laws to filmed drops and rank them
///
/// All drops share restitution and friction; each has its own initial state. Intervals and criteria
/// are explained in docs/guide/film.md.
#[derive(Debug, Args)]
pub(super) struct Fit {
    /// Text files exported by Tracker, one drop each
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    #[command(flatten)]
    scene: SceneArguments,

    #[command(flatten)]
    columns: Columns,

    /// Laws to fit, separated by commas [default: moreau,chatterjee-ruina]
    #[arg(long = "law", value_enum, value_name = "NAME", value_delimiter = ',')]
    #[arg(help_heading = "Fit")]
    laws: Vec<LawName>,

    /// Parameters to fit, if a law has them, separated by commas
    #[arg(long = "fit", value_enum, value_name = "NAME", value_delimiter = ',')]
    #[arg(default_value = "restitution,friction,eta", help_heading = "Fit")]
    free: Vec<Name>,

    /// Number of bounces to fit: frames count up to the next bounce after these
    #[arg(long, value_name = "N", default_value_t = 2, help_heading = "Fit")]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=20))]
    bounces: u8,

    /// Greatest time since the first frame to fit, s
    #[arg(long, value_name = "S", help_heading = "Fit")]
    until: Option<f64>,

    /// Loss of the residuals
    #[arg(long, value_enum, default_value_t = LossName::Square, help_heading = "Fit")]
    loss: LossName,

    /// Confidence of the intervals
    #[arg(long, value_name = "P", default_value_t = 0.95, help_heading = "Fit")]
    confidence: f64,

    /// New file for the fit, as JSON
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// New file for the residuals: .csv of all laws, .svg of the best; repeatable
    #[arg(long, value_name = "FILE")]
    residuals: Vec<PathBuf>,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    Restitution,
    Friction,
    /// η of Gaek & Sukhov's law
    Eta,
    /// Duration of the half sine
    Time,
    /// Peak of the half sine, if --peak-n gives one
    Peak,
    /// Stiffness of the contact relative to that of its materials
    Stiffness,
    /// Height of the surface in the film
    Floor,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LossName {
    /// Squares, for normal noise
    Square,
    /// Huber's, for films with outliers
    Huber,
}

impl Fit {
    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        for path in &self.residuals {
            if !["csv", "svg"].contains(&ending(path)) {
                return Err(Failure::Input(anyhow!(
                    "--residuals {}: the name must end in .csv or .svg",
                    path.display()
                )));
            }
        }
        interrupt::end_at_once(console)?;
        let files = begin_new(self.out.iter().chain(&self.residuals))?;
        let (models, options) = self.task()?;
        let footage = self.columns.read_once_each(&self.files)?;
        let drops: Vec<_> = footage.into_iter().map(|footage| footage.drop).collect();
        let fits =
            fit_all(&models, &drops, &options).map_err(|error| Failure::Input(error.into()))?;
        self.write(files, &fits)?;
        let printed = match self.format {
            Format::Json => output::print_json(&report::to_json(&fits)),
            Format::Table => output::print(&report::to_text(&fits, console.stdout())),
        };
        printed.map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }

    fn task(&self) -> Result<(Vec<Model>, Options), Failure> {
        let mut laws: Vec<LawName> = Vec::new();
        let asked = if self.laws.is_empty() {
            &LawName::DEFAULT[..]
        } else {
            &self.laws
        };
        for law in asked {
            if !laws.contains(law) {
                laws.push(*law);
            }
        }
        let mut models = Vec::new();
        let mut shared = Options::default().shared;
        for law in laws {
            let (model, given) = self.scene.model(law)?;
            models.push(model);
            shared = given;
        }
        let until_s = self.until.unwrap_or(f64::INFINITY);
        if until_s.is_nan() || until_s <= 0.0 {
            return Err(Failure::Input(anyhow!("--until must be positive")));
        }
        let options = Options {
            free: self
                .free
                .iter()
                .map(|name| Parameter::from(*name))
                .collect(),
            shared,
            bounces: usize::from(self.bounces),
            until_s,
            loss: match self.loss {
                LossName::Square => Loss::Square,
                LossName::Huber => Loss::Huber,
            },
            confidence: self.confidence,
        };
        Ok((models, options))
    }

    /// Writes the files of `out` and `residuals`, in this order.
    fn write(&self, files: Vec<NewFile>, fits: &[Fitted]) -> Result<(), Failure> {
        let fit = || format!("{:#}\n", report::to_json(fits));
        let best = compare(fits).first().map_or(0, |ranked| ranked.fit);
        let residuals = self.residuals.iter().map(|path| match ending(path) {
            "svg" => residuals_svg(&fits[best]),
            _ => residuals_csv(fits),
        });
        let texts = self.out.iter().map(|_| fit()).chain(residuals);
        for (file, text) in files.into_iter().zip(texts) {
            write_file(file, text)?;
        }
        Ok(())
    }
}

fn ending(path: &std::path::Path) -> &str {
    path.extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or("")
}

impl From<Name> for Parameter {
    fn from(name: Name) -> Self {
        match name {
            Name::Restitution => Self::Restitution,
            Name::Friction => Self::Friction,
            Name::Eta => Self::Eta,
            Name::Time => Self::PulseTime,
            Name::Peak => Self::Peak,
            Name::Stiffness => Self::Stiffness,
            Name::Floor => Self::Floor,
        }
    }
}
