//! `coinmc film fit`: laws fitted to drops.

use super::files::{Columns, must_be_new, write_new};
use super::law::LawName;
use super::report;
use super::scene::SceneArguments;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc_film::{
    Fit as Fitted, Loss, Model, Options, Parameter, compare, fit_all, residuals_csv, residuals_svg,
};
use std::path::PathBuf;

/// Fit laws of impact to filmed drops, and say which describes them best
///
/// All drops share restitution and friction; each has its own first state. Intervals and criteria
/// are explained in docs/guide/film.md.
#[derive(Debug, Args)]
pub(super) struct Fit {
    /// Files of text that Tracker exported, one drop each
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    #[command(flatten)]
    scene: SceneArguments,

    #[command(flatten)]
    columns: Columns,

    /// Laws to fit; several with commas [default: moreau,chatterjee-ruina]
    #[arg(long = "law", value_enum, value_name = "NAME", value_delimiter = ',')]
    #[arg(help_heading = "Fit")]
    laws: Vec<LawName>,

    /// Parameters to fit, of laws that have them; several with commas
    #[arg(long = "fit", value_enum, value_name = "NAME", value_delimiter = ',')]
    #[arg(default_values_t = [Name::Restitution, Name::Friction, Name::Eta], help_heading = "Fit")]
    free: Vec<Name>,

    /// The film counts up to the bounce after this many
    #[arg(long, value_name = "N", default_value_t = 2, help_heading = "Fit")]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=20))]
    bounces: u8,

    /// And no longer than this after its first frame, s
    #[arg(long, value_name = "S", help_heading = "Fit")]
    until: Option<f64>,

    /// What residuals cost
    #[arg(long, value_enum, default_value_t = LossName::Square, help_heading = "Fit")]
    loss: LossName,

    /// Confidence of the intervals
    #[arg(long, value_name = "P", default_value_t = 0.95, help_heading = "Fit")]
    confidence: f64,

    /// New file to write the fit to, as JSON
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// New file to write the residuals to: .csv of all laws, .svg of the best; repeatable
    #[arg(long, value_name = "FILE")]
    residuals: Vec<PathBuf>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    Restitution,
    Friction,
    /// η of Gaek & Sukhov's law
    Eta,
    /// Length of the half sine
    Time,
    /// Height of the half sine, where --peak-n gives one
    Peak,
    /// Stiffness of the contact, over that of its materials
    Stiffness,
    /// Height of the surface in the film
    Floor,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LossName {
    /// Squares, for normal noise
    Square,
    /// Huber's, where points may be marked wrongly
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
        must_be_new(self.out.iter().chain(&self.residuals))?;
        let (models, options) = self.task()?;
        let footage = self.columns.read(&self.files)?;
        let drops: Vec<_> = footage.into_iter().map(|footage| footage.drop).collect();
        let fits =
            fit_all(&models, &drops, &options).map_err(|error| Failure::Input(error.into()))?;
        self.write(&fits)?;
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
            &LawName::USUAL[..]
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

    fn write(&self, fits: &[Fitted]) -> Result<(), Failure> {
        if let Some(path) = &self.out {
            let text = format!("{:#}\n", report::to_json(fits));
            write_new(path, text.as_bytes())?;
        }
        let best = compare(fits).first().map_or(0, |ranked| ranked.fit);
        for path in &self.residuals {
            let text = match ending(path) {
                "svg" => residuals_svg(&fits[best]),
                _ => residuals_csv(fits),
            };
            write_new(path, text.as_bytes())?;
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
