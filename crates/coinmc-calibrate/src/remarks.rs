//! What the measurements leave open, in words.

use crate::posterior::Posterior;

/// Correlations beyond which only a combination of two parameters is known.
const TIED: f64 = 0.7;
/// A parameter whose spread is still this share of the prior's was not measured.
const OPEN: f64 = 0.9;
/// Draws below which intervals are rough.
const FEW: f64 = 400.0;

/// Remarks on a posterior.
pub(crate) fn remarks(posterior: &Posterior) -> Vec<String> {
    let mut remarks = vec![];
    let summaries = &posterior.summaries;
    for summary in summaries {
        if summary.contraction > OPEN {
            remarks.push(format!(
                "nothing measured says much of the {}: what is shown is its prior",
                summary.parameter.words()
            ));
        }
    }
    for (i, a) in summaries.iter().enumerate() {
        for (j, b) in summaries.iter().enumerate().skip(i + 1) {
            let r = posterior.correlations[i][j];
            if r.abs() > TIED {
                let how = if r > 0.0 {
                    "both may be larger, or both smaller"
                } else {
                    "one may be larger if the other is smaller"
                };
                remarks.push(format!(
                    "{} and {} are known only together (correlation {r:.2}): {how}; a measurement of either \
                     settles both",
                    a.parameter.words(),
                    b.parameter.words()
                ));
            }
        }
    }
    if posterior.effective < FEW {
        remarks.push(format!(
            "the posterior is worth only {:.0} independent draws: its intervals are rough",
            posterior.effective
        ));
    }
    remarks
}
