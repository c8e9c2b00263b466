//! A fair coin to print: its solid, and what to expect of it.
//!
//! The thickness is that at which [`fair()`](crate::fair()) finds the side with the probability asked for, in
//! tosses of the coin as it will be printed: with rounded rims or a conical edge, and with the moments of inertia
//! of its rims, marks and infill.

mod document;
mod faces;
mod printed;
mod sheet;
mod size;

pub use document::document_of_design;
pub use faces::Faces;
pub use printed::PrintedCoin;
pub use size::{PRINTED_DIAMETER_M, diameter_told};

use crate::assumptions::{self, Effect};
use crate::scenes::{Assumption, EverydayScene};
use crate::{
    Fair, Question, QuestionError, Root, Size, Template, Test, Workers, fair, tosses_for_power,
};
use coinmc::config::Override;
use coinmc_solid::{Mass, MassError, Mesh, MeshError, Shape, ShapeError};
use coinmc_solid::{write_3mf, write_openscad, write_stl};
use std::io::{self, Write};
use thiserror::Error;

/// Tosses that show the effect of each assumption.
const ASSUMPTION_TOSSES: u64 = 1024;
/// The test of the printed coin that the sheet speaks of.
pub const TEST: Test = Test {
    false_alarm: 0.05,
    power: 0.8,
};
/// Errors of the thickness that are spoken of, m.
pub const THICKNESS_ERRORS_M: [f64; 3] = [5e-5, 1e-4, 2e-4];
/// Errors of P(side) that a test is to find.
const CHANGES: [f64; 4] = [0.02, 0.03, 0.05, 0.1];

/// The coin to design.
///
/// # Example
/// ```
/// use coinmc_questions::{Design, PrintedCoin, Workers, design, scenes::EverydayScene};
/// use coinmc_solid::Edge;
/// use std::sync::atomic::AtomicBool;
/// let coin = PrintedCoin {
///     diameter_m: 0.03,
///     edge: Edge::Rounded { radius_m: 0.001 },
///     draft_deg: None,
///     marks: true,
///     density_kg_m3: 1240.0,
///     infill: None,
/// };
/// let question = Design { coin, target: 1.0 / 3.0, half_width: 0.1 };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let felt = EverydayScene::named("felt")?;
/// let designed = design(&felt.template(&[]), Some(felt), &[], &question, &workers)?;
/// assert!((0.5..2.5).contains(&(designed.shape.thickness_m() / 0.015)));
/// assert!(designed.sheet().starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    /// The coin, but for its thickness.
    pub coin: PrintedCoin,
    /// The probability of the side.
    pub target: f64,
    /// Half width of the interval of H/R that is enough.
    pub half_width: f64,
}

/// Why a coin cannot be designed.
#[derive(Debug, Error)]
pub enum DesignError {
    /// The question has no answer.
    #[error(transparent)]
    Question(#[from] QuestionError),
    /// The solid cannot be.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Its mass cannot be.
    #[error(transparent)]
    Mass(#[from] MassError),
    /// It cannot be divided into triangles.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// There is no such coin, or there are several.
    #[error("no single thickness gives the side this probability; `coinmc fair` shows the curve")]
    NoSingleRoot,
    /// The config's centre of mass is off the middle.
    #[error(
        "a print is of one material: `coin.centre_of_mass_over_height` must be 0 (a conical edge, \
         `coin.draft_deg`, moves the centre of mass of a print)"
    )]
    Loaded,
}

/// A coin that has been designed, and what is known of it.
#[derive(Debug, Clone)]
pub struct Designed {
    /// The everyday scene, if it is for one.
    pub scene: Option<EverydayScene>,
    /// What was changed of the scene, or of the config, but for the coin, which is here.
    pub overrides: Vec<Override>,
    /// The search for the ratio.
    pub fair: Fair,
    /// The ratio.
    pub root: Root,
    /// Heads and tails there, if a conical edge makes them differ.
    pub faces: Option<Faces>,
    /// How far the scene's assumptions move the root.
    pub effects: Vec<Effect>,
    /// The solid.
    pub shape: Shape,
    /// Its mass and moments of inertia.
    pub mass: Mass,
    /// Its surface in triangles.
    pub mesh: Mesh,
}

/// Designs a coin. `overrides` are those of the template, which say what of the scene is not assumed.
///
/// # Errors
/// [`DesignError`]; a solid that cannot be, whatever its thickness, is found before the first toss.
pub fn design(
    template: &Template,
    scene: Option<EverydayScene>,
    overrides: &[Override],
    question: &Design,
    workers: &Workers<'_>,
) -> Result<Designed, DesignError> {
    question.coin.check()?;
    let template = template
        .clone()
        .with_size(Size::Diameter(question.coin.diameter_m))?;
    let coin = question.coin.with_edge_of(&template)?;
    coin.check()?;
    let template = match coin.draft_deg {
        Some(draft) => template.with_value("coin.draft_deg", draft),
        None => template,
    };
    let template = template.with_coins_made(move |made| coin.numbers(made));
    refuse_sweep(&template)?;
    let fair = fair(
        &template,
        &Question {
            target: question.target,
            half_width: question.half_width,
            numerical_tosses: 0,
            ..Question::default()
        },
        workers,
    )?;
    let root = only_root(&fair).ok_or(DesignError::NoSingleRoot)?;
    let mut effects = vec![];
    if let Some(scene) = scene {
        let of_size = |assumed: &Assumption| assumed.key == "coin.radius_m";
        let assumed = scene.assumed(overrides).into_iter();
        let assumed = assumed.filter(|assumed| !of_size(assumed));
        let tosses = ASSUMPTION_TOSSES;
        effects = assumptions::effects(&template, &fair, &root, assumed, tosses, workers)?;
    }
    let shape = coin.shape(root.coin.height_m())?;
    let not_of_coin = overrides.iter().filter(|set| !set.is_of("coin"));
    let faces = (shape.draft_deg() != 0.0).then(|| Faces::at(&template, &root, workers));
    Ok(Designed {
        faces: faces.transpose()?,
        mass: coin.mass(&shape)?,
        mesh: shape.mesh(shape.chord_error_m())?,
        scene,
        overrides: not_of_coin.cloned().collect(),
        fair,
        root,
        effects,
        shape,
    })
}

/// Refuses a config that sweeps anything but the ratio, which is sought: there is one coin to print.
fn refuse_sweep(template: &Template) -> Result<(), QuestionError> {
    let plan = template.plan(&[("coin.ratio", "1.0".to_owned())])?;
    if plan.axes.is_empty() {
        Ok(())
    } else {
        Err(QuestionError::Swept(plan.axes.join(", ")))
    }
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

/// A kind of file that a design is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DesignFile {
    /// Triangles in millimetres, binary STL.
    Stl,
    /// The same as 3MF.
    ThreeMf,
    /// OpenSCAD source.
    OpenScad,
    /// The sheet to print, SVG.
    Sheet,
}

impl DesignFile {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Stl, Self::ThreeMf, Self::OpenScad, Self::Sheet];

    /// How its name ends.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Stl => ".stl",
            Self::ThreeMf => ".3mf",
            Self::OpenScad => ".scad",
            Self::Sheet => ".svg",
        }
    }
}

impl Designed {
    /// Writes a file.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, file: DesignFile, mut out: impl Write) -> io::Result<()> {
        match file {
            DesignFile::Stl => write_stl(&self.mesh, &mut out),
            DesignFile::ThreeMf => write_3mf(
                &self.mesh,
                &format!("{}, by coinmc", self.title()),
                &mut out,
            ),
            DesignFile::OpenScad => write_openscad(&self.shape, &mut out),
            DesignFile::Sheet => out.write_all(self.sheet().as_bytes()),
        }
    }

    /// What it is. With a conical edge only the side is fair, if that is asked for.
    pub fn title(&self) -> &'static str {
        if self.faces.is_some() {
            "A coin with a conical edge"
        } else if self.is_for_a_third() {
            "A fair coin with three sides"
        } else {
            "A coin with three sides"
        }
    }

    /// Whether the side is to be as likely as each face.
    pub(crate) fn is_for_a_third(&self) -> bool {
        (self.fair.question.target - 1.0 / 3.0).abs() < 1e-6
    }

    /// The page to print and keep with the coin, SVG.
    pub fn sheet(&self) -> String {
        sheet::svg(self)
    }

    /// Change of P(side) with a thickness greater by `error_m`, at the same diameter.
    pub fn change(&self, error_m: f64) -> f64 {
        self.root.slope * error_m / self.root.coin.radius_m()
    }

    /// Tosses that tell a coin whose P(side) is off by `change` from the one asked for, by [`TEST`].
    pub fn tosses_to_tell(&self, change: f64) -> u64 {
        let side = self.fair.question.target;
        let heads = self.faces.map_or(0.5, |faces| faces.share_of_heads());
        let faces = |side: f64| [heads * (1.0 - side), (1.0 - heads) * (1.0 - side), side];
        tosses_for_power(faces(side), faces(side + change), TEST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

    /// A massive coin without anything to it.
    fn plain() -> PrintedCoin {
        PrintedCoin {
            diameter_m: 0.024,
            edge: coinmc_solid::Edge::Sharp,
            draft_deg: None,
            marks: false,
            density_kg_m3: 1240.0,
            infill: None,
        }
    }

    /// Its title and its sheet say of a coin that it is fair only if that is what it is for.
    #[test]
    fn a_coin_is_called_fair_if_a_third_was_asked_for() {
        let text = "surface = { restitution = 0.5, friction = 0.3, landing = 'adhesive' }\n\
                    launch.preset = 'robot'\nengine.flat = {}";
        for (target, title) in [
            (1.0 / 3.0, "A fair coin with three sides"),
            (0.5, "A coin with three sides"),
        ] {
            let question = Design {
                coin: plain(),
                target,
                half_width: 0.05,
            };
            let cancel = AtomicBool::new(false);
            let workers = Workers {
                threads: None,
                cancel: &cancel,
                made: &|_| (),
            };
            let template = Template::new("inline", text, &[]);
            let designed = design(&template, None, &[], &question, &workers).expect("a design");
            assert_eq!(designed.title(), title);
            let sheet = designed.sheet();
            assert!(sheet.contains(title), "{sheet}");
            assert_eq!(sheet.contains("fair coin"), target < 0.4, "{sheet}");
        }
    }

    /// Before a toss is made, and by the reason that it is.
    #[test]
    fn a_config_that_sweeps_another_number_is_refused_as_such() {
        let question = Design {
            coin: plain(),
            target: 1.0 / 3.0,
            half_width: 0.5,
        };
        let refused = |numbers: &str| {
            let text = format!("{numbers}\nlaunch.preset = 'robot'\nengine.flat = {{}}");
            let made = |_| panic!("a toss was made");
            let cancel = AtomicBool::new(false);
            let workers = Workers {
                threads: None,
                cancel: &cancel,
                made: &made,
            };
            let template = Template::new("inline", text, &[]);
            let designed = design(&template, None, &[], &question, &workers);
            designed.map(|_| ()).expect_err("refused").to_string()
        };
        assert_eq!(
            refused("surface = { restitution = 0.5, friction = [0.2, 0.3] }"),
            "the config must be a single point, but sweeps friction"
        );
    }
}
