//! The engine of a point, and what an engine refuses because it does not model it.

mod impact_laws;

use super::build::{At, Fault, boolean, get, integer};
use super::diagnostics::Problems;
use super::form::{Form, What};
use super::quantity::Quantity;
use super::schema::ENERGY;
use crate::plan::EngineChoice;
use coinmc_flat as flat;
use coinmc_rapier as rapier;
use coinmc_volumetric as volumetric;

/// The engine with its settings at one point.
pub(super) fn choice(root: &Form, at: &At<'_>) -> Result<EngineChoice, Fault> {
    let form = get(root, "engine")?;
    let What::Tagged(tag, inner) = &form.what else {
        return Err(Fault::Reported);
    };
    match *tag {
        "flat" => Ok(EngineChoice::Flat(in_the_plane(inner, at)?)),
        "volumetric" => Ok(EngineChoice::Volumetric(in_space(inner, at)?)),
        "rapier" => Ok(EngineChoice::Rapier(in_steps(inner, at)?)),
        _ => {
            let rule = get(inner, "rule")?
                .word()
                .and_then(|name| name.parse().ok());
            rule.map(EngineChoice::Analytic).ok_or(Fault::Reported)
        }
    }
}

fn in_the_plane(form: &Form, at: &At<'_>) -> Result<flat::Settings, Fault> {
    let decision = match &get(form, "decision")?.what {
        What::Word(ENERGY) => flat::Decision::Energy,
        What::Tagged(_, fraction) => flat::Decision::EnergyFraction(at.number(fraction)?),
        _ => return Err(Fault::Reported),
    };
    let settings = flat::Settings {
        law: impact_laws::law(form, at)?,
        decision,
        zeno: at.required(form, "zeno")?,
        tolerance: at.required(form, "tolerance")?,
        max_impacts: whole(form, "max_impacts")?,
    };
    settings
        .validate()
        .map_err(|error| Fault::problem(form.span, error.to_string(), None))?;
    Ok(settings)
}

fn in_space(form: &Form, at: &At<'_>) -> Result<volumetric::Settings, Fault> {
    use volumetric::{Decision, Law};
    let settings = volumetric::Settings {
        law: named(form, "law", Law::ALL, Law::name)?,
        decision: named(form, "decision", Decision::ALL, Decision::name)?,
        zeno: at.required(form, "zeno")?,
        tolerance: at.required(form, "tolerance")?,
        stick_speed: at.required(form, "stick_speed")?,
        smoothing_time: at.required(form, "smoothing_time")?,
        max_impacts: whole(form, "max_impacts")?,
        max_steps: whole(form, "max_steps")?,
        time_limit: at.required(form, "time_limit")?,
    };
    settings
        .validate()
        .map_err(|error| Fault::problem(form.span, error.to_string(), None))?;
    Ok(settings)
}

fn in_steps(form: &Form, at: &At<'_>) -> Result<rapier::Settings, Fault> {
    use rapier::{Decision, Flight, FrictionModel, Gyroscopic, Standing};
    let settings = rapier::Settings {
        step_s: at.required(form, "step_s")?,
        substeps: whole(form, "substeps")?,
        friction_model: named(
            form,
            "friction_model",
            FrictionModel::ALL,
            FrictionModel::name,
        )?,
        prediction: at.required(form, "prediction")?,
        ccd: flag(form, "ccd")?,
        gyroscopic: named(form, "gyroscopic", Gyroscopic::ALL, Gyroscopic::name)?,
        flight: named(form, "flight", Flight::ALL, Flight::name)?,
        standing: named(form, "standing", Standing::ALL, Standing::name)?,
        tosses_at_once: whole(form, "tosses_at_once")?,
        decision: named(form, "decision", Decision::ALL, Decision::name)?,
        max_gain: at.required(form, "max_gain")?,
        max_steps: whole(form, "max_steps")?,
        time_limit: at.required(form, "time_limit")?,
    };
    settings
        .validate()
        .map_err(|error| Fault::problem(form.span, error.to_string(), None))?;
    Ok(settings)
}

fn flag(form: &Form, key: &str) -> Result<bool, Fault> {
    boolean(form, key).ok_or(Fault::Reported)
}

/// The one of `all` whose name stands under a key.
fn named<T: Copy>(
    form: &Form,
    key: &str,
    all: impl IntoIterator<Item = T>,
    name: fn(T) -> &'static str,
) -> Result<T, Fault> {
    let word = get(form, key)?.word().ok_or(Fault::Reported)?;
    all.into_iter()
        .find(|&one| name(one) == word)
        .ok_or(Fault::Reported)
}

fn whole(form: &Form, key: &str) -> Result<u32, Fault> {
    integer(form, key)
        .and_then(|n| n.try_into().ok())
        .ok_or(Fault::Reported)
}

/// What the flat engine does not model: the table, the key, and what it would be.
const NOT_IN_THE_PLANE: [(&str, &str, &str); 5] = [
    ("surface", "rolling_friction_m", "rolling friction"),
    ("surface", "pivoting_friction_m", "pivoting friction"),
    (
        "surface",
        "restitution_threshold_m_s",
        "restitution threshold",
    ),
    ("environment", "linear_drag_per_s", "drag"),
    ("environment", "angular_drag_per_s", "drag"),
];

/// Refuses everything that the config asks for and its engine does not model. It would be ignored
/// otherwise, and the results would claim what was never computed.
pub(super) fn refuse_unmodelled(root: &Form, problems: &mut Problems) {
    if root.get("engine").and_then(Form::tag) != Some("flat") {
        return;
    }
    impact_laws::refuse_friction(root, problems);
    let value = |table: &str, key: &str| root.get(table).and_then(|form| form.get(key));
    for (table, key, what) in NOT_IN_THE_PLANE {
        if let Some(form) = value(table, key).filter(|form| is_somewhere_not_zero(form)) {
            problems.add_with_help(
                form.span,
                format!("engine.flat models no {what}: `{table}.{key}` must be 0"),
                format!("remove `{key}`, or toss in space with [engine.volumetric]"),
            );
        }
    }
    if let Some(form) = value("environment", "gyroscopic_torque")
        && matches!(form.what, What::Boolean(false))
    {
        problems.add_with_help(
            form.span,
            "engine.flat has no gyroscopic torque to switch off: \
             `environment.gyroscopic_torque` must be true",
            "remove `gyroscopic_torque` (spin stays in the plane, where that torque is 0), or toss \
             in space with [engine.volumetric]",
        );
    }
}

/// A list or range has at least two different values.
fn is_somewhere_not_zero(form: &Form) -> bool {
    match &form.what {
        What::Number(Quantity::Constant(value), _) => *value != 0.0,
        What::Number(..) => true,
        _ => false,
    }
}
