//! A calibration as a JSON document: what the command line prints and Python reads.

use crate::calibration::Calibration;
use crate::model::Model;
use crate::{FairRatio, Predicted, Prior, Reading};
use serde_json::{Value, json};

/// Version of the document. It stays when fields are added, and changes when a field changes its meaning or
/// is removed.
const FORMAT_VERSION: u32 = 1;

/// A calibration as a JSON document. docs/reference/calibrate.md describes its fields.
pub fn document(model: &Model, calibration: &Calibration) -> Value {
    let observed = model.observed();
    let point = &observed.predicted.points[0];
    let posterior = &calibration.posterior;
    let parameters = observed.priors.iter().zip(&posterior.summaries);
    let parameters = parameters.map(|(prior, summary)| {
        json!({
            "name": prior.parameter.key(),
            "unit": prior.parameter.unit(),
            "mean": summary.mean,
            "sd": summary.sd,
            "median": summary.median,
            "lo": summary.lo,
            "hi": summary.hi,
            "contraction": summary.contraction,
            "prior": of_prior(prior),
        })
    });
    let conflicts = calibration.conflicts.iter().map(|conflict| {
        json!({
            "measurement": conflict.name,
            "p_value": conflict.p_value,
            "with_others": conflict.with_others,
            "words": conflict.words(),
        })
    });
    let suggestions = calibration.suggestions.iter().map(|suggestion| {
        json!({
            "kind": suggestion.kind.name(),
            "what": suggestion.what,
            "bits": suggestion.bits,
            "p_side_sd_after": suggestion.side_after,
        })
    });
    let fits = model.fits().map(|fit| {
        json!({
            "of": fit.counted.map_or("the scene to predict", |counted| &counted.name),
            "degree": fit.degree,
            "error": fit.error,
            "tosses": fit.tosses,
        })
    });
    let prediction = &calibration.prediction;
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "calibration",
        "confidence": observed.plan.confidence,
        "engine": point.engine.descriptor().name,
        "law": point.engine.law(),
        "ratio": point.scene.coin.ratio(),
        "radius_m": point.scene.coin.radius_m(),
        "parameters": parameters.collect::<Vec<_>>(),
        "correlations": posterior.correlations,
        "draws": posterior.draws.len(),
        "effective_draws": posterior.effective,
        "log_evidence": posterior.log_evidence,
        "measurements": measurements(model),
        "prediction": {
            "faces": prediction.faces.iter().map(of_face).collect::<Vec<_>>(),
            "tosses": prediction.tosses,
            "without_face": prediction.tosses - prediction.shown,
            "numerical_pairs": prediction.pairs,
        },
        "fair": calibration.fair.as_ref().map(of_fair),
        "next": suggestions.collect::<Vec<_>>(),
        "conflicts": conflicts.collect::<Vec<_>>(),
        "remarks": calibration.remarks,
        "fits": fits.collect::<Vec<_>>(),
        "tosses": calibration.tosses,
        "notes": observed.notes().collect::<Vec<_>>(),
    })
}

fn of_prior(prior: &Prior) -> Value {
    json!({
        "median": prior.median(),
        "low": prior.low,
        "high": prior.high,
        "source": prior.source,
    })
}

fn measurements(model: &Model) -> Vec<Value> {
    let counts = model.observed().counts.iter().map(|counted| {
        let [heads, tails, side] = counted.faces;
        json!({
            "name": counted.name,
            "kind": "counts",
            "heads": heads,
            "tails": tails,
            "side": side,
        })
    });
    counts
        .chain(model.readings().iter().map(of_reading))
        .collect()
}

fn of_reading(reading: &Reading) -> Value {
    let parameter = reading.law.parameter();
    let [value, low, high] = [0.0, -1.0, 1.0].map(|by| {
        reading
            .law
            .inverse(reading.value + by * reading.error_at(reading.value))
    });
    json!({
        "name": reading.name,
        "kind": reading.kind.name(),
        "parameter": parameter.key(),
        "value": value,
        "standard_error": 0.5 * (high - low),
    })
}

fn of_face(predicted: &Predicted) -> Value {
    json!({
        "face": predicted.face.name(),
        "p": predicted.p,
        "lo": predicted.lo,
        "hi": predicted.hi,
        "parameter_error": predicted.parameter,
        "statistical_error": predicted.statistical,
        "numerical": predicted.numerical.map(of_shift),
    })
}

fn of_fair(fair: &FairRatio) -> Value {
    json!({
        "value": fair.value,
        "lo": fair.lo,
        "hi": fair.hi,
        "parameter_error": fair.parameter,
        "statistical_error": fair.statistical,
        "numerical": fair.numerical.map(of_shift),
        "thickness_m": fair.value * fair.radius_m,
        "tosses": fair.tosses,
    })
}

fn of_shift((shift, error): (f64, f64)) -> Value {
    json!({ "shift": shift, "standard_error": error })
}
