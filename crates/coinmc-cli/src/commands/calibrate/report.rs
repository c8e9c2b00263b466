//! A calibration as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, grouped, in_ascii, signed, wrapped};
use coinmc_calibrate::{Calibration, FairRatio, Model, Parameter, Predicted, Prior, Summary};
use coinmc_questions::number::{three_digits, two_digits};

/// Suggestions that are shown.
const SUGGESTED: usize = 4;

/// The whole answer.
pub(super) fn text(model: &Model, calibration: &Calibration, style: &Style) -> String {
    let mut text = measured(model, style);
    text += &surface(model, calibration, style);
    text += &listed("Sources of the priors:", sources(model), style);
    text += &predicted(model, calibration, style);
    text += &next(calibration, style);
    let conflicts = calibration
        .conflicts
        .iter()
        .map(coinmc_calibrate::Conflict::words);
    let remarks = conflicts.chain(calibration.remarks.iter().cloned());
    text += &listed("Mind:", remarks, style);
    text += &listed("It assumes:", assumed(model), style);
    let fit = model.fits().map(|fit| fit.error).fold(0.0, f64::max);
    let note = format!(
        "{} tosses in all; the probabilities are fitted within ± {}",
        grouped(calibration.tosses),
        compact(two_digits(fit))
    );
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

/// What was measured.
fn measured(model: &Model, style: &Style) -> String {
    let counts = model.observed().counts.iter().map(|counted| {
        let [heads, tails, side] = counted.faces.map(grouped);
        format!(
            "{}: {heads} heads, {tails} tails, {side} on the side",
            counted.name
        )
    });
    let readings = model.readings().iter().map(|reading| {
        let [value, low, high] = [0.0, -1.0, 1.0].map(|by| {
            reading
                .law
                .inverse(reading.value + by * reading.error_at(reading.value))
        });
        format!(
            "{}: {} = {} ± {}",
            reading.name,
            reading.law.parameter().key(),
            compact(shown_to(value, 0.5 * (high - low))),
            compact(two_digits(0.5 * (high - low)))
        )
    });
    listed(
        "Measured (± one standard error):",
        counts.chain(readings),
        style,
    )
}

fn surface(model: &Model, calibration: &Calibration, style: &Style) -> String {
    let percent = compact(100.0 * model.observed().plan.confidence);
    let mut table = Table::new(vec![
        Column::left("surface"),
        Column::right("prior, 95 %").droppable(1),
        Column::right("median"),
        Column::right(format!("{percent} % interval")),
        Column::right("spread left").droppable(2),
    ]);
    let rows = model
        .observed()
        .priors
        .iter()
        .zip(&calibration.posterior.summaries);
    for (prior, summary) in rows {
        table.push(row(prior, summary));
    }
    table.render(style).text
}

fn row(prior: &Prior, summary: &Summary) -> Vec<String> {
    let number = |x: f64| compact(three_digits(x));
    let fine = |x: f64| compact(shown_to(x, summary.hi - summary.lo));
    let left = 100.0 * summary.contraction;
    vec![
        summary.parameter.key().to_owned(),
        format!("{} to {}", number(prior.low), number(prior.high)),
        fine(summary.median),
        format!("[{}, {}]", fine(summary.lo), fine(summary.hi)),
        match left {
            small if small < 0.5 => format!("{} %", compact(two_digits(small))),
            left => format!("{left:.0} %"),
        },
    ]
}

/// A number rounded to three digits, or to as many as show two of what it is known to.
fn shown_to(x: f64, width: f64) -> f64 {
    let coarse = three_digits(x);
    // about the place of the second digit of the width
    let place = libm::floor(libm::log10(width)) - 1.0;
    if x == 0.0 || !place.is_finite() || place >= libm::floor(libm::log10(x.abs())) - 2.0 {
        return coarse;
    }
    // decimals of numbers near 1 and of those far below it; more than fifteen are not there
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let decimals = (-place).clamp(0.0, 18.0) as usize;
    format!("{x:.decimals$}").parse().unwrap_or(coarse)
}

fn sources(model: &Model) -> impl Iterator<Item = String> {
    let priors = model.observed().priors.iter();
    priors.map(|prior| format!("{}: {}", prior.parameter.key(), prior.source))
}

fn predicted(model: &Model, calibration: &Calibration, style: &Style) -> String {
    let observed = model.observed();
    let point = &observed.predicted.points[0];
    let prediction = &calibration.prediction;
    let percent = compact(100.0 * observed.plan.confidence);
    let coin = &point.scene.coin;
    let title = format!(
        "This coin, H/R = {}, on this surface (engine {}, {}):",
        compact(coin.ratio()),
        point.engine.descriptor().name,
        point.engine.law()
    );
    let mut table = Table::new(vec![
        Column::left("face"),
        Column::right("P"),
        Column::right(format!("{percent} % interval")),
        Column::right("± parameters"),
        Column::right("± tosses"),
        Column::right("finer settings").droppable(1),
    ]);
    for face in &prediction.faces {
        table.push(of_face(face));
    }
    let mut text = format!(
        "\n{}\n{}",
        style.paint(Colors::Strong, &title),
        table.render(style).text
    );
    if prediction.shown < prediction.tosses {
        text += &wrapped(
            &format!(
                "{} of {} tosses ended without a face, and are left out.",
                grouped(prediction.tosses - prediction.shown),
                grouped(prediction.tosses)
            ),
            style.width,
            0,
        );
    }
    text + &fair(calibration.fair.as_ref(), &percent, style)
}

fn of_face(face: &Predicted) -> Vec<String> {
    let total = both(face.parameter, face.statistical);
    let decimals = decimals_for(total);
    let number = |x: f64| format!("{x:.decimals$}");
    vec![
        face.face.name().to_owned(),
        number(face.p),
        format!("[{}, {}]", number(face.lo), number(face.hi)),
        number(face.parameter),
        number(face.statistical),
        face.numerical.map_or_else(
            || "-".to_owned(),
            |(shift, error)| format!("{} ± {}", signed(shift, decimals), number(error)),
        ),
    ]
}

fn fair(fair: Option<&FairRatio>, percent: &str, style: &Style) -> String {
    let Some(fair) = fair else {
        return "No coin with H/R from 0.2 to 4 is fair on it.\n".to_owned();
    };
    let decimals = decimals_for(both(fair.parameter, fair.statistical));
    let number = |x: f64| format!("{x:.decimals$}");
    let end = |end: Option<f64>| end.map_or_else(|| "open".to_owned(), number);
    let mut text = format!(
        "Fair coin, P(side) = 1/3: H/R = {}, {percent} %: [{}, {}]; ± {} parameters, ± {} tosses",
        number(fair.value),
        end(fair.lo),
        end(fair.hi),
        number(fair.parameter),
        number(fair.statistical)
    );
    if let Some((shift, error)) = fair.numerical {
        let shift = signed(shift, decimals);
        text += &format!(", {shift} ± {} by finer settings", number(error));
    }
    text += &format!(
        ". With a diameter of {:.2} mm it is {:.2} mm thick.",
        2e3 * fair.radius_m,
        1e3 * fair.value * fair.radius_m
    );
    wrapped(&text, style.width, 0)
}

fn next(calibration: &Calibration, style: &Style) -> String {
    let now = calibration.prediction.side().parameter;
    let decimals = decimals_for(now);
    let title = format!("What to measure next (P(side) is now known ± {now:.decimals$}):");
    let lines = calibration
        .suggestions
        .iter()
        .take(SUGGESTED)
        .map(|suggestion| {
            format!(
                "{}: ± {:.decimals$}, {:.1} bits",
                suggestion.what, suggestion.side_after, suggestion.bits
            )
        });
    format!("\n{}", listed(&title, lines, style))
}

/// What else the answer rests on.
fn assumed(model: &Model) -> impl Iterator<Item = String> {
    let observed = model.observed();
    let surface = observed.plan.points[0].scene.surface;
    let ground = match surface.roughness() {
        Some(rough) if model.parameters().contains(&Parameter::RoughnessSlope) => format!(
            "a ground with a wavelength of {} m, which is not calibrated",
            compact(rough.wavelength_m())
        ),
        Some(rough) => format!(
            "a ground with a slope of {} and a wavelength of {} m, which is not calibrated",
            compact(rough.slope()),
            compact(rough.wavelength_m())
        ),
        None => "a perfect plane: for thin coins P(side) is then an upper bound".to_owned(),
    };
    let same =
        "one surface for all measurements, on which friction lengths do not depend on the coin";
    [ground, same.to_owned()]
        .into_iter()
        .chain(observed.notes().map(str::to_owned))
}

/// A title and lines below it; nothing without lines.
fn listed(title: &str, lines: impl Iterator<Item = String>, style: &Style) -> String {
    let mut text = String::new();
    for line in lines {
        text += "  ";
        text += &wrapped(&line, style.width.saturating_sub(2), 4);
    }
    if text.is_empty() {
        return text;
    }
    format!("{}\n{text}", style.paint(Colors::Strong, title))
}

/// Two independent errors together.
fn both(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_digits_that_its_width_needs() {
        for (x, width, shown) in [
            (0.492_114, 0.000_36, 0.492_11),
            (0.492_114, 0.1, 0.492),
            (3.456_78e-5, 1e-5, 3.46e-5),
            (3.456_78e-5, 2e-8, 3.456_8e-5),
            (123.456, 0.12, 123.46),
            (0.5, 0.0, 0.5),
            (0.0, 1e-9, 0.0),
            (0.5, f64::NAN, 0.5),
        ] {
            assert_eq!(shown_to(x, width), shown, "{x} {width}");
        }
    }
}
