//! What is heard, as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, grouped, in_ascii, wrapped};
use coinmc_calibrate::Observations;
use coinmc_listen::{FromDrops, Heard, Kind, Told, config};
use coinmc_questions::number::{three_digits, two_digits};

/// Times that are shown.
const SHOWN: usize = 12;

/// The whole answer; without remarks if it is to be quiet.
pub(super) fn text(
    heard: &[Heard],
    told: Option<(&Told, &Observations)>,
    style: &Style,
    quiet: bool,
) -> String {
    let mut text: String = heard.iter().map(|one| of_recording(one, style)).collect();
    if let Some((told, observed)) = told {
        text += &surface(told, style);
        if !quiet {
            text += &remarks(observed, style);
        }
    }
    text += &format!(
        "\n{}\n",
        style.paint(Colors::Strong, "For a config of coinmc calibrate:")
    );
    let lines = config(heard, told.map(|(told, _)| told));
    text += if lines.is_empty() {
        "# nothing: they say no more than the prior\n"
    } else {
        &lines
    };
    if style.unicode { text } else { in_ascii(&text) }
}

fn of_recording(heard: &Heard, style: &Style) -> String {
    let [channel, channels] = heard.channel;
    let which = if channels > 1 {
        format!(", channel {channel} of {channels}, the loudest")
    } else {
        String::new()
    };
    let title = format!(
        "{}: {:.2} s{which}, {:.0} dB above the noise at most",
        heard.name, heard.seconds, heard.onsets.signal_to_noise_db
    );
    let mut text = format!("{}\n", style.paint(Colors::Strong, &title));
    let mut line = |words: &str| {
        text += "  ";
        text += &wrapped(words, style.width.saturating_sub(2), 4);
    };
    match (heard.kind, &heard.bounces, &heard.whirr) {
        (Some(Kind::Drop), Ok(bounces), _) => {
            let times = bounces.times_s.iter().map(|time| format!("{time:.3}"));
            line(&format!(
                "a drop, {} bounces, s after the first: {}",
                bounces.times_s.len(),
                listed(&times.collect::<Vec<_>>())
            ));
        }
        (Some(Kind::Whirr), _, Ok(whirr)) => {
            let pitches = whirr
                .readings
                .iter()
                .map(|pitch| format!("{:.1} Hz at {:.2} s", pitch.frequency_hz, pitch.time_s));
            line(&format!(
                "a spin that whirrs: {}; scatter {:.1} %",
                listed(&pitches.collect::<Vec<_>>()),
                100.0 * whirr.scatter
            ));
        }
        _ => {}
    }
    for doubt in &heard.doubts {
        line(&format!(
            "{} {doubt}",
            style.paint(Colors::Warning, "mind:")
        ));
    }
    text
}

/// The first of them, and how many more there are.
fn listed(all: &[String]) -> String {
    let more = all.len().saturating_sub(SHOWN);
    let shown = all[..all.len() - more].join(", ");
    if more > 0 {
        format!("{shown} and {more} more")
    } else {
        shown
    }
}

fn surface(told: &Told, style: &Style) -> String {
    let mut text = String::from("\n");
    if let Some(drops) = &told.drops {
        text += &by_drops(drops, style);
    }
    if let Some(length) = &told.whirrs {
        let words = format!(
            "By the whirr: rolling_friction_m = {} ± {} (one standard error)",
            compact(three_digits(length.length_m)),
            compact(two_digits(length.error_m))
        );
        text += &wrapped(&words, style.width, 0);
    }
    for doubt in &told.doubts {
        let words = format!("{} {doubt}", style.paint(Colors::Warning, "mind:"));
        text += &wrapped(&words, style.width, 2);
    }
    text
}

/// What was assumed of the scene.
fn remarks(observed: &Observations, style: &Style) -> String {
    let note = |note| {
        wrapped(
            &style.paint(Colors::Faint, &format!("note: {note}")),
            style.width,
            0,
        )
    };
    observed.notes().map(note).collect()
}

fn by_drops(drops: &FromDrops, style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("surface"),
        Column::right("prior, 95 %").droppable(1),
        Column::right("median"),
        Column::right("95 % interval"),
        Column::right("spread left").droppable(2),
    ]);
    let number = |x: f64| compact(three_digits(x));
    for found in &drops.parameters {
        let [low, high] = found.interval;
        table.push(vec![
            found.prior.parameter.key().to_owned(),
            format!(
                "{} to {}",
                number(found.prior.low),
                number(found.prior.high)
            ),
            number(found.median),
            format!("[{}, {}]", number(low), number(high)),
            format!("{:.0} %", 100.0 * found.spread_left),
        ]);
    }
    let mut text = table.render(style).text;
    let note = format!(
        "{} simulated drops, of which those on {} surfaces sound most alike",
        grouped(drops.drops),
        grouped(drops.nearest as u64)
    );
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    for doubt in &drops.doubts {
        let words = format!("{} {doubt}", style.paint(Colors::Warning, "mind:"));
        text += &wrapped(&words, style.width, 2);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without remarks warnings stay.
    #[test]
    fn quiet_leaves_remarks_out_and_warnings_in() {
        let config = "coin = { ratio = 0.1, radius_m = 0.0116 }\nlaunch.preset = 'hand'\nengine.volumetric = {}\n\
                      surface = { restitution = 0.5, friction = 0.3 }\n";
        let observed = Observations::parse("inline", config, &[], "".as_ref()).unwrap();
        let told = Told {
            drops: None,
            whirrs: None,
            doubts: vec!["odd".to_owned()],
        };
        let said = |quiet| text(&[], Some((&told, &observed)), &Style::plain(80), quiet);
        assert!(said(false).contains("note: surface.roughness_slope = 0"));
        assert!(!said(true).contains("note:"));
        assert!(said(true).contains("mind: odd"));
    }
}
