//! The least-squares problem: from shared parameters and initial states to weighted residuals.

use super::loss::Loss;
use crate::drop::{Coordinate, FilmedDrop, wrapped};
use crate::law::Model;
use crate::parameter::{Parameter, Shared};
use crate::path::{Path, Start, path, start_scales};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra_lm::storage::Owned;
use nalgebra_lm::{DMatrix, DMatrixViewMut, DVector, Dyn};

/// Step of the central differences, in units of the search: the cube root of a path's rounding
/// error, where truncation and rounding errors are about equal.
const STEP: f64 = 1e-5;

/// If the squared derivatives to one side exceed those to the other by this factor, the path is
/// discontinuous on that side. (Over a step of this size a derivative normally changes by 1e-4.)
const JUMP: f64 = 4.0;

/// The data that are fixed while a law is fitted.
#[derive(Debug, Clone)]
pub(crate) struct Task<'a> {
    pub(crate) model: Model,
    pub(crate) drops: &'a [FilmedDrop],
    /// Times of the frames since the first, per drop.
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

    /// Whether a drop's x was marked at all; otherwise its x position is undetermined.
    fn has_x(&self, drop: usize) -> bool {
        let x = Coordinate::X.index();
        self.drops[drop].frames.iter().any(|f| f.seen[x].is_some())
    }
}

/// A point of the search: shared parameters and initial states.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    pub(crate) shared: Shared,
    pub(crate) starts: Vec<Start>,
}

/// The frames that count and their weights.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weighing {
    /// Number of frames of each drop that count.
    pub(crate) frames: Vec<usize>,
    /// Standard deviation of each coordinate.
    pub(crate) sigma: [f64; 3],
}

/// A fitted number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unknown {
    Shared(Parameter),
    /// Index of the drop and index in its [`Start`].
    Start(usize, usize),
}

/// A task at a point, for the optimiser.
#[derive(Debug, Clone)]
pub(crate) struct Problem<'a> {
    pub(crate) task: &'a Task<'a>,
    pub(crate) weighing: Weighing,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) point: Point,
    /// Whether a long search is worthwhile: a path is cheap, and the law may be the right one.
    pub(crate) thorough: bool,
}

/// One residual: its position, and the observed minus the predicted value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    pub(crate) drop: usize,
    pub(crate) frame: usize,
    pub(crate) coordinate: Coordinate,
    /// m or rad.
    pub(crate) by: f64,
}

impl<'a> Problem<'a> {
    /// The problem with these shared parameters and all initial states unknown.
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

    /// Number of attempts, given the usual number.
    pub(crate) fn tries(&self, usual: u64) -> u64 {
        if self.thorough {
            usual
        } else {
            usual.div_ceil(8)
        }
    }

    /// Half the sum of the folded residuals' squares: Σρ. Infinite if there is no prediction.
    pub(crate) fn cost(&self) -> f64 {
        self.deviations().map_or(f64::INFINITY, |deviations| {
            deviations
                .iter()
                .map(|deviation| self.task.loss.rho(self.weighted(deviation)))
                .sum()
        })
    }

    pub(crate) fn weighted(&self, deviation: &Deviation) -> f64 {
        deviation.by / self.weighing.sigma[deviation.coordinate.index()]
    }

    /// All residuals, ordered by drop and frame.
    pub(crate) fn deviations(&self) -> Option<Vec<Deviation>> {
        let mut deviations = Vec::new();
        for drop in 0..self.task.drops.len() {
            self.deviations_of(drop, &self.point, &mut deviations)?;
        }
        Some(deviations)
    }

    fn deviations_of(
        &self,
        drop: usize,
        point: &Point,
        deviations: &mut Vec<Deviation>,
    ) -> Option<()> {
        let frames = self.weighing.frames[drop];
        let path = self.task.path(drop, point, frames)?;
        let filmed = &self.task.drops[drop].frames[..frames];
        for (frame, (seen, predicted)) in filmed.iter().zip(&path.seen).enumerate() {
            for coordinate in Coordinate::ALL {
                let c = coordinate.index();
                let Some(value) = seen.seen[c] else { continue };
                let deviation = match coordinate {
                    Coordinate::Theta => wrapped(value - predicted[c]),
                    Coordinate::X | Coordinate::Z => value - predicted[c],
                };
                if !deviation.is_finite() {
                    return None;
                }
                deviations.push(Deviation {
                    drop,
                    frame,
                    coordinate,
                    by: deviation,
                });
            }
        }
        Some(())
    }

    /// The unit of the search for an unknown.
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

    /// A point with one unknown changed by this multiple of its unit, clamped to its range.
    fn moved(&self, unknown: Unknown, by: f64) -> (Point, f64) {
        let (before, scale) = (self.value(unknown), self.scale(unknown));
        let mut point = self.point.clone();
        set(&mut point, unknown, before + by * scale);
        point.shared = point.shared.clamped();
        let after = get(&point, unknown);
        (point, (after - before) / scale)
    }

    /// Changes all unknowns by a multiple of a direction in units of the search.
    pub(crate) fn shift(&mut self, direction: &[f64], by: f64) {
        for (i, unknown) in self.unknowns.clone().into_iter().enumerate() {
            let value = self.value(unknown) + by * direction[i] * self.scale(unknown);
            set(&mut self.point, unknown, value);
        }
        self.point.shared = self.point.shared.clamped();
    }

    /// Derivatives of the weighted residuals with respect to the unknowns (in units of the search),
    /// by differences: see [`slope`]. An initial state affects only its own drop.
    pub(crate) fn derivatives(&self) -> Option<DMatrix<f64>> {
        let base = self.deviations()?;
        let mut matrix = DMatrix::zeros(base.len(), self.unknowns.len());
        let mut rows = Vec::with_capacity(self.task.drops.len() + 1);
        rows.push(0);
        for drop in 0..self.task.drops.len() {
            rows.push(base.partition_point(|deviation| deviation.drop <= drop));
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
                self.deviations_of(drop, &up, &mut above)?;
                self.deviations_of(drop, &down, &mut below)?;
                let here = &base[rows[drop]..rows[drop + 1]];
                let changes = |moved: &[Deviation]| -> Vec<f64> {
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

    /// The weighted difference between two residuals of the same observation.
    fn change(&self, to: &Deviation, from: &Deviation) -> f64 {
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
        // the last step may have been rejected
        if after.cost() <= before.cost() {
            after
        } else {
            before
        }
    }
}

/// Derivatives from a step up and a step down: central differences, unless one of the steps crosses
/// a discontinuity where the order of impacts changes; then the one-sided difference of the other.
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
        let deviations = self.deviations()?;
        let folded = deviations
            .iter()
            .map(|m| self.task.loss.folded(self.weighted(m)).0);
        Some(DVector::from_iterator(deviations.len(), folded))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let mut matrix = self.derivatives()?;
        if self.task.loss == Loss::Huber {
            for (row, deviation) in self.deviations()?.iter().enumerate() {
                let slope = self.task.loss.folded(self.weighted(deviation)).1;
                matrix.row_mut(row).scale_mut(slope);
            }
        }
        Some(matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slopes of residuals that change by these over steps of ±1/8.
    fn slopes<const N: usize>(up: [f64; N], down: [f64; N]) -> [f64; N] {
        let mut matrix = DMatrix::zeros(N, 1);
        slope(
            (&up, 0.125),
            (&down, -0.125),
            matrix.view_mut((0, 0), (N, 1)),
        );
        std::array::from_fn(|i| matrix[i])
    }

    /// y = 3 s + 8 s² and y = −s: the central difference leaves out what is even.
    #[test]
    fn a_slope_is_the_central_difference() {
        assert_eq!(slopes([0.5, -0.125], [-0.25, 0.125]), [3.0, -1.0]);
    }

    /// Of changes whose squares differ more than fourfold, the greater ones cross a leap; signs do not matter.
    #[test]
    fn a_slope_across_a_leap_is_that_of_the_other_side() {
        assert_eq!(slopes([0.5, -0.5], [-0.125, 0.25]), [1.0, -2.0]);
        assert_eq!(slopes([0.125, 0.25], [0.5, -0.5]), [1.0, 2.0]);
        let (near, beyond) = (0.249, 0.251);
        assert_eq!(
            slopes([near, -near], [-0.125, 0.125]),
            [0.374 / 0.25, -0.374 / 0.25]
        );
        assert_eq!(slopes([beyond, -beyond], [-0.125, 0.125]), [1.0, -1.0]);
        assert_eq!(
            slopes([0.125, -0.125], [-near, near]),
            [0.374 / 0.25, -0.374 / 0.25]
        );
        assert_eq!(slopes([0.125, -0.125], [-beyond, beyond]), [1.0, -1.0]);
    }

    /// Near the end of a range one step is shorter: changes are compared by the way that they take. From slopes of 2 and 3
    /// over ways of 4 : 1 the central difference makes 2.2.
    #[test]
    fn slopes_are_compared_by_their_steps() {
        let mut matrix = DMatrix::zeros(1, 1);
        slope(
            (&[1.0], 0.5),
            (&[-0.375], -0.125),
            matrix.view_mut((0, 0), (1, 1)),
        );
        assert!((matrix[0] - 2.2).abs() < 1e-15);
    }

    /// At the end of a parameter's range there is no step to one side.
    #[test]
    fn a_slope_at_the_end_of_a_range_is_that_of_the_side_within() {
        let mut matrix = DMatrix::zeros(1, 2);
        slope(
            (&[0.0], 0.0),
            (&[-0.5], -0.125),
            matrix.view_mut((0, 0), (1, 1)),
        );
        slope(
            (&[0.5], 0.25),
            (&[0.0], 0.0),
            matrix.view_mut((0, 1), (1, 1)),
        );
        assert_eq!([matrix[0], matrix[1]], [4.0, 2.0]);
    }

    /// An angle that goes once round between two paths has not changed by 2π.
    #[test]
    fn changes_of_angles_have_no_whole_turns() {
        let drops = [];
        let model = crate::fit::tests::model();
        let task = Task::new(model, &drops, Loss::Square);
        let point = Point {
            shared: Shared::default(),
            starts: Vec::new(),
        };
        let weighing = Weighing {
            frames: Vec::new(),
            sigma: [0.5, 0.25, 0.125],
        };
        let problem = Problem::new(&task, weighing, &[], point);
        let of = |coordinate, by| Deviation {
            drop: 0,
            frame: 0,
            coordinate,
            by,
        };
        let change = |coordinate| problem.change(&of(coordinate, 3.0), &of(coordinate, -3.0));
        assert_eq!(change(Coordinate::X), 12.0);
        assert_eq!(change(Coordinate::Z), 24.0);
        let angle = change(Coordinate::Theta);
        assert!((angle - (6.0 - std::f64::consts::TAU) / 0.125).abs() < 1e-14);
    }
}
