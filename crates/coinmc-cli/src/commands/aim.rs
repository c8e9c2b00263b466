//! `coinmc aim`: the launch that forces a face.

use super::new_file;
use super::question::{AnswerArgs, KeyRange, SceneArgs, ask, range_and_count, write_file};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, four_decimals_for, grouped, in_ascii};
use anyhow::anyhow;
use clap::Args;
use coinmc_core::{Estimate, Face};
use coinmc_questions::{self as questions, Aim, Aimed, Parameter};
use std::path::PathBuf;
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  coinmc aim --scene felt --face heads --over launch.height_m=0.05..1
  coinmc aim toss.toml --face side --over launch.height_m=0.1..2:15 \\
    --over launch.spin.precessing.psi_deg.normal.mean=20..90:15 --picture side.svg

The spread of the hand is that of the config's own distributions.";

/// Values of a parameter of which the number is not given.
const VALUES: usize = 11;

/// Find the launch that forces a face
///
/// Tosses with every value of one or two numbers of the launch, finds where the face is most and
/// least likely, and tells how likely with fresh tosses that took no part in the choice; also in
/// clumsier hands.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct AimAt {
    #[command(flatten)]
    scene: SceneArgs,

    /// The face
    #[arg(long, value_name = "FACE", value_parser = super::names::face(), default_value = "side")]
    #[arg(hide_possible_values = true)]
    face: Face,

    /// A number of the launch and its values, as in `launch.height_m=0.1..2` or `…=0.1..2:15`; once
    /// or twice
    #[arg(long, value_name = "KEY=FROM..TO[:N]", required = true)]
    over: Vec<Over>,

    /// Tosses of every launch of the map
    #[arg(long, value_name = "N", default_value = "256", value_parser = super::count)]
    tosses: u64,

    /// Tosses of the launches in the answer
    #[arg(long, value_name = "N", default_value = "10_000", value_parser = super::count)]
    final_tosses: u64,

    /// Times the spread of the hand, separated by commas
    #[arg(
        long,
        value_name = "FACTORS",
        value_delimiter = ',',
        value_parser = super::trimmed::<f64>,
        default_value = "2,4"
    )]
    clumsy: Vec<f64>,

    /// New file (.svg) for a picture of the map
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// A number of the launch and its values, and how they were typed.
#[derive(Debug, Clone)]
struct Over(Parameter, String);

impl FromStr for Over {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (range, values) = range_and_count(text, VALUES)?;
        let KeyRange {
            key,
            from,
            to,
            text,
        } = range;
        let parameter = Parameter {
            key,
            from,
            to,
            values,
        };
        Ok(Self(parameter, text))
    }
}

impl AimAt {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (_, mut template) = self.scene.template()?;
        for Over(parameter, text) in &self.over {
            template = template.with_typed(&parameter.key, "--over", text);
        }
        let picture = new_file::begin(self.picture.as_deref(), "svg")?;
        let question = self.question();
        let answer = ask(console, &self.answer, |workers| {
            questions::aim(&template, &question, workers)
        })?;
        if let Some(file) = picture {
            write_file(file, questions::picture(&answer))?;
        }
        match console.format() {
            Format::Json => output::print_json(&questions::document_of_aim(&answer)),
            Format::Table => output::print(&text(&answer, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    fn question(&self) -> Aim {
        Aim {
            face: self.face,
            parameters: self.over.iter().map(|over| over.0.clone()).collect(),
            tosses: self.tosses,
            final_tosses: self.final_tosses,
            clumsiness: self.clumsy.clone(),
        }
    }
}

fn text(answer: &Aimed, style: &Style) -> String {
    let question = &answer.question;
    let face = question.face.name();
    let keys = question
        .parameters
        .iter()
        .map(|parameter| parameter.key.as_str());
    let mut columns = vec![Column::left("launch")];
    columns.extend(keys.clone().map(Column::right));
    columns.push(Column::right(format!("P({face})")));
    columns.push(Column::left("interval"));
    let mut table = Table::new(columns);
    let mut row = |name: String, values: &[f64], estimate: &Estimate| {
        let mut cells = vec![name];
        cells.extend(values.iter().map(|value| compact(*value)));
        let decimals = four_decimals_for(estimate.half_width());
        cells.push(format!("{:.decimals$}", estimate.p));
        cells.push(format!(
            "[{:.decimals$}, {:.decimals$}]",
            estimate.lo, estimate.hi
        ));
        table.push(cells);
    };
    let own = ("the config's own", &answer.baseline);
    for (name, place) in [
        ("most likely", &answer.best),
        ("least likely", &answer.worst),
        own,
    ] {
        row(name.to_owned(), &place.values, &place.estimate);
    }
    for clumsy in &answer.clumsy {
        let name = format!("most likely, {} times the spread", compact(clumsy.factor));
        row(name, &answer.best.values, &clumsy.estimate);
    }
    let title = format!(
        "P({face}) over {} launches:",
        grouped(answer.map.len() as u64)
    );
    let mut text = format!("{}\n", style.paint(Colors::Strong, &title));
    text += &table.render(style).text;
    let note = format!(
        "{} fresh tosses of each, {} in all (engine {}, {})",
        grouped(question.final_tosses),
        grouped(answer.tosses),
        answer.engine,
        answer.law
    );
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_has_a_key_and_a_range() {
        let Over(parameter, text) = "launch.height_m=0.1..2:15".parse().expect("a range");
        assert_eq!(
            (parameter.from, parameter.to, parameter.values),
            (0.1, 2.0, 15)
        );
        assert_eq!(text, "launch.height_m=0.1..2:15");
        let Over(parameter, _) = "launch.velocity_m_s.z=-1..1".parse().expect("a range");
        assert_eq!((parameter.from, parameter.values), (-1.0, VALUES));
        for wrong in [
            "", "a", "a=1", "a=1..", "a=1..2:", "a=1..2:x", "=..", "a=b..c",
        ] {
            assert!(wrong.parse::<Over>().is_err(), "{wrong}");
        }
    }
}
