//! A planned experiment: the config of a run, interpreted as commands to a robot.

use crate::{Face, Setting};
use coinmc::engines::EngineError;
use coinmc::plan::{Plan, Point, Stop};
use coinmc::run::toss;
use coinmc_core::{Domain, Launch, Marginal, Orientation, Outcome, Spin, Stream};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Greatest number of throws of an experiment: a thousand years of a robot's work, and well within
/// the link's 32-bit ids.
pub const MAX_THROWS: u64 = 1_000_000_000;

/// The number of throws and their settings, all fixed before the first throw.
///
/// Throw k (from 0) is toss k of the plan's only point, with spin and angle rounded to the units of
/// the link. It depends only on the config's seed and k, so drawing it again gives the same throw.
///
/// # Example
/// ```
/// use coinmc_robot::Experiment;
/// let plan = coinmc::config::parse("toss", "
///     [coin]
///     ratio = 1.0
///     [surface]
///     restitution = 0.5
///     friction = 0.3
///     [launch]
///     preset = 'robot'
///     [engine.flat]
///     [stop]
///     tosses = 1000
/// ", &[]).unwrap();
/// let experiment = Experiment::new(plan).unwrap();
/// assert_eq!(experiment.throws(), 1000);
/// assert_eq!(experiment.setting(7), experiment.setting(7));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    plan: Plan,
    throws: u32,
}

/// Why a config does not describe an experiment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnsuitablePlan {
    /// One sentence per problem, with its remedy.
    pub problems: Vec<String>,
}

impl fmt::Display for UnsuitablePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the robot cannot throw what this config describes:")?;
        self.problems
            .iter()
            .try_for_each(|problem| write!(f, "\n  - {problem}"))
    }
}

impl std::error::Error for UnsuitablePlan {}

impl Experiment {
    /// The experiment of a plan.
    ///
    /// # Errors
    /// [`UnsuitablePlan`] with all problems: more than one point, an engine without tosses, a stop
    /// rule that does not fix the number of throws, launches outside the robot's range.
    pub fn new(plan: Plan) -> Result<Self, UnsuitablePlan> {
        let mut problems = Vec::new();
        if !plan.axes.is_empty() || plan.points.len() != 1 {
            problems.push(format!(
                "it has {} points (swept: {}): a robot throws one coin onto one surface. Give \
                 every number one value, for instance with --set",
                plan.points.len(),
                plan.axes.join(", ")
            ));
        }
        let throws = throws(&plan, &mut problems);
        for point in plan.points.iter().take(1) {
            check_launches(point, &mut problems);
        }
        if problems.is_empty() {
            Ok(Self { plan, throws })
        } else {
            Err(UnsuitablePlan { problems })
        }
    }

    /// The plan of the experiment.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Throws planned.
    pub fn throws(&self) -> u32 {
        self.throws
    }

    /// Spin and angle of throw number `throw`, from 0.
    ///
    /// # Panics
    /// Never for plans that [`new`](Self::new) accepts.
    pub fn setting(&self, throw: u32) -> Setting {
        Setting::of_launch(&self.drawn(throw)).expect("launches were checked to be in range")
    }

    /// Simulates a throw with this setting by the config's engine: for the simulated robot, and for
    /// comparison with a measured face.
    ///
    /// Quantities that the robot does not set (height, velocity) are those of toss `throw` of the
    /// plan.
    ///
    /// # Errors
    /// [`EngineError`] if the engine rejects its settings.
    pub fn simulate(&self, throw: u32, setting: Setting) -> Result<Outcome, EngineError> {
        toss(self.point(), &setting.applied_to(&self.drawn(throw)))
    }

    /// The face of [`simulate`](Self::simulate); `None` for an undecided toss.
    ///
    /// # Errors
    /// [`EngineError`] if the engine rejects its settings.
    pub fn model_face(&self, throw: u32, setting: Setting) -> Result<Option<Face>, EngineError> {
        Ok(self.simulate(throw, setting)?.face())
    }

    /// The distributions of the spin, rev/s, and of the start angle, degrees.
    pub fn marginals(&self) -> (Marginal, Marginal) {
        let launches = &self.point().launches;
        let spin = spin_about_y(&launches.spin).unwrap_or(Marginal::Constant(0.0));
        let angle = tilt(&launches.orientation).unwrap_or(Marginal::Constant(0.0));
        (scaled(spin, 1.0 / TAU), scaled(angle, 180.0 / PI))
    }

    /// The greatest spin and the greatest start angle that are planned.
    pub fn reach(&self) -> Setting {
        let (spin, angle) = self.marginals();
        let greatest = |of: Marginal| bounds(of).map_or(0.0, |(_, to)| to);
        Setting::nearest(greatest(spin), greatest(angle)).unwrap_or_default()
    }

    fn point(&self) -> &Point {
        &self.plan.points[0]
    }

    /// The launch as drawn, before it is rounded to the link's units.
    fn drawn(&self, throw: u32) -> Launch {
        let point = self.point();
        let stream = Stream::new(self.plan.seed, Domain::Launch, 0);
        point
            .launches
            .launch(&point.scene.coin, &mut stream.toss(u64::from(throw)))
    }
}

fn throws(plan: &Plan, problems: &mut Vec<String>) -> u32 {
    let no_tosses = plan
        .points
        .first()
        .is_some_and(|point| !point.engine.makes_tosses());
    if no_tosses {
        problems.push(
            "[engine.analytic] does not toss coins: give the model to compare the experiment with, \
             [engine.flat] or [engine.volumetric]"
                .to_owned(),
        );
        return 0;
    }
    match plan.stop {
        Stop::Tosses(tosses) if (1..=MAX_THROWS).contains(&tosses) => {
            u32::try_from(tosses).unwrap_or(u32::MAX)
        }
        Stop::Tosses(tosses) => {
            problems.push(format!(
                "stop.tosses is {tosses}: an experiment has 1 to {MAX_THROWS} throws"
            ));
            0
        }
        Stop::Targets(_) => {
            problems.push(
                "the targets of [stop] do not fix the number of throws: give stop.tosses (1000 throws \
                 determine a probability of 1/2 to +- 0.03)"
                    .to_owned(),
            );
            0
        }
    }
}

fn check_launches(point: &Point, problems: &mut Vec<String>) {
    match tilt(&point.launches.orientation) {
        Some(angle) => check_range(
            "launch.orientation",
            scaled(angle, 180.0 / PI),
            (180.0, "degrees"),
            problems,
        ),
        None => problems.push(
            "launch.orientation is not a tilt: the robot turns the coin about one horizontal axis. \
             Give `orientation = { tilt_deg = … }`, as the preset `robot` has"
                .to_owned(),
        ),
    }
    match spin_about_y(&point.launches.spin) {
        Some(spin) => check_range(
            "launch.spin",
            scaled(spin, 1.0 / TAU),
            (5.0, "rev/s"),
            problems,
        ),
        None => problems.push(
            "launch.spin is not about y: the robot spins the coin about one horizontal axis. Give \
             `spin = { about = { axis = [0, 1, 0], … } }`, as the preset `robot` has"
                .to_owned(),
        ),
    }
}

/// Reports a marginal that can leave the range from 0 to `max`.
fn check_range(what: &str, of: Marginal, (max, unit): (f64, &str), problems: &mut Vec<String>) {
    const SLACK: f64 = 1e-9;
    match bounds(of) {
        None => problems.push(format!(
            "{what} is normal and so has no bounds, but the robot's range is 0 to {max} {unit}: give \
             a constant or a uniform distribution within it"
        )),
        Some((from, to)) if from < -SLACK || to > max + SLACK => problems.push(format!(
            "{what} extends from {from} to {to} {unit}, but the robot's range is 0 to {max} {unit}: \
             narrow it"
        )),
        Some(_) => {}
    }
}

/// The least and the greatest value, if there are bounds.
fn bounds(of: Marginal) -> Option<(f64, f64)> {
    match of {
        Marginal::Constant(value) => Some((value, value)),
        Marginal::Uniform { from, to } => Some((from, to)),
        Marginal::Normal { mean, sd: 0.0 } => Some((mean, mean)),
        Marginal::Normal { .. } => None,
    }
}

/// The tilt in the xz plane, rad, if the orientation is a tilt.
fn tilt(orientation: &Orientation) -> Option<Marginal> {
    match orientation {
        Orientation::Tilt(angle) => Some(*angle),
        Orientation::Fixed(axis) if axis.y == 0.0 => {
            Some(Marginal::Constant(libm::atan2(axis.x, axis.z)))
        }
        _ => None,
    }
}

/// The spin about y, rad/s, if the spin is only about y.
fn spin_about_y(spin: &Spin) -> Option<Marginal> {
    if !spin.is_planar() {
        return None;
    }
    match spin {
        Spin::Components([_, y, _]) => Some(*y),
        Spin::About { axis, rate_rad_s } => Some(scaled(*rate_rad_s, axis.y)),
        Spin::Precessing { .. } => None,
    }
}

/// The marginal of the quantity times a factor, which may be negative.
fn scaled(marginal: Marginal, by: f64) -> Marginal {
    match marginal {
        Marginal::Constant(value) => Marginal::Constant(value * by),
        Marginal::Uniform { from, to } => Marginal::Uniform {
            from: (from * by).min(to * by),
            to: (from * by).max(to * by),
        },
        Marginal::Normal { mean, sd } => Marginal::Normal {
            mean: mean * by,
            sd: (sd * by).abs(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::config::{Override, parse};

    const CONFIG: &str = "seed = 3\n[coin]\nratio = 1.0\n[surface]\nrestitution = 0.5\n\
        friction = 0.3\n[launch]\npreset = 'robot'\n[engine.flat]\n[stop]\ntosses = 100\n";

    fn experiment(overrides: &[&str]) -> Result<Experiment, UnsuitablePlan> {
        let overrides: Vec<Override> = overrides.iter().map(|o| o.parse().unwrap()).collect();
        Experiment::new(parse("test", CONFIG, &overrides).unwrap())
    }

    #[test]
    fn a_throw_is_always_the_same() {
        let one = experiment(&[]).unwrap();
        let again = experiment(&["stop.tosses=7"]).unwrap();
        let settings: Vec<_> = (0..7).map(|throw| one.setting(throw)).collect();
        assert_eq!(
            settings,
            (0..7).map(|t| again.setting(t)).collect::<Vec<_>>()
        );
        let other = experiment(&["seed=4"]).unwrap();
        assert_ne!(settings[0], other.setting(0));
    }

    #[test]
    fn the_preset_gives_the_robots_whole_range() {
        let (spin, angle) = experiment(&[]).unwrap().marginals();
        let near = |marginal, most: f64| match marginal {
            Marginal::Uniform { from, to } => from == 0.0 && (to - most).abs() < 1e-12,
            _ => false,
        };
        assert!(near(spin, 5.0) && near(angle, 180.0));
    }

    #[test]
    fn all_problems_are_reported_at_once() {
        let error = experiment(&[
            "coin.ratio=[1, 2]",
            "stop={half_width=0.01, max_tosses=1000}",
            "launch.spin={about={axis=[0,1,0], rate_rad_s={uniform={from=-1, to=40}}}}",
            "launch.orientation={tilt_deg={normal={mean=60, sd=5}}}",
        ])
        .unwrap_err();
        let words = [
            "2 points (swept: ratio)",
            "the targets of [stop]",
            "normal",
            "rev/s",
        ];
        assert_eq!(error.problems.len(), 4, "{error}");
        for word in words {
            assert!(error.to_string().contains(word), "{word}: {error}");
        }
    }

    #[test]
    fn launches_in_space_and_engines_without_tosses_are_rejected() {
        let space = "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
            launch.preset = 'clean'\nengine.volumetric = {}\nstop.tosses = 10";
        let error = Experiment::new(parse("test", space, &[]).unwrap()).unwrap_err();
        assert_eq!(error.problems.len(), 2, "{error}");
        let closed = "coin.ratio = 1\nengine.analytic.rule = 'arc'";
        let error = Experiment::new(parse("test", closed, &[]).unwrap()).unwrap_err();
        assert!(error.to_string().contains("engine.flat"), "{error}");
    }

    #[test]
    fn simulated_faces_depend_on_setting_and_number() {
        let experiment = experiment(&[]).unwrap();
        let face = |throw| {
            let setting = experiment.setting(throw);
            experiment.model_face(throw, setting).unwrap()
        };
        let faces: Vec<_> = (0..50).map(face).collect();
        assert_eq!(faces, (0..50).map(face).collect::<Vec<_>>());
        assert!(Face::ALL.iter().all(|face| faces.contains(&Some(*face))));
        // another setting gives another toss
        let other = Setting::new(4321, 1234).unwrap();
        let others: Vec<_> = (0..50)
            .map(|t| experiment.model_face(t, other).unwrap())
            .collect();
        assert_ne!(others, faces);
    }
}
