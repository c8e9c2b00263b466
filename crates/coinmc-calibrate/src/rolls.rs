//! What coins that roll upright would tell of rough ground.
//!
//! A coin that rolls stays up or falls by the slope of the ground, and no ruler or ramp measures that. How
//! often it would stay up on the surfaces of the posterior is tossed; nothing is fitted.

use crate::CalibrationError;
use crate::model::Model;
use crate::posterior::{Posterior, moments};
use crate::tosses::{At, Faces, count, launches, point_with};
use coinmc_core::{Coin, Face, LaunchDistribution, Marginal, Orientation, Spin};
use coinmc_questions::Workers;
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

/// Rolls that a person would make.
pub(crate) const ROLLS: f64 = 60.0;
/// How fast a coin rolls from a hand, m/s.
const SPEED_M_S: f64 = 0.3;
/// How far from upright it begins, rad: two degrees.
const TILT_SD_RAD: f64 = std::f64::consts::PI / 90.0;
/// Draws of the posterior on whose surfaces coins roll.
const SURFACES: u64 = 256;
/// Fewest of them on which two rolls or more end on a face or the side.
const LEAST: usize = 32;

/// How the share of coins that stay up varies over the posterior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rolls {
    /// Variance of its probability.
    pub(crate) variance: f64,
    /// Covariance of that with the number that is to be sharpened.
    pub(crate) covariance: f64,
    /// Variance of a share of [`ROLLS`] about its probability.
    pub(crate) noise: f64,
}

impl Rolls {
    /// Lets coins roll on surfaces of the posterior, for each of which `side` has a number; also how many
    /// rolled. `None` if too few came to rest.
    ///
    /// # Errors
    /// [`CalibrationError`] if tosses fail or are stopped.
    pub(crate) fn of(
        model: &Model,
        posterior: &Posterior,
        side: &[f64],
        workers: &Workers<'_>,
    ) -> Result<(Option<Self>, u64), CalibrationError> {
        let plan = &model.observed.predicted;
        let parameters = model.parameters();
        let each = (model.settings.predicted / (8 * SURFACES)).max(4);
        let draws = posterior.draws.iter().zip(0..SURFACES);
        let work = draws.map(|(draw, k)| {
            let mut point = point_with(plan, &parameters, draw)?;
            point.launches = rolling(&point.scene.coin);
            Ok(At {
                point,
                tosses: k * each..(k + 1) * each,
            })
        });
        let work: Vec<At> = work.collect::<Result<_, CalibrationError>>()?;
        let faces = count(&work, &launches(plan.seed), workers)?;
        Ok((Self::counted(&faces, side), each * work.len() as u64))
    }

    /// By the faces on each surface. Few tosses each are enough: shares s of n tosses scatter about their
    /// probabilities p by p(1 − p)/n, of which s(1 − s)/(n − 1) is an unbiased estimate. It is subtracted from
    /// their variance; their covariance with other numbers it does not move.
    fn counted(faces: &[Faces], side: &[f64]) -> Option<Self> {
        let enough = faces
            .iter()
            .zip(side)
            .filter(|(faces, _)| faces.iter().sum::<u64>() > 1);
        let (mut shares, mut sides, mut scatter, mut alone) = (vec![], vec![], 0.0, 0.0);
        for (faces, side) in enough {
            let n = faces.iter().sum::<u64>() as f64;
            let share = faces[Face::Side as usize] as f64 / n;
            let spread = share * (1.0 - share) / (n - 1.0);
            scatter += spread;
            alone += spread * n;
            shares.push(share);
            sides.push(*side);
        }
        if shares.len() < LEAST {
            return None;
        }
        let n = shares.len() as f64;
        let ((mean, sd), (mean_side, _)) = (moments(&shares), moments(&sides));
        let products = shares.iter().zip(&sides);
        let products = products.map(|(share, side)| (share - mean) * (side - mean_side));
        Some(Self {
            variance: (sd * sd - scatter / n).max(0.0),
            covariance: products.sum::<f64>() / (n - 1.0),
            noise: alone / n / ROLLS,
        })
    }
}

/// A coin that a hand sets rolling, about upright.
fn rolling(coin: &Coin) -> LaunchDistribution {
    let still = Marginal::Constant(0.0);
    LaunchDistribution {
        // lifted until it touches
        height_m: still,
        velocity_m_s: [still, Marginal::Constant(SPEED_M_S), still],
        orientation: Orientation::Tilt(Marginal::Normal {
            mean: FRAC_PI_2,
            sd: TILT_SD_RAD,
        }),
        spin: Spin::About {
            axis: Vector3::x_axis(),
            rate_rad_s: Marginal::Constant(-SPEED_M_S / coin.radius_m()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Domain, Stream, UniformSource};

    /// Shares of few tosses, whose probabilities p are uniform from 0 to 1 and the side's p/4: the variance of p is
    /// 1/12, the covariance 1/48, and the mean of p(1 − p) is 1/6. Standard errors over 20,000 surfaces: that of the
    /// variance is below .001, of the covariance below .0003, and 5 of them are allowed.
    #[test]
    fn shares_of_few_tosses_show_how_their_probabilities_vary() {
        let stream = Stream::new(7, Domain::Parameters, 0);
        for each in [2, 4, 16] {
            let mut side = vec![];
            let faces = (0..20_000).map(|k| {
                let mut uniforms = stream.toss(k);
                let p = uniforms.uniform(0);
                side.push(p / 4.0);
                let up = (1..=each).filter(|toss| uniforms.uniform(*toss) < p);
                let up = up.count() as u64;
                [u64::from(each) - up, 0, up]
            });
            let faces: Vec<Faces> = faces.collect();
            let rolls = Rolls::counted(&faces, &side).unwrap();
            assert!((rolls.variance - 1.0 / 12.0).abs() < 5e-3, "{rolls:?}");
            assert!((rolls.covariance - 1.0 / 48.0).abs() < 1.5e-3, "{rolls:?}");
            assert!((rolls.noise * ROLLS - 1.0 / 6.0).abs() < 5e-3, "{rolls:?}");
        }
    }

    /// Where all stay up nothing is learnt; where hardly one comes to rest nothing is known.
    #[test]
    fn what_always_ends_alike_varies_by_nothing() {
        let side: Vec<f64> = (0..40).map(f64::from).collect();
        let rolls = Rolls::counted(&[[0, 0, 4]; 40], &side).unwrap();
        assert_eq!(
            (rolls.variance, rolls.covariance, rolls.noise),
            (0.0, 0.0, 0.0)
        );
        assert_eq!(Rolls::counted(&[[0, 0, 1]; 40], &side), None);
    }

    /// The coin begins upright to some degrees and rolls without slipping.
    #[test]
    fn a_coin_set_rolling_does_not_slip() {
        let coin = Coin::cylinder(0.2, 0.011).unwrap();
        let stream = Stream::new(1, Domain::Launch, 0);
        for toss in 0..50 {
            let launch = rolling(&coin).launch(&coin, &mut stream.toss(toss));
            assert!(launch.axis.z.abs() < 5.0 * TILT_SD_RAD);
            let at_ground = Vector3::new(0.0, 0.0, -coin.radius_m());
            let slip = launch.velocity_m_s + launch.spin_rad_s.cross(&at_ground);
            assert!(slip.norm() < 1e-12, "{slip}");
        }
    }
}
