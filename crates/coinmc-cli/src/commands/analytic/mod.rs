//! `coinmc analytic`: the closed forms as tables.

mod listing;
mod tables;

use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, RowsFormat};
use clap::Args;
use coinmc_analytic::Rule;
use coinmc_core::Scene;
use listing::Listing;

const EXAMPLES: &str = "\
Examples:
  coinmc analytic                                every rule: formula, fair ratio, source
  coinmc analytic --ratio 0.5,1,1.5              probabilities at these ratios
  coinmc analytic --fair --target 0.5            ratios at which every second toss ends on the side
  coinmc analytic --rule arc --ratio 1.2 --format json
  coinmc analytic --psi-deg 90,80,70 --fair      fair ratios of a coin that precesses
  coinmc analytic --speed 2.4 --spin 238.6       Keller: heads or tails, and how near the edge";

/// Tabulate the closed forms
///
/// Each rests on assumptions (listed if no option is given), and none depends on restitution or friction:
/// compare tosses with them.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[allow(clippy::doc_markdown)] // help text is not Markdown
pub(crate) struct Analytic {
    /// Probabilities at this ratio H/R; repeat or separate by commas
    #[arg(long, value_name = "H/R", value_delimiter = ',', value_parser = not_negative)]
    ratio: Vec<f64>,

    /// The ratio H/R at which P(side) is the target
    #[arg(long, conflicts_with = "ratio")]
    fair: bool,

    /// The target P(side) [default: 1/3]
    #[arg(long, value_name = "P", requires = "fair", value_parser = probability)]
    target: Option<f64>,

    /// Only this rule; repeat or separate by commas
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    rule: Vec<Rule>,

    /// A coin that starts heads up and precesses with this angle between its normal and its angular
    /// momentum; repeat or separate by commas
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', value_parser = angle)]
    #[arg(conflicts_with = "rule")]
    psi_deg: Vec<f64>,

    /// Keller's thin coin: upward speed, m/s
    #[arg(long, value_name = "M/S", requires = "spin", value_parser = not_negative)]
    #[arg(conflicts_with_all = ["ratio", "fair", "rule", "psi_deg"])]
    speed: Option<f64>,

    /// Keller's thin coin: spin about a horizontal diameter, rad/s
    #[arg(long, value_name = "RAD/S", requires = "speed", value_parser = finite)]
    spin: Option<f64>,

    /// Keller's thin coin: gravity, m/s²
    #[arg(long, value_name = "M/S2", requires = "speed", value_parser = positive)]
    #[arg(default_value_t = Scene::STANDARD_GRAVITY_M_S2)]
    gravity: f64,

    /// How to write the table
    #[arg(long, value_enum, default_value_t = RowsFormat::Table)]
    format: RowsFormat,
}

impl Analytic {
    /// The format of failures.
    pub(crate) fn errors_as(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let listing = self.listing();
        match self.format {
            RowsFormat::Table => output::print(&listing.to_table(console.stdout())),
            RowsFormat::Json => output::print_json(&listing.to_json()),
            RowsFormat::Csv => output::print(&listing.to_csv()),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }

    fn listing(&self) -> Listing {
        let rules = if self.rule.is_empty() {
            &Rule::ALL[..]
        } else {
            &self.rule
        };
        let target = self.target.unwrap_or(1.0 / 3.0);
        if let (Some(speed), Some(spin)) = (self.speed, self.spin) {
            return tables::keller(speed, spin, self.gravity);
        }
        match (self.psi_deg.is_empty(), self.ratio.is_empty(), self.fair) {
            (true, false, _) => tables::probabilities(rules, &self.ratio),
            (true, true, true) => tables::fair_ratios(rules, target),
            (true, true, false) => tables::rules(rules),
            (false, false, _) => tables::precession_probabilities(&self.psi_deg, &self.ratio),
            (false, true, true) => tables::precession_fair_ratios(&self.psi_deg, target),
            (false, true, false) => tables::precession_thin(&self.psi_deg),
        }
    }
}

fn number(text: &str, allowed: impl Fn(f64) -> bool, what: &str) -> Result<f64, String> {
    let wrong = || format!("expected {what}");
    let x: f64 = text.trim().parse().map_err(|_| wrong())?;
    if x.is_finite() && allowed(x) {
        Ok(x)
    } else {
        Err(wrong())
    }
}

fn finite(text: &str) -> Result<f64, String> {
    number(text, |_| true, "a finite number")
}

fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "a finite number above 0")
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0, "a finite number, 0 or more")
}

fn probability(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=1.0).contains(&x), "a number from 0 to 1")
}

fn angle(text: &str) -> Result<f64, String> {
    number(
        text,
        |x| (0.0..=180.0).contains(&x),
        "an angle from 0 to 180 degrees",
    )
}
