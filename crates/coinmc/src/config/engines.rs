//! The engine of a point, and what an engine refuses because it does not model it.

use super::at::{At, Fault, get};
use super::diagnostics::Problems;
use super::form::{Form, What};
use super::quantity::Quantity;
use super::values::read;
use crate::engines::{EngineChoice, engine};

/// The engine with its settings at one point.
pub(super) fn choice(root: &Form, at: &At<'_>) -> Result<EngineChoice, Fault> {
    let What::Tagged(tag, inner) = &get(root, "engine")?.what else {
        return Err(Fault::Reported);
    };
    let engine = engine(tag).ok_or(Fault::Reported)?;
    read(inner, at, |values| Ok((engine.read)(values)?))
}

/// Refuses everything that the config asks for and its engine or law does not model. It would be
/// ignored otherwise, and the results would claim what was never computed.
pub(super) fn refuse_unmodelled(root: &Form, problems: &mut Problems) {
    let Some(What::Tagged(tag, inner)) = root.get("engine").map(|form| &form.what) else {
        return;
    };
    let Some(engine) = engine(tag) else {
        return;
    };
    let law = inner.get("law").and_then(|law| law.word().or(law.tag()));
    let laws = engine.laws.iter().filter(|known| Some(known.name) == law);
    let unmodelled = laws.flat_map(|law| law.unmodelled).chain(engine.unmodelled);
    for refused in unmodelled {
        let given = root
            .get(refused.table)
            .and_then(|table| table.get(refused.key))
            .filter(|form| is_somewhere_in_force(form));
        if let Some(form) = given {
            problems.add_with_help(form.span, refused.message, refused.help);
        }
    }
}

/// A number is not 0, or something true by nature is switched off. A list or range has at least two
/// different values.
fn is_somewhere_in_force(form: &Form) -> bool {
    match &form.what {
        What::Number(Quantity::Constant(value), _) => *value != 0.0,
        What::Number(..) | What::Boolean(false) => true,
        _ => false,
    }
}
