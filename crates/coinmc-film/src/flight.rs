//! The flight before the first impact, which gives a fit's initial states from the film alone.

use crate::drop::{Coordinate, FilmedDrop, median, wrapped};
use crate::path::Start;

/// Number of frames before the first impact that a fit needs.
pub const MIN_FLIGHT: usize = 5;

/// Smallest noise assumed, m and rad.
const MIN_NOISE: [f64; 3] = [1e-6, 1e-6, 1e-5];

/// A frame further than this from the parabola is after the impact, in standard deviations.
const FAR: f64 = 6.0;

/// The flight before the first impact.
#[derive(Debug, Clone)]
pub(crate) struct Flight {
    /// Number of frames.
    pub(crate) frames: usize,
    /// The state at the first frame.
    pub(crate) start: Start,
}

/// Standard deviation of the noise of each coordinate, from third differences.
///
/// In flight the third differences of x, z and θ vanish, and a few impacts do not affect a median.
/// For white noise the difference y₀ − 3y₁ + 3y₂ − y₃ has the variance 20σ², and the median of its
/// absolute value is 0.6745 standard deviations.
pub(crate) fn noise(drops: &[FilmedDrop]) -> [f64; 3] {
    let mut noise = [None; 3];
    for coordinate in Coordinate::ALL {
        let c = coordinate.index();
        let mut third: Vec<f64> = drops
            .iter()
            .flat_map(|drop| drop.frames.windows(4))
            .filter_map(|four| {
                let [y0, y1, y2, y3] = [0, 1, 2, 3].map(|i: usize| four[i].seen[c]);
                let (a, b, d) = (y1? - y0?, y2? - y1?, y3? - y2?);
                let steps = match coordinate {
                    Coordinate::Theta => [wrapped(a), wrapped(b), wrapped(d)],
                    Coordinate::X | Coordinate::Z => [a, b, d],
                };
                Some((steps[2] - 2.0 * steps[1] + steps[0]).abs())
            })
            .collect();
        noise[c] =
            median(&mut third).map(|middle| MIN_NOISE[c].max(middle / 0.6745 / 20.0_f64.sqrt()));
    }
    of_one_camera(noise, MIN_NOISE)
}

/// The noise of each coordinate: that found, that of the other length in the same picture, or else the one given.
pub(crate) fn of_one_camera([x, z, theta]: [Option<f64>; 3], else_: [f64; 3]) -> [f64; 3] {
    [
        x.or(z).unwrap_or(else_[0]),
        z.or(x).unwrap_or(else_[1]),
        theta.unwrap_or(else_[2]),
    ]
}

/// Finds the flight: the frames before z leaves its parabola. `None` if it is too short.
pub(crate) fn flight(drop: &FilmedDrop, gravity: f64, noise: &[f64; 3]) -> Option<Flight> {
    let origin = drop.frames.first()?.time_s;
    let marked: Vec<(usize, f64, f64)> = drop
        .frames
        .iter()
        .enumerate()
        .filter_map(|(i, frame)| {
            let t = frame.time_s - origin;
            // without free fall, a straight line remains
            Some((i, t, frame.seen[1]? + 0.5 * gravity * t * t))
        })
        .collect();
    let mut line = Line::default();
    let mut last = None;
    for (k, &(i, t, z)) in marked.iter().enumerate() {
        let far = |t: f64, z: f64| {
            (z - line.at(t)).abs() > FAR * noise[1] * (1.0 + line.leverage(t)).sqrt()
        };
        if k >= MIN_FLIGHT && far(t, z) {
            if marked.get(k + 1).is_none_or(|&(_, t, z)| far(t, z)) {
                break;
            }
            // a single wrong mark
            continue;
        }
        line.add(t, z);
        last = Some((k, i));
    }
    let (k, frame) = last?;
    if k + 1 < MIN_FLIGHT {
        return None;
    }
    let frames = frame + 1;
    let (z, vz) = line.coefficients();
    let (x, vx) = linear(drop, frames, Coordinate::X).unwrap_or((0.0, 0.0));
    let (theta, omega) = linear(drop, frames, Coordinate::Theta)?;
    Some(Flight {
        frames,
        start: [x, vx, z, vz, theta, omega],
    })
}

/// Value at the first frame and rate of a coordinate that changes linearly.
fn linear(drop: &FilmedDrop, frames: usize, coordinate: Coordinate) -> Option<(f64, f64)> {
    let origin = drop.frames.first()?.time_s;
    let points: Vec<(f64, f64)> = drop.frames[..frames]
        .iter()
        .filter_map(|frame| Some((frame.time_s - origin, frame.seen[coordinate.index()]?)))
        .collect();
    let mut rates: Vec<f64> = points
        .windows(2)
        .map(|pair| wrapped(pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0))
        .collect();
    let rate = median(&mut rates)?;
    let first = points.first()?;
    let mut line = Line::default();
    let mut turned = first.1;
    let mut before = *first;
    for &(t, y) in &points {
        turned = match coordinate {
            Coordinate::X | Coordinate::Z => y,
            // remove whole turns with the help of the rate
            Coordinate::Theta => {
                let expected = turned + rate * (t - before.0);
                expected + wrapped(y - expected)
            }
        };
        line.add(t, turned);
        before = (t, y);
    }
    Some(line.coefficients())
}

/// A least-squares line through points, updated point by point.
#[derive(Debug, Default)]
struct Line {
    n: f64,
    t: f64,
    y: f64,
    tt: f64,
    ty: f64,
}

impl Line {
    /// Welford's updates: sums about the mean.
    fn add(&mut self, t: f64, y: f64) {
        self.n += 1.0;
        let (dt, dy) = (t - self.t, y - self.y);
        self.t += dt / self.n;
        self.y += dy / self.n;
        self.tt += dt * (t - self.t);
        self.ty += dt * (y - self.y);
    }

    fn slope(&self) -> f64 {
        if self.tt > 0.0 {
            self.ty / self.tt
        } else {
            0.0
        }
    }

    fn at(&self, t: f64) -> f64 {
        self.y + self.slope() * (t - self.t)
    }

    /// Variance of [`at`](Self::at) for unit noise.
    fn leverage(&self, t: f64) -> f64 {
        let spread = if self.tt > 0.0 {
            (t - self.t) * (t - self.t) / self.tt
        } else {
            0.0
        };
        1.0 / self.n + spread
    }

    fn coefficients(&self) -> (f64, f64) {
        (self.at(0.0), self.slope())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drop::Frame;
    use coinmc_core::{Philox4x64, inverse_normal_cdf, unit_interval};

    const GRAVITY: f64 = 9.81;

    /// A drop that turns `turns` times in a second, marked with noise of these standard deviations.
    fn filmed(turns: f64, noise: [f64; 3]) -> FilmedDrop {
        frames(400, turns, noise)
    }

    /// A second in so many frames.
    fn frames(count: u32, turns: f64, noise: [f64; 3]) -> FilmedDrop {
        let random = Philox4x64::new([7, 0]);
        let frames = (0..count).map(|i| {
            let t = f64::from(i) / f64::from(count);
            let theta = 0.3 + std::f64::consts::TAU * turns * t;
            let exact = [0.1 + 0.2 * t, 9.0 - 0.5 * GRAVITY * t * t, theta];
            let words = random.block([u64::from(i), 0, 0, 0]);
            let marked =
                |c: usize| exact[c] + noise[c] * inverse_normal_cdf(unit_interval(words[c]));
            let [x, z, theta] = [0, 1, 2].map(marked);
            Frame {
                time_s: t,
                seen: [Some(x), Some(z), Some(wrapped(theta))],
            }
        });
        FilmedDrop {
            name: "drop".to_owned(),
            frames: frames.collect(),
        }
    }

    /// The median of 4000 differences, neighbours correlated, is good to some 3 %: 12 % is four of that.
    #[test]
    fn the_noise_of_a_flight_is_what_was_added() {
        let added = [5e-4, 2e-4, 1e-2];
        for turns in [0.0, 12.0] {
            let found = noise(&[frames(4000, turns, added)]);
            for (found, added) in found.into_iter().zip(added) {
                assert!((found / added - 1.0).abs() < 0.12, "{found} {added}");
            }
        }
    }

    /// Of a length that is hardly marked the noise is that of the other one, as a camera sees both alike.
    #[test]
    fn a_length_without_differences_is_as_noisy_as_the_other() {
        let added = [5e-4, 2e-4, 1e-2];
        for rare in [0, 1] {
            let mut drop = frames(4000, 3.0, added);
            for frame in &mut drop.frames[2..] {
                frame.seen[rare] = None;
            }
            let found = noise(&[drop]);
            assert_eq!(found[0], found[1]);
            assert!((found[rare] / added[1 - rare] - 1.0).abs() < 0.12);
        }
    }

    #[test]
    fn a_flight_of_many_turns_has_its_rate() {
        for turns in [-12.0, 0.0, 3.0] {
            let drop = filmed(turns, [0.0; 3]);
            let flight = flight(&drop, GRAVITY, &noise(std::slice::from_ref(&drop))).unwrap();
            assert_eq!(flight.frames, 400);
            let expected = [0.1, 0.2, 9.0, 0.0, 0.3, std::f64::consts::TAU * turns];
            for (found, expected) in flight.start.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{:?}", flight.start);
            }
        }
    }

    /// The parabola of 400 frames with noise in all of them is followed to its end: a frame must be six standard
    /// deviations off, of its own noise and that of the line.
    #[test]
    fn noise_does_not_end_a_flight() {
        let drop = filmed(3.0, [5e-4, 2e-4, 1e-2]);
        let noise = [5e-4, 2e-4, 1e-2];
        assert_eq!(flight(&drop, GRAVITY, &noise).unwrap().frames, 400);
    }

    /// From the frame where it leaves its parabola for good; a single wrong mark is passed over.
    #[test]
    fn a_flight_ends_where_z_leaves_its_parabola() {
        let noise = [5e-4, 2e-4, 1e-2];
        let mut drop = filmed(3.0, [0.0; 3]);
        drop.frames[100].seen[1] = Some(0.0);
        assert_eq!(flight(&drop, GRAVITY, &noise).unwrap().frames, 400);
        for frame in &mut drop.frames[200..] {
            let since = frame.time_s - 0.5;
            frame.seen[1] = frame.seen[1].map(|z| z + 0.01 + 2.0 * since);
        }
        drop.frames[100].seen[1] = None;
        assert_eq!(flight(&drop, GRAVITY, &noise).unwrap().frames, 200);
        drop.frames.truncate(MIN_FLIGHT);
        assert_eq!(flight(&drop, GRAVITY, &noise).unwrap().frames, 5);
        drop.frames.pop();
        assert!(flight(&drop, GRAVITY, &noise).is_none());
    }

    /// From five evenly spaced points the next is known to sqrt(1 + 1/5 + 9/10) = 1.45 standard deviations and the one
    /// after it to sqrt(1 + 1/5 + 16/10) = 1.67. So a step of 7 is not six of either, and none later, as the line bends; one
    /// of 10.5 is.
    #[test]
    fn a_frame_is_far_by_its_own_noise_and_that_of_the_line() {
        let noise = [5e-4, 2e-4, 1e-2];
        let ends = |step: f64| {
            let mut drop = filmed(3.0, [0.0; 3]);
            for frame in &mut drop.frames[5..] {
                frame.seen[1] = frame.seen[1].map(|z| z + step * noise[1]);
            }
            flight(&drop, GRAVITY, &noise).unwrap().frames
        };
        assert_eq!([7.0, 10.5, -7.0, -10.5].map(ends), [400, 5, 400, 5]);
    }

    /// Against sums over all points: the value, the slope, and the variances of both for unit noise.
    #[test]
    fn a_line_is_that_of_least_squares() {
        let points = [(0.5, 2.0), (1.0, 1.0), (2.5, 4.0), (4.0, 3.0)];
        let mut line = Line::default();
        for (t, y) in points {
            line.add(t, y);
        }
        let n = 4.0;
        let (t0, y0) = (2.0, 2.5);
        let squares: f64 = points.iter().map(|(t, _)| (t - t0) * (t - t0)).sum();
        let products: f64 = points.iter().map(|(t, y)| (t - t0) * (y - y0)).sum();
        assert!((line.slope() - products / squares).abs() < 1e-14);
        for t in [-1.0, 0.0, 2.0, 7.0] {
            assert!((line.at(t) - (y0 + products / squares * (t - t0))).abs() < 1e-14);
            let leverage = 1.0 / n + (t - t0) * (t - t0) / squares;
            assert!((line.leverage(t) - leverage).abs() < 1e-14);
        }
        let mut point = Line::default();
        point.add(3.0, 5.0);
        assert_eq!(
            [point.at(9.0), point.slope(), point.leverage(9.0)],
            [5.0, 0.0, 1.0]
        );
    }

    /// Angles are marked up to whole turns: of a coin that turns by more than half a turn between marks that are missing,
    /// too. Times count from the film's first frame, whatever it says.
    #[test]
    fn turns_between_marks_that_are_missing_are_counted() {
        let mut drop = filmed(40.0, [0.0; 3]);
        for (i, frame) in drop.frames.iter_mut().enumerate() {
            frame.time_s += 100.0;
            if i % 50 >= 20 {
                frame.seen[2] = None;
            }
        }
        let flight = flight(&drop, GRAVITY, &noise(std::slice::from_ref(&drop))).unwrap();
        let expected = [0.1, 0.2, 9.0, 0.0, 0.3, std::f64::consts::TAU * 40.0];
        for (found, expected) in flight.start.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-8, "{:?}", flight.start);
        }
    }
}
