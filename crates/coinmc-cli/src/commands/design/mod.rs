//! `coinmc design`: a fair coin as files for a 3D printer, and a sheet of what to expect of it.

mod files;
mod report;

use super::quantity::{Density, Length};
use super::question::{AnswerArgs, SceneArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_questions::{self as questions, Design, DesignError, Designed};
use coinmc_questions::{PRINTED_DIAMETER_M, PrintedCoin};
use coinmc_solid::{Edge, Infill};
use files::Files;
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc design                                  fair-coin.stl, .3mf, .scad and .svg, for a table
  coinmc design --scene felt --diameter 30mm --rim 1mm --marks --out felt-coin
  coinmc design toss.toml --density 1.24g/cm3 --walls 0.8mm --infill 20 --set surface.friction=0.2

The mesh is in millimetres, as slicers expect. The sheet (.svg) is one page to print.";

/// Design a fair coin for a 3D printer: STL, 3MF, OpenSCAD, and a sheet with its tolerances
///
/// Finds the thickness at which the coin lands on its side in a third of the tosses, as `coinmc fair`
/// does, with the edge and the infill that it will have. Nothing is overwritten.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct DesignArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// Diameter [default: that of the config; for an everyday scene 24mm]
    #[arg(long, value_name = "LENGTH")]
    diameter: Option<Length>,

    /// Probability of the side [default: 1/3]
    #[arg(long, value_name = "P")]
    target: Option<f64>,

    /// Round the rims with this radius
    #[arg(long, value_name = "LENGTH", conflicts_with = "chamfer")]
    rim: Option<Length>,

    /// Cut the rims at 45° by this much. The tosses are those of rims rounded with this radius
    #[arg(long, value_name = "LENGTH")]
    chamfer: Option<Length>,

    /// Tilt the side by this angle to the axis: a conical edge. Above 0 heads is the wider face, of the
    /// diameter given; heads and tails then differ, and the side alone gets its probability
    #[arg(long, value_name = "DEGREES", conflicts_with_all = ["rim", "chamfer", "marks", "infill"])]
    draft: Option<f64>,

    /// Engrave a ring of three marks on heads and of six on tails, which keep the coin balanced
    #[arg(long)]
    marks: bool,

    /// Density of the material
    #[arg(long, value_name = "DENSITY", default_value = "1.24g/cm3")]
    density: Density,

    /// Thickness of walls, bottom and lid of a coin that is not full inside
    #[arg(long, value_name = "LENGTH", requires = "infill")]
    walls: Option<Length>,

    /// Share of its inside that is full, percent
    #[arg(long, value_name = "PERCENT", requires = "walls")]
    #[arg(value_parser = clap::value_parser!(u8).range(0..=100))]
    infill: Option<u8>,

    /// Search until the interval of H/R is no wider than ± this
    #[arg(long, value_name = "W", default_value_t = 0.01)]
    half_width: f64,

    /// Name of the files, without their endings
    #[arg(short, long, value_name = "NAME", default_value = "fair-coin")]
    out: PathBuf,

    #[command(flatten)]
    answer: AnswerArgs,
}

impl DesignArgs {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (scene, template) = self.scene.template()?;
        let overrides = self.scene.overrides();
        let told = questions::diameter_told(&template, scene, overrides);
        let (diameter_m, told) = if let Some(Length(asked)) = self.diameter {
            // a config with several diameters, or with one that cannot be, is none of its concern
            (asked, told.ok().flatten())
        } else {
            let told = told?;
            (told.unwrap_or(PRINTED_DIAMETER_M), told)
        };
        let question = self.question(diameter_m);
        // what is wrong with any coin of this kind is said before files are begun
        let coin = &question.coin;
        coin.check().map_err(DesignError::from)?;
        let files = Files::begin(&self.out)?;
        let designed = ask(console, &self.answer, |workers| {
            questions::design(&template, scene, overrides, &question, workers)
        })?;
        let paths = files.write(&designed)?;
        match console.format() {
            Format::Json => output::print_json(&document(&designed, &paths)),
            Format::Table => {
                let infill = question.coin.infill;
                let style = console.stdout();
                output::print(&report::text(&designed, told, infill, &paths, style))
            }
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(if designed.root.reached {
            Outcome::Done
        } else {
            Outcome::ShortOfTarget
        })
    }

    /// The question, of a coin of this diameter.
    fn question(&self, diameter_m: f64) -> Design {
        let edge = match (self.rim, self.chamfer) {
            (Some(Length(radius_m)), _) => Edge::Rounded { radius_m },
            (None, Some(Length(size_m))) => Edge::Chamfered { size_m },
            (None, None) => Edge::Sharp,
        };
        let infill = self.walls.zip(self.infill);
        Design {
            coin: PrintedCoin {
                diameter_m,
                edge,
                draft_deg: self.draft,
                marks: self.marks,
                density_kg_m3: self.density.0,
                infill: infill.map(|(walls, percent)| Infill {
                    walls_m: walls.0,
                    density_fraction: f64::from(percent) / 100.0,
                }),
            },
            target: self.target.unwrap_or(1.0 / 3.0),
            half_width: self.half_width,
        }
    }
}

fn document(designed: &Designed, paths: &[PathBuf]) -> Value {
    let mut document = questions::document_of_design(designed);
    let paths = paths.iter().map(|path| path.display().to_string());
    document["files"] = paths.collect();
    document
}
