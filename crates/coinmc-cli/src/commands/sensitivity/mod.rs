//! `coinmc sensitivity`: how the probabilities, and the fair ratio, move with every number of a scene.

mod local;
mod ranking;

use super::new_file;
use super::question::{AnswerArgs, KeyRange, SceneArgs, ask, write_file};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::decimals_that_show;
use anyhow::anyhow;
use clap::{ArgGroup, Args};
use coinmc_core::Face;
use coinmc_questions::sensitivity::Steps;
use coinmc_questions::{self as questions, Question, QuestionError, Rank, Root, Unknown};
use coinmc_questions::{Template, Workers};
use local::Local;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc sensitivity toss.toml                      how P(side) moves with every number
  coinmc sensitivity --scene felt --fair            … and the fair ratio, at a fair coin
  coinmc sensitivity toss.toml --of surface.friction,surface.restitution --tosses 200_000
  coinmc sensitivity --scene felt --fair --rank --picture felt.svg
  coinmc sensitivity toss.toml --over surface.friction=0.1..0.5 --over launch.height_m=0.2..1";

/// Show how the probabilities move with every number of a scene
///
/// Each number is decreased and increased a little, and the same tosses are made with both values. The
/// table shows dP/d ln(number): P rises by a hundredth of it if the number does by 1 %.
///
/// With --rank or --over it tells which unknown matters most: how much of the variance of P over all
/// ranges comes from each number.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[command(group(ArgGroup::new("ranking").multiple(true).args(["rank", "over"])))]
pub(crate) struct SensitivityOf {
    #[command(flatten)]
    scene: SceneArgs,

    /// The face
    #[arg(long, value_name = "FACE", value_parser = super::face, default_value = "side")]
    face: Face,

    /// Keys of the numbers, separated by commas [default: all that are not 0]
    #[arg(long, value_name = "KEYS", value_delimiter = ',', value_parser = super::trimmed::<String>)]
    of: Vec<String>,

    /// Change of each number, as a share of it
    #[arg(long, value_name = "S", default_value_t = 0.05)]
    step: f64,

    /// Tosses with either value of each number [default: 20_000; with ranges 4096]
    #[arg(long, value_name = "N", value_parser = super::count)]
    tosses: Option<u64>,

    /// Find the fair ratio first, at which the face has P = 1/3, and show how it moves
    #[arg(long)]
    fair: bool,

    /// Rank what an everyday scene assumes, over the ranges in which that may be in life
    #[arg(long, conflicts_with_all = ["config", "of", "step"])]
    rank: bool,

    /// Rank this number over this range, as in `surface.friction=0.1..0.5`; repeatable
    #[arg(long, value_name = "KEY=FROM..TO", conflicts_with_all = ["of", "step"])]
    over: Vec<KeyRange>,

    /// Samples of all ranges
    #[arg(long, value_name = "N", default_value = "500", value_parser = super::count)]
    #[arg(requires = "ranking")]
    samples: u64,

    /// New file (.svg) for a tornado plot of the ranking
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// New file (.csv) for the rows of the table
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// The scene, and its fair ratio if that was asked for.
struct Fair {
    template: Template,
    /// Whether it was asked for.
    sought: bool,
    root: Option<Root>,
}

/// What to write.
struct Answer {
    text: String,
    document: serde_json::Value,
    picture: Option<String>,
}

impl SensitivityOf {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (scene, mut template) = self.scene.template()?;
        for KeyRange { key, text, .. } in &self.over {
            template = template.with_typed(key, "--over", text);
        }
        let mut unknowns: Vec<Unknown> = self.over.iter().map(KeyRange::unknown).collect();
        if let (true, Some(scene)) = (self.rank, scene) {
            let assumed = self.scene.assumed(&scene).into_iter().map(Unknown::from);
            let given: Vec<String> = unknowns.iter().map(|unknown| unknown.key.clone()).collect();
            unknowns.extend(assumed.filter(|assumed| !given.contains(&assumed.key)));
        }
        if self.picture.is_some() && unknowns.is_empty() {
            let message = "--picture is of a ranking: add --rank or --over";
            return Err(Failure::Input(anyhow!(message)));
        }
        let picture = new_file::begin(self.picture.as_deref(), "svg")?;
        let csv = new_file::begin(self.csv.as_deref(), "csv")?;
        let answer = ask(console, &self.answer, |workers| {
            self.find(&template, &unknowns, console, workers)
        })?;
        if let (Some(file), Some(svg)) = (picture, &answer.picture) {
            write_file(file, svg)?;
        }
        if let Some(file) = csv {
            write_file(file, questions::csv_of_rows(&answer.document))?;
        }
        match console.format() {
            Format::Json => output::print_json(&answer.document),
            Format::Table => output::print(&answer.text),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    fn find(
        &self,
        template: &Template,
        unknowns: &[Unknown],
        console: &Console,
        workers: &Workers<'_>,
    ) -> Result<Answer, QuestionError> {
        let fair = self.fair(template, workers)?;
        let style = console.stdout();
        if unknowns.is_empty() {
            let steps = Steps {
                keys: self.of.clone(),
                step: self.step,
                tosses: self.tosses.unwrap_or(20_000),
            };
            let local = Local::find(self.face, steps, fair, workers)?;
            return Ok(Answer {
                text: local.text(style),
                document: local.document(),
                picture: None,
            });
        }
        let question = Rank {
            face: self.face,
            unknowns: unknowns.to_vec(),
            samples: self.samples,
            tosses: self.tosses.unwrap_or(4096),
        };
        let found = questions::rank(&fair.template, &question, workers)?;
        Ok(Answer {
            text: fair.heading(self.face) + &ranking::text(&found, style),
            document: questions::document_of_ranking(&found),
            picture: Some(questions::picture_of_ranking(&found)),
        })
    }

    /// The scene, with the fair ratio if that is asked for and there is one.
    fn fair(&self, template: &Template, workers: &Workers<'_>) -> Result<Fair, QuestionError> {
        let mut fair = Fair {
            template: template.clone(),
            sought: self.fair,
            root: None,
        };
        if self.fair {
            let question = Question {
                half_width: 0.02,
                numerical_tosses: 0,
                face: self.face,
                ..Question::default()
            };
            let answer = questions::fair(template, &question, workers)?;
            let [curve] = &answer.curves[..] else {
                return Err(QuestionError::Swept("parameters".to_owned()));
            };
            fair.root = curve.roots().next().cloned();
        }
        if let Some(root) = &fair.root {
            fair.template = fair.template.with_value("coin.ratio", root.value);
        }
        Ok(fair)
    }
}

impl Fair {
    fn heading(&self, face: Face) -> String {
        let face = face.name();
        match &self.root {
            Some(root) => {
                let arm = root.half_width();
                let decimals = decimals_that_show(arm, 3);
                format!(
                    "At the fair ratio, H/R = {:.decimals$} ± {arm:.decimals$}, P({face}) = 1/3:\n",
                    root.value
                )
            }
            None if self.sought => format!("No coin of this scene has P({face}) = 1/3.\n"),
            None => String::new(),
        }
    }
}
