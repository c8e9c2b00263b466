//! `coinmc ask`: an answer without a toss.

use super::quantity::Length;
use super::question::{AnswerArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, grouped, in_ascii};
use anyhow::anyhow;
use clap::Args;
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
pub(crate) struct Ask {
    /// Height over radius, H/R
    #[arg(long, value_name = "H/R", required_unless_present = "thickness")]
    ratio: Option<f64>,

    /// Thickness of the coin, such as 2.33mm, instead of the ratio
    #[arg(long, value_name = "LENGTH", conflicts_with = "ratio")]
    thickness: Option<Length>,

    /// What it lands on
    #[arg(long, value_name = "NAME", default_value = "laminate")]
    material: String,

    /// How it is let go
    #[arg(long, value_name = "NAME", default_value = "hand")]
    launch: String,

    /// Replace a number of the surface, as in `friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=NUMBER")]
    numbers: Vec<Number>,

    /// Toss that coin as well
    #[arg(long)]
    sure: bool,

    /// How many tosses --sure makes
    #[arg(long, value_name = "N", default_value = "20_000", value_parser = super::count)]
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

impl Ask {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let launch: Launch = self.launch.parse()?;
        let atlas = Atlas::of(launch);
        let mut answer = self.answer(launch, &atlas)?;
        if self.sure {
            let plan = scene(&atlas, launch, &answer.place, self.tosses)?;
            let counts = ask(console, &self.answer, |workers| {
                toss(&plan, self.tosses, workers)
            })?;
            let Some(counts) = counts else {
                return Ok(Outcome::Interrupted);
            };
            answer.counts = Some(counts);
        }
        match console.format() {
            Format::Json => output::print_json(&answer.document(&atlas)),
            Format::Table => output::print(&text(&answer, &atlas, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    fn answer(&self, launch: Launch, atlas: &Atlas) -> Result<Answer, Failure> {
        let material: Material = self.material.parse().map_err(AtlasError::from)?;
        let radius_m = atlas.radius_m();
        let ratio = match (self.ratio, self.thickness) {
            (Some(ratio), _) => ratio,
            (None, Some(Length(thickness_m))) => thickness_m / radius_m,
            (None, None) => unreachable!("clap requires one of the two"),
        };
        let numbers: Vec<(String, f64)> = self
            .numbers
            .iter()
            .map(|Number(key, value)| (key.clone(), *value))
            .collect();
        let place = Place::with(&material, ratio, radius_m, &numbers)?;
        Ok(Answer {
            launch,
            material: material.name,
            place,
            faces: atlas.faces(&place)?,
            fair: atlas.root(&place, 1.0 / 3.0)?,
            counts: None,
        })
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
        Some((root, half_width)) => format!(
            "There the side comes up in a third of the tosses at H/R = {:.2} ± {half_width:.2}\n",
            root.ratio,
        ),
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
    let decimals = decimals_for(0.5 * (hi - lo)).min(4);
    [
        format!("{p:.decimals$}"),
        format!("[{lo:.decimals$}, {hi:.decimals$}]"),
    ]
}
