//! `coinmc ask`: an answer without a toss.

use super::names;
use super::quantity::Length;
use super::question::{AnswerArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{
    Colors, Style, compact, decimals_that_show, four_decimals_for, grouped, in_ascii,
};
use anyhow::anyhow;
use clap::{ArgGroup, Args};
use coinmc::plan::MAX_TOSSES;
use coinmc_atlas::{Answer, Atlas, AtlasError, Launch, Place, scene, toss};
use coinmc_core::{Face, Material};
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  coinmc ask --ratio 0.8 --material wood            a coin tossed by hand onto a wooden table
  coinmc ask --thickness 2.33mm --launch rolled     a 1 euro coin that rolls on its rim
  coinmc ask --ratio 1.1 --set friction=0.2 --sure  and by tosses, too

Launches: hand, dropped, rolled. Materials: glass, steel, laminate, wood, cloth, felt, carpet.";

/// Ask for the faces of a coin, answered in milliseconds
///
/// Answers for a coin with the diameter of a 1 euro coin from an atlas of tosses: networks fitted to
/// millions of them, which know their own error. With --sure it tosses that very coin as well.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[command(group = ArgGroup::new("size").required(true).args(["ratio", "thickness"]))]
pub(crate) struct Ask {
    /// Height over radius, H/R
    #[arg(long, value_name = "H/R")]
    ratio: Option<f64>,

    /// Thickness of the coin, such as 2.33mm, instead of the ratio
    #[arg(long, value_name = "LENGTH")]
    thickness: Option<Length>,

    /// What it lands on
    #[arg(long, value_name = "NAME", default_value = "laminate", value_parser = names::materials())]
    #[arg(hide_possible_values = true)]
    material: String,

    /// How it is let go
    #[arg(long, value_name = "NAME", default_value = "hand", value_parser = names::launches())]
    #[arg(hide_possible_values = true)]
    launch: String,

    /// Replace a number of the surface, as in `friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=NUMBER")]
    numbers: Vec<Number>,

    /// Toss that coin as well
    #[arg(long)]
    sure: bool,

    /// How many tosses --sure makes
    #[arg(long, value_name = "N", default_value = "20_000", value_parser = tosses, requires = "sure")]
    tosses: u64,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// A number of the surface.
#[derive(Debug, Clone)]
struct Number(String, f64);

impl FromStr for Number {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text
            .split_once('=')
            .and_then(|(key, value)| Some(Self(key.trim().to_owned(), value.trim().parse().ok()?)));
        parsed.ok_or_else(|| "expected a key and a number, as in `friction=0.2`".to_owned())
    }
}

/// A number of tosses that a plan may have.
fn tosses(text: &str) -> Result<u64, String> {
    let tosses = super::count(text)?;
    if (1..=MAX_TOSSES).contains(&tosses) {
        Ok(tosses)
    } else {
        Err(format!("expected a whole number from 1 to {MAX_TOSSES}"))
    }
}

/// What is wrong with a question, all of it.
#[derive(Debug, Default)]
struct Problems(Vec<String>);

impl Problems {
    /// The value; `None` once the problem is noted.
    fn unless<T, E: Into<AtlasError>>(&mut self, result: Result<T, E>) -> Option<T> {
        result
            .map_err(|error| self.0.push(error.into().to_string()))
            .ok()
    }
}

impl Ask {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (atlas, mut answer) = self.answer()?;
        if self.sure {
            let plan = scene(&atlas, answer.launch, &answer.place, self.tosses)?;
            let counts = ask(console, &self.answer, |workers| {
                toss(&plan, self.tosses, workers)
            })?;
            answer.counts = Some(counts);
        }
        match console.format() {
            Format::Json => output::print_json(&answer.document(&atlas)),
            Format::Table => output::print(&text(&answer, &atlas, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    /// The answer without a toss, or everything that is wrong with the question.
    fn answer(&self) -> Result<(Atlas, Answer), Failure> {
        let mut problems = Problems::default();
        let launch = problems.unless(self.launch.parse::<Launch>());
        let material = problems.unless(self.material.parse::<Material>());
        let atlas = Atlas::of(launch.unwrap_or(Launch::ALL[0]));
        // another in its stead, so that what does not depend on it is checked as well
        let place = self.place(
            &material.unwrap_or(Material::ALL[0]),
            atlas.radius_m(),
            &mut problems,
        );
        // its limits are those of the launch
        let faces = launch.and_then(|_| problems.unless(atlas.faces(&place)));
        let (Some(launch), Some(material), Some(faces), true) =
            (launch, material, faces, problems.0.is_empty())
        else {
            return Err(Failure::Input(anyhow!(problems.0.join("\n"))));
        };
        let answer = Answer {
            launch,
            material: material.name,
            place,
            faces,
            fair: atlas.root(&place, 1.0 / 3.0)?,
            counts: None,
        };
        Ok((atlas, answer))
    }

    /// The place of all numbers that the atlas knows.
    fn place(&self, material: &Material, radius_m: f64, problems: &mut Problems) -> Place {
        let ratio = match (self.ratio, self.thickness) {
            (Some(ratio), _) => ratio,
            (None, Some(Length(thickness_m))) => thickness_m / radius_m,
            (None, None) => unreachable!("clap requires one of the two"),
        };
        let mut numbers: Vec<(String, f64)> = vec![];
        let mut place = Place::on(material, ratio, radius_m);
        for Number(key, value) in &self.numbers {
            numbers.push((key.clone(), *value));
            match problems.unless(Place::with(material, ratio, radius_m, &numbers)) {
                Some(found) => place = found,
                None => drop(numbers.pop()),
            }
        }
        place
    }
}

fn text(answer: &Answer, atlas: &Atlas, style: &Style) -> String {
    let place = &answer.place;
    let mm = 1e3 * atlas.radius_m();
    let headline = format!(
        "A coin of {:.2} mm × {} mm (H/R = {}), {}, onto {}",
        mm * place.ratio,
        compact(2.0 * mm),
        compact(place.ratio),
        answer.launch.doc(),
        answer.material,
    );
    let mut text = format!("{}\n", style.paint(Colors::Strong, &headline));
    let mut columns = vec![
        Column::left("face"),
        Column::right("P"),
        Column::left("95 % interval"),
    ];
    if answer.counts.is_some() {
        columns.extend([Column::right("by tosses"), Column::left("95 % interval")]);
    }
    let mut table = Table::new(columns);
    for face in Face::ALL {
        let [lo, hi] = answer.interval(face);
        let p = answer.faces.p[face as usize];
        let mut cells = vec![face.name().to_owned()];
        cells.extend(probability(p, lo, hi));
        if let Some(tossed) = answer.tossed(face) {
            cells.extend(probability(tossed.p, tossed.lo, tossed.hi));
        }
        table.push(cells);
    }
    text += &table.render(style).text;
    text += &match answer.fair.zip(answer.fair_half_width()) {
        Some((root, half_width)) => {
            let decimals = decimals_that_show(half_width, 2);
            format!(
                "There the side comes up in a third of the tosses at H/R = {:.decimals$} ± {half_width:.decimals$}\n",
                root.ratio,
            )
        }
        None => "At no H/R of the atlas does the side come up in a third of the tosses there\n"
            .to_owned(),
    };
    let mut note = format!(
        "From an atlas of {} tosses at {} coins and surfaces",
        grouped(atlas.tosses()),
        grouped(atlas.points())
    );
    if let Some(counts) = answer.counts {
        note += &format!(
            "; {} tosses of this one, {} undecided",
            grouped(counts.tosses()),
            grouped(counts.undecided)
        );
    }
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

fn probability(p: f64, lo: f64, hi: f64) -> [String; 2] {
    let decimals = four_decimals_for(0.5 * (hi - lo));
    [
        format!("{p:.decimals$}"),
        format!("[{lo:.decimals$}, {hi:.decimals$}]"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Only {
        #[command(flatten)]
        ask: Ask,
    }

    fn asked(words: &[&str]) -> Result<Ask, String> {
        let words = ["ask"].iter().chain(words);
        let only = Only::try_parse_from(words).map_err(|error| error.to_string())?;
        Ok(only.ask)
    }

    fn problems(words: &[&str]) -> Vec<String> {
        let ask = asked(words).expect("words that can be read");
        let failure = ask.answer().map(|_| ()).expect_err("problems");
        failure.message().lines().map(str::to_owned).collect()
    }

    #[test]
    fn everything_that_is_wrong_is_told_at_once() {
        let numbers = ["--ratio", "9", "--set", "frction=2", "--set", "friction=7"];
        let found = problems(&[&numbers[..], &["--material", "marble"]].concat());
        let begins = [
            "there is no `material` called `marble`: there are glass, ",
            "the atlas has no `frction`",
            "the atlas holds ratio from",
            "the atlas holds friction from",
        ];
        assert_eq!(found.len(), begins.len(), "{found:?}");
        for (found, begin) in found.iter().zip(begins) {
            assert!(found.starts_with(begin), "{found}");
        }
        let found = problems(&[
            "--ratio",
            "0.8",
            "--launch",
            "thrown",
            "--material",
            "marble",
        ]);
        assert!(
            found[0].contains("launch `thrown`") && found.len() == 2,
            "{found:?}"
        );
    }

    /// The thickness or the ratio is needed, and the message names both.
    #[test]
    fn a_coin_has_one_size() {
        let none = asked(&[]).expect_err("no size");
        assert!(
            none.contains("--ratio") && none.contains("--thickness"),
            "{none}"
        );
        assert!(asked(&["--ratio", "1", "--thickness", "2mm"]).is_err());
        assert!(asked(&["--thickness", "2mm"]).is_ok());
    }

    #[test]
    fn no_interval_reads_as_wide_as_nothing() {
        assert_eq!(probability(0.25, 0.24, 0.26), ["0.250", "[0.240, 0.260]"]);
        let sure = probability(0.999_998, 0.999_994, 1.0);
        assert_eq!(sure, ["0.999998", "[0.999994, 1.000000]"]);
    }

    #[test]
    fn tosses_are_those_of_sure_and_name_their_option() {
        assert!(asked(&["--ratio", "1", "--tosses", "5"]).is_err());
        assert!(asked(&["--ratio", "1"]).is_ok());
        let none = asked(&["--ratio", "1", "--sure", "--tosses", "0"]).expect_err("no toss");
        assert!(none.contains("'0' for '--tosses <N>'"), "{none}");
    }
}
