//! `coinmc trace map`: the face over two quantities of the launch, every pixel a toss to watch.

use super::super::new_file::must_end_in;
use super::super::question::{KeyRange, range_and_count, write_file};
use super::plan_of;
use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::progress::Progress;
use crate::terminal::tosses;
use anyhow::anyhow;
use clap::Args;
use coinmc::config::Override;
use coinmc_recording::NewFile;
use coinmc_report::{Map, MapError, Quantity, map};
use serde_json::json;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::Ordering;

const EXAMPLES: &str = "\
Example:
  coinmc trace map toss.toml --over wy_rad_s=0..60:48 --over height_m=0.1..1:32 -o map.html

Quantities: height_m, vx_m_s, vy_m_s, vz_m_s, wx_rad_s, wy_rad_s, wz_rad_s, and tilt_rad or tilt_deg, the \
angle of the heads normal from the vertical towards x. All else is as in the toss.";

/// Pixels of a side of which the number is not given.
const PIXELS: usize = 24;

/// Make a page of the basins of heads, tails and side, each pixel a toss to watch
///
/// Tosses the launch of one toss with every value of two of its quantities. Nothing is random.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct MapOf {
    /// The config (TOML), or the directory of a run
    #[arg(value_name = "CONFIG|RUN_DIR")]
    config: PathBuf,

    /// A quantity of the launch, its range, and the number of pixels: first across, then up
    #[arg(long, value_name = "QUANTITY=FROM..TO[:N]", required = true)]
    over: Vec<Over>,

    /// The page: a new file (.html)
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,

    /// The point
    #[arg(long, value_name = "P", default_value_t = 0)]
    point: usize,

    /// The toss whose launch gives all other quantities
    #[arg(long, value_name = "K", default_value = "0", value_parser = crate::commands::count)]
    toss: u64,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// How to write what was done
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,

    /// Hide progress; warnings and errors are still shown
    #[arg(long, short)]
    quiet: bool,
}

/// A side of the map.
#[derive(Debug, Clone, Copy)]
struct Over(Quantity, f64, f64, usize);

impl FromStr for Over {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (KeyRange { key, from, to, .. }, pixels) = range_and_count(text, PIXELS)?;
        let quantity = key.parse().map_err(|error| format!("{error}"))?;
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(format!("the range from {from:?} to {to:?} does not go up"));
        }
        if quantity == Quantity::Height && from < 0.0 {
            return Err(format!("a height is not negative, as {from:?} is"));
        }
        Ok(Self(quantity, from, to, pixels))
    }
}

impl MapOf {
    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let [x, y] = self.over[..] else {
            return Err(Failure::Input(anyhow!(
                "a map has two sides: give --over twice, not {} times",
                self.over.len()
            )));
        };
        let plan = plan_of(&self.config, &self.overrides)?;
        must_end_in(&self.out, "html")?;
        let file = NewFile::begin(&self.out)?;
        let progress = Progress::new(*console.stderr(), self.quiet);
        let told = progress.clone();
        let cancel = interrupt::listen(move || told.note("stopping; Ctrl-C again stops at once"))?;
        let sides = [x, y].map(|Over(quantity, from, to, pixels)| (quantity, from, to, pixels));
        let pixels = x.3.saturating_mul(y.3) as u64;
        let made = Map::toss(&plan, self.point, self.toss, sides, |done| {
            progress.searched(done as u64, pixels);
            !cancel.load(Ordering::Relaxed)
        });
        progress.finish();
        let made = made.map_err(|error: MapError| Failure::Input(error.into()))?;
        let Some(made) = made else {
            return Err(Failure::Interrupted);
        };
        write_file(file, map(&plan, &made))?;
        self.tell(pixels, console)
    }

    fn tell(&self, pixels: u64, console: &Console) -> Result<Outcome, Failure> {
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "map",
                "out": self.out.to_string_lossy(),
                "pixels": pixels,
            })),
            Format::Table => output::print(&format!(
                "Map: {} ({})\n",
                self.out.display(),
                tosses(pixels)
            )),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_goes_up_and_a_height_is_not_negative() {
        for (text, is_right) in [
            ("height_m=0..1:8", true),
            ("wy_rad_s=-60..60", true),
            ("wy_rad_s=60..0", false),
            ("wy_rad_s=60..60", false),
            ("wy_rad_s=0..inf", false),
            ("height_m=-1..1", false),
        ] {
            assert_eq!(text.parse::<Over>().is_ok(), is_right, "{text}");
        }
    }
}
