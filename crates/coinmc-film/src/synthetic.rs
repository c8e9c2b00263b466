//! Simulated films, for trying and measuring the reader and the fit.

use crate::drop::{FilmedDrop, Frame, wrapped};
use crate::law::Model;
use crate::parameter::Shared;
use crate::path::{Start, clearance, path};
use coinmc_core::{Philox4x64, inverse_normal_cdf, unit_interval};

/// A drop and how it is filmed. All noise is drawn from the seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Synthetic {
    /// Seed of the random numbers.
    pub seed: u64,
    /// The surface. A law's own parameters are those of its model.
    pub shared: Shared,
    /// State at the first frame: x, x', z above the surface, z', θ, θ' (m, m/s, m, m/s, rad,
    /// rad/s).
    pub start: [f64; 6],
    /// Frame rate, 1/s.
    pub rate_hz: f64,
    /// Length of the film, s.
    pub duration_s: f64,
    /// Standard deviation of a marked position, m.
    pub position_noise_m: f64,
    /// Standard deviation of a marked angle, rad.
    pub angle_noise_rad: f64,
    /// Fraction of unmarked points.
    pub missing: f64,
}

impl Default for Synthetic {
    /// From 20 cm, tilted and turning, e = 0.5, μ = 0.2; 240 frames/s for 0.6 s, with noise of 0.5
    /// mm and 0.5°, every point marked.
    fn default() -> Self {
        Self {
            seed: 1,
            shared: Shared {
                friction: 0.2,
                ..Shared::default()
            },
            start: [
                0.0,
                0.1,
                0.2,
                0.0,
                23.0_f64.to_radians(),
                170.0_f64.to_radians(),
            ],
            rate_hz: 240.0,
            duration_s: 0.6,
            position_noise_m: 0.5e-3,
            angle_noise_rad: 0.5_f64.to_radians(),
            missing: 0.0,
        }
    }
}

impl Synthetic {
    /// The film of the motion that the law predicts, up to the end of the toss and the flight that
    /// follows it. `None` if the values are far out of range, or the coin begins in the ground.
    pub fn film(&self, model: &Model) -> Option<FilmedDrop> {
        // at least one frame, and a bound against wrong input
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let frames = (self.duration_s * self.rate_hz).clamp(0.0, 99_999.0) as usize + 1;
        let times: Vec<f64> = (0..frames).map(|i| i as f64 / self.rate_hz).collect();
        let start: Start = self.start;
        let is_finite = start.iter().all(|number| number.is_finite());
        if !is_finite || clearance(&model.coin, start[2], start[4]) < 0.0 {
            return None;
        }
        let path = path(model, &self.shared.of(model.law), &start, &times)?;
        let noise = [
            self.position_noise_m,
            self.position_noise_m,
            self.angle_noise_rad,
        ];
        let philox = Philox4x64::new([self.seed, FILM]);
        let seen = |frame: usize, c: usize, value: f64| {
            let block = philox.block([frame as u64, c as u64, 0, 0]);
            let uniform = unit_interval(block[0]);
            let normal = inverse_normal_cdf(unit_interval(block[1]));
            (uniform >= self.missing).then_some(value + noise[c] * normal)
        };
        let frames = path.seen.iter().take(path.valid).enumerate();
        let frames = frames
            .map(|(i, predicted)| Frame {
                time_s: times[i],
                seen: [
                    seen(i, 0, predicted[0]),
                    seen(i, 1, predicted[1]),
                    seen(i, 2, predicted[2]).map(wrapped),
                ],
            })
            .collect();
        Some(FilmedDrop {
            name: format!("drop {}", self.seed),
            frames,
        })
    }
}

/// Second word of the key, which separates films from tosses with the same seed.
const FILM: u64 = 0x6669_6c6d;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::model;

    /// A coin of radius 10 mm and height 10 mm stands at 10 mm and lies at 5 mm.
    #[test]
    fn a_film_begins_above_the_ground() {
        let film = |place: usize, value: f64| {
            let mut start = [0.0, 0.1, 0.2, 0.0, 0.0, 0.0];
            start[place] = value;
            let film = Synthetic {
                start,
                ..Synthetic::default()
            };
            film.film(&model())
        };
        assert!(film(2, 5.001e-3).is_some());
        for (place, value) in [(2, 4.999e-3), (2, -1.0), (1, f64::INFINITY), (0, f64::NAN)] {
            assert!(film(place, value).is_none(), "{place} {value}");
        }
    }
}
