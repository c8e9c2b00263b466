//! What is heard as JSON, as CSV, and as lines of a config for `coinmc calibrate`.

use crate::listened::{Heard, Kind, Told};
use coinmc_calibrate::{Observations, Parameter};
use coinmc_core::csv_cell;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Version of the document.
const FORMAT_VERSION: u32 = 1;
/// A parameter of which less than this share of the prior's spread is left has been measured.
const LEARNT: f64 = 0.8;

/// The answer as JSON.
pub fn document(heard: &[Heard], told: Option<(&Told, &Observations)>) -> Value {
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "listened",
        "recordings": heard.iter().map(of_recording).collect::<Vec<_>>(),
        "surface": told.map(|(told, observed)| of_surface(told, observed)),
        "config": config(heard, told.map(|(told, _)| told)),
    })
}

fn of_recording(heard: &Heard) -> Value {
    let whirr = heard.whirr.as_ref().ok();
    let bounces = heard.bounces.as_ref().ok();
    json!({
        "name": heard.name,
        "seconds": heard.seconds,
        "rate_hz": heard.rate_hz,
        "bits": heard.bits,
        "channel": heard.channel[0],
        "channels": heard.channel[1],
        "clipped": heard.clipped,
        "signal_to_noise_db": heard.onsets.signal_to_noise_db,
        "taken_for": heard.kind.map(name_of),
        "doubts": heard.doubts,
        "onsets": heard.onsets.onsets.iter().map(|onset| json!({
            "time_s": onset.time_s,
            "error_s": onset.error_s,
            "strength": onset.strength,
        })).collect::<Vec<_>>(),
        "bounces_s": bounces.map(|bounces| &bounces.times_s),
        "whirr": whirr.map(|whirr| json!({
            "readings": whirr.readings.iter().map(|pitch| json!({
                "time_s": pitch.time_s,
                "frequency_hz": pitch.frequency_hz,
            })).collect::<Vec<_>>(),
            "scatter": whirr.scatter,
            "rate_s2": whirr.rate_s2,
            "rate_error": whirr.rate_error,
            "end_s": whirr.end_s,
        })),
    })
}

fn of_surface(told: &Told, observed: &Observations) -> Value {
    json!({
        "confidence": 0.95,
        "drops": told.drops.as_ref().map(|drops| json!({
            "simulated": drops.drops,
            "nearest": drops.nearest,
            "doubts": drops.doubts,
            "parameters": drops.parameters.iter().map(|found| json!({
                "name": found.prior.parameter.key(),
                "unit": found.prior.parameter.unit(),
                "prior": [found.prior.low, found.prior.high],
                "mean": found.mean,
                "median": found.median,
                "interval": found.interval,
                "spread_left": found.spread_left,
            })).collect::<Vec<_>>(),
        })),
        "whirrs": told.whirrs.map(|length| json!({
            "rolling_friction_m": length.length_m,
            "error_m": length.error_m,
        })),
        "doubts": told.doubts,
        "notes": observed.notes().collect::<Vec<_>>(),
    })
}

const fn name_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Whirr => "spin",
        Kind::Drop => "drop",
    }
}

/// Onsets, bounces and pitches, one a row.
pub fn csv(heard: &[Heard]) -> String {
    let mut text = String::from("recording,what,time_s,error_s,strength,frequency_hz\n");
    for one in heard {
        let name = csv_cell(&one.name);
        let mut row = |rest: &str| {
            // writing to a string cannot fail
            let _ = writeln!(text, "{name},{rest}");
        };
        for onset in &one.onsets.onsets {
            let (time, error, strength) = (onset.time_s, onset.error_s, onset.strength);
            row(&format!("onset,{time:.6},{error:.6},{strength:.4},"));
        }
        if let (Some(Kind::Drop), Ok(bounces)) = (one.kind, &one.bounces) {
            for (time, strength) in bounces.times_s.iter().zip(&bounces.strengths) {
                row(&format!("bounce,{time:.6},,{strength:.4},"));
            }
        }
        if let (Some(Kind::Whirr), Ok(whirr)) = (one.kind, &one.whirr) {
            for pitch in &whirr.readings {
                let (time, frequency) = (pitch.time_s, pitch.frequency_hz);
                row(&format!("pitch,{time:.6},,,{frequency:.4}"));
            }
        }
    }
    text
}

/// Lines for a config of `coinmc calibrate`: what simulated drops and whirrs tell, as `[prior]`; or without a scene, in
/// which nothing is simulated, the times of each drop as `[[bounces]]` and the pitch of each whirr as `[[whirr]]`.
pub fn config(heard: &[Heard], told: Option<&Told>) -> String {
    if let Some(told) = told {
        return prior(told);
    }
    let mut text = String::new();
    for one in heard {
        match (one.kind, &one.bounces, &one.whirr) {
            (Some(Kind::Whirr), _, Ok(whirr)) => {
                let of = |of: &dyn Fn(usize) -> String| {
                    let cells: Vec<String> = (0..whirr.readings.len()).map(of).collect();
                    cells.join(", ")
                };
                let times = of(&|k| format!("{:.3}", whirr.readings[k].time_s));
                let pitches = of(&|k| format!("{:.2}", whirr.readings[k].frequency_hz));
                let _ = writeln!(
                    text,
                    "[[whirr]]\ntime_s = [{times}]\nfrequency_hz = [{pitches}]\nfrequency_error = {:.3}",
                    whirr.scatter
                );
            }
            (Some(Kind::Drop), Ok(bounces), _) => {
                let times: Vec<String> =
                    bounces.times_s.iter().map(|t| format!("{t:.4}")).collect();
                let _ = writeln!(
                    text,
                    "[[bounces]]              # for a coin that stays flat\ntime_s = [{}]",
                    times.join(", ")
                );
            }
            _ => {}
        }
    }
    text
}

/// What is learnt of a surface, as the prior of a calibration.
fn prior(told: &Told) -> String {
    let mut lines = String::new();
    let mut line = |key: &str, interval: [f64; 2]| {
        let [low, high] = interval.map(three_digits);
        // writing to a string cannot fail
        let _ = writeln!(lines, "{key} = {{ low = {low}, high = {high} }}");
    };
    for found in told.drops.iter().flat_map(|drops| &drops.parameters) {
        let key = found.prior.parameter.key();
        let by_whirr = told.whirrs.is_some() && key == Parameter::RollingFriction.key();
        if found.spread_left < LEARNT && !by_whirr {
            line(key, found.interval);
        }
    }
    if let Some(length) = told.whirrs {
        let factor = libm::exp(1.96 * length.error_m / length.length_m);
        let ends = [length.length_m / factor, length.length_m * factor];
        line(Parameter::RollingFriction.key(), ends);
    }
    if lines.is_empty() {
        return lines;
    }
    format!("[prior]                  # by coinmc listen\n{lines}")
}

/// A number with three digits, as TOML writes it.
fn three_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if rounded != 0.0 && rounded.abs() < 1e-3 {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}
