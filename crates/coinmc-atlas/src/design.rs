//! What was tossed at the points of a design with one seed, from a run or from a table of it.

use crate::network::single;
use crate::{Axis, Counts, FitError, Place};
use coinmc::config;
use coinmc::results::{Results, Row};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The points of a design and their counts.
///
/// # Example
/// ```
/// use coinmc_atlas::{Counts, Design, Launch, Place};
/// let place = Place::on(&"wood".parse()?, 0.8, 0.011_625);
/// let counts = Counts { faces: [90, 90, 76], undecided: 0 };
/// let design = Design::new(Launch::Hand.design().to_owned(), vec![(place, counts)])?;
/// assert_eq!(design.radius_m(), 0.011_625);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    config: String,
    plan_hash: String,
    radius_m: f64,
    axes: Vec<Axis>,
    points: Vec<(Place, Counts)>,
}

impl Design {
    /// Points that were tossed with this config. Their numbers are rounded to single precision, as tables
    /// have them.
    ///
    /// # Errors
    /// [`FitError::NotADesign`].
    pub fn new(config: String, points: Vec<(Place, Counts)>) -> Result<Self, FitError> {
        let plan = config::parse("design", &config, &[])
            .map_err(|problems| FitError::NotADesign(problems.to_string()))?;
        let (axes, radius_m) = ranges(&config)?;
        let rounded = |place: Place| Place::of(place.numbers().map(|x| f64::from(single(x))));
        let points = points.into_iter();
        Ok(Self {
            plan_hash: plan.hash(),
            radius_m,
            axes,
            points: points.map(|(at, counts)| (rounded(at), counts)).collect(),
            config,
        })
    }

    /// The points of a run.
    ///
    /// # Errors
    /// [`FitError::NotADesign`].
    pub fn of(results: &Results) -> Result<Self, FitError> {
        let points = results
            .rows
            .each()
            .map(|row| Ok((place(&row)?, count(&row))));
        Self::new(results.config.clone(), points.collect::<Result<_, _>>()?)
    }

    /// The config, TOML.
    pub fn config(&self) -> &str {
        &self.config
    }

    /// The hash of its plan.
    pub fn plan_hash(&self) -> &str {
        &self.plan_hash
    }

    /// Radius of the coin, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Its ranges, in the order of [`Place::NAMES`].
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Coins and surfaces, and what the tosses there showed.
    pub fn points(&self) -> &[(Place, Counts)] {
        &self.points
    }
}

fn place(row: &Row) -> Result<Place, FitError> {
    let mut numbers = [0.0; Place::NAMES.len()];
    for (number, name) in numbers.iter_mut().zip(Place::NAMES) {
        let value = row.parameter(name);
        *number = value.ok_or_else(|| FitError::NotADesign(format!("no `{name}` is swept")))?;
    }
    Ok(Place::of(numbers))
}

fn count(row: &Row) -> Counts {
    let tally = &row.tally;
    Counts {
        faces: [tally.heads, tally.tails, tally.side],
        undecided: tally.undecided(),
    }
}

/// The ranges of a config, in the order of [`Place::NAMES`], and the radius of its coin.
fn ranges(config: &str) -> Result<(Vec<Axis>, f64), FitError> {
    let wrong = |why: &str| FitError::NotADesign(why.to_owned());
    let config = DeTable::parse(config).map_err(|_| wrong("it is no TOML"))?;
    let config = config.get_ref();
    let at = |table: &str, key: &str| inner(config.get(table)?.get_ref(), key);
    if at("sweep", "mode").and_then(DeValue::as_str) != Some("sobol") {
        return Err(wrong("its mode is another"));
    }
    let mut axes = Vec::new();
    for name in Place::NAMES {
        let table = if name == "ratio" { "coin" } else { "surface" };
        let range = at(table, name).and_then(|value| axis(name, value));
        axes.push(range.ok_or_else(|| wrong(&format!("`{table}.{name}` is no range")))?);
    }
    let radius_m = at("coin", "radius_m").and_then(float);
    let radius_m = radius_m.ok_or_else(|| wrong("`coin.radius_m` is no number"))?;
    Ok((axes, radius_m))
}

fn inner<'a, 'i>(table: &'a DeValue<'i>, key: &str) -> Option<&'a DeValue<'i>> {
    match table {
        DeValue::Table(entries) => entries.get(key).map(Spanned::get_ref),
        _ => None,
    }
}

fn float(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        _ => None,
    }
}

fn axis(name: &str, range: &DeValue<'_>) -> Option<Axis> {
    Some(Axis {
        name: name.to_owned(),
        from: float(inner(range, "from")?)?,
        to: float(inner(range, "to")?)?,
        log: inner(range, "scale").and_then(DeValue::as_str) == Some("log"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Launch;
    use coinmc::config::Override;

    #[test]
    fn configs_that_are_no_design_are_refused() {
        for (config, why) in [
            ("", "its mode is another"),
            ("[sweep]\nmode = 'zip'", "its mode is another"),
            ("[sweep]\nmode = 'sobol'", "`coin.ratio` is no range"),
            ("[[", "it is no TOML"),
        ] {
            let error = ranges(config).unwrap_err().to_string();
            assert!(error.ends_with(why), "{error}");
        }
        assert!(Design::new("[[".to_owned(), vec![]).is_err());
    }

    #[test]
    fn all_designs_have_the_same_axes() {
        let designs = Launch::ALL.map(|launch| {
            let plan = config::parse(launch.name(), launch.design(), &[]).unwrap();
            Design::new(plan.resolved_toml, vec![]).unwrap()
        });
        let first = &designs[0];
        assert!(designs.iter().all(|design| design.axes() == first.axes()));
        assert!(
            designs
                .iter()
                .all(|design| design.radius_m() == first.radius_m())
        );
    }

    /// A design has the plan, and so the hash, of the run that its config describes: also with the resolved config that a
    /// run keeps.
    #[test]
    fn a_design_has_the_hash_of_its_run() {
        let seed = ["seed=3".parse::<Override>().unwrap()];
        let plan = config::parse("hand", Launch::Hand.design(), &seed).unwrap();
        let design = Design::new(plan.resolved_toml.clone(), vec![]).unwrap();
        assert_eq!(design.plan_hash(), plan.hash());
        let other = Design::new(Launch::Hand.design().to_owned(), vec![]).unwrap();
        assert_ne!(design.plan_hash(), other.plan_hash());
    }

    /// A run and its table, which has single precision, are the same design.
    #[test]
    fn points_are_rounded_as_in_tables() {
        let place = Place::of([0.8, 0.5, 0.3, 0.01, 0.001, 0.02, 0.003]);
        let config = Launch::Hand.design();
        let design = Design::new(config.to_owned(), vec![(place, Counts::default())]).unwrap();
        let (rounded, _) = design.points()[0];
        assert_ne!(rounded, place);
        let again = Design::new(config.to_owned(), design.points().to_vec()).unwrap();
        assert_eq!(again, design);
    }
}
