//! An answer as a JSON document: what the command line prints and Python reads.

use crate::assumptions::Effect;
use crate::scenes::EverydayScene;
use crate::{Curve, Fair, Finding, Root};
use coinmc::config::Override;
use serde_json::{Map, Value, json};

/// Version of all documents of answers. It stays when fields are added, and changes when a field changes its
/// meaning or is removed.
pub(crate) const FORMAT_VERSION: u32 = 1;

/// An answer, with the everyday scene it is for, what was changed of it or of a config, and the effects of that scene's
/// assumptions, as a JSON document. docs/reference/formats.md describes its fields.
pub fn document(
    answer: &Fair,
    (scene, overrides): (Option<&EverydayScene>, &[Override]),
    effects: &[Effect],
) -> Value {
    let question = &answer.question;
    let overrides: Vec<_> = overrides.iter().map(Override::text).collect();
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "fair",
        "scene": scene.map(|scene| scene.name),
        "overrides": overrides,
        "parameter": question.key,
        "searched": question.range,
        "face": question.face.name(),
        "target": question.target,
        "half_width": question.half_width,
        "confidence": answer.confidence,
        "engine": answer.engine,
        "law": answer.law,
        "tosses": answer.tosses,
        "curves": answer.curves.iter().map(curve).collect::<Vec<_>>(),
        "assumptions": effects.iter().map(effect).collect::<Vec<_>>(),
    })
}

fn curve(curve: &Curve) -> Value {
    let at: Map<String, Value> = curve
        .at
        .iter()
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    let near = curve.findings.iter().filter_map(|finding| match finding {
        Finding::Near { from, to } => Some(json!({ "from": from, "to": to })),
        Finding::Root(_) => None,
    });
    let scan = curve.scan.iter().map(|scanned| {
        json!({
            "value": scanned.value,
            "p": scanned.p,
            "lo": scanned.lo,
            "hi": scanned.hi,
            "tosses": scanned.tosses,
        })
    });
    json!({
        "at": at,
        "roots": curve.roots().map(root).collect::<Vec<_>>(),
        "near": near.collect::<Vec<_>>(),
        "scan": scan.collect::<Vec<_>>(),
    })
}

fn root(root: &Root) -> Value {
    let rounds = root.rounds.iter().map(|round| {
        json!({
            "from": round.from,
            "to": round.to,
            "tosses": round.tosses,
            "value": round.value,
            "lo": round.lo,
            "hi": round.hi,
        })
    });
    json!({
        "value": root.value,
        "lo": root.lo,
        "hi": root.hi,
        "reached": root.reached,
        "slope": root.slope,
        "slope_error": root.slope_error,
        "plateau": root.is_on_plateau(),
        "tosses": root.tosses,
        "undecided": root.undecided,
        "numerical": root.numerical.map(|numerical| json!({
            "shift": numerical.shift,
            "lo": numerical.lo,
            "hi": numerical.hi,
            "tosses": numerical.tosses,
        })),
        "diameter_m": 2.0 * root.coin.radius_m(),
        "thickness_m": root.coin.height_m(),
        "rounds": rounds.collect::<Vec<_>>(),
    })
}

fn effect(effect: &Effect) -> Value {
    let assumption = &effect.assumption;
    let moved = effect
        .roots
        .map(|moved| json!({ "value": moved.value, "half_width": moved.half_width }));
    json!({
        "parameter": assumption.key,
        "name": assumption.name,
        "value": assumption.value,
        "low": assumption.low,
        "high": assumption.high,
        "source": assumption.source,
        "root_at_low": moved[0],
        "root_at_high": moved[1],
    })
}
