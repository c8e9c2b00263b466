//! Who made a run, for people.

use crate::terminal::{count, duration};
use coinmc::run::{Contribution, Maker, Provenance};

/// A line for each build and machine, and one for what is not recorded.
pub(super) fn lines(provenance: &Provenance) -> Vec<String> {
    let mut lines: Vec<String> = provenance.contributions.iter().map(line).collect();
    if provenance.unrecorded_chunks > 0 {
        let chunks = count(provenance.unrecorded_chunks, "chunk");
        lines.push(format!("coinmc: who made {chunks} is not recorded"));
    }
    lines
}

fn line(contribution: &Contribution) -> String {
    let Maker {
        build, cpu, lanes, ..
    } = &contribution.maker;
    let chunks = count(contribution.chunks, "chunk");
    let (time, of) = match contribution.processor {
        Some(time) => (time, "of processor time"),
        None => (contribution.wall, "of its threads"),
    };
    let time = duration(time);
    format!("coinmc: made by {build}, {cpu}, {lanes} lanes: {chunks}, {time} {of}")
}
