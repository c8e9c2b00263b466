//! The axes of a sweep and the points they span.

use super::build::integer;
use super::checked::{COMPONENTS, Checked, CheckedValue};
use super::diagnostics::Problems;
use super::quantity::Quantity;
use super::source::Span;
use crate::plan::MAX_POINTS;
use coinmc_core::{Domain, Stream, unit_interval};
use coinmc_quadrature::{DIMENSIONS, Sobol};

/// Number of the stream that scrambles the points of a design; no point of a plan has it.
const SCRAMBLE: u64 = u64::MAX;

/// One swept number.
#[derive(Debug)]
pub(super) struct Axis {
    /// The name of its column.
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// How the axes combine.
#[derive(Debug)]
pub(super) struct Sweep {
    pub(super) axes: Vec<Axis>,
    pub(super) points: usize,
    grid: bool,
}

impl Sweep {
    /// No axis: a single point.
    pub(super) fn none() -> Self {
        Self {
            axes: vec![],
            points: 1,
            grid: true,
        }
    }

    /// Finds every swept number (in the order of the schema, so that the order of keys in the
    /// file does not matter), numbers them, and writes their values out if they are not too many.
    pub(super) fn find(root: &mut Checked, problems: &mut Problems) -> Option<Self> {
        let mode = root
            .get("sweep")
            .and_then(|sweep| sweep.get("mode"))
            .map(Checked::word)??;
        let mut found = Vec::new();
        collect(root, &mut Vec::new(), &mut found);
        let points = match mode {
            "zip" => zipped("zipped axes", &found, problems),
            "sobol" => spread(&found, problems),
            _ => gridded(&found, problems),
        }?;
        let values: Vec<Vec<f64>> = match mode {
            "sobol" => designed(&found, points, integer(root, "seed")?),
            _ => found.iter().map(|axis| axis.quantity.values()).collect(),
        };
        let mut distinct = true;
        let axes = found
            .into_iter()
            .zip(values)
            .map(|(axis, values)| {
                if has_duplicates(&values) {
                    let message = format!(
                        "the {} values of `{}` lie closer together than numbers can",
                        values.len(),
                        axis.name
                    );
                    problems.add_with_help(axis.span, message, "use fewer steps or a wider range");
                    distinct = false;
                }
                Axis {
                    name: axis.name,
                    values,
                }
            })
            .collect();
        let grid = !matches!(mode, "zip" | "sobol");
        distinct.then_some(Self { axes, points, grid })
    }

    /// Index of the value of each axis at point number `point`.
    pub(super) fn indices(&self, point: usize, indices: &mut Vec<usize>) {
        indices.clear();
        indices.resize(self.axes.len(), point);
        if self.grid {
            let mut rest = point;
            for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
                *index = rest % axis.values.len();
                rest /= axis.values.len();
            }
        }
    }
}

/// A swept number before its values are written out.
struct Found {
    name: String,
    quantity: Quantity,
    span: Span,
}

fn collect(checked: &mut Checked, path: &mut Vec<&'static str>, found: &mut Vec<Found>) {
    match &mut checked.value {
        CheckedValue::Number(quantity, axis) if quantity.len() > 1 => {
            *axis = Some(found.len());
            let quantity = quantity.clone();
            found.push(Found {
                name: column(path),
                quantity,
                span: checked.span,
            });
        }
        CheckedValue::Table(entries) => {
            for (key, inner) in entries {
                path.push(key);
                collect(inner, path, found);
                path.pop();
            }
        }
        CheckedValue::Tagged(tag, inner) => {
            path.push(tag);
            collect(inner, path, found);
            path.pop();
        }
        CheckedValue::Vector(components) => {
            for (name, inner) in COMPONENTS.iter().zip(components) {
                path.push(name);
                collect(inner, path, found);
                path.pop();
            }
        }
        _ => {}
    }
}

/// Column names: the bare key for parameters of the scene, the whole path for the others.
fn column(path: &[&'static str]) -> String {
    match path {
        ["coin" | "surface" | "environment", key] => (*key).to_owned(),
        _ => path.join("."),
    }
}

fn gridded(found: &[Found], problems: &mut Problems) -> Option<usize> {
    let product = found
        .iter()
        .try_fold(1_u64, |n, axis| n.checked_mul(axis.quantity.len()));
    match product {
        Some(points) if points <= MAX_POINTS => usize::try_from(points).ok(),
        _ => {
            let longest = found.iter().max_by_key(|axis| axis.quantity.len())?;
            let count = product.map_or("more than 10^19".to_owned(), |n| n.to_string());
            let factors: Vec<String> = found
                .iter()
                .map(|a| format!("{} {}", a.name, a.quantity.len()))
                .collect();
            let message = format!(
                "the sweep has {count} points ({}), at most {MAX_POINTS} are allowed",
                factors.join(" × ")
            );
            problems.add_with_help(longest.span, message, "use fewer steps, or mode = \"zip\"");
            None
        }
    }
}

fn zipped(what: &str, found: &[Found], problems: &mut Problems) -> Option<usize> {
    let Some(first) = found.first() else {
        return Some(1);
    };
    let mut equal = true;
    for axis in &found[1..] {
        if axis.quantity.len() != first.quantity.len() {
            let message = format!(
                "{what} must be equally long: `{}` has {} values, `{}` has {}",
                axis.name,
                axis.quantity.len(),
                first.name,
                first.quantity.len()
            );
            problems.add(axis.span, message);
            equal = false;
        }
    }
    if equal {
        usize::try_from(first.quantity.len()).ok()
    } else {
        None
    }
}

/// The number of points of a design: that of the steps of each of its ranges.
fn spread(found: &[Found], problems: &mut Problems) -> Option<usize> {
    let mut sound = true;
    for axis in found {
        // A range of two steps is a list by its canonical form.
        if !matches!(axis.quantity, Quantity::Range(range) if range.steps > 2) {
            let message = format!("`{}` must be a range of at least three steps", axis.name);
            let help = "mode = \"sobol\" takes points between the ends of ranges";
            problems.add_with_help(axis.span, message, help);
            sound = false;
        }
    }
    if let Some(axis) = found.get(DIMENSIONS) {
        let message = format!(
            "{} axes: mode = \"sobol\" spreads at most {DIMENSIONS}",
            found.len()
        );
        problems.add(axis.span, message);
        sound = false;
    }
    let points = zipped("ranges of a design", found, problems)?;
    sound.then_some(points)
}

/// The values of each axis at scrambled Sobol points: they fill the box between the ends of all ranges
/// evenly, and so do the first 2^n of them for every n.
fn designed(found: &[Found], points: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut words = Stream::new(seed, Domain::Scramble, SCRAMBLE).toss(0);
    let sobol = Sobol::scrambled(found.len(), &mut words);
    let coordinates: Vec<_> = sobol.points(0..points as u64).collect();
    let along = |(axis, found): (usize, &Found)| match &found.quantity {
        Quantity::Range(range) => coordinates
            .iter()
            .map(|point| range.between(unit_interval(point[axis])))
            .collect(),
        other => other.values(),
    };
    found.iter().enumerate().map(along).collect()
}

fn has_duplicates(values: &[f64]) -> bool {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}
