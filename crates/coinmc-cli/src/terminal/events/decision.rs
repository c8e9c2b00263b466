//! Explanation of what decided the face of a toss, and when.

use super::rows::of_balance;
use crate::terminal::{compact, count};
use coinmc_core::{Ended, EventKind, Face, Landing};
use coinmc_trace::{Record, RecordKind, Trace};

/// A coin with its axis within this angle of level, rad, lies along its side.
const LEVEL: f64 = 1e-6;

pub(super) fn decision(trace: &Trace) -> String {
    let when = when(trace);
    match trace.outcome.ended {
        Ended::Decided(face) if trace.scene.surface.landing() == Landing::Adhesive => {
            adhesive(&when, face)
        }
        Ended::Decided(face) if trace.outcome.overruled => {
            format!(
                "The decision rule of the config named {} as soon as the energy was low enough for \
                 it. Continued until the face was decided by energy, {when}, the coin showed \
                 another face.",
                name(face)
            )
        }
        Ended::Decided(face) => decided(trace, &when, face),
        Ended::Left => format!("The coin left the table {when}: its centre passed the edge."),
        Ended::NeverSettles => format!(
            "Undecided: it is proven {when} that the coin never settles. It loses no energy: it \
             stands balanced, or bounces or rolls forever."
        ),
        Ended::TimeLimit => undecided(trace, &when, "the limit of simulated time, time_limit"),
        Ended::ImpactLimit => {
            undecided(trace, &when, "its limit of impacts or of steps in contact")
        }
        Ended::Failed => format!(
            "Failed {when}: a value is not a number (NaN). The toss counts as failed, without a face."
        ),
    }
}

fn adhesive(when: &str, face: Face) -> String {
    format!(
        "The landing is adhesive: the first contact, {when}, decides. The coin topples to the side \
         of the touching rim on which its centre is. {}",
        shows(face)
    )
}

/// Explains a decision by energy.
fn decided(trace: &Trace, when: &str, face: Face) -> String {
    let Some(last) = trace.records.last() else {
        return shows(face).to_owned();
    };
    let left = of_balance(trace, last);
    let percent = compact_percent(left);
    let level = last.state.axis.z.abs();
    let why = if left < 1.0 {
        format!(
            "its energy is {percent} of what it takes to balance over its rim, so that it can never \
             cross it again"
        )
    } else if level < LEVEL {
        format!(
            "it lies along its side; its energy is {percent} of what it takes to balance over its \
             rim, but is in rolling and sliding, which cannot tilt it that far"
        )
    } else {
        format!(
            "its energy is {percent} of what it takes to balance over its rim, but too little of \
             that can tilt it: the rest is in motion along the surface"
        )
    };
    format!("Decided {when}{}: {why}. {}", after(trace), shows(face))
}

fn undecided(trace: &Trace, when: &str, limit: &str) -> String {
    let left = trace.records.last().map_or(String::new(), |last| {
        compact_percent(of_balance(trace, last))
    });
    format!(
        "Undecided {when}, after {}: stopped at {limit} of the engine, with {left} of the energy \
         that it takes to balance over the rim. Raise the limit in the config to continue it.",
        count(u64::from(trace.outcome.impacts), "impact")
    )
}

/// "at 0.4123 s"
fn when(trace: &Trace) -> String {
    format!("at {} s", compact(trace.duration_s()))
}

/// ", just after impact 7" if that was the last event.
fn after(trace: &Trace) -> String {
    let event = |record: &Record| match record.kind {
        RecordKind::Event(kind) => Some(kind),
        RecordKind::Sample => None,
    };
    let before_end = trace.records.iter().rev().filter_map(event).nth(1);
    match before_end {
        Some(EventKind::Impact) => format!(", just after impact {}", trace.outcome.impacts),
        Some(EventKind::Sticking | EventKind::Sliding) => ", in contact".to_owned(),
        _ => String::new(),
    }
}

fn shows(face: Face) -> &'static str {
    match face {
        Face::Heads => "It shows heads.",
        Face::Tails => "It shows tails.",
        Face::Side => "It comes to rest on its side.",
    }
}

fn name(face: Face) -> &'static str {
    match face {
        Face::Heads => "heads",
        Face::Tails => "tails",
        Face::Side => "its side",
    }
}

/// Three digits, rounded away from 100 %, to show whether it is above or below.
fn compact_percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rounded = if percent < 100.0 {
        libm::floor(percent * 10.0) / 10.0
    } else {
        libm::ceil(percent * 10.0) / 10.0
    };
    format!("{} %", compact(rounded))
}
