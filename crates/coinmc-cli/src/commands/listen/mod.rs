//! `coinmc listen`: a coin in a sound recording, and what it tells of the surface.

mod report;
mod synthetic;

use super::question::{AnswerArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, RowsFormat};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc::config::Override;
use coinmc_calibrate::Observations;
use coinmc_listen::{Effort, Heard, Kind, ListenError, Told, csv, document};
use std::path::PathBuf;
use synthetic::SyntheticArgs;

const EXAMPLES: &str = "\
Examples:
  coinmc listen drop.wav                               when does it strike?
  coinmc listen drop-*.wav --config my-coin.toml       … and which surface sounds like that?
  coinmc listen spin.wav --config my-coin.toml         rolling friction from the whirr
  coinmc listen --synthetic drop.wav --config my-coin.toml --noise-db 10

How to record, and what the config says: docs/guide/listen.md.";

/// Hear a dropped or spun coin in sound recordings, and what it tells of the surface
///
/// Finds the impacts of a dropped coin, and the pitch of one that whirrs as it settles. With a config that says
/// coin and launch, restitution and friction follow from simulated drops that sound alike, and rolling friction
/// from the whirr. Several recordings of the same coin and launch together say more.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Listen {
    /// Recordings (WAV)
    #[arg(value_name = "FILE", required_unless_present = "synthetic")]
    files: Vec<PathBuf>,

    /// The config (TOML): coin, launch and what is believed of the surface, as for `coinmc calibrate`
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,

    /// Replace or add a value of the config, as in `launch.height_m=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "config")]
    overrides: Vec<Override>,

    /// What the recordings are of [default: a spin if it whirrs, else a drop]
    #[arg(long, value_enum, value_name = "KIND")]
    of: Option<KindName>,

    /// Surfaces, drawn from the prior, on which drops are simulated
    #[arg(long, value_name = "N", default_value = "20_000", value_parser = super::count)]
    #[arg(requires = "config")]
    surfaces: u64,

    /// Seed of all random numbers
    #[arg(long, default_value_t = 1, requires = "config")]
    seed: u64,

    #[command(flatten)]
    synthetic: SyntheticArgs,

    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = RowsFormat::Table)]
    format: RowsFormat,

    /// Show no progress and no remarks, only warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum KindName {
    Drop,
    Spin,
}

impl From<KindName> for Kind {
    fn from(name: KindName) -> Self {
        match name {
            KindName::Drop => Self::Drop,
            KindName::Spin => Self::Whirr,
        }
    }
}

impl Listen {
    pub(crate) fn format(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        // impacts hardly tell how rough the ground is
        let load =
            |path| Observations::load(path, &self.overrides).map(Observations::with_known_ground);
        let observed = self.config.as_deref().map(load).transpose()?;
        if self.synthetic.is_asked_for() {
            return self.synthetic.write(observed.as_ref(), self.seed, console);
        }
        let scene = observed
            .as_ref()
            .map(|observed| &observed.plan.points[0].scene);
        let heard = Heard::of_files(&self.files, scene, self.of.map(Kind::from))
            .map_err(|error| Failure::Input(anyhow!(error)))?;
        let mut told = None;
        if let Some(observed) = &observed {
            let effort = Effort {
                surfaces: self.surfaces,
                seed: self.seed,
            };
            let answer = AnswerArgs {
                threads: self.threads,
                format: self.format(),
                quiet: self.quiet,
            };
            let answered = ask(console, &answer, |workers| {
                Told::of(&heard, observed, effort, workers)
            })?;
            told = Some((answered, observed));
        }
        let told = told.as_ref().map(|(told, observed)| (told, *observed));
        match self.format {
            RowsFormat::Json => output::print_json(&document(&heard, told)),
            RowsFormat::Csv => output::print(&csv(&heard)),
            RowsFormat::Table => {
                let style = console.stdout();
                output::print(&report::text(&heard, told, style, self.quiet))
            }
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }
}

impl From<ListenError> for super::question::Unanswered {
    fn from(error: ListenError) -> Self {
        match error {
            ListenError::Question(error) => error.into(),
            ListenError::Calibration(error) => error.into(),
            error => Self::Failed(Failure::Input(error.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Words {
        #[command(flatten)]
        listen: super::Listen,
    }

    /// Without a config nothing is simulated, so that numbers of a simulation say that it is missing.
    #[test]
    fn what_is_simulated_needs_a_config() {
        let parsed =
            |words: &str| Words::try_parse_from(words.split(' ')).map(|words| words.listen);
        assert_eq!(parsed("listen a.wav").unwrap().surfaces, 20_000);
        for asked in ["listen a.wav --surfaces 100", "listen a.wav --seed 3"] {
            let error = parsed(asked).unwrap_err().to_string();
            assert!(error.contains("--config"), "{error}");
            assert!(parsed(&format!("{asked} --config a.toml")).is_ok());
        }
    }
}
