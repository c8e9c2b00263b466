//! What a run still lacks, as a list that can be handed to machines again.

use super::cut::Cut;
use super::schedule::{Job, Next, Schedule};
use super::{Chunk, Part};
use crate::plan::Plan;
use std::collections::BTreeSet;
use std::fmt;

/// Most chunks that a message names.
const NAMED: usize = 20;

/// The chunks that none of the parts of a run holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// The first of them, with adjacent ones joined.
    pub chunks: Vec<Chunk>,
    /// How many there are.
    pub total: u64,
    /// The parts they belong to, as `coinmc run --shard` takes them; empty if the directories do not
    /// agree on how many parts there are, or a run that stops at targets has none.
    pub parts: Vec<Part>,
}

impl Missing {
    /// The parts as they are named: `3/8`, with at most twenty named.
    ///
    /// # Example
    /// ```
    /// use coinmc::run::{Missing, Part};
    /// let missing = Missing { chunks: vec![], total: 2, parts: vec![Part::new(3, 3).unwrap()] };
    /// assert_eq!(missing.names(), "3/3");
    /// ```
    pub fn names(&self) -> String {
        let named = self.parts.iter().take(NAMED).map(Part::to_string);
        let mut names: Vec<String> = named.collect();
        if self.parts.len() > NAMED {
            names.push("…".to_owned());
        }
        names.join(", ")
    }

    /// The numbers of the parts as job arrays take them: `3,5-7`.
    ///
    /// # Example
    /// ```
    /// use coinmc::run::{Missing, Part};
    /// let parts = [3, 5, 6, 7].map(|i| Part::new(i, 8).unwrap()).to_vec();
    /// let missing = Missing { chunks: vec![], total: 9, parts };
    /// assert_eq!(missing.array(), "3,5-7");
    /// ```
    pub fn array(&self) -> String {
        let mut ranges: Vec<(u32, u32)> = Vec::new();
        for index in self.parts.iter().map(|part| part.index()) {
            match ranges.last_mut() {
                Some((_, last)) if *last + 1 == index => *last = index,
                _ => ranges.push((index, index)),
            }
        }
        let range = |(first, last)| match last - first {
            0 => format!("{first}"),
            1 => format!("{first},{last}"),
            _ => format!("{first}-{last}"),
        };
        let ranges: Vec<String> = ranges.into_iter().map(range).collect();
        ranges.join(",")
    }
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let are = if self.total == 1 {
            "1 chunk is".to_owned()
        } else {
            format!("{} chunks are", self.total)
        };
        let named = self.chunks.iter().take(NAMED);
        let named: Vec<String> = named.map(Chunk::to_string).collect();
        write!(f, "{are} in none of the parts: {}", named.join("; "))?;
        if self.chunks.len() > NAMED {
            write!(f, "; …")?;
        }
        match &self.parts[..] {
            [] => {}
            [part] => write!(f, ". Run this part (again): {part}")?,
            [first, ..] => {
                let of = first.of();
                write!(f, ". Run these parts of {of} (again): {}", self.array())?;
            }
        }
        Ok(())
    }
}

/// What a schedule lacks: a chunk that it hands out. `None` if nothing is missing. `parts` are those of the
/// directories that were read.
pub(super) fn what_is_missing(
    plan: &Plan,
    schedule: &mut Schedule,
    parts: &[Part],
) -> Option<Missing> {
    let cut = Cut::new(plan);
    let of = parts.iter().map(|part| part.of()).max().unwrap_or(1);
    let is_shared = of > 1 && parts.iter().all(|part| part.of() == of || part.of() == 1);
    let (mut chunks, mut total, mut owners) = (Vec::<Chunk>::new(), 0, BTreeSet::new());
    while let Next::Chunk(Job { chunk, .. }) = schedule.next() {
        total += 1;
        owners.insert(cut.turn(&chunk) % u64::from(of));
        let has_room = chunks.len() <= NAMED;
        match chunks.last_mut() {
            Some(last) if last.point == chunk.point && last.tosses.end == chunk.tosses.start => {
                last.tosses.end = chunk.tosses.end;
            }
            _ if has_room => chunks.push(chunk),
            _ => {}
        }
    }
    let owner = |index| Part::new(u32::try_from(index).ok()? + 1, of).ok();
    let parts = owners.into_iter().filter(|_| is_shared).filter_map(owner);
    (total > 0).then(|| Missing {
        chunks,
        total,
        parts: parts.collect(),
    })
}
