//! The engine of a point, and the rejection of what an engine does not model.

use super::at::{At, Fault, get};
use super::checked::{Checked, CheckedValue};
use super::diagnostics::Problems;
use super::quantity::Quantity;
use super::values::read;
use crate::engines::{EngineChoice, EngineDescriptor, engine};
use coinmc_core::Unmodelled;

/// The engine with its settings at one point.
pub(super) fn choice(root: &Checked, at: &At<'_>) -> Result<EngineChoice, Fault> {
    let CheckedValue::Tagged(tag, inner) = &get(root, "engine")?.value else {
        return Err(Fault::Reported);
    };
    let engine = engine(tag).ok_or(Fault::Reported)?;
    read(inner, at, |values| Ok((engine.read)(values)?))
}

/// The engine, if its name is valid.
pub(super) fn descriptor(root: &Checked) -> Option<&'static EngineDescriptor> {
    engine(root.get("engine")?.tag()?)
}

/// What the engine and the law of impact of the config do not model.
pub(super) fn unmodelled(root: &Checked) -> Vec<&'static Unmodelled> {
    let (Some(engine), Some(CheckedValue::Tagged(_, inner))) = (
        descriptor(root),
        root.get("engine").map(|checked| &checked.value),
    ) else {
        return vec![];
    };
    let law = inner.get("law").and_then(|law| law.word().or(law.tag()));
    let laws = engine.laws.iter().filter(|known| Some(known.name) == law);
    laws.flat_map(|law| law.unmodelled)
        .chain(engine.unmodelled)
        .collect()
}

/// Rejects everything in the config that its engine or law does not model. Otherwise it would be
/// ignored, and the results would claim what was never computed.
pub(super) fn refuse_unmodelled(root: &Checked, problems: &mut Problems) {
    for refused in unmodelled(root) {
        let of_radius = refused.key.strip_suffix("_m");
        let of_radius = of_radius.map(|length| format!("{length}_over_radius"));
        let given = root
            .get(refused.table)
            .and_then(|table| {
                let fraction = || table.get(of_radius.as_deref()?);
                table.get(refused.key).or_else(fraction)
            })
            .filter(|checked| is_somewhere_in_force(checked));
        if let Some(checked) = given {
            problems.add_with_help(checked.span, refused.message, refused.help);
        }
    }
}

/// Whether a number is anywhere not 0, or something that is true by default is switched off. A list
/// or range has at least two different values.
fn is_somewhere_in_force(checked: &Checked) -> bool {
    match &checked.value {
        CheckedValue::Number(Quantity::Constant(value), _) => *value != 0.0,
        CheckedValue::Number(..) | CheckedValue::Boolean(false) => true,
        _ => false,
    }
}
