//! `coinmc listen --synthetic`: the recording of a simulated toss.

use crate::commands::new_file::must_end_in;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_calibrate::Observations;
use coinmc_core::{Domain, Stream};
use coinmc_listen::Synthetic;
use coinmc_recording::NewFile;
use serde_json::json;
use std::io::Write;
use std::path::PathBuf;

/// How a simulated toss is recorded.
#[derive(Debug, Args)]
#[command(next_help_heading = "A simulated recording")]
pub(super) struct SyntheticArgs {
    /// New file (.wav) for the recording of a toss of the config, instead of listening
    #[arg(
        long,
        value_name = "FILE",
        requires = "config",
        conflicts_with = "files"
    )]
    synthetic: Option<PathBuf>,

    /// Number of the toss
    #[arg(long, value_name = "K", default_value = "0", requires = "synthetic")]
    #[arg(value_parser = crate::commands::count)]
    toss: u64,

    /// Power of the toss over that of the room's noise, dB
    #[arg(
        long,
        value_name = "DB",
        default_value_t = 30.0,
        allow_negative_numbers = true
    )]
    #[arg(requires = "synthetic")]
    noise_db: f64,

    /// How strong echoes are, from 0 for none to 1 for a bare room
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.3,
        requires = "synthetic"
    )]
    echo: f64,

    /// Peak in units of the full scale: beyond 1 it is clipped
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.7,
        requires = "synthetic"
    )]
    peak: f64,

    /// Samples a second
    #[arg(
        long,
        value_name = "HZ",
        default_value_t = 44_100,
        requires = "synthetic"
    )]
    #[arg(value_parser = clap::value_parser!(u32).range(8000..=192_000))]
    rate: u32,
}

impl SyntheticArgs {
    pub(super) fn is_asked_for(&self) -> bool {
        self.synthetic.is_some()
    }

    /// Writes the recording.
    pub(super) fn write(
        &self,
        observed: Option<&Observations>,
        seed: u64,
        console: &Console,
    ) -> Result<Outcome, Failure> {
        let (Some(path), Some(observed)) = (&self.synthetic, observed) else {
            return Err(Failure::Input(anyhow!("--synthetic needs --config")));
        };
        self.check()?;
        must_end_in(path, "wav")?;
        let mut file = NewFile::begin(path)?;
        let point = &observed.plan.points[0];
        let stream = Stream::new(seed, Domain::Launch, 0);
        let launch = point
            .launches
            .launch(&point.scene.coin, &mut stream.toss(self.toss));
        let synthetic = Synthetic {
            seed: seed.wrapping_add(self.toss),
            rate_hz: self.rate,
            signal_to_noise_db: self.noise_db,
            echo: self.echo,
            peak: self.peak,
            ..Synthetic::default()
        };
        let recording = synthetic
            .recording(point, &launch)
            .map_err(|error| Failure::Input(error.into()))?;
        let written = recording.to_bytes().map_err(|error| anyhow!(error));
        written
            .and_then(|bytes| Ok(file.write_all(&bytes)?))
            .and_then(|()| Ok(file.flush()?))
            .map_err(Failure::Runtime)?;
        file.finish()?;
        let seconds = recording.seconds();
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "listen_synthetic",
                "file": path.display().to_string(),
                "seconds": seconds,
            })),
            Format::Table => output::print(&format!("{}: {seconds:.2} s\n", path.display())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    fn check(&self) -> Result<(), Failure> {
        let refuse = |message: &str| Err(Failure::Input(anyhow!("{message}")));
        if !(-60.0..=120.0).contains(&self.noise_db) {
            return refuse("--noise-db must be from -60 to 120");
        }
        if !(0.0..=1.0).contains(&self.echo) {
            return refuse("--echo must be from 0 to 1");
        }
        if !(self.peak > 0.0 && self.peak <= 100.0) {
            return refuse("--peak must be above 0, and 100 at most");
        }
        Ok(())
    }
}
