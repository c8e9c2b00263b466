//! The published numbers: data/counts.csv, data/values.csv, data/same-side.csv and the table of Unity, compiled in.

use coinmc::published::table1;
use std::sync::LazyLock;

/// A published number of a data set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Number {
    pub(crate) set: &'static str,
    pub(crate) name: String,
    /// H/R, where the coin's thickness matters.
    pub(crate) ratio: Option<f64>,
    pub(crate) seen: Seen,
}

/// What was published.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Seen {
    /// So many of so many tosses.
    Count {
        face: &'static str,
        shown: u64,
        tosses: u64,
        /// It is the most extreme of so many such counts.
        chosen_from: u64,
    },
    /// A probability of the side.
    Value(f64),
    /// The ratio at which P(side) is 1/3, and its error.
    FairRatio(f64),
}

static NUMBERS: LazyLock<Vec<Number>> = LazyLock::new(|| {
    let mut numbers = rows(
        include_str!("../../data/counts.csv"),
        "set,line,ratio,face,shown,tosses,chosen_from",
        counted,
    );
    numbers.extend(rows(
        include_str!("../../data/values.csv"),
        "set,quantity,ratio,value,half_width",
        value,
    ));
    numbers.extend(rows(
        include_str!("../../data/same-side.csv"),
        "person,heads_same,heads_other,tails_same,tails_other",
        person,
    ));
    numbers.extend(table1().iter().map(|counts| Number {
        set: "unity",
        name: format!("H/R = {}", counts.ratio),
        ratio: Some(counts.ratio),
        seen: Seen::Count {
            face: "side",
            shown: counts.side,
            tosses: counts.tosses(),
            chosen_from: 1,
        },
    }));
    numbers
});

/// The numbers of a data set.
pub(crate) fn numbers(set: &str) -> impl Iterator<Item = &'static Number> {
    NUMBERS.iter().filter(move |number| number.set == set)
}

/// Parses a CSV file that is compiled into the program.
fn rows(
    text: &'static str,
    header: &str,
    parse: fn(&[&'static str]) -> Option<Number>,
) -> Vec<Number> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header), "the columns in data/README.md");
    let row = |line: &'static str| {
        let cells: Vec<_> = line.split(',').collect();
        parse(&cells).unwrap_or_else(|| panic!("not a row of {header}: {line}"))
    };
    lines.map(row).collect()
}

fn counted(cells: &[&'static str]) -> Option<Number> {
    let [set, name, ratio, face, shown, tosses, chosen_from] = cells else {
        return None;
    };
    Some(Number {
        set,
        name: (*name).to_owned(),
        ratio: ratio.parse().ok(),
        seen: Seen::Count {
            face,
            shown: shown.parse().ok()?,
            tosses: tosses.parse().ok()?,
            chosen_from: chosen_from.parse().ok()?,
        },
    })
}

fn value(cells: &[&'static str]) -> Option<Number> {
    let [set, quantity, ratio, value, half_width] = cells else {
        return None;
    };
    let number: f64 = value.parse().ok()?;
    let half_width: f64 = half_width.parse().ok()?;
    let (name, seen) = match *quantity {
        "p_side" => (format!("H/R = {ratio}"), Seen::Value(number)),
        "fair_ratio" if half_width > 0.0 => (
            format!("fair at {number} ± {half_width}"),
            Seen::FairRatio(half_width),
        ),
        "fair_ratio" => (format!("fair at {number:.4}"), Seen::FairRatio(0.0)),
        _ => return None,
    };
    Some(Number {
        set,
        name,
        ratio: ratio.parse().ok(),
        seen,
    })
}

fn person(cells: &[&'static str]) -> Option<Number> {
    let [name, counts @ ..] = cells else {
        return None;
    };
    let counts: Vec<u64> = counts.iter().filter_map(|cell| cell.parse().ok()).collect();
    let [heads_same, heads_other, tails_same, tails_other] = counts[..] else {
        return None;
    };
    Some(Number {
        set: "bartos",
        name: (*name).to_owned(),
        ratio: None,
        seen: Seen::Count {
            face: "same",
            shown: heads_same + tails_same,
            tosses: heads_same + heads_other + tails_same + tails_other,
            chosen_from: 1,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sets::{Predictor, SETS};

    /// Every set that is predicted has numbers, and every number belongs to such a set.
    #[test]
    fn sets_and_numbers_belong_to_each_other() {
        for set in &SETS {
            let predicted = !matches!(set.by, Predictor::Nothing(_));
            assert_eq!(numbers(set.name).count() > 0, predicted, "{}", set.name);
        }
        for number in NUMBERS.iter() {
            assert!(SETS.iter().any(|set| set.name == number.set), "{number:?}");
        }
    }

    /// 178,078 of 350,757, as published (the paper's text counts one more).
    #[test]
    fn the_people_add_up_to_the_published_counts() {
        let sums = numbers("bartos").fold((0, 0), |sum, number| match number.seen {
            Seen::Count { shown, tosses, .. } => (sum.0 + shown, sum.1 + tosses),
            _ => panic!("counts"),
        });
        assert_eq!(sums, (178_078, 350_757));
    }
}
