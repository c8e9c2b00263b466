//! Meaning and units of the columns.

use super::diagnostics::{Problems, quoted};
use super::header::{Column, Header};
use std::f64::consts::{FRAC_PI_2, PI};

/// The direction that the marked angle measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AngleOf {
    /// That of a line along the heads face, anticlockwise from the right: 0 if the coin lies heads
    /// up. A line or protractor along the coin's edge in Tracker shows this angle.
    #[default]
    Face,
    /// That of the coin's axis (outwards from the heads face), anticlockwise from the right.
    Axis,
    /// That of the axis, clockwise from the vertical: coinmc's θ.
    Tilt,
}

impl AngleOf {
    /// θ for a marked angle, both rad.
    pub(super) fn theta(self, marked: f64) -> f64 {
        match self {
            Self::Face => -marked,
            Self::Axis => FRAC_PI_2 - marked,
            Self::Tilt => marked,
        }
    }

    /// The marked angle for θ: each conversion is its own inverse.
    pub(super) fn marked(self, theta: f64) -> f64 {
        self.theta(theta)
    }
}

/// The columns and units to read. Those not given are found by the columns' names: `x`, `y`, `θ`
/// (or theta, angle, rotation, phi); units are taken from brackets after a name, or else are
/// metres, seconds and degrees, like Tracker's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Choice {
    /// Column of x, as `name` or `track.name`.
    pub x: Option<String>,
    /// Column of the height.
    pub y: Option<String>,
    /// Column of the angle.
    pub angle: Option<String>,
    /// Two tracks instead: points of the coin at equal distances on either side of its centre. The
    /// marked angle is the direction from the first to the second.
    pub ends: Option<(String, String)>,
    /// Unit of lengths, m.
    pub length_m: Option<f64>,
    /// Unit of angles, rad.
    pub angle_rad: Option<f64>,
    /// What the angle is the direction of.
    pub angle_of: AngleOf,
}

/// A column and its unit in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Picked {
    pub(super) index: usize,
    pub(super) unit: f64,
}

/// The columns of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Layout {
    /// x (optional), y and angle.
    Centre(Option<Picked>, Picked, Picked),
    /// x and y of two points.
    Ends([[Picked; 2]; 2]),
}

/// Names of units and their size in SI.
type Units = &'static [(&'static str, f64)];
const LENGTHS: Units = &[
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("in", 0.0254),
    ("ft", 0.3048),
];
const ANGLES: Units = &[
    ("°", PI / 180.0),
    ("deg", PI / 180.0),
    ("degree", PI / 180.0),
    ("degrees", PI / 180.0),
    ("rad", 1.0),
    ("radian", 1.0),
    ("radians", 1.0),
];
const TIMES: Units = &[("s", 1.0), ("ms", 1e-3), ("min", 60.0)];

/// Finds the columns in a header.
pub(super) struct Picker<'a, 'b, 'c> {
    pub(super) header: &'a Header,
    pub(super) choice: &'a Choice,
    pub(super) problems: &'b mut Problems<'c>,
}

impl Picker<'_, '_, '_> {
    /// The layout and the unit of time; `None` if there are problems.
    pub(super) fn layout(&mut self) -> Option<(Layout, f64)> {
        let time = self.unit(self.header.time, TIMES, None)?;
        let layout = if let Some((first, second)) = &self.choice.ends {
            let (first, second) = (self.point(first), self.point(second));
            Layout::Ends([first?, second?])
        } else {
            self.centre()?
        };
        Some((layout, time))
    }

    fn centre(&mut self) -> Option<Layout> {
        let y = match &self.choice.y {
            Some(name) => self.named(name),
            None => self.first("y", |column| column.is_named("y")),
        };
        // prefer x and angle of the same track
        let track = y.map(|y| self.header.columns[y].0.track.clone());
        let near = |wanted: &dyn Fn(&Column) -> bool| {
            let columns = || self.header.columns.iter();
            let of_track = |c: &Column| wanted(c) && Some(&c.track) == track.as_ref();
            columns()
                .position(|(column, _)| of_track(column))
                .or_else(|| columns().position(|(column, _)| wanted(column)))
        };
        let x = near(&|column| column.is_named("x"));
        let angle = near(&Column::is_angle);
        let x = match &self.choice.x {
            Some(name) => Some(self.named(name)),
            None => x.map(Some),
        };
        let angle = match (&self.choice.angle, angle) {
            (Some(name), _) => self.named(name),
            (None, Some(index)) => Some(index),
            (None, None) => self.first("the angle", Column::is_angle),
        };
        let length = self.choice.length_m;
        let x = match x {
            Some(x) => Some(self.picked(x?, LENGTHS, length)?),
            None => None,
        };
        let (y, angle) = (y?, angle?);
        Some(Layout::Centre(
            x,
            self.picked(y, LENGTHS, length)?,
            self.picked(angle, ANGLES, self.choice.angle_rad)?,
        ))
    }

    fn point(&mut self, track: &str) -> Option<[Picked; 2]> {
        let of = |name: &str| {
            let found = |c: &Column| same_track(&c.track, track) && c.is_named(name);
            self.header.columns.iter().position(|(c, _)| found(c))
        };
        let (Some(x), Some(y)) = (of("x"), of("y")) else {
            let message = format!("no track {} with columns x and y", quoted(track));
            self.report(message);
            return None;
        };
        let length = self.choice.length_m;
        Some([
            self.picked(x, LENGTHS, length)?,
            self.picked(y, LENGTHS, length)?,
        ])
    }

    fn named(&mut self, name: &str) -> Option<usize> {
        let columns = &self.header.columns;
        let found = columns
            .iter()
            .position(|(column, _)| same_track(&column.full_name(), name) || column.is_named(name));
        if found.is_none() {
            self.report(format!("there is no column {}", quoted(name)));
        }
        found
    }

    fn first(&mut self, what: &str, wanted: impl Fn(&Column) -> bool) -> Option<usize> {
        let found = self.header.columns.iter().position(|(c, _)| wanted(c));
        if found.is_none() {
            self.report(format!("there is no column for {what}"));
        }
        found
    }

    fn picked(&mut self, index: usize, units: Units, given: Option<f64>) -> Option<Picked> {
        let unit = self.unit(index, units, given)?;
        Some(Picked { index, unit })
    }

    fn unit(&mut self, index: usize, units: Units, given: Option<f64>) -> Option<f64> {
        let (column, place) = &self.header.columns[index];
        let Some(name) = &column.unit else {
            return Some(given.unwrap_or(units[0].1));
        };
        let known = units
            .iter()
            .find(|(unit, _)| unit.eq_ignore_ascii_case(name));
        if let Some((_, size)) = known {
            return Some(given.unwrap_or(*size));
        }
        if given.is_some() {
            return given;
        }
        let allowed: Vec<&str> = units.iter().map(|(unit, _)| *unit).collect();
        let message = format!(
            "the unit {} is not known; known units are {}",
            quoted(name),
            allowed.join(", ")
        );
        let help = name.to_lowercase().starts_with('p').then(|| {
            "lengths in pixels mean that the film is not calibrated: place a calibration stick in \
             Tracker"
                .to_owned()
        });
        let line = self.header.line;
        self.problems.add(line, place.clone(), message, help);
        None
    }

    /// Reports a problem with the header and lists its columns.
    fn report(&mut self, message: String) {
        let names: Vec<String> = self
            .header
            .columns
            .iter()
            .take(20)
            .map(|(column, _)| quoted(&column.full_name()))
            .collect();
        let end = self.header.columns.last().map_or(0, |(_, place)| place.end);
        let help = format!("the columns are {}: choose one by name", names.join(", "));
        self.problems
            .add(self.header.line, 0..end, message, Some(help));
    }
}

/// Tracker sometimes writes `mass A` as `mass_A`.
fn same_track(a: &str, b: &str) -> bool {
    a.replace('_', " ")
        .eq_ignore_ascii_case(&b.replace('_', " "))
}
