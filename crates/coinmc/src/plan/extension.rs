//! Whether a plan goes on where another ended: it has the same points, perhaps more, and asks for more tosses.

use super::{Plan, Point, Stop, Targets};
use std::collections::HashMap;
use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Longest value that is quoted, in characters.
const QUOTED: usize = 60;

/// A key of the config that two plans give different values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The dotted key.
    pub key: String,
    /// Its value in the first plan, as the resolved config has it; `None` if it has none.
    pub old: Option<String>,
    /// Its value in the other.
    pub new: Option<String>,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = |value: &Option<String>| {
            let value = value.as_deref().unwrap_or("none");
            let mut short: String = value.chars().take(QUOTED).collect();
            if short.len() < value.len() {
                short.push('…');
            }
            short
        };
        write!(
            f,
            "{} {} -> {}",
            self.key,
            value(&self.old),
            value(&self.new)
        )
    }
}

/// Why a plan does not go on where another ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Obstacle {
    /// These keys matter to tosses that are made, or to what is said of them.
    Changed(Vec<Change>),
    /// These keys of `[stop]` ask for less than is there, or for something else.
    Less(Vec<Change>),
    /// The points are there, but at other places of the sweep, and so with other random numbers.
    Moved(Vec<Change>),
    /// Several of these at once.
    Several(Vec<Obstacle>),
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// More changes are not named.
        const NAMED: usize = 8;
        let (changes, why) = match self {
            Self::Changed(changes) => (changes, ""),
            Self::Less(changes) => (changes, ", which is not more of the same"),
            Self::Moved(changes) => (
                changes,
                ", which gives points that are there other random numbers (put new values at the end of the list \
                 that varies slowest, the first of the config)",
            ),
            Self::Several(obstacles) => {
                let told: Vec<String> = obstacles.iter().map(Self::to_string).collect();
                return f.write_str(&told.join("; "));
            }
        };
        let named: Vec<String> = changes.iter().take(NAMED).map(Change::to_string).collect();
        let more = if changes.len() > NAMED { "; …" } else { "" };
        write!(f, "{}{more}{why}", named.join("; "))
    }
}

/// How a plan goes on where another ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Extension {
    /// The place in the new plan of every point of the old one.
    places: Vec<usize>,
    /// What differs.
    pub(crate) changes: Vec<Change>,
}

impl Extension {
    /// How `new` goes on where `old` ended.
    pub(crate) fn of(old: &Plan, new: &Plan) -> Result<Self, Obstacle> {
        let changes = old.changes(new);
        let of_stop = |change: &Change| change.key.starts_with("stop.");
        let (stop, others): (Vec<_>, Vec<_>) = changes.iter().cloned().partition(of_stop);
        let same = old.seed == new.seed
            && old.paired == new.paired
            && old.sampling == new.sampling
            && old.confidence.to_bits() == new.confidence.to_bits()
            && old.interval == new.interval;
        let found = if same { places(old, new) } else { None };
        let places = match found {
            None => Err(Obstacle::Changed(others)),
            Some(places) if are_moved(&places) && !new.paired => Err(Obstacle::Moved(others)),
            Some(places) => Ok(places),
        };
        let stops = if asks_for_more(&old.stop, &new.stop) {
            Ok(())
        } else {
            Err(Obstacle::Less(stop))
        };
        match (places, stops) {
            (Ok(places), Ok(())) => Ok(Self { places, changes }),
            (Err(one), Err(other)) => Err(Obstacle::Several(vec![one, other])),
            (Err(only), _) | (_, Err(only)) => Err(only),
        }
    }

    /// The place in the new plan of a point of the old one.
    pub(crate) fn place(&self, old: usize) -> Option<usize> {
        self.places.get(old).copied()
    }

    /// Whether some point has another place.
    pub(crate) fn moves(&self) -> bool {
        are_moved(&self.places)
    }
}

impl Plan {
    /// What the config of `other` has different from that of this plan.
    ///
    /// # Example
    /// ```
    /// let plan = |seed: u32| coinmc::config::parse(
    ///     "inline", &format!("seed = {seed}\ncoin.ratio = 1\nengine.analytic.rule = 'arc'"), &[],
    /// ).unwrap();
    /// let changes = plan(1).changes(&plan(2));
    /// assert_eq!(changes[0].to_string(), "seed 1 -> 2");
    /// ```
    pub fn changes(&self, other: &Self) -> Vec<Change> {
        let (old, new) = (lines(&self.resolved_toml), lines(&other.resolved_toml));
        let value = |lines: &[(String, &str)], key: &str| {
            let found = lines.iter().find(|(known, _)| known == key);
            found.map(|(_, value)| (*value).to_owned())
        };
        let gone = old.iter().filter(|(key, _)| value(&new, key).is_none());
        let keys = new.iter().chain(gone).map(|(key, _)| key.clone());
        let change = |key: String| {
            let (old, new) = (value(&old, &key), value(&new, &key));
            (old != new).then_some(Change { key, old, new })
        };
        keys.filter_map(change).collect()
    }
}

/// The keys of a resolved config, which has one in each line, and their values.
fn lines(resolved: &str) -> Vec<(String, &str)> {
    let (mut table, mut found) = (String::new(), Vec::new());
    for line in resolved.lines() {
        if let Some(name) = line
            .strip_prefix('[')
            .and_then(|line| line.strip_suffix(']'))
        {
            table = format!("{name}.");
        } else if let Some((key, value)) = line.split_once(" = ") {
            found.push((format!("{table}{key}"), value));
        }
    }
    found
}

/// The place in `new` of every point of `old`; `None` if there is one that it lacks.
fn places(old: &Plan, new: &Plan) -> Option<Vec<usize>> {
    let is_there = |index: usize| {
        index < new.points.len() && same_tosses(&old.points.at(index), &new.points.at(index))
    };
    if (0..old.points.len()).all(is_there) {
        return Some((0..old.points.len()).collect());
    }
    let mut by_print = HashMap::<u64, Vec<usize>>::new();
    for (index, point) in new.points.each().enumerate() {
        by_print.entry(print(&point)).or_default().push(index);
    }
    let place = |index| {
        let point = &old.points.at(index);
        let alike = by_print.get(&print(point))?.iter();
        let mut same = alike.filter(|&&index| same_tosses(point, &new.points.at(index)));
        same.next().copied()
    };
    (0..old.points.len()).map(place).collect()
}

/// Whether some point has another place.
fn are_moved(places: &[usize]) -> bool {
    places.iter().enumerate().any(|(old, new)| old != *new)
}

/// Whether two points make the same tosses of the same random numbers.
fn same_tosses(a: &Point, b: &Point) -> bool {
    a.scene == b.scene && a.launches == b.launches && a.engine == b.engine
}

/// A number that points of the same tosses share.
fn print(point: &Point) -> u64 {
    let mut hasher = DefaultHasher::new();
    // numbers are written so that they read back as the same
    format!("{:?}", (&point.scene, &point.launches, &point.engine)).hash(&mut hasher);
    hasher.finish()
}

/// Whether a stop rule asks for all that another does, and perhaps for more.
fn asks_for_more(old: &Stop, new: &Stop) -> bool {
    match (old, new) {
        (Stop::Tosses(old), Stop::Tosses(new)) => new >= old,
        (Stop::Targets(old), Stop::Targets(new)) => {
            is_tighter(old.half_width, new.half_width)
                && is_tighter(old.relative_error, new.relative_error)
                && old
                    .events
                    .is_none_or(|old| new.events.is_some_and(|new| new >= old))
                && new.face.is_none_or(|face| old.face == Some(face))
                && allow_more(old, new)
        }
        _ => false,
    }
}

fn is_tighter(old: Option<f64>, new: Option<f64>) -> bool {
    old.is_none_or(|old| new.is_some_and(|new| new <= old))
}

/// Whether no limit is lower.
fn allow_more(old: &Targets, new: &Targets) -> bool {
    fn holds<T: PartialOrd>(old: Option<T>, new: Option<T>) -> bool {
        new.is_none_or(|new| old.is_some_and(|old| new >= old))
    }
    new.max_tosses >= old.max_tosses
        && holds(old.total_tosses, new.total_tosses)
        && holds(old.max_core_seconds, new.max_core_seconds)
        && holds(old.total_core_seconds, new.total_core_seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(text: &str) -> Plan {
        let text = format!("launch.preset = 'robot'\nengine.flat = {{}}\n{text}");
        crate::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
    }

    fn of(old: &str, new: &str) -> Result<Vec<usize>, String> {
        let found = Extension::of(&plan(old), &plan(new));
        found
            .map(|found| found.places)
            .map_err(|obstacle| obstacle.to_string())
    }

    fn scene(ratios: &str, restitutions: &str, rest: &str) -> String {
        format!(
            "coin.ratio = {ratios}\nsurface = {{ restitution = {restitutions}, friction = 0.3 }}\n{rest}"
        )
    }

    #[test]
    fn more_tosses_and_more_values_go_on() {
        let old = scene("[1, 2]", "0.5", "stop.tosses = 100");
        let more = scene("[1, 2, 1.5]", "0.5", "stop.tosses = 200");
        assert_eq!(of(&old, &more), Ok(vec![0, 1]));
        // one more axis, which varies faster
        let wider = scene("[1, 2]", "[0.3, 0.5]", "stop.tosses = 100");
        assert!(
            of(&old, &wider)
                .unwrap_err()
                .contains("other random numbers")
        );
        let [old, wider] = [old, wider].map(|text| format!("paired = true\n{text}"));
        assert_eq!(of(&old, &wider), Ok(vec![1, 3]));
    }

    #[test]
    fn what_matters_is_named() {
        let old = scene("[1, 2]", "0.5", "stop.tosses = 100");
        let other = scene("[1, 2]", "0.4", "seed = 3\nstop.tosses = 100");
        let named = of(&old, &other).unwrap_err();
        assert_eq!(named, "seed 1 -> 3; surface.restitution 0.5 -> 0.4");
        let fewer = scene("[1, 3]", "0.5", "stop.tosses = 100");
        assert_eq!(
            of(&old, &fewer).unwrap_err(),
            "coin.ratio [1.0, 2.0] -> [1.0, 3.0]"
        );
        let less = scene("[1, 2]", "0.5", "stop.tosses = 99");
        assert!(
            of(&old, &less)
                .unwrap_err()
                .starts_with("stop.tosses 100 -> 99, which")
        );
        let both = scene("[1, 3]", "0.5", "stop.tosses = 99");
        assert_eq!(
            of(&old, &both).unwrap_err(),
            "coin.ratio [1.0, 2.0] -> [1.0, 3.0]; stop.tosses 100 -> 99, which is not more of the same"
        );
    }

    #[test]
    fn targets_may_only_become_tighter() {
        let stop = |rule: &str| scene("1", "0.5", &format!("[stop]\n{rule}"));
        let goes_on = |old: &str, new: &str| of(&stop(old), &stop(new)).is_ok();
        assert!(goes_on("half_width = 0.01", "half_width = 0.005"));
        assert!(goes_on(
            "half_width = 0.01",
            "half_width = 0.01\nevents = 5"
        ));
        assert!(goes_on(
            "half_width = 0.01\ntotal_tosses = 10_000",
            "half_width = 0.01"
        ));
        assert!(!goes_on("half_width = 0.01", "half_width = 0.02"));
        assert!(!goes_on("half_width = 0.01", "relative_error = 0.01"));
        assert!(!goes_on(
            "half_width = 0.01",
            "half_width = 0.005\ntotal_tosses = 10_000"
        ));
        assert!(!goes_on("half_width = 0.01", "tosses = 1_000_000"));
        // the interval of one face, or of all three
        assert!(goes_on(
            "half_width = 0.01\nface = 'side'",
            "half_width = 0.01"
        ));
        assert!(!goes_on(
            "half_width = 0.01\nface = 'side'",
            "half_width = 0.01\nface = 'heads'"
        ));
        assert!(goes_on("events = 5", "events = 5"));
        assert!(goes_on("events = 5", "events = 6"));
        assert!(!goes_on("events = 5", "events = 4"));
        assert!(!goes_on("events = 5", "half_width = 0.01"));
        let limited = "half_width = 0.01\ntotal_tosses = 10_000";
        assert!(goes_on(limited, limited));
        assert!(goes_on(limited, "half_width = 0.01\ntotal_tosses = 20_000"));
        assert!(!goes_on(limited, "half_width = 0.01\ntotal_tosses = 9_000"));
    }

    /// Each of these alone changes tosses that are made, or what is said of them.
    #[test]
    fn whatever_all_points_share_must_stay() {
        let old = scene("[1, 2]", "0.5", "stop.tosses = 100");
        for (other, change) in [
            ("seed = 3", "seed 1 -> 3"),
            ("paired = true", "paired false -> true"),
            (
                "sampling.method = 'random'",
                "sampling.method \"auto\" -> \"random\"",
            ),
            (
                "estimate.confidence = 0.9",
                "estimate.confidence 0.95 -> 0.9",
            ),
            (
                "estimate.interval = 'clopper-pearson'",
                "estimate.interval \"wilson\" -> \"clopper-pearson\"",
            ),
        ] {
            assert_eq!(of(&old, &format!("{other}\n{old}")), Err(change.to_owned()));
        }
    }

    #[test]
    fn points_move_where_an_axis_grows_before_its_end() {
        let scene = |ratios| {
            let rest = "paired = true\nstop.tosses = 100";
            format!("{rest}\n{}", scene(ratios, "0.5", ""))
        };
        let moves = |new| {
            let found = Extension::of(&plan(&scene("[1, 2]")), &plan(&scene(new))).unwrap();
            (found.moves(), found.place(0), found.place(1))
        };
        assert_eq!(moves("[1, 2, 3]"), (false, Some(0), Some(1)));
        assert_eq!(moves("[1, 1.5, 2]"), (true, Some(0), Some(2)));
        assert_eq!(moves("[3, 2, 1]"), (true, Some(2), Some(1)));
        let one = plan(&scene("[1]"));
        let obstacle = Extension::of(&plan(&scene("[1, 2]")), &one).unwrap_err();
        let change = "coin.ratio [1.0, 2.0] -> 1.0";
        assert_eq!(obstacle.to_string(), change);
    }
}
