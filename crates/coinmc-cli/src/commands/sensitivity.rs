//! `coinmc sensitivity`: how the probabilities, and the fair ratio, move with every number of a scene.

use super::question::{ask, template};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, grouped, in_ascii};
use anyhow::anyhow;
use clap::Args;
use coinmc::config::Override;
use coinmc_core::Face;
use coinmc_questions::sensitivity::{Derivative, Sensitivity, Steps, sensitivities};
use coinmc_questions::{self as questions, Question, QuestionError, Root, Template, Workers};
use serde_json::{Value, json};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc sensitivity toss.toml                      how P(side) moves with every number
  coinmc sensitivity --scene felt --fair            … and the fair ratio, at a fair coin
  coinmc sensitivity toss.toml --of surface.friction,surface.restitution --tosses 200_000";

/// Show how the probabilities move with every number of a scene
///
/// Each number is decreased and increased a little, and the same tosses are made with both values. The
/// table shows dP/d ln(number): P rises by a hundredth of it if the number does by 1 %.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SensitivityOf {
    /// The config (TOML); its [stop] has no effect
    config: Option<PathBuf>,

    /// Everyday scene, see `coinmc fair --help` [default: table]
    #[arg(long, value_name = "NAME", conflicts_with = "config")]
    scene: Option<String>,

    /// The face
    #[arg(long, value_name = "FACE", value_parser = super::face, default_value = "side")]
    face: Face,

    /// Keys of the numbers, separated by commas [default: all that are not 0]
    #[arg(long, value_name = "KEYS", value_delimiter = ',')]
    of: Vec<String>,

    /// Change of each number, as a share of it
    #[arg(
        long,
        value_name = "S",
        default_value_t = 0.05,
        allow_negative_numbers = true
    )]
    step: f64,

    /// Tosses with either value of each number
    #[arg(long, value_name = "N", default_value = "20_000", value_parser = count)]
    tosses: u64,

    /// Find the fair ratio first, and show how it moves: P(side) = 1/3
    #[arg(long)]
    fair: bool,

    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,

    /// Show no progress, only warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

/// A whole number, in which digits may be grouped by `_`.
fn count(text: &str) -> Result<u64, String> {
    text.replace('_', "")
        .parse()
        .map_err(|_| "expected a whole number".to_owned())
}

/// What was found.
struct Found {
    /// Strongest first.
    sensitivities: Vec<Sensitivity>,
    root: Option<Root>,
}

impl SensitivityOf {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (_, template) = template(
            self.config.as_deref(),
            self.scene.as_deref(),
            &self.overrides,
        )?;
        let found = ask(console, self.quiet, self.threads, |workers| {
            self.find(&template, workers)
        })?;
        let Some(found) = found else {
            return Ok(Outcome::Interrupted);
        };
        match console.format() {
            Format::Json => output::print_json(&self.document(&found)),
            Format::Table => output::print(&self.text(&found, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    fn find(&self, template: &Template, workers: &Workers<'_>) -> Result<Found, QuestionError> {
        let mut template = template.clone();
        let mut root = None;
        if self.fair {
            let question = Question {
                half_width: 0.02,
                numerical_tosses: 0,
                face: self.face,
                ..Question::default()
            };
            let answer = questions::fair(&template, &question, workers)?;
            let [curve] = &answer.curves[..] else {
                return Err(QuestionError::Swept("parameters".to_owned()));
            };
            root = curve.roots().next().cloned();
        }
        if let Some(root) = &root {
            template = template.with_value("coin.ratio", root.value);
        }
        let steps = Steps {
            keys: self.of.clone(),
            step: self.step,
            tosses: self.tosses,
        };
        let mut sensitivities = sensitivities(&template, &steps, workers)?;
        let size = |one: &Sensitivity| one.of(self.face).value.abs();
        sensitivities.sort_by(|a, b| size(b).total_cmp(&size(a)));
        Ok(Found {
            sensitivities,
            root,
        })
    }

    fn text(&self, found: &Found, style: &Style) -> String {
        let face = self.face.name();
        let mut columns = vec![
            Column::left("parameter"),
            Column::right("value"),
            Column::right(format!("dP({face})/d ln")),
            Column::left("interval"),
        ];
        if found.root.is_some() {
            columns.push(Column::right("d(H/R)/d ln"));
            columns.push(Column::left("interval"));
        } else {
            columns.push(Column::right("elasticity"));
        }
        columns.push(Column::right("changed").droppable(1));
        let mut table = Table::new(columns);
        for one in &found.sensitivities {
            let derivative = one.of(self.face);
            let mut cells = vec![one.parameter.key.clone(), compact(one.parameter.value)];
            cells.extend(shown(derivative));
            match &found.root {
                Some(root) => cells.extend(shown(one.shift(self.face, root))),
                None => cells.push(number(one.elasticity(self.face).value, 2)),
            }
            cells.push(format!("{:.1} %", 100.0 * one.changed));
            table.push(cells);
        }
        let mut text = String::new();
        if self.fair {
            text += &match &found.root {
                Some(root) => format!(
                    "At the fair ratio, H/R = {:.3} ± {:.3}, P({face}) = 1/3:\n",
                    root.value,
                    root.half_width()
                ),
                None => format!("No coin of this scene has P({face}) = 1/3.\n"),
            };
        }
        text += &table.render(style).text;
        let tosses = grouped(self.tosses);
        let note = format!(
            "{tosses} tosses with either value, {} apart",
            percent(self.step)
        );
        text += &format!("{}\n", style.paint(Colors::Faint, &note));
        if style.unicode { text } else { in_ascii(&text) }
    }

    fn document(&self, found: &Found) -> Value {
        let interval = |derivative: Derivative| json!({ "value": derivative.value, "lo": derivative.lo, "hi": derivative.hi });
        let rows = found.sensitivities.iter().map(|one| {
            json!({
                "parameter": one.parameter.key,
                "value": one.parameter.value,
                "tosses": one.tosses,
                "changed": one.changed,
                "d_p_heads": interval(one.of(Face::Heads)),
                "d_p_tails": interval(one.of(Face::Tails)),
                "d_p_side": interval(one.of(Face::Side)),
                "elasticity": interval(one.elasticity(self.face)),
                "fair_ratio_shift": found.root.as_ref().map(|root| interval(one.shift(self.face, root))),
            })
        });
        json!({
            "format_version": FORMAT_VERSION,
            "kind": "sensitivity",
            "face": self.face.name(),
            "step": self.step,
            "fair_ratio": found.root.as_ref().map(|root| root.value),
            "rows": rows.collect::<Vec<_>>(),
        })
    }
}

/// A derivative and its interval as cells.
fn shown(derivative: Derivative) -> [String; 2] {
    let decimals = decimals_for(0.5 * (derivative.hi - derivative.lo)).min(4);
    [
        number(derivative.value, decimals),
        format!(
            "[{}, {}]",
            number(derivative.lo, decimals),
            number(derivative.hi, decimals)
        ),
    ]
}

/// With its sign; 0 has none.
fn number(x: f64, decimals: usize) -> String {
    let text = format!("{x:+.decimals$}");
    if text.contains(|c: char| c.is_ascii_digit() && c != '0') || !x.is_finite() {
        text
    } else {
        text[1..].to_owned()
    }
}

fn percent(share: f64) -> String {
    format!("{} %", compact(100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(number(-0.000_01, 3), "0.000");
        assert_eq!(number(-0.01, 3), "-0.010");
        assert_eq!(number(0.0, 1), "0.0");
        assert_eq!(number(0.25, 2), "+0.25");
    }
}
