//! The result of a fit.

use super::covariance::{Spread, of};
use super::problem::{Deviation, Problem, Unknown};
use super::search::early;
use super::{Loss, Options, Remark};
use crate::drop::Coordinate;
use crate::law::Model;
use crate::parameter::{Parameter, Shared};
use coinmc_core::student_t_quantile;

/// A fitted shared parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// The parameter.
    pub parameter: Parameter,
    /// The best value. If one end of the interval is open, all values beyond the other end fit
    /// equally well.
    pub value: f64,
    /// Standard error by linear theory, if there is one.
    pub std_error: Option<f64>,
    /// Lower end of the profile-likelihood interval; `None`: open.
    pub lo: Option<f64>,
    /// Upper end.
    pub hi: Option<f64>,
}

impl Estimated {
    /// Whether the film bounds it on both sides.
    pub fn is_determined(&self) -> bool {
        self.lo.is_some() && self.hi.is_some()
    }
}

/// A fitted drop.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedDrop {
    /// Its name.
    pub name: String,
    /// x, x', z above the surface, z', θ, θ' at the first frame: m, m/s, rad, rad/s.
    pub start: [f64; 6],
    /// Half the width of each interval, by linear theory; `None` if the film does not determine it.
    pub half_width: [Option<f64>; 6],
    /// Number of frames that count.
    pub frames: usize,
    /// Number of all frames.
    pub of_frames: usize,
    /// Times of the impacts within the frames that count, since the first frame, s.
    pub impacts_s: Vec<f64>,
}

/// Noise of one coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// The coordinate.
    pub coordinate: Coordinate,
    /// Number of points.
    pub n: usize,
    /// Standard deviation, m or rad.
    pub sigma: f64,
    /// Correlation of the residuals of successive frames.
    pub correlation: f64,
}

/// One residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Index of the drop.
    pub drop: usize,
    /// Index of the frame.
    pub frame: usize,
    /// Time in the film, s.
    pub time_s: f64,
    /// The coordinate.
    pub coordinate: Coordinate,
    /// Marked value, m or rad.
    pub seen: f64,
    /// Observed minus predicted value, m or rad (angles without whole turns).
    pub residual: f64,
    /// The same in standard deviations.
    pub standardised: f64,
}

/// A law fitted to drops.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Law, coin and gravity.
    pub model: Model,
    /// The fitted parameters.
    pub parameters: Vec<Estimated>,
    /// All parameters, fitted and given.
    pub shared: Shared,
    /// The drops.
    pub drops: Vec<FittedDrop>,
    /// The noise of each marked coordinate.
    pub noise: Vec<Noise>,
    /// Number of points that count.
    pub n: usize,
    /// Number of fitted numbers: parameters, initial states and noise.
    pub fitted: usize,
    /// Logarithm of the maximum likelihood.
    pub log_likelihood: f64,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Remarks for the reader.
    pub remarks: Vec<Remark>,
    /// Every residual.
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The estimate of a parameter, if it was fitted.
    pub fn estimate(&self, parameter: Parameter) -> Option<&Estimated> {
        self.parameters.iter().find(|e| e.parameter == parameter)
    }

    /// Akaike information criterion 2k − 2 ln L.
    pub fn aic(&self) -> f64 {
        2.0 * (self.fitted as f64 - self.log_likelihood)
    }

    /// Bayesian information criterion k ln n − 2 ln L.
    pub fn bic(&self) -> f64 {
        self.fitted as f64 * libm::log(self.n as f64) - 2.0 * self.log_likelihood
    }
}

/// Assembles the result; `None` if the computation fails.
pub(super) fn report(
    problem: &Problem,
    spread: &Spread,
    ends: &[(Option<f64>, Option<f64>)],
    options: &Options,
) -> Option<Fit> {
    let deviations = problem.deviations()?;
    let noise = noise(problem, &deviations);
    let mut fit = Fit {
        model: problem.task.model,
        parameters: estimates(problem, spread, ends),
        shared: problem.point.shared,
        drops: drops(problem, spread, options)?,
        log_likelihood: log_likelihood(problem.task.loss, &deviations),
        n: deviations.len(),
        fitted: fitted(problem, &deviations),
        noise,
        confidence: options.confidence,
        remarks: Vec::new(),
        residuals: residuals(problem, &deviations),
    };
    fit.remarks = remarks(&fit, problem.task.loss);
    Some(fit)
}

/// Number of fitted values: the unknowns, and the noise of each coordinate.
pub(super) fn fitted(problem: &Problem, deviations: &[Deviation]) -> usize {
    let noises = Coordinate::ALL.into_iter();
    let noises = noises.filter(|coordinate| !of(deviations, *coordinate).is_empty());
    problem.unknowns.len() + noises.count()
}

fn estimates(
    problem: &Problem,
    spread: &Spread,
    ends: &[(Option<f64>, Option<f64>)],
) -> Vec<Estimated> {
    let unknowns = problem.unknowns.iter().zip(&spread.errors);
    let shared = unknowns.filter_map(|(unknown, error)| match unknown {
        Unknown::Shared(parameter) => Some((*parameter, *error)),
        Unknown::Start(..) => None,
    });
    shared
        .enumerate()
        .map(|(i, (parameter, std_error))| {
            let (lo, hi) = ends.get(i).copied().unwrap_or((None, None));
            Estimated {
                parameter,
                value: problem.point.shared.get(parameter),
                std_error,
                lo,
                hi,
            }
        })
        .collect()
}

fn drops(problem: &Problem, spread: &Spread, options: &Options) -> Option<Vec<FittedDrop>> {
    let task = problem.task;
    let t = student_t_quantile(spread.degrees(), 0.5 * (1.0 - options.confidence));
    let early = early(problem)?;
    let mut drops = Vec::new();
    for (d, filmed) in task.drops.iter().enumerate() {
        let frames = problem.weighing.frames[d];
        let last = task.times[d].get(frames.saturating_sub(1)).copied()?;
        let mut impacts_s = task.path(d, &problem.point, frames)?.impacts_s;
        impacts_s.retain(|impact| *impact <= last);
        let mut half_width = [None; 6];
        for (i, unknown) in problem.unknowns.iter().enumerate() {
            if let Unknown::Start(of, place) = unknown
                && *of == d
            {
                let (error, early) = (spread.errors[i], early.errors[i]);
                half_width[*place] = error.map(|error| t * trusted(error, early));
            }
        }
        drops.push(FittedDrop {
            name: filmed.name.clone(),
            start: problem.point.starts[d],
            half_width,
            frames,
            of_frames: filmed.frames.len(),
            impacts_s,
        });
    }
    Some(drops)
}

/// The standard error of an initial state. Each impact amplifies the difference between two starts,
/// so after some impacts only starts in a narrow, winding valley fit the film: linear theory sees
/// its width but not its length. If frames long after the first impact seem to reduce an error
/// much, the error from the earlier frames is used instead.
fn trusted(error: f64, early: Option<f64>) -> f64 {
    /// The greatest reduction that is trusted.
    const NARROWED: f64 = 0.7;
    early
        .filter(|early| error < NARROWED * early)
        .unwrap_or(error)
}

/// ln of the density of the residuals at the noise that maximises it.
fn log_likelihood(loss: Loss, deviations: &[Deviation]) -> f64 {
    let mut sum = 0.0;
    for coordinate in Coordinate::ALL {
        let residuals = of(deviations, coordinate);
        let n = residuals.len() as f64;
        if residuals.is_empty() {
            continue;
        }
        let sigma = loss.scale(&residuals, n).max(f64::MIN_POSITIVE);
        let cost: f64 = residuals.iter().map(|r| loss.rho(r / sigma)).sum();
        sum -= n * (libm::log(sigma) + loss.log_normaliser()) + cost;
    }
    sum
}

fn noise(problem: &Problem, deviations: &[Deviation]) -> Vec<Noise> {
    Coordinate::ALL
        .into_iter()
        .filter_map(|coordinate| {
            let n = of(deviations, coordinate).len();
            (n > 0).then(|| Noise {
                coordinate,
                n,
                sigma: problem.weighing.sigma[coordinate.index()],
                correlation: correlation(deviations, coordinate),
            })
        })
        .collect()
}

/// Correlation of a coordinate's residuals in successive frames.
fn correlation(deviations: &[Deviation], coordinate: Coordinate) -> f64 {
    let of_it: Vec<&Deviation> = deviations
        .iter()
        .filter(|m| m.coordinate == coordinate)
        .collect();
    let squares: f64 = of_it.iter().map(|m| m.by * m.by).sum();
    let products: f64 = of_it
        .windows(2)
        .filter(|pair| pair[0].drop == pair[1].drop && pair[0].frame + 1 == pair[1].frame)
        .map(|pair| pair[0].by * pair[1].by)
        .sum();
    if squares > 0.0 {
        products / squares
    } else {
        0.0
    }
}

fn residuals(problem: &Problem, deviations: &[Deviation]) -> Vec<Residual> {
    deviations
        .iter()
        .filter_map(|deviation| {
            let frame = &problem.task.drops[deviation.drop].frames[deviation.frame];
            Some(Residual {
                drop: deviation.drop,
                frame: deviation.frame,
                time_s: frame.time_s,
                coordinate: deviation.coordinate,
                seen: frame.seen[deviation.coordinate.index()]?,
                residual: deviation.by,
                standardised: problem.weighted(deviation),
            })
        })
        .collect()
}

fn remarks(fit: &Fit, loss: Loss) -> Vec<Remark> {
    /// Threshold; normal, independent noise exceeds it once in 15,000 per coordinate.
    const CORRELATED: f64 = 4.0;
    /// Threshold; normal noise exceeds it in six of ten million residuals.
    const OUTLYING: f64 = 5.0;
    let mut remarks = Vec::new();
    for drop in &fit.drops {
        if drop.impacts_s.is_empty() {
            let drop = drop.name.clone();
            remarks.push(Remark::NoImpact { drop });
        }
    }
    for estimate in &fit.parameters {
        let (low, high) = estimate.parameter.range();
        if !estimate.is_determined() {
            remarks.push(Remark::Undetermined(estimate.parameter));
        } else if estimate.value <= low || estimate.value >= high {
            remarks.push(Remark::AtTheEnd(estimate.parameter));
        }
    }
    for noise in &fit.noise {
        if noise.correlation > CORRELATED / (noise.n as f64).sqrt() {
            remarks.push(Remark::Correlated {
                coordinate: noise.coordinate,
                correlation: noise.correlation,
            });
        }
    }
    let count = fit
        .residuals
        .iter()
        .filter(|residual| residual.standardised.abs() > OUTLYING)
        .count();
    if count > 0 && loss == Loss::Square {
        remarks.push(Remark::Outliers { count });
    }
    remarks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::blank;

    /// Of n equal residuals n − 1 pairs agree, of alternating ones all differ; a gap or another drop parts them.
    #[test]
    fn the_correlation_is_that_of_successive_frames() {
        let of = |by: fn(usize) -> f64, frame: fn(usize) -> usize, drop: fn(usize) -> usize| {
            let deviations: Vec<Deviation> = (0..5)
                .map(|i| Deviation {
                    drop: drop(i),
                    frame: frame(i),
                    coordinate: Coordinate::Z,
                    by: by(i),
                })
                .collect();
            correlation(&deviations, Coordinate::Z)
        };
        let alternating = |i: usize| if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        assert_eq!(of(|_| 0.5, |i| i, |_| 0), 0.8);
        assert_eq!(of(alternating, |i| i, |_| 0), -0.8);
        assert_eq!(of(|_| 0.5, |i| 2 * i, |_| 0), 0.0);
        assert_eq!(of(|_| 0.5, |i| i, |i| i / 3), 0.6);
        assert_eq!(of(|_| 0.0, |i| i, |_| 0), 0.0);
    }

    /// An error that later frames make less than .7 of what it was is not believed.
    #[test]
    fn late_frames_may_narrow_a_start_only_so_far() {
        assert_eq!(trusted(0.75, Some(1.0)), 0.75);
        assert_eq!(trusted(0.65, Some(1.0)), 1.0);
        assert_eq!(trusted(1.3, Some(2.0)), 2.0);
        assert_eq!(trusted(3.0, Some(2.0)), 3.0);
        assert_eq!(trusted(0.1, None), 0.1);
    }

    fn noise_of(n: usize, correlation: f64) -> Noise {
        Noise {
            coordinate: Coordinate::X,
            n,
            sigma: 1.0,
            correlation,
        }
    }

    /// Correlations of n independent residuals scatter by 1/sqrt(n); more than four times that is told.
    #[test]
    fn correlated_residuals_are_told() {
        let told = |n, correlation| {
            let fit = Fit {
                noise: vec![noise_of(n, correlation)],
                ..blank()
            };
            !remarks(&fit, Loss::Square).is_empty()
        };
        assert_eq!(
            [
                told(100, 0.39),
                told(100, 0.41),
                told(1600, 0.11),
                told(1600, 0.09)
            ],
            [false, true, true, false]
        );
    }

    /// Residuals of more than five standard deviations are counted, unless the loss expects them.
    #[test]
    fn outliers_are_counted() {
        let residuals = [0.1, -5.1, 4.9, 7.0].map(|standardised| Residual {
            drop: 0,
            frame: 0,
            time_s: 0.0,
            coordinate: Coordinate::Z,
            seen: 0.0,
            residual: 0.0,
            standardised,
        });
        let fit = Fit {
            residuals: residuals.to_vec(),
            ..blank()
        };
        assert_eq!(remarks(&fit, Loss::Square), [Remark::Outliers { count: 2 }]);
        assert_eq!(remarks(&fit, Loss::Huber), []);
        assert_eq!(remarks(&blank(), Loss::Square), []);
    }

    /// An interval that ends on both sides around the end of a parameter's range, and one that does not.
    #[test]
    fn parameters_at_the_end_of_their_range_are_told() {
        let remark = |value, hi| {
            let estimate = Estimated {
                parameter: Parameter::Restitution,
                value,
                std_error: None,
                lo: Some(0.0),
                hi,
            };
            let fit = Fit {
                parameters: vec![estimate],
                ..blank()
            };
            remarks(&fit, Loss::Square)
        };
        let e = Parameter::Restitution;
        assert_eq!(remark(0.5, Some(0.75)), []);
        assert_eq!(remark(0.0, Some(0.75)), [Remark::AtTheEnd(e)]);
        assert_eq!(remark(1.0, Some(1.0)), [Remark::AtTheEnd(e)]);
        assert_eq!(remark(1.0, None), [Remark::Undetermined(e)]);
    }
}
