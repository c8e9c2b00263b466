//! Fits as text and as JSON.

use crate::output::FORMAT_VERSION;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, decimals_for};
use coinmc_film::{Coordinate, Estimated, Fit, Ranked, compare, parameters};
use serde_json::{Map, Value, json};

/// The text report: the ranking of the laws, then the best one in detail.
pub(super) fn to_text(fits: &[Fit], style: &Style) -> String {
    let ranking = compare(fits);
    let mut text = String::new();
    if fits.len() > 1 {
        text += &laws(fits, &ranking, style);
        text.push('\n');
    }
    for (place, ranked) in ranking.iter().enumerate() {
        if place > 0 {
            text.push('\n');
        }
        text += &one(&fits[ranked.fit], style);
    }
    text
}

fn laws(fits: &[Fit], ranking: &[Ranked], style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("law"),
        Column::right("AIC"),
        Column::right("more"),
        Column::right("BIC"),
        Column::right("weight"),
        Column::right("fitted"),
        Column::right("points"),
    ]);
    for ranked in ranking {
        let fit = &fits[ranked.fit];
        table.push(vec![
            fit.model.law.name().to_owned(),
            format!("{:.1}", ranked.aic),
            format!("{:.1}", ranked.delta_aic),
            format!("{:.1}", ranked.bic),
            format!("{:.3}", ranked.weight),
            fit.fitted.to_string(),
            fit.n.to_string(),
        ]);
    }
    table.render(style).text
}

fn one(fit: &Fit, style: &Style) -> String {
    let title = format!("{}, {} points", fit.model.law.name(), fit.n);
    let mut text = style.paint(Colors::Strong, &title) + "\n";
    for estimate in &fit.parameters {
        let name = estimate.parameter.name();
        text += &format!("  {name:<12} {}\n", value(estimate));
    }
    let noise: Vec<String> = fit
        .noise
        .iter()
        .map(|noise| match noise.coordinate {
            Coordinate::X => format!("x {:.3} mm", 1e3 * noise.sigma),
            Coordinate::Z => format!("z {:.3} mm", 1e3 * noise.sigma),
            Coordinate::Theta => format!("angle {:.3} deg", noise.sigma.to_degrees()),
        })
        .collect();
    text += &format!("  {:<12} {}\n", "scatter", noise.join(", "));
    for drop in &fit.drops {
        text += &format!(
            "  {}: {} of {} frames, {} impact{}\n",
            drop.name,
            drop.frames,
            drop.of_frames,
            drop.impacts_s.len(),
            if drop.impacts_s.len() == 1 { "" } else { "s" },
        );
    }
    for remark in &fit.remarks {
        text += &style.paint(Colors::Warning, "  note:");
        text += &format!(" {remark}\n");
    }
    text
}

/// `0.5012 (0.4998 to 0.5027)`, or the known end of the interval.
fn value(estimate: &Estimated) -> String {
    let ends = [estimate.lo, estimate.hi].into_iter().flatten();
    let arm = ends
        .map(|end| (end - estimate.value).abs())
        .fold(0.0, f64::max);
    let decimals = decimals_for(arm);
    match (estimate.lo, estimate.hi) {
        (Some(lo), Some(hi)) => format!(
            "{:.decimals$}  ({lo:.decimals$} to {hi:.decimals$})",
            estimate.value
        ),
        (Some(lo), None) => format!("at least {lo:.decimals$}"),
        (None, Some(hi)) => format!("at most {hi:.decimals$}"),
        (None, None) => "not determined".to_owned(),
    }
}

/// The JSON report: all fits, the best first.
pub(super) fn to_json(fits: &[Fit]) -> Value {
    let ranking = compare(fits);
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "film_fit",
        "fits": ranking.iter().map(|ranked| fit_to_json(&fits[ranked.fit], ranked)).collect::<Vec<_>>(),
    })
}

fn fit_to_json(fit: &Fit, ranked: &Ranked) -> Value {
    const STATE: [&str; 6] = ["x_m", "vx_m_s", "z_m", "vz_m_s", "theta_rad", "omega_rad_s"];
    json!({
        "law": fit.model.law.name(),
        "ratio": fit.model.coin.ratio(),
        "radius_m": fit.model.coin.radius_m(),
        "gravity_m_s2": fit.model.gravity_m_s2,
        "confidence": fit.confidence,
        "parameters": fit.parameters.iter().map(|estimate| json!({
            "name": estimate.parameter.name(),
            "value": estimate.is_determined().then_some(estimate.value),
            "std_error": estimate.std_error,
            "lo": estimate.lo,
            "hi": estimate.hi,
        })).collect::<Vec<_>>(),
        "shared": parameters(fit.model.law)
            .iter()
            .map(|parameter| (parameter.name().to_owned(), json!(fit.shared.get(*parameter))))
            .collect::<Map<_, _>>(),
        "noise": fit.noise.iter().map(|noise| json!({
            "coordinate": noise.coordinate.name(),
            "points": noise.n,
            "sigma": noise.sigma,
            "correlation": noise.correlation,
        })).collect::<Vec<_>>(),
        "drops": fit.drops.iter().map(|drop| json!({
            "name": drop.name,
            "frames": drop.frames,
            "of_frames": drop.of_frames,
            "impacts_s": drop.impacts_s,
            "start": STATE.iter().zip(drop.start.iter().zip(&drop.half_width)).map(
                |(name, (value, half_width))| json!({
                    "name": name, "value": value, "half_width": half_width,
                })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "points": fit.n,
        "fitted": fit.fitted,
        "log_likelihood": fit.log_likelihood,
        "aic": ranked.aic,
        "bic": ranked.bic,
        "delta_aic": ranked.delta_aic,
        "delta_bic": ranked.delta_bic,
        "akaike_weight": ranked.weight,
        "remarks": fit.remarks.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}
