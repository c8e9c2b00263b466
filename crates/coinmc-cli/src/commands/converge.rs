//! `coinmc converge`: how far the engine's numerical settings move the probabilities.

use super::question::{AnswerArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, RowsFormat};
use crate::terminal::table::{Column, Table};
use crate::terminal::with_interval;
use crate::terminal::{Colors, Style, compact, count, decimals_for, grouped, in_ascii, signed};
use anyhow::anyhow;
use clap::Args;
use coinmc::config::{self, Override};
use coinmc_core::Face;
use coinmc_questions::{self as questions, Converged, Convergence, Interval, Template};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc converge toss.toml
  coinmc converge toss.toml --set engine.flat.zeno=1 --tosses 100_000      how coarse is too coarse?
  coinmc converge toss.toml --format csv > shifts.csv";

/// Most lines about points that are biased.
const TOLD: usize = 8;

/// Toss every point again, by the same launches, with every tolerance ten times smaller, and show what changes
///
/// The shift of a face is P with tight settings minus P with those of the config: how far its probability is off
/// because the engine computes with finite tolerances. Only tosses that end on another face contribute to its error.
/// engine.rapier has a time step; it is halved, as a tenth would take ten times as long: with an error of first order
/// the whole bias is twice the shift.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Converge {
    /// The config (TOML); its [stop] has no effect
    config: PathBuf,

    /// Replace or add a value of the config, as in `engine.flat.zeno=0.1`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// Tosses of each point with either settings
    #[arg(long, value_name = "N", default_value = "20_000", value_parser = super::count)]
    tosses: u64,

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

impl Converge {
    pub(crate) fn format(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let text = config::read_text(&self.config)?;
        let template = Template::new(self.config.display().to_string(), text, &self.overrides);
        let args = AnswerArgs {
            threads: self.threads,
            format: self.format(),
            quiet: self.quiet,
        };
        let found = ask(console, &args, |workers| {
            questions::converge(&template, self.tosses, workers)
        })?;
        let document = || questions::document_of_convergence(&found);
        match self.format {
            RowsFormat::Json => output::print_json(&document()),
            RowsFormat::Csv => output::print(&questions::csv_of_rows(&document())),
            RowsFormat::Table => output::print(&table(&found, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }
}

fn table(found: &Convergence, style: &Style) -> String {
    let mut text = String::new();
    if let Some(first) = found.points.first() {
        let axes = first.parameters.iter();
        let mut columns: Vec<_> = axes
            .map(|(name, _)| Column::right(name.to_string()))
            .collect();
        columns.push(Column::right("P(side)").droppable(2));
        columns.extend(Face::ALL.map(|face| Column::right(format!("shift of P({})", face.name()))));
        columns.push(Column::right("changed"));
        columns.push(Column::right("tosses").droppable(1));
        let mut table = Table::new(columns);
        for point in &found.points {
            table.push(cells(point));
        }
        text += &table.render(style).text;
    }
    text += &words(found);
    if !found.settings.is_empty() {
        text += &format!("{}\n", style.paint(Colors::Faint, &settings(found)));
    }
    if style.unicode { text } else { in_ascii(&text) }
}

fn cells(point: &Converged) -> Vec<String> {
    let mut cells: Vec<_> = point
        .parameters
        .iter()
        .map(|(_, value)| compact(*value))
        .collect();
    cells.push(with_interval(&point.p[Face::Side as usize], 4, "±"));
    cells.extend(point.shifts.map(shown));
    cells.push(grouped(point.changed));
    cells.push(grouped(point.tosses));
    cells
}

/// A shift and the longer arm of its interval.
fn shown(shift: Interval) -> String {
    let Interval { value, lo, hi } = shift;
    let arm = (hi - value).max(value - lo);
    let decimals = decimals_for(arm);
    format!("{} ± {arm:.decimals$}", signed(value, decimals))
}

/// Whether there is a bias.
fn words(found: &Convergence) -> String {
    let percent = compact(100.0 * found.confidence);
    if found.settings.is_empty() {
        return "Nothing to tighten: the engine has no numerical setting that is a single number\n"
            .to_owned();
    }
    let mut text = String::new();
    if found.without_tosses > 0 {
        let points = count(found.without_tosses as u64, "point");
        text += &format!("{points} without tosses: nothing is tightened there\n");
    }
    if found.points.is_empty() {
        return text;
    }
    let biased: Vec<_> = found.biased().collect();
    for (point, face) in biased.iter().take(TOLD) {
        let axes = point.parameters.iter();
        let at: Vec<_> = axes
            .map(|(name, value)| format!("{name} {}", compact(*value)))
            .collect();
        let at = if at.is_empty() {
            String::new()
        } else {
            format!(" at {}", at.join(", "))
        };
        text += &format!(
            "Biased: P({}){at} moves by {} with tight settings\n",
            face.name(),
            shown(point.shifts[*face as usize])
        );
    }
    if biased.len() > TOLD {
        text += &format!("… and {} more\n", grouped((biased.len() - TOLD) as u64));
    }
    let undecided = [0, 1].map(|settings| {
        let tosses = found.points.iter().map(|point| point.undecided[settings]);
        tosses.sum::<u64>()
    });
    if undecided != [0, 0] {
        let [usual, tight] = undecided.map(grouped);
        text += &format!(
            "Undecided: {usual} tosses, with tight settings {tight}; every interval holds whatever they would \
             have shown\n"
        );
    }
    if biased.is_empty() {
        text += &format!(
            "No bias is seen: every shift may be 0, and none is larger than {:.1e} ({percent} %)\n",
            found.at_most()
        );
    }
    text
}

/// What was tightened.
fn settings(found: &Convergence) -> String {
    let settings = found.settings.iter().map(|setting| {
        format!(
            "{} {} -> {}",
            setting.key,
            compact(setting.usual),
            compact(setting.tight)
        )
    });
    format!(
        "engine {}: {}",
        found.engine,
        settings.collect::<Vec<_>>().join(", ")
    )
}
