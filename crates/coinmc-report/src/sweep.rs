//! Which points of a large sweep a page shows.

use coinmc::results::{Results, Row};
use std::collections::BTreeMap;

/// The rows to show of a sweep, and a sentence about the others if there are any.
pub(crate) fn thinned(results: &Results, most: usize) -> (Vec<usize>, Option<String>) {
    let all = results.rows.len();
    if all <= most {
        return ((0..all).collect(), None);
    }
    let mut axes: Vec<Axis> = results
        .axes
        .iter()
        .map(|name| Axis::new(results, name))
        .collect();
    let product: usize = axes.iter().map(|axis| axis.places.len()).product();
    if product != all {
        // not a grid: the points are in an order of their own
        let step = all.div_ceil(most);
        let rows = (0..all).step_by(step).collect();
        return (rows, Some(format!("every {} point", ordinal(step))));
    }
    while axes.iter().map(Axis::kept).product::<usize>() > most {
        let longest = axes.iter_mut().max_by_key(|axis| axis.kept());
        longest.expect("a sweep has an axis").step *= 2;
    }
    let rows = (0..all).filter(|&i| axes.iter().all(|axis| axis.keeps(&results.rows.at(i))));
    let words = axes.iter().filter(|axis| axis.step > 1);
    let words: Vec<String> = words
        .map(|axis| format!("every {} value of {}", ordinal(axis.step), axis.name))
        .collect();
    (rows.collect(), Some(words.join(", ")))
}

/// The values of a swept parameter, of which every `step`-th is kept.
struct Axis<'a> {
    name: &'a str,
    places: BTreeMap<u64, usize>,
    step: usize,
}

impl<'a> Axis<'a> {
    fn new(results: &Results, name: &'a str) -> Self {
        let mut values: Vec<f64> = results
            .rows
            .each()
            .filter_map(|row| row.parameter(name))
            .collect();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        let places = values
            .iter()
            .enumerate()
            .map(|(i, value)| (value.to_bits(), i));
        Self {
            name,
            places: places.collect(),
            step: 1,
        }
    }

    fn kept(&self) -> usize {
        self.places.len().div_ceil(self.step)
    }

    fn keeps(&self, row: &Row) -> bool {
        let value = row.parameter(self.name).map(f64::to_bits);
        let place = value.and_then(|value| self.places.get(&value));
        place.is_none_or(|place| place.is_multiple_of(self.step))
    }
}

/// `4th`, `22nd`.
fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::StoppedBy;
    use coinmc_core::Tally;

    fn results(more: &str) -> Results {
        let config = format!(
            "coin.ratio = {{ from = 0.1, to = 4, steps = 40 }}\n\
             surface = {{ restitution = [0.3, 0.5, 0.7], friction = 0.3 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\nstop.tosses = 10\n{more}"
        );
        let plan = coinmc::config::parse("test", &config, &[]).unwrap_or_else(|e| panic!("{e}"));
        let row = |i| Row::new(&plan, i, Tally::default(), StoppedBy::Tosses);
        Results::new(&plan, (0..plan.points.len()).map(row).collect())
    }

    #[test]
    fn small_sweeps_are_shown_whole() {
        let (rows, word) = thinned(&results(""), 120);
        assert_eq!((rows.len(), word), (120, None));
    }

    #[test]
    fn what_is_left_of_a_grid_is_a_grid() {
        let results = results("");
        let (rows, word) = thinned(&results, 33);
        assert_eq!(word.unwrap(), "every 4th value of ratio");
        assert_eq!(rows.len(), 30);
        let of = |name: &str| -> std::collections::BTreeSet<u64> {
            rows.iter()
                .map(|&i| results.rows[i].parameter(name).unwrap().to_bits())
                .collect()
        };
        assert_eq!((of("ratio").len(), of("restitution").len()), (10, 3));
    }

    #[test]
    fn points_that_are_no_grid_are_thinned_in_order() {
        let config = "coin.ratio = [0.1, 0.2, 0.3, 0.4, 0.5]\n\
            surface = { restitution = [0.1, 0.2, 0.3, 0.4, 0.5], friction = 0.3 }\n\
            launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 10\nsweep.mode = 'zip'";
        let plan = coinmc::config::parse("test", config, &[]).unwrap_or_else(|e| panic!("{e}"));
        let row = |i| Row::new(&plan, i, Tally::default(), StoppedBy::Tosses);
        let results = Results::new(&plan, (0..5).map(row).collect());
        let (rows, word) = thinned(&results, 3);
        assert_eq!(
            (rows, word.as_deref()),
            (vec![0, 2, 4], Some("every 2nd point"))
        );
    }

    #[test]
    fn ordinals() {
        let words = [1, 2, 3, 4, 11, 12, 22, 101, 113].map(ordinal);
        assert_eq!(
            words.join(" "),
            "1st 2nd 3rd 4th 11th 12th 22nd 101st 113th"
        );
    }
}
