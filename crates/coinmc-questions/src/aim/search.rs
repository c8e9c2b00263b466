//! The best of many places by tosses, and how good it is.
//!
//! # Method
//! Successive halving (Karnin, Koren & Somekh, ICML 2013, "Almost optimal exploration in multi-armed
//! bandits"): all places are tossed equally often, the better half stays and is tossed twice as
//! often with fresh tosses, until one place is left. Every round makes about as many tosses as the
//! first. A place's rank is by all its tosses so far: unlike in the paper, none are forgotten.
//!
//! # The winner's bias
//! The place that showed the face most often was, among other things, lucky: its own count
//! overstates its probability, the more so the more places compete. So the tosses that chose a
//! place say nothing of how good it is. That is told by final tosses that took no part in the
//! choice, whose interval holds whatever place was chosen.

use crate::seen::Seen;
use std::ops::Range;

/// Whoever tosses at the places 0, 1, 2, …
pub(super) trait Places {
    type Error;

    /// Counts the tosses with these numbers at each of these places.
    fn count(&mut self, places: &[usize], tosses: Range<u64>) -> Result<Vec<Seen>, Self::Error>;
}

/// A place that was chosen, and the final tosses there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) place: usize,
    pub(super) seen: Seen,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Searched {
    /// The first tosses at every place.
    pub(super) map: Vec<Seen>,
    pub(super) best: Found,
    pub(super) worst: Found,
    /// The numbers of the final tosses.
    pub(super) last: Range<u64>,
}

/// What is sought of the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sought {
    Most,
    Least,
}

/// The tosses per place of the first round, and the final ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Effort {
    pub(super) first: u64,
    pub(super) last: u64,
}

/// Finds the places where the face is most and least likely.
///
/// There must be at least one place.
pub(super) fn search<P: Places>(
    arena: &mut P,
    places: usize,
    effort: Effort,
) -> Result<Searched, P::Error> {
    let all: Vec<usize> = (0..places).collect();
    let map = arena.count(&all, 0..effort.first)?;
    let best = narrow(arena, &map, effort.first, Sought::Most)?;
    let worst = narrow(arena, &map, effort.first, Sought::Least)?;
    let fresh = rounds(places, effort.first)
        .last()
        .map_or(0, |(_, tosses)| tosses.end);
    let last = fresh..fresh + effort.last;
    let seen = arena.count(&[best, worst], last.clone())?;
    Ok(Searched {
        map,
        best: Found {
            place: best,
            seen: seen[0],
        },
        worst: Found {
            place: worst,
            seen: seen[1],
        },
        last,
    })
}

/// How many places each round tosses, and with which toss numbers.
fn rounds(places: usize, first: u64) -> impl Iterator<Item = (usize, Range<u64>)> {
    let halved = |&(places, ref tosses): &(usize, Range<u64>)| {
        let more = 2 * (tosses.end - tosses.start);
        let left = places.div_ceil(2);
        (left > 1).then_some((left, tosses.end..tosses.end + more))
    };
    std::iter::successors(Some((places, 0..first)), halved)
}

/// All tosses of a search.
pub(super) fn planned(places: usize, effort: Effort) -> u64 {
    let of_round =
        |(places, tosses): (usize, Range<u64>)| places as u64 * (tosses.end - tosses.start);
    let mut each = rounds(places, effort.first).map(of_round);
    let map = each.next().unwrap_or(0);
    map + 2 * (each.sum::<u64>() + effort.last)
}

/// The place that is left after all rounds.
fn narrow<P: Places>(
    arena: &mut P,
    map: &[Seen],
    first: u64,
    sought: Sought,
) -> Result<usize, P::Error> {
    let mut left: Vec<(usize, Seen)> = map.iter().copied().enumerate().collect();
    for (places, tosses) in rounds(map.len(), first).skip(1) {
        keep(&mut left, places, sought);
        let indices: Vec<usize> = left.iter().map(|(place, _)| *place).collect();
        for ((_, sum), seen) in left.iter_mut().zip(arena.count(&indices, tosses)?) {
            sum.add(seen);
        }
    }
    keep(&mut left, 1, sought);
    Ok(left[0].0)
}

/// Keeps the best places; of equally good ones those that come first. All have been tossed equally
/// often.
fn keep(left: &mut Vec<(usize, Seen)>, places: usize, sought: Sought) {
    left.sort_by(|(a_place, a), (b_place, b)| {
        let order = match sought {
            Sought::Most => b.shown.cmp(&a.shown),
            Sought::Least => a.shown.cmp(&b.shown),
        };
        order.then(a_place.cmp(b_place))
    });
    left.truncate(places);
}

#[cfg(test)]
mod tests;
