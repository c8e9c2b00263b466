//! How the probabilities of the faces move with every number of a scene.
//!
//! # Method
//! Each parameter θ is decreased and increased by half a step, by the same factor, and the same tosses
//! are made with both values. Only tosses whose face changes contribute to the difference, so its error
//! is far smaller than that of two independent estimates:
//!
//! ```text
//! dP/d ln θ = [P(θ sqrt(1 + s)) − P(θ/sqrt(1 + s))]/ln(1 + s),
//! ```
//!
//! right to the second order of s. Where the range of θ ends before that, as that of a restitution of 1, the two
//! values are θ/(1 + s) and θ, or θ and θ(1 + s), which is right to the first order. The elasticity is d ln P/d ln θ, by how many per cent P grows if θ
//! does by one: the derivative divided by the mean of both P.
//!
//! Near a root x* of P(x, θ) = target, dx*/d ln θ = −(dP/d ln θ)/(dP/dx).

use crate::changes::Changes;
use crate::interval::normal_quantile;
use crate::workers::At;
use crate::{Interval, QuestionError, Root, Template, Workers};
use coinmc::config::nearest;
use coinmc::plan::Plan;
use coinmc_core::Face;
use toml::de::{DeTable, DeValue};

/// Tables of a config whose numbers can be varied.
const TABLES: [&str; 4] = ["coin", "surface", "environment", "launch"];
/// Least number of tosses: with fewer the intervals mean nothing.
pub const LEAST_TOSSES: u64 = 256;

/// A number of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its key in configs.
    pub key: String,
    /// The number.
    pub value: f64,
}

/// How the probabilities move with one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The parameter.
    pub parameter: Parameter,
    /// Its two values: around its own, or on one side of it where its range ends.
    pub values: [f64; 2],
    /// dP/d ln(parameter) of heads, tails and side.
    pub faces: [Interval; 3],
    /// Share of the tosses that show each face, the mean of those with either value.
    pub p: [f64; 3],
    /// Undecided tosses with either value. The intervals hold whatever they would have shown.
    pub undecided: [u64; 2],
    /// Share of the tosses whose face changes.
    pub changed: f64,
    /// Tosses with either value.
    pub tosses: u64,
    /// Confidence of the intervals.
    pub confidence: f64,
}

impl Sensitivity {
    /// Whether the range of the parameter ends so near that it was moved to one side only.
    pub fn is_one_sided(&self) -> bool {
        self.values.contains(&self.parameter.value)
    }

    /// dP/d ln(parameter) of a face.
    pub fn of(&self, face: Face) -> Interval {
        self.faces[face as usize]
    }

    /// d ln P/d ln(parameter) of a face; infinite or NaN if it was not seen. Undecided tosses may have shown it,
    /// so its interval allows for a P that is as much higher.
    pub fn elasticity(&self, face: Face) -> Interval {
        let least = self.p[face as usize];
        let [first, second] = self.undecided.map(|undecided| undecided as f64);
        let most = least + 0.5 * (first + second) / self.tosses as f64;
        let Interval { value, lo, hi } = self.of(face);
        Interval {
            value: value / least,
            lo: lo / if lo < 0.0 { least } else { most },
            hi: hi / if hi > 0.0 { least } else { most },
        }
    }

    /// dx*/d ln(parameter) of a root x* of the face's probability. The interval holds the error of the
    /// derivative and that of the slope, added as independent.
    pub fn shift(&self, face: Face, root: &Root) -> Interval {
        let derivative = self.of(face);
        let z = normal_quantile(self.confidence);
        let value = -derivative.value / root.slope;
        let of_slope = z * root.slope_error / root.slope * value;
        let arm = |of_derivative: f64| {
            let arm = of_derivative / root.slope;
            (arm * arm + of_slope * of_slope).sqrt()
        };
        let (below, above) = (
            derivative.value - derivative.lo,
            derivative.hi - derivative.value,
        );
        let falls = root.slope > 0.0;
        let [lower, upper] = if falls {
            [above, below]
        } else {
            [below, above]
        };
        Interval {
            value,
            lo: value - arm(lower),
            hi: value + arm(upper),
        }
    }
}

/// What to vary, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    /// Keys of the parameters; empty for all that are not 0.
    pub keys: Vec<String>,
    /// Ratio of the two values minus 1.
    pub step: f64,
    /// Tosses with either value.
    pub tosses: u64,
}

/// The numbers of a scene that can be varied: all but 0 in coin, surface, environment and launch. The
/// mass of a uniform coin affects no probability and is left out.
///
/// # Errors
/// [`QuestionError::Config`]; [`QuestionError::Swept`] if the config sweeps parameters.
pub fn parameters(template: &Template) -> Result<Vec<Parameter>, QuestionError> {
    let plan = template.plan(&[])?;
    if !plan.axes.is_empty() {
        return Err(QuestionError::Swept(plan.axes.join(", ")));
    }
    let mut found = vec![];
    if let Ok(document) = DeTable::parse(&plan.resolved_toml) {
        let document = document.into_inner();
        for name in TABLES {
            if let Some(table) = document.get(name) {
                collect(table.get_ref(), name.to_owned(), &mut found);
            }
        }
    }
    let loaded = found
        .iter()
        .any(|number| number.key.ends_with("_moment_kg_m2"));
    found.retain(|number| loaded || number.key != "coin.mass_kg");
    Ok(found)
}

fn collect(value: &DeValue<'_>, key: String, found: &mut Vec<Parameter>) {
    let text = match value {
        DeValue::Table(table) => {
            for (name, inner) in table {
                collect(inner.get_ref(), format!("{key}.{}", name.get_ref()), found);
            }
            return;
        }
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Integer(number) => number.as_str().replace('_', ""),
        _ => return,
    };
    if let Ok(value) = text.parse::<f64>()
        && value != 0.0
    {
        found.push(Parameter { key, value });
    }
}

/// How the probabilities move with parameters of a scene, in the order of the config.
///
/// # Errors
/// [`QuestionError`] if the question or the config with a changed value has problems, or it was stopped.
///
/// # Example
/// ```
/// use coinmc_core::Face;
/// use coinmc_questions::{Template, Workers, sensitivity::{Steps, sensitivities}};
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 1.6\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///             launch.preset = 'robot'\nengine.flat = {}";
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let steps = Steps { keys: vec!["coin.ratio".to_owned()], step: 0.05, tosses: 4096 };
/// let found = sensitivities(&Template::new("inline", text, &[]), &steps, &workers)?;
/// assert!(found[0].of(Face::Side).lo > 0.0);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn sensitivities(
    template: &Template,
    steps: &Steps,
    workers: &Workers<'_>,
) -> Result<Vec<Sensitivity>, QuestionError> {
    let template = template.resolved()?;
    let chosen = chosen(&template, steps)?;
    let moved = chosen
        .into_iter()
        .map(|parameter| Moved::by(steps.step, parameter, &template));
    let moved: Vec<Moved> = moved.collect::<Result<_, _>>()?;
    let pairs: Vec<_> = moved
        .iter()
        .map(|moved| at_first_point(&moved.plans))
        .collect();
    let changes = workers.compare(&pairs, 0..steps.tosses)?;
    let found = moved.into_iter().zip(&changes);
    Ok(found
        .map(|(moved, changes)| sensitivity(moved, changes, steps.step))
        .collect())
}

/// A parameter with its two values, and their plans.
struct Moved {
    parameter: Parameter,
    values: [f64; 2],
    plans: [Plan; 2],
}

impl Moved {
    /// Values whose ratio is 1 + step: around the parameter's own, or beside it where its range ends.
    fn by(step: f64, parameter: Parameter, template: &Template) -> Result<Self, QuestionError> {
        let at = |value: f64| template.plan(&[(&parameter.key, format!("{value:?}"))]);
        let both = |[one, other]: [f64; 2]| Ok::<_, QuestionError>([at(one)?, at(other)?]);
        let (own, whole) = (parameter.value, 1.0 + step);
        let around = [own / whole.sqrt(), own * whole.sqrt()];
        let refused = match both(around) {
            Ok(plans) => return Ok(Self::new(parameter, around, plans)),
            Err(QuestionError::Config(refused)) => refused,
            Err(error) => return Err(error),
        };
        for beside in [[own / whole, own], [own, own * whole]] {
            if let Ok(plans) = both(beside) {
                return Ok(Self::new(parameter, beside, plans));
            }
        }
        Err(QuestionError::Config(refused))
    }

    fn new(parameter: Parameter, values: [f64; 2], plans: [Plan; 2]) -> Self {
        Self {
            parameter,
            values,
            plans,
        }
    }
}

fn at_first_point(plans: &[Plan; 2]) -> [At<'_>; 2] {
    plans.each_ref().map(|plan| At { plan, point: 0 })
}

/// The parameters to vary, or everything that is wrong with the steps.
fn chosen(template: &Template, steps: &Steps) -> Result<Vec<Parameter>, QuestionError> {
    let mut refused = vec![];
    if !(steps.step > 0.0 && steps.step <= 1.0) {
        refused.push(QuestionError::Step(steps.step));
    }
    if steps.tosses < LEAST_TOSSES {
        refused.push(QuestionError::TooFewTosses {
            least: LEAST_TOSSES,
            given: steps.tosses,
        });
    }
    let all = parameters(template)?;
    let chosen = if steps.keys.is_empty() {
        all
    } else {
        let named = |key: &str| all.iter().find(|one| one.key == key).cloned();
        let keys = steps.keys.iter().map(String::as_str);
        each_varied(&all, keys, named).unwrap_or_else(|error| {
            refused.push(error);
            vec![]
        })
    };
    QuestionError::of_all(refused).map_or(Ok(chosen), Err)
}

/// What is found under each of these keys, or which of them are of no parameter that can be varied, of all that can.
pub(crate) fn each_varied<'a, T>(
    all: &[Parameter],
    keys: impl Iterator<Item = &'a str>,
    find: impl Fn(&str) -> Option<T>,
) -> Result<Vec<T>, QuestionError> {
    let known = || all.iter().map(|known| known.key.as_str());
    let (mut found, mut unknown) = (vec![], vec![]);
    for key in keys {
        match find(key) {
            Some(one) => found.push(one),
            None => unknown.push((key.to_owned(), nearest(key, known()).map(str::to_owned))),
        }
    }
    if unknown.is_empty() {
        return Ok(found);
    }
    Err(QuestionError::NotVaried {
        keys: unknown,
        known: known().collect::<Vec<_>>().join(", "),
    })
}

fn sensitivity(moved: Moved, changes: &Changes, step: f64) -> Sensitivity {
    let confidence = moved.plans[0].confidence;
    let per_log = 1.0 / libm::log1p(step);
    let faces = Face::ALL.map(|face| changes.interval(face, confidence).scaled(per_log));
    Sensitivity {
        parameter: moved.parameter,
        values: moved.values,
        faces,
        p: Face::ALL.map(|face| changes.mean_share(face)),
        undecided: changes.undecided(),
        changed: changes.changed() as f64 / changes.tosses() as f64,
        tosses: changes.tosses(),
        confidence,
    }
}
