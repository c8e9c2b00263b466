//! `coinmc design`: a fair coin as files for a 3D printer, and a sheet of what to expect of it.

mod files;
mod report;
mod sheet;
mod solid;

use super::quantity::{Density, Length};
use super::question::{AnswerArgs, SceneArgs, ask};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_questions::assumptions::{self, Effect};
use coinmc_questions::scenes::EverydayScene;
use coinmc_questions::{self as questions, Fair, Question, QuestionError, Root, Size};
use coinmc_questions::{Template, Test, Workers, tosses_for_power};
use coinmc_solid::{Mass, Shape};
use files::Files;
use solid::Solid;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc design                                  fair-coin.stl, .3mf, .scad and .svg, for a table
  coinmc design --scene felt --diameter 30mm --rim 1mm --marks --out felt-coin
  coinmc design toss.toml --density 1.24g/cm3 --walls 0.8mm --infill 20 --set surface.friction=0.2

The mesh is in millimetres, as slicers expect. The sheet (.svg) is one page to print.";

/// Tosses that show the effect of each assumption.
const ASSUMPTION_TOSSES: u64 = 1024;
/// The test of the printed coin that the sheet speaks of.
const TEST: Test = Test {
    false_alarm: 0.05,
    power: 0.8,
};

/// Design a fair coin for a 3D printer: STL, 3MF, OpenSCAD, and a sheet with its tolerances
///
/// Finds the thickness at which the coin lands on its side in a third of the tosses, as `coinmc fair`
/// does, with the rim and the infill that it will have. Nothing is overwritten.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Design {
    #[command(flatten)]
    scene: SceneArgs,

    /// Diameter
    #[arg(long, value_name = "LENGTH", default_value = "24mm")]
    diameter: Length,

    /// Probability of the side [default: 1/3]
    #[arg(long, value_name = "P", allow_negative_numbers = true)]
    target: Option<f64>,

    /// Round the rims with this radius
    #[arg(long, value_name = "LENGTH", conflicts_with = "chamfer")]
    rim: Option<Length>,

    /// Cut the rims at 45° by this much. The tosses are those of a sharp rim
    #[arg(long, value_name = "LENGTH")]
    chamfer: Option<Length>,

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
    #[arg(
        long,
        value_name = "W",
        default_value_t = 0.01,
        allow_negative_numbers = true
    )]
    half_width: f64,

    /// Name of the files, without their endings
    #[arg(short, long, value_name = "NAME", default_value = "fair-coin")]
    out: PathBuf,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// A coin that has been designed, and what is known of it.
struct Designed {
    scene: Option<EverydayScene>,
    fair: Fair,
    root: Root,
    effects: Vec<Effect>,
    shape: Shape,
    mass: Mass,
}

impl Design {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let solid = self.solid()?;
        let files = Files::begin(&self.out)?;
        let (scene, template) = self.template(&solid)?;
        let found = ask(console, &self.answer, |workers| {
            self.find(scene, &template, workers)
        })?;
        let Some(found) = found else {
            return Ok(Outcome::Interrupted);
        };
        let designed = designed(scene, found, &solid)?;
        let written = files.write(&designed)?;
        match console.format() {
            Format::Json => output::print_json(&report::document(&designed, &written)),
            Format::Table => output::print(&report::text(&designed, &written, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(if designed.root.reached {
            Outcome::Done
        } else {
            Outcome::ShortOfTarget
        })
    }

    fn solid(&self) -> Result<Solid, Failure> {
        let solid = Solid {
            diameter_m: self.diameter.0,
            rim_m: self.rim.map(|rim| rim.0),
            chamfer_m: self.chamfer.map(|chamfer| chamfer.0),
            marks: self.marks,
            density_kg_m3: self.density.0,
            infill: self
                .walls
                .zip(self.infill)
                .map(|(walls, percent)| (walls.0, f64::from(percent) / 100.0)),
        };
        // a coin as thick as wide shows what is wrong with all others
        solid.shape(self.diameter.0)?;
        Ok(solid)
    }

    fn template(&self, solid: &Solid) -> Result<(Option<EverydayScene>, Template), Failure> {
        let (scene, template) = self.scene.template()?;
        let template = template.with_size(Size::Diameter(self.diameter.0))?;
        let solid = *solid;
        Ok((
            scene,
            template.with_coins_made(move |coin| solid.numbers(coin)),
        ))
    }

    /// The fair ratio, and what it rests on.
    fn find(
        &self,
        scene: Option<EverydayScene>,
        template: &Template,
        workers: &Workers<'_>,
    ) -> Result<Found, QuestionError> {
        let question = Question {
            target: self.target.unwrap_or(1.0 / 3.0),
            half_width: self.half_width,
            numerical_tosses: 0,
            ..Question::default()
        };
        let fair = questions::fair(template, &question, workers)?;
        let root = only_root(&fair);
        let mut effects = vec![];
        if let (Some(scene), Some(root)) = (scene, &root) {
            let assumed = self.scene.assumed(&scene);
            let assumed = assumed.filter(|assumed| assumed.key != "coin.radius_m");
            let tosses = ASSUMPTION_TOSSES;
            effects = assumptions::effects(template, &fair, root, assumed, tosses, workers)?;
        }
        Ok(Found {
            fair,
            root,
            effects,
        })
    }
}

/// What the tosses say.
struct Found {
    fair: Fair,
    root: Option<Root>,
    effects: Vec<Effect>,
}

/// The only root of a single curve.
fn only_root(fair: &Fair) -> Option<Root> {
    let [curve] = &fair.curves[..] else {
        return None;
    };
    let mut roots = curve.roots();
    let root = roots.next().cloned();
    root.filter(|_| roots.next().is_none())
}

/// The coin of the ratio that was found.
fn designed(
    scene: Option<EverydayScene>,
    found: Found,
    solid: &Solid,
) -> Result<Designed, Failure> {
    let root = found.root.ok_or_else(|| {
        Failure::Input(anyhow!(
            "no single thickness gives the side this probability; `coinmc fair` shows the curve"
        ))
    })?;
    let shape = solid.shape(root.coin.height_m())?;
    let mass = solid.mass(&shape)?;
    Ok(Designed {
        scene,
        fair: found.fair,
        root,
        effects: found.effects,
        shape,
        mass,
    })
}

impl Designed {
    /// Change of P(side) with a thickness greater by `error_m`, at the same diameter.
    fn change(&self, error_m: f64) -> f64 {
        self.root.slope * error_m / self.root.coin.radius_m()
    }

    /// Tosses that tell a coin whose P(side) is off by `change` from the one asked for.
    fn tosses_to_tell(&self, change: f64) -> u64 {
        let side = self.fair.question.target;
        let faces = |side: f64| [0.5 * (1.0 - side), 0.5 * (1.0 - side), side];
        tosses_for_power(faces(side), faces(side + change), TEST)
    }
}
