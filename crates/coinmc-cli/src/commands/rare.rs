//! `coinmc rare`: the probability of a face that hardly ever comes up.

use super::question::{AnswerArgs, SceneArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, grouped, in_ascii};
use anyhow::anyhow;
use clap::Args;
use coinmc_core::Face;
use coinmc_questions::{self as questions, HowRare, Rareness};

const EXAMPLES: &str = "\
Examples:
  coinmc rare --scene felt --set coin.ratio=0.1     how often does a thin coin stand on felt?
  coinmc rare toss.toml --face heads --relative-error 0.05 --show";

/// Estimate the probability of a rare face with fewer tosses
///
/// Brute force takes some 400/P tosses for an error of 10 %. This draws at least as many launches, but tosses mostly those
/// whose first touch with the ground makes the face likely, and weights them so that the estimate is
/// unbiased. Where the coin bounces high or rolls far, nothing is gained; the answer says how much was.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Rare {
    #[command(flatten)]
    scene: SceneArgs,

    /// The face
    #[arg(long, value_name = "FACE", value_parser = super::face, default_value = "side")]
    face: Face,

    /// Toss until the interval is no wider than ± this share of the probability
    #[arg(long, value_name = "E", default_value_t = 0.1)]
    relative_error: f64,

    /// Tosses at which the answer stops short of that
    #[arg(long, value_name = "N", default_value = "10_000_000", value_parser = super::count)]
    max_tosses: u64,

    /// Show the strata of launches
    #[arg(long)]
    show: bool,

    #[command(flatten)]
    answer: AnswerArgs,
}

impl Rare {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (_, template) = self.scene.template()?;
        let question = HowRare {
            face: self.face,
            relative_error: self.relative_error,
            max_tosses: self.max_tosses,
        };
        let answer = ask(console, &self.answer, |workers| {
            questions::how_rare(&template, &question, workers)
        })?;
        match console.format() {
            Format::Json => output::print_json(&questions::document_of_rare(&answer)),
            Format::Table => output::print(&text(&answer, self.show, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(if answer.reached {
            Outcome::Done
        } else {
            Outcome::ShortOfTarget
        })
    }
}

fn text(answer: &Rareness, show: bool, style: &Style) -> String {
    let p = &answer.p;
    let percent = compact(100.0 * answer.confidence);
    let face = answer.question.face.name();
    let limited = answer.is_limited_by_undecided();
    let headline = if limited {
        format!(
            "P({face}) = {:.3e} to {:.3e}, depending on undecided tosses",
            p.value,
            p.value + answer.p.hi - answer.without_undecided.hi
        )
    } else if p.value > 0.0 {
        let error = 100.0 * p.half_width() / p.value;
        format!("P({face}) = {:.3e} ± {error:.1} %", p.value)
    } else {
        format!("P({face}) was not seen")
    };
    let mut text = style.paint(Colors::Strong, &headline);
    text += &format!("    {percent} %: [{:.3e}, {:.3e}]\n", p.lo, p.hi);
    text += &format!(
        "{} of {} launches tossed, of which {} showed it, after a pilot of {} tosses\n",
        grouped(answer.tosses),
        grouped(answer.launches),
        grouped(answer.shown),
        grouped(answer.pilot_tosses),
    );
    let gain = answer.gain();
    if gain.tosses.is_finite() && !limited {
        let brute_force = gain.tosses * (answer.tosses + answer.pilot_tosses) as f64;
        text += &format!(
            "Brute force would take {} tosses, {:.1} times as many, and {:.1} times the work\n",
            grouped(rounded(brute_force)),
            gain.tosses,
            gain.work
        );
    }
    text += &problems(answer);
    if show {
        text += &strata(answer, style);
    }
    let note = format!("engine {}, {}", answer.engine, answer.law);
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

/// Why the answer is short of the error asked for.
fn problems(answer: &Rareness) -> String {
    let mut text = String::new();
    if answer.undecided > 0 {
        text += &format!(
            "{} tosses without a face, which the upper end counts as if they showed it\n",
            grouped(answer.undecided)
        );
    }
    let error = compact(100.0 * answer.question.relative_error);
    if answer.is_limited_by_undecided() {
        let of_chance = 100.0 * answer.without_undecided.half_width() / answer.p.value;
        let of_chance = if of_chance.is_finite() {
            format!(": without them it would be ± {of_chance:.1} %")
        } else {
            String::new()
        };
        text += &format!(
            "Short of the ± {error} % asked for because of them{of_chance}. More tosses do not help, only fewer \
             undecided ones\n"
        );
    } else if !answer.reached {
        text += &format!("Short of the ± {error} % asked for: all tosses are spent\n");
    }
    text
}

fn strata(answer: &Rareness, style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("first touch at"),
        Column::right("launches"),
        Column::right("tossed"),
        Column::right("chance"),
        Column::right("showed it"),
    ]);
    for stratum in &answer.strata {
        let tilt = |cos: f64| 90.0 - libm::acos(cos.clamp(0.0, 1.0)).to_degrees();
        table.push(vec![
            format!("{:.2}° to {:.2}°", tilt(stratum.from), tilt(stratum.to)),
            grouped(stratum.launches),
            grouped(stratum.tosses),
            format!("{:.3}", stratum.chance),
            grouped(stratum.shown),
        ]);
    }
    table.render(style).text
        + "Angles between the faces and the vertical: 0° on the rim, 90° flat.\n"
}

/// To three digits.
fn rounded(tosses: f64) -> u64 {
    let text = format!("{tosses:.2e}");
    let rounded: f64 = text.parse().expect("`e` format is a number");
    // a number of tosses; `as` saturates
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let rounded = rounded as u64;
    rounded
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_questions::Interval;

    fn answer(hi: f64, undecided: u64) -> Rareness {
        let decided = Interval {
            value: 0.01,
            lo: 0.009,
            hi: 0.011,
        };
        Rareness {
            question: HowRare {
                face: Face::Side,
                relative_error: 0.3,
                max_tosses: 20_000,
            },
            p: Interval { hi, ..decided },
            without_undecided: decided,
            reached: undecided == 0,
            confidence: 0.95,
            launches: 20_000,
            tosses: 20_000,
            shown: 200,
            undecided,
            pilot_tosses: 1000,
            work: 1000,
            work_of_a_toss: 1.0,
            strata: vec![],
            engine: "flat",
            law: "moreau",
        }
    }

    #[test]
    fn what_limits_an_answer_is_told() {
        let style = Style::plain(100);
        let open = text(&answer(0.211, 4000), false, &style);
        assert!(
            open.starts_with("P(side) = 1.000e-2 to 2.100e-1, depending on undecided tosses"),
            "{open}"
        );
        assert!(
            open.contains("because of them: without them it would be ± 10.0 %"),
            "{open}"
        );
        assert!(!open.contains("Brute force"), "{open}");
        let usual = text(&answer(0.011, 0), false, &style);
        assert!(
            usual.starts_with("P(side) = 1.000e-2 ± 10.0 %") && usual.contains("Brute force"),
            "{usual}"
        );
        assert!(!usual.contains("Short of"), "{usual}");
    }

    #[test]
    fn brute_force_is_no_number_where_every_toss_shows_the_face() {
        let all = Interval {
            // but for rounding
            value: 1.0 - 1e-15,
            lo: 0.95,
            hi: 1.0,
        };
        let answer = Rareness {
            p: all,
            without_undecided: all,
            ..answer(1.0, 0)
        };
        assert!(answer.gain().tosses.is_nan());
        let text = text(&answer, false, &Style::plain(100));
        assert!(!text.contains("Brute force"), "{text}");
    }
}
