//! What a config says of the priors: its table `[prior]`.

use crate::Parameter;
use crate::prior::Prior;
use coinmc::config::{Diagnostics, Place};
use coinmc::plan::Plan;
use coinmc_core::schema::{
    Absent, Bounds, Kind as KeyKind, ReadError, TableKind, Values, Word, field, fields, table,
};
use coinmc_core::{Material, Roughness};

/// What `[prior]` says.
pub(super) struct PriorGiven {
    /// A material of the table, or "any".
    material: Option<&'static str>,
    /// Ends of the central 95 %.
    ranges: Vec<(Parameter, [f64; 2])>,
}

/// The word for any material.
const ANY: &str = "any";

/// What is said of parameters on which tosses in this scene do not depend is a mistake.
pub(super) fn check_ranges(
    given: &PriorGiven,
    parameters: &[Parameter],
    place: &Place,
) -> Result<(), Diagnostics> {
    let given = given.ranges.iter().map(|(parameter, _)| *parameter);
    let unknown: Vec<Parameter> = given.filter(|one| !parameters.contains(one)).collect();
    if unknown.is_empty() {
        return Ok(());
    }
    let (message, help) = if unknown == [Parameter::RoughnessSlope] {
        (
            "the ground of this scene is a plane, which has no slope".to_owned(),
            "give surface.roughness_slope and surface.roughness_wavelength_m, or a material",
        )
    } else {
        let words: Vec<&str> = unknown.iter().map(|one| one.words()).collect();
        (
            format!("this engine knows no {}", words.join(", no ")),
            "use [engine.volumetric]",
        )
    };
    Err(place.problem(message, Some(help.to_owned())))
}

pub(super) fn priors(
    plan: &Plan,
    parameters: &[Parameter],
    given: Option<&PriorGiven>,
) -> Vec<Prior> {
    let around = || {
        let mut priors = Prior::around(parameters, &plan.points[0].scene.surface);
        for prior in &mut priors {
            let missing = format!("surface.{} is not given", prior.parameter.key());
            let in_config = format!("around the {} of the config", prior.parameter.key());
            let is_missing = plan.notes.iter().any(|note| note.starts_with(&missing));
            if is_missing && prior.source == in_config {
                prior.source = format!(
                    "around the usual {}: the config gives none",
                    prior.parameter.words()
                );
            }
        }
        priors
    };
    let of = |of: &dyn Fn(Parameter) -> Prior| parameters.iter().map(|p| of(*p)).collect();
    let mut priors: Vec<Prior> = match given.and_then(|given| given.material) {
        Some(ANY) => of(&Prior::of_any),
        Some(name) => match name.parse::<Material>() {
            Ok(material) => of(&|parameter| Prior::of_material(parameter, &material)),
            Err(_) => around(),
        },
        None => around(),
    };
    for (parameter, [low, high]) in given.map_or(&[][..], |given| &given.ranges) {
        for prior in priors
            .iter_mut()
            .filter(|prior| prior.parameter == *parameter)
        {
            *prior = Prior {
                parameter: *parameter,
                low: *low,
                high: *high,
                source: "[prior] of the config".to_owned(),
            };
        }
    }
    priors
}

pub(super) fn schema() -> TableKind {
    let materials = Material::ALL.iter();
    let mut words: Vec<Word> = materials
        .map(|material| Word {
            name: material.name,
            doc: material.doc,
        })
        .collect();
    words.push(Word {
        name: ANY,
        doc: "any of them",
    });
    let mut all = vec![field(
        "material",
        "The material whose numbers, and their uncertainty, are believed.",
        KeyKind::Word(words),
        Absent::Omitted,
    )];
    for parameter in Parameter::ALL {
        let bounds = match parameter {
            Parameter::Restitution => Bounds::open(0.0, 1.0),
            Parameter::Friction => Bounds::above_zero(100.0),
            Parameter::RoughnessSlope => Bounds::above_zero(Roughness::MAX_SLOPE),
            _ => Bounds::above_zero(1.0),
        };
        let end = |name, doc| field(name, doc, KeyKind::Real(bounds), Absent::Required);
        let ends = fields(vec![
            end("low", "Lower end of the central 95 %."),
            end("high", "Upper end."),
        ]);
        let doc = "Where it is believed to be, with 95 % probability.";
        all.push(table(parameter.key(), doc, ends, Absent::Omitted));
    }
    fields(all)
}

pub(super) fn read(values: &Values) -> Result<PriorGiven, ReadError> {
    let material = match values.get("material") {
        Some(_) => Some(values.word("material")?),
        None => None,
    };
    let mut ranges = vec![];
    for parameter in Parameter::ALL {
        if let Some(ends) = values.table(parameter.key())? {
            ranges.push((parameter, [ends.number("low")?, ends.number("high")?]));
        }
    }
    let wrong: Vec<&str> = ranges
        .iter()
        .filter(|(_, [low, high])| low >= high)
        .map(|(parameter, _)| parameter.key())
        .collect();
    if let Some(first) = wrong.first() {
        let message = format!("`low` must be below `high`, here of {}", wrong.join(", "));
        return Err(ReadError::new(message).at("high").at(first));
    }
    Ok(PriorGiven { material, ranges })
}
