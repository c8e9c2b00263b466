//! The least-squares problem: from shared parameters and first states to weighted residuals.

use super::loss::Loss;
use crate::drop::{Coordinate, FilmedDrop, wrapped};
use crate::law::Model;
use crate::parameter::{Parameter, Shared};
use crate::path::{Path, Start, path, start_scales};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra_lm::storage::Owned;
use nalgebra_lm::{DMatrix, DMatrixViewMut, DVector, Dyn};

/// Step of the central differences, in the units of the search: the cube root of the rounding in a
/// path, where truncation and rounding are alike.
const STEP: f64 = 1e-5;

/// Where the squared derivatives to one side exceed those to the other by this factor, they are none:
/// the path jumps there. (Over a step of this size a derivative changes by its 1e-4th part, at rest
/// or in the wildest drop.)
const JUMP: f64 = 4.0;

/// Everything that is fixed while a law is fitted.
#[derive(Debug, Clone)]
pub(crate) struct Task<'a> {
    pub(crate) model: Model,
    pub(crate) drops: &'a [FilmedDrop],
    /// Times of the frames since the first, drop by drop.
    pub(crate) times: Vec<Vec<f64>>,
    pub(crate) loss: Loss,
}

impl<'a> Task<'a> {
    pub(crate) fn new(model: Model, drops: &'a [FilmedDrop], loss: Loss) -> Self {
        let times = drops
            .iter()
            .map(|drop| {
                let origin = drop.frames.first().map_or(0.0, |frame| frame.time_s);
                drop.frames.iter().map(|f| f.time_s - origin).collect()
            })
            .collect();
        Self {
            model,
            drops,
            times,
            loss,
        }
    }

    pub(crate) fn path(&self, drop: usize, point: &Point, frames: usize) -> Option<Path> {
        let at = &self.times[drop][..frames];
        path(&self.model, &point.shared, &point.starts[drop], at)
    }

    /// Whether a drop's x was marked at all; without it its position has no meaning.
    fn has_x(&self, drop: usize) -> bool {
        let x = Coordinate::X.index();
        self.drops[drop].frames.iter().any(|f| f.seen[x].is_some())
    }
}

/// Where the search is.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    pub(crate) shared: Shared,
    pub(crate) starts: Vec<Start>,
}

/// Which frames count, and how much.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weighing {
    /// Frames of each drop that count.
    pub(crate) frames: Vec<usize>,
    /// Standard deviations by coordinate.
    pub(crate) sigma: [f64; 3],
}

/// A number that is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unknown {
    Shared(Parameter),
    /// Drop and place in its [`Start`].
    Start(usize, usize),
}

/// A task at a point, as the optimiser sees it.
#[derive(Debug, Clone)]
pub(crate) struct Problem<'a> {
    pub(crate) task: &'a Task<'a>,
    pub(crate) weighing: Weighing,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) point: Point,
    /// Worth looking around at length: a path costs little, and the law may be the film's.
    pub(crate) thorough: bool,
}

/// One residual: where it belongs, and what was seen less what was predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Miss {
    pub(crate) drop: usize,
    pub(crate) frame: usize,
    pub(crate) coordinate: Coordinate,
    /// m or rad.
    pub(crate) by: f64,
}

impl<'a> Problem<'a> {
    /// With these shared parameters unknown, and every first state.
    pub(crate) fn new(
        task: &'a Task<'a>,
        weighing: Weighing,
        free: &[Parameter],
        point: Point,
    ) -> Self {
        let mut unknowns: Vec<Unknown> = free.iter().map(|p| Unknown::Shared(*p)).collect();
        for drop in 0..task.drops.len() {
            let first = usize::from(!task.has_x(drop));
            unknowns.extend((first..6).map(|place| Unknown::Start(drop, place)));
        }
        Self {
            task,
            weighing,
            unknowns,
            point,
            thorough: !task.model.is_costly(),
        }
    }

    /// How often to try where one would like to try so often.
    pub(crate) fn tries(&self, usual: u64) -> u64 {
        if self.thorough {
            usual
        } else {
            usual.div_ceil(8)
        }
    }

    /// Half the sum of the folded residuals' squares: Σρ. Infinite where nothing can be predicted.
    pub(crate) fn cost(&self) -> f64 {
        self.misses().map_or(f64::INFINITY, |misses| {
            misses
                .iter()
                .map(|miss| self.task.loss.rho(self.weighed(miss)))
                .sum()
        })
    }

    pub(crate) fn weighed(&self, miss: &Miss) -> f64 {
        miss.by / self.weighing.sigma[miss.coordinate.index()]
    }

    /// Every residual, drop by drop and frame by frame.
    pub(crate) fn misses(&self) -> Option<Vec<Miss>> {
        let mut misses = Vec::new();
        for drop in 0..self.task.drops.len() {
            self.misses_of(drop, &self.point, &mut misses)?;
        }
        Some(misses)
    }

    fn misses_of(&self, drop: usize, point: &Point, misses: &mut Vec<Miss>) -> Option<()> {
        let frames = self.weighing.frames[drop];
        let path = self.task.path(drop, point, frames)?;
        let filmed = &self.task.drops[drop].frames[..frames];
        for (frame, (seen, predicted)) in filmed.iter().zip(&path.seen).enumerate() {
            for coordinate in Coordinate::ALL {
                let c = coordinate.index();
                let Some(value) = seen.seen[c] else { continue };
                let miss = match coordinate {
                    Coordinate::Theta => wrapped(value - predicted[c]),
                    Coordinate::X | Coordinate::Z => value - predicted[c],
                };
                if !miss.is_finite() {
                    return None;
                }
                misses.push(Miss {
                    drop,
                    frame,
                    coordinate,
                    by: miss,
                });
            }
        }
        Some(())
    }

    /// What "one" means to the search.
    pub(crate) fn scale(&self, unknown: Unknown) -> f64 {
        match unknown {
            Unknown::Shared(parameter) => {
                let Model {
                    coin, gravity_m_s2, ..
                } = &self.task.model;
                parameter.scale(coin, *gravity_m_s2)
            }
            Unknown::Start(_, place) => start_scales(&self.task.model)[place],
        }
    }

    pub(crate) fn value(&self, unknown: Unknown) -> f64 {
        match unknown {
            Unknown::Shared(parameter) => self.point.shared.get(parameter),
            Unknown::Start(drop, place) => self.point.starts[drop][place],
        }
    }

    /// A point with one number moved by this much of its scale, kept in range.
    fn moved(&self, unknown: Unknown, by: f64) -> (Point, f64) {
        let (before, scale) = (self.value(unknown), self.scale(unknown));
        let mut point = self.point.clone();
        set(&mut point, unknown, before + by * scale);
        point.shared = point.shared.clamped();
        let after = get(&point, unknown);
        (point, (after - before) / scale)
    }

    /// Moves every unknown by a multiple of a direction given in units of the search.
    pub(crate) fn shift(&mut self, direction: &[f64], by: f64) {
        for (i, unknown) in self.unknowns.clone().into_iter().enumerate() {
            let value = self.value(unknown) + by * direction[i] * self.scale(unknown);
            set(&mut self.point, unknown, value);
        }
        self.point.shared = self.point.shared.clamped();
    }

    /// Derivatives of the weighed residuals by the unknowns (in units of their scales), by differences:
    /// see [`slope`]. A first state moves its own drop alone.
    pub(crate) fn derivatives(&self) -> Option<DMatrix<f64>> {
        let base = self.misses()?;
        let mut matrix = DMatrix::zeros(base.len(), self.unknowns.len());
        let mut rows = Vec::with_capacity(self.task.drops.len() + 1);
        rows.push(0);
        for drop in 0..self.task.drops.len() {
            rows.push(base.partition_point(|miss| miss.drop <= drop));
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (column, unknown) in self.unknowns.iter().enumerate() {
            let (up, by_up) = self.moved(*unknown, STEP);
            let (down, by_down) = self.moved(*unknown, -STEP);
            let drops = match unknown {
                Unknown::Shared(_) => 0..self.task.drops.len(),
                Unknown::Start(drop, _) => *drop..drop + 1,
            };
            for drop in drops {
                above.clear();
                below.clear();
                self.misses_of(drop, &up, &mut above)?;
                self.misses_of(drop, &down, &mut below)?;
                let here = &base[rows[drop]..rows[drop + 1]];
                let changes = |moved: &[Miss]| -> Vec<f64> {
                    let pairs = moved.iter().zip(here);
                    pairs
                        .map(|(moved, here)| self.change(moved, here))
                        .collect()
                };
                let column = matrix.view_mut((rows[drop], column), (here.len(), 1));
                slope(
                    (&changes(&above), by_up),
                    (&changes(&below), by_down),
                    column,
                );
            }
        }
        Some(matrix)
    }

    /// From one residual to another of the same point, weighed.
    fn change(&self, to: &Miss, from: &Miss) -> f64 {
        let change = match to.coordinate {
            Coordinate::Theta => wrapped(to.by - from.by),
            Coordinate::X | Coordinate::Z => to.by - from.by,
        };
        change / self.weighing.sigma[to.coordinate.index()]
    }

    /// Moves to the nearest minimum.
    pub(crate) fn minimise(self, patience: usize) -> Self {
        let solver = LevenbergMarquardt::new()
            .with_ftol(1e-10)
            .with_xtol(1e-9)
            .with_gtol(1e-9)
            .with_stepbound(1.0)
            .with_patience(patience);
        let before = self.clone();
        let (mut after, _) = solver.minimize(self);
        after.point.shared = after.point.shared.clamped();
        // the last step tried need not be a step taken
        if after.cost() <= before.cost() {
            after
        } else {
            before
        }
    }
}

/// Derivatives from the changes that a step up and a step down make: central ones, unless one of the
/// steps leads over a jump, where the order of impacts changes; then those of the other.
fn slope(
    (up, by_up): (&[f64], f64),
    (down, by_down): (&[f64], f64),
    mut column: DMatrixViewMut<f64>,
) {
    let steepness = |changes: &[f64], by: f64| {
        let squares: f64 = changes.iter().map(|change| change * change).sum();
        if by == 0.0 {
            f64::INFINITY
        } else {
            squares / (by * by)
        }
    };
    let (above, below) = (steepness(up, by_up), steepness(down, by_down));
    for (i, (a, b)) in up.iter().zip(down).enumerate() {
        column[i] = if above > JUMP * below {
            b / by_down
        } else if below > JUMP * above {
            a / by_up
        } else {
            (a - b) / (by_up - by_down)
        };
    }
}

fn set(point: &mut Point, unknown: Unknown, value: f64) {
    match unknown {
        Unknown::Shared(parameter) => point.shared = point.shared.with(parameter, value),
        Unknown::Start(drop, place) => point.starts[drop][place] = value,
    }
}

fn get(point: &Point, unknown: Unknown) -> f64 {
    match unknown {
        Unknown::Shared(parameter) => point.shared.get(parameter),
        Unknown::Start(drop, place) => point.starts[drop][place],
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        for (i, unknown) in self.unknowns.clone().into_iter().enumerate() {
            let scale = self.scale(unknown);
            set(&mut self.point, unknown, x[i] * scale);
        }
    }

    fn params(&self) -> DVector<f64> {
        let values = self
            .unknowns
            .iter()
            .map(|u| self.value(*u) / self.scale(*u));
        DVector::from_iterator(self.unknowns.len(), values)
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let misses = self.misses()?;
        let folded = misses
            .iter()
            .map(|m| self.task.loss.folded(self.weighed(m)).0);
        Some(DVector::from_iterator(misses.len(), folded))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let mut matrix = self.derivatives()?;
        if self.task.loss == Loss::Huber {
            for (row, miss) in self.misses()?.iter().enumerate() {
                let slope = self.task.loss.folded(self.weighed(miss)).1;
                matrix.row_mut(row).scale_mut(slope);
            }
        }
        Some(matrix)
    }
}
