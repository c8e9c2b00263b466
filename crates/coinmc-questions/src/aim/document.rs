//! An answer as a JSON document.

use super::{Aimed, Clumsy, Parameter, Place};
use crate::document::FORMAT_VERSION;
use coinmc_core::Estimate;
use serde_json::{Value, json};

/// The answer to an [`Aim`](super::Aim) as a JSON document. `values` are those of `parameters`, in
/// the units of their keys, and `p`, `lo` and `hi` the face's probability and its interval in
/// `tosses` tosses.
///
/// # Example
/// ```
/// # use coinmc_questions::{Aim, Parameter, Template, Workers, aim};
/// # use std::sync::atomic::AtomicBool;
/// use coinmc_core::Face;
/// use coinmc_questions::document_of_aim;
/// # let text = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
/// #             launch.preset = 'robot'\nengine.flat = {}";
/// # let key = "launch.height_m".to_owned();
/// let parameters = vec![Parameter { key, from: 0.1, to: 0.5, values: 2 }];
/// let question =
///     Aim { face: Face::Side, parameters, tosses: 16, final_tosses: 64, clumsiness: vec![] };
/// # let cancel = AtomicBool::new(false);
/// # let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// # let template = Template::new("inline", text, &[]);
/// let document = document_of_aim(&aim(&template, &question, &workers)?);
/// assert_eq!(document["kind"], "aim");
/// assert_eq!(document["baseline"]["values"][0], 0.5);
/// assert_eq!(document["best"]["tosses"], 64);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn document_of_aim(answer: &Aimed) -> Value {
    let question = &answer.question;
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "aim",
        "face": question.face.name(),
        "parameters": question.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "confidence": answer.confidence,
        "engine": answer.engine,
        "law": answer.law,
        "tosses": answer.tosses,
        "best": place(&answer.best),
        "worst": place(&answer.worst),
        "baseline": place(&answer.baseline),
        "clumsy": answer.clumsy.iter().map(clumsy).collect::<Vec<_>>(),
        "map": answer.map.iter().map(place).collect::<Vec<_>>(),
    })
}

fn parameter(parameter: &Parameter) -> Value {
    json!({
        "parameter": parameter.key,
        "from": parameter.from,
        "to": parameter.to,
        "values": parameter.steps(),
        "logarithmic": parameter.is_logarithmic(),
    })
}

fn place(place: &Place) -> Value {
    let Estimate { p, lo, hi, n, .. } = place.estimate;
    json!({ "values": place.values, "p": p, "lo": lo, "hi": hi, "tosses": n })
}

fn clumsy(clumsy: &Clumsy) -> Value {
    let Estimate { p, lo, hi, n, .. } = clumsy.estimate;
    json!({ "factor": clumsy.factor, "p": p, "lo": lo, "hi": hi, "tosses": n })
}
