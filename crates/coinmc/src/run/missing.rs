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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::chunk_result::{ChunkResult, Tossed};
    use crate::run::finished::Finished;
    use crate::run::packed::Packed;
    use coinmc_core::Tally;
    use std::sync::Arc;

    fn missing_of(indices: &[u32], of: u32) -> Missing {
        let part = |&index: &u32| Part::new(index, of).unwrap();
        Missing {
            chunks: vec![],
            total: 1,
            parts: indices.iter().map(part).collect(),
        }
    }

    #[test]
    fn parts_are_listed_as_job_arrays_take_them() {
        for (indices, array) in [
            (&[][..], ""),
            (&[3], "3"),
            (&[3, 4], "3,4"),
            (&[1, 2, 3], "1-3"),
            (&[1, 3, 5, 6, 8, 9, 10, 11], "1,3,5,6,8-11"),
        ] {
            assert_eq!(missing_of(indices, 20).array(), array);
        }
    }

    #[test]
    fn at_most_twenty_parts_are_named() {
        let indices: Vec<u32> = (1..=21).collect();
        let all = missing_of(&indices[..20], 30).names();
        assert!(all.starts_with("1/30, 2/30, ") && all.ends_with(", 20/30"));
        assert_eq!(missing_of(&indices, 30).names(), format!("{all}, …"));
    }

    /// Points of one chunk each.
    fn plan(points: u32) -> Arc<Plan> {
        let config = format!(
            "coin.ratio = {{ from = 1.0, to = 2.0, steps = {points} }}\nlaunch.preset = 'robot'\n\
             surface = {{ restitution = 0.5, friction = 0.3 }}\nengine.flat = {{}}\nstop.tosses = 100"
        );
        Arc::new(crate::config::parse("test", &config, &[]).unwrap())
    }

    #[test]
    fn what_is_stored_between_them_parts_missing_chunks() {
        let config = "coin.ratio = 1\nlaunch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 60_000\n\
                      surface = { restitution = 0.5, friction = 0.3 }";
        let plan = Arc::new(crate::config::parse("test", config, &[]).unwrap());
        let chunk = |tosses| Chunk { point: 0, tosses };
        let tossed = Tossed {
            tally: Tally {
                heads: 16_384,
                ..Tally::default()
            },
            microseconds: 0,
        };
        let stored = Packed::from(&ChunkResult::Tossed(tossed));
        let finished = Finished::new([(chunk(16_384..32_768), stored)]);
        let mut schedule = Schedule::new(&plan, Part::WHOLE, finished);
        let missing = what_is_missing(&plan, &mut schedule, &[]).unwrap();
        assert_eq!(missing.chunks, [chunk(0..16_384), chunk(32_768..60_000)]);
        assert_eq!(missing.total, 3);
    }

    #[test]
    fn at_most_twenty_chunks_are_named() {
        for (points, more) in [(20, ""), (21, "; …"), (30, "; …")] {
            let plan = plan(points);
            let mut schedule = Schedule::new(&plan, Part::WHOLE, Finished::default());
            let missing = what_is_missing(&plan, &mut schedule, &[]).unwrap();
            assert_eq!(missing.total, u64::from(points));
            // one more shows that there are more
            assert!(missing.chunks.len() <= NAMED + 1, "{points}");
            let end = format!("; point 19, tosses 0..100{more}");
            let text = missing.to_string();
            assert!(text.ends_with(&end), "{text}");
        }
    }

    /// Of two points, and none stored.
    #[test]
    fn parts_are_named_where_the_directories_agree_how_many_there_are() {
        let plan = plan(2);
        let named = |parts: &[(u32, u32)]| {
            let parts: Vec<Part> = parts
                .iter()
                .map(|&(i, of)| Part::new(i, of).unwrap())
                .collect();
            let mut schedule = Schedule::new(&plan, Part::WHOLE, Finished::default());
            let missing = what_is_missing(&plan, &mut schedule, &parts).unwrap();
            assert_eq!((missing.total, missing.chunks.len()), (2, 2));
            missing.names()
        };
        assert_eq!(named(&[(3, 3)]), "1/3, 2/3");
        // the whole has all parts
        assert_eq!(named(&[(3, 3), (1, 1)]), "1/3, 2/3");
        for none in [&[][..], &[(1, 1)], &[(1, 2), (1, 3)]] {
            assert_eq!(named(none), "");
        }
    }
}
