//! `coinmc fair`: the value of a parameter at which a face has a given probability.

mod report;

use super::other_size::OtherSize;
use super::quantity::{Density, Length, Mass, Volume};
use super::question::{AnswerArgs, SceneArgs, Unanswered, ask};
use crate::exit::{Failure, Outcome, several};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_core::Face;
use coinmc_questions::assumptions::{self, Effect};
use coinmc_questions::scenes::{Assumption, EverydayScene};
use coinmc_questions::{self as questions, Fair as Answer, Question, QuestionError, Size};
use coinmc_questions::{Template, Workers};

const EXAMPLES: &str = "\
Examples:
  coinmc fair                                       how thick is a fair coin on a table?
  coinmc fair --scene felt --diameter 30mm          … one of 30 mm, on felt
  coinmc fair toss.toml --show                      in the scene of a config
  coinmc fair toss.toml --vary surface.restitution  which bounce makes this coin fair?
  coinmc fair toss.toml --face heads --target 0.45

Scenes: table, wood, glass, steel, felt, tray, billiards, floor, carpet. What each assumes is printed with \
the answer.";

/// Find how thick a fair coin is, with the error of the answer
///
/// Searches for the ratio H/R (or another parameter) at which a face comes up with a given
/// probability: by default the side in a third of the tosses. Without a config it answers for an
/// everyday scene and says what that assumes, and how far each assumption moves the answer.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Fair {
    #[command(flatten)]
    scene: SceneArgs,

    /// The face
    #[arg(long, value_name = "FACE", value_parser = super::names::face(), default_value = "side")]
    #[arg(hide_possible_values = true)]
    face: Face,

    /// Its probability [default: 1/3]
    #[arg(long, value_name = "P")]
    target: Option<f64>,

    /// The parameter that is varied, by its key [default: coin.ratio]
    #[arg(long, value_name = "KEY")]
    vary: Option<String>,

    /// Least value to search [default for coin.ratio: 0.05]
    #[arg(long, value_name = "X")]
    from: Option<f64>,

    /// Largest value to search [default for coin.ratio: 4]
    #[arg(long, value_name = "X")]
    to: Option<f64>,

    /// Search until the interval is no wider than ± this
    #[arg(long, value_name = "W", default_value_t = 0.005)]
    half_width: f64,

    /// Tosses of each answer at which the search stops short of that
    #[arg(long, value_name = "N", default_value = "10_000_000", value_parser = super::count)]
    max_tosses: u64,

    /// Tosses with finer numerical settings, which show the numerical error; 0 for none
    #[arg(long, value_name = "N", default_value = "2048", value_parser = super::count)]
    numerical: u64,

    /// Tosses of each assumption of an everyday scene, which show its effect; 0 for none
    #[arg(long, value_name = "N", default_value = "1024", value_parser = super::count)]
    #[arg(conflicts_with = "config")]
    assumptions: u64,

    /// Diameter of the coin, such as 24mm
    #[arg(long, value_name = "LENGTH", conflicts_with_all = ["volume", "mass"])]
    diameter: Option<Length>,

    /// Volume of the coin, such as 1.2cm3
    #[arg(long, value_name = "VOLUME", conflicts_with = "mass")]
    volume: Option<Volume>,

    /// Mass of the coin, such as 7.5g; with its density
    #[arg(long, value_name = "MASS", requires = "density")]
    mass: Option<Mass>,

    /// Density of the coin, such as 1.24g/cm3
    #[arg(long, value_name = "DENSITY", requires = "mass")]
    density: Option<Density>,

    /// Show how the search went
    #[arg(long)]
    show: bool,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// The failure, which names the option at fault where that is an end of the range.
fn by_option(error: QuestionError) -> Failure {
    match error {
        QuestionError::RangeEnd {
            end,
            value,
            problems,
        } => {
            let messages = problems.problems().iter();
            let messages: Vec<&str> = messages.map(|problem| problem.message.as_str()).collect();
            Failure::Input(anyhow!("--{end} {value}: {}", messages.join("; ")))
        }
        QuestionError::Several(errors) => several(errors.into_iter().map(by_option)),
        error => error.into(),
    }
}

fn unanswered(error: QuestionError) -> Unanswered {
    match error {
        QuestionError::Stopped => Unanswered::Stopped,
        error => Unanswered::Failed(by_option(error)),
    }
}

/// The answer, and what it rests on.
struct Answered {
    scene: Option<EverydayScene>,
    answer: Answer,
    /// Effects of the scene's assumptions on its only root.
    effects: Vec<Effect>,
    /// Whether they are left out because a sweep has several curves.
    unweighed: bool,
}

impl Fair {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (scene, template) = self.scene.template()?;
        let other_size = self.other_size(scene, &template);
        let template = self.sized(template)?;
        let answered = ask(console, &self.answer, |workers| {
            self.answer(scene, &template, workers).map_err(unanswered)
        })?;
        self.present(&answered, other_size, console)
    }

    /// The scene with coins of the size that the command line gives, if any.
    fn sized(&self, template: Template) -> Result<Template, Failure> {
        let size = match (self.diameter, self.volume, self.mass, self.density) {
            (Some(Length(diameter)), ..) => Size::Diameter(diameter),
            (_, Some(Volume(volume)), ..) => Size::Volume(volume),
            (_, _, Some(Mass(mass)), Some(Density(density))) => Size::Volume(mass / density),
            _ => Size::OfConfig,
        };
        let mut template = template.with_size(size)?;
        if let Some(key) = &self.vary {
            template = template.with_typed(key, "--vary", key);
        }
        Ok(template)
    }

    /// What the command line gives in place of the diameter of the config, if both give one.
    fn other_size(&self, scene: Option<EverydayScene>, template: &Template) -> Option<OtherSize> {
        let asked = match (self.diameter, self.volume, self.mass) {
            (Some(_), ..) => "diameter",
            (_, Some(_), _) => "volume",
            (.., Some(_)) => "mass",
            _ => return None,
        };
        // a config with several diameters, or with one that cannot be, is none of the answer's concern
        let told = questions::diameter_told(template, scene, self.scene.overrides());
        let told_m = told.ok().flatten()?;
        Some(OtherSize { asked, told_m })
    }

    fn key(&self) -> &str {
        self.vary.as_deref().unwrap_or("coin.ratio")
    }

    fn answer(
        &self,
        scene: Option<EverydayScene>,
        template: &Template,
        workers: &Workers<'_>,
    ) -> Result<Answered, QuestionError> {
        let question = Question {
            key: self.key().to_owned(),
            range: self.range(template)?,
            face: self.face,
            target: self.target.unwrap_or(1.0 / 3.0),
            half_width: self.half_width,
            max_tosses: self.max_tosses,
            numerical_tosses: self.numerical,
        };
        let answer = questions::fair(template, &question, workers)?;
        let mut effects = vec![];
        if let (Some(scene), [curve], true) = (scene, &answer.curves[..], self.assumptions > 0)
            && let Some(root) = curve.roots().next()
        {
            let assumed = self.assumed(&scene);
            effects =
                assumptions::effects(template, &answer, root, assumed, self.assumptions, workers)?;
        }
        Ok(Answered {
            scene,
            unweighed: scene.is_some() && self.assumptions > 0 && answer.curves.len() > 1,
            answer,
            effects,
        })
    }

    /// The range to search, if the command line says anything of it.
    fn range(&self, template: &Template) -> Result<Option<[f64; 2]>, QuestionError> {
        Ok(match (self.from, self.to) {
            (None, None) => None,
            (Some(from), Some(to)) => Some([from, to]),
            (from, to) => {
                let [least, largest] = questions::natural_range(template, self.key())?;
                Some([from.unwrap_or(least), to.unwrap_or(largest)])
            }
        })
    }

    /// What the scene assumes and the command line does not say otherwise.
    fn assumed(&self, scene: &EverydayScene) -> impl Iterator<Item = Assumption> {
        let sized = self.diameter.is_some() || self.volume.is_some() || self.mass.is_some();
        let assumed = self.scene.assumed(scene).into_iter();
        assumed.filter(move |assumed| !(sized && assumed.key == "coin.radius_m"))
    }

    fn present(
        &self,
        answered: &Answered,
        other_size: Option<OtherSize>,
        console: &Console,
    ) -> Result<Outcome, Failure> {
        let overrides = self.scene.overrides();
        match console.format() {
            Format::Json => output::print_json(&questions::document(
                &answered.answer,
                (answered.scene.as_ref(), overrides),
                &answered.effects,
            )),
            Format::Table => {
                let shown = report::Shown {
                    overrides,
                    other_size,
                    search: self.show,
                };
                output::print(&report::text(answered, &shown, console.stdout()))
            }
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        let curves = &answered.answer.curves;
        let short = curves
            .iter()
            .flat_map(questions::Curve::roots)
            .any(|root| !root.reached);
        Ok(if short {
            Outcome::ShortOfTarget
        } else {
            Outcome::Done
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Only {
        #[command(flatten)]
        fair: Fair,
    }

    fn range(arguments: &[&str]) -> Result<Option<[f64; 2]>, QuestionError> {
        let Only { fair } = Only::parse_from(["coinmc"].iter().chain(arguments));
        let (_, template) = fair.scene.template().expect("a scene of its own");
        fair.range(&template)
    }

    #[test]
    fn an_end_of_the_range_that_is_not_given_has_its_default() {
        assert_eq!(range(&[]).expect("no range"), None);
        assert_eq!(range(&["--from=1"]).expect("a range"), Some([1.0, 4.0]));
        assert_eq!(range(&["--to=1"]).expect("a range"), Some([0.05, 1.0]));
        let both = range(&["--vary=launch.height_m", "--from=1", "--to=2"]);
        assert_eq!(both.expect("a range"), Some([1.0, 2.0]));
        let one = range(&["--vary=launch.height_m", "--from=1"]);
        assert!(matches!(one, Err(QuestionError::NoRange { .. })));
    }
}
