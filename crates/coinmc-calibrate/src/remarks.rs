//! What the measurements leave open, in words.

use crate::Observations;
use crate::model::Model;
use crate::posterior::Posterior;

/// Correlations beyond which only a combination of two parameters is known.
const TIED: f64 = 0.7;
/// A parameter whose spread is still this share of the prior's was not measured.
const OPEN: f64 = 0.9;
/// Draws below which intervals are rough.
const FEW: f64 = 400.0;

/// Tosses without a face that are no longer few, as a share of all.
const LOST: f64 = 0.05;

/// Counted tosses that are worth less than this share of themselves.
const WORTH: f64 = 0.5;

/// Remarks on what was measured.
fn on_measured(observed: &Observations) -> impl Iterator<Item = String> {
    let counted = observed.counts.iter().filter_map(|counted| {
        let all = counted.faces.iter().sum::<u64>() + counted.lost;
        let share = counted.lost as f64 / all as f64;
        (share > LOST).then(|| {
            format!(
                "{} of the {all} tosses of {} showed no face: if these would have shown other shares of the faces, \
                 the surface is another one",
                counted.lost, counted.name
            )
        })
    });
    let readings = observed
        .readings
        .iter()
        .filter(|reading| reading.excess > 1.0);
    let readings = readings.map(|reading| {
        format!(
            "the readings of {} scatter {:.1} times as much as their errors allow, so these are taken to be as much larger",
            reading.name, reading.excess
        )
    });
    counted
        .chain(readings)
        .chain(observed.film_remarks.iter().cloned())
}

/// Remarks on counts that tell less than they could, because the fit of their probabilities is not exact enough.
fn on_fits(model: &Model) -> impl Iterator<Item = String> {
    let counts = model.observed.counts.iter().zip(&model.counted);
    counts.filter_map(|(counted, chances)| {
        let tosses = counted.faces.iter().sum();
        let worth = chances.worth(tosses);
        (worth < WORTH * tosses as f64).then(|| {
            format!(
                "the {tosses} tosses of {} tell no more than {worth:.0} would if the fit of their probabilities were exact: \
                 a design of more points, or of more tosses at each, makes it so",
                counted.name
            )
        })
    })
}

/// Remarks on what was measured and on a posterior.
pub(crate) fn remarks(model: &Model, posterior: &Posterior) -> Vec<String> {
    let mut remarks: Vec<String> = on_measured(&model.observed).chain(on_fits(model)).collect();
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
