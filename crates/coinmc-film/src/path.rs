//! A law's prediction for the frames of a drop.

use crate::drop::wrapped;
use crate::law::Model;
use crate::parameter::Shared;
use coinmc_core::{Coin, Event, EventKind, Launch, Observer, State};
use nalgebra::{UnitVector3, Vector3};

/// The state at the first frame: x, x', z above the surface, z', θ, θ' (m, m/s, rad, rad/s).
pub(crate) type Start = [f64; 6];

/// The unit of the search for each component of a [`Start`].
pub(crate) fn start_scales(model: &Model) -> Start {
    let d = model.coin.rim_distance_m();
    let rate = (model.gravity_m_s2 / d).sqrt();
    [d, d * rate, d, d * rate, 1.0, rate]
}

/// The predicted frames and impacts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Path {
    /// x, z and θ at every frame, in the film's coordinates.
    pub(crate) seen: Vec<[f64; 3]>,
    /// Time of every impact since the first frame, s.
    pub(crate) impacts_s: Vec<f64>,
    /// Number of frames with a physical prediction: the remaining ones are after the toss was
    /// decided and the flight after its last impact has ended.
    pub(crate) valid: usize,
}

/// Simulates a drop and samples it at these times since its first frame.
pub(crate) fn path(model: &Model, shared: &Shared, start: &Start, at: &[f64]) -> Option<Path> {
    let shared = shared.clamped();
    let (sin, cos) = libm::sincos(start[4]);
    let launch = Launch {
        height_m: start[2],
        velocity_m_s: Vector3::new(start[1], 0.0, start[3]),
        axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
        spin_rad_s: Vector3::new(0.0, start[5], 0.0),
    };
    let mut recorder = PathRecorder {
        at,
        path: Path::default(),
        last: None,
    };
    model.simulate(&shared, &launch, &mut recorder)?;
    let PathRecorder { mut path, last, .. } = recorder;
    path.valid = path.seen.len();
    continue_flight(&mut path, &last?, model, at);
    for [x, z, _] in &mut path.seen {
        *x += start[0];
        *z += shared.floor_m;
    }
    Some(path)
}

/// The engine stops once the face is decided; until the coin's next contact, the last flight
/// continues in closed form.
fn continue_flight(path: &mut Path, last: &State, model: &Model, at: &[f64]) {
    let [x, z, theta] = seen(last);
    let mut aloft = true;
    for time in &at[path.seen.len()..] {
        let t = time - last.time_s;
        let velocity = last.velocity_m_s;
        let now = [
            x + velocity.x * t,
            z + t * (velocity.z - 0.5 * model.gravity_m_s2 * t),
            theta + last.spin_rad_s.y * t,
        ];
        aloft &= clearance(&model.coin, now[1], now[2]) > 0.0;
        path.valid += usize::from(aloft);
        path.seen.push(now);
    }
}

/// Height of the lowest corner.
pub(crate) fn clearance(coin: &Coin, z: f64, theta: f64) -> f64 {
    let (sin, cos) = libm::sincos(theta);
    z - coin.radius_m() * sin.abs() - 0.5 * coin.height_m() * cos.abs()
}

fn seen(state: &State) -> [f64; 3] {
    let (position, axis) = (state.position_m, state.axis);
    [position.x, position.z, wrapped(libm::atan2(axis.x, axis.z))]
}

struct PathRecorder<'a> {
    at: &'a [f64],
    path: Path,
    last: Option<State>,
}

impl Observer for PathRecorder<'_> {
    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::Impact {
            self.path.impacts_s.push(event.state.time_s);
        }
        self.last = Some(event.state);
    }

    fn wants_at_s(&self) -> f64 {
        self.at
            .get(self.path.seen.len())
            .copied()
            .unwrap_or(f64::INFINITY)
    }

    fn sample(&mut self, state: &State) {
        self.path.seen.push(seen(state));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::model;

    /// Height of the lowest of the four corners of a coin in the plane.
    fn lowest(coin: &Coin, [_, z, theta]: [f64; 3]) -> f64 {
        let (sin, cos) = libm::sincos(theta);
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let heights =
            corners.map(|(a, b)| z + a * coin.radius_m() * sin + b * 0.5 * coin.height_m() * cos);
        heights.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The face is certain while the coin is still in the air.
    #[test]
    fn the_last_flight_is_followed_until_a_corner_is_down() {
        let model = model();
        let at: Vec<f64> = (0..6000).map(|frame| f64::from(frame) * 1e-4).collect();
        for theta in [0.0, 0.2, -0.3, 1.4] {
            let start = [0.0, 0.1, 0.1, 0.0, theta, 0.0];
            let path = path(&model, &Shared::default(), &start, &at).unwrap();
            let (aloft, after) = path.seen.split_at(path.valid);
            assert!(aloft.iter().all(|seen| lowest(&model.coin, *seen) > -1e-9));
            assert!(lowest(&model.coin, after[0]) <= 0.0, "{theta}");
            let last = *path.impacts_s.last().unwrap();
            let flight = path.valid - at.partition_point(|time| *time <= last);
            assert!(flight > 5, "{theta}: {flight}");
        }
    }

    /// A coin in free fall that is followed by nothing but the last flight's closed form.
    #[test]
    fn a_flight_goes_on_as_bodies_fall() {
        let model = model();
        let start = Launch {
            height_m: 3.0,
            velocity_m_s: Vector3::new(0.5, 0.0, 1.5),
            axis: UnitVector3::new_normalize(Vector3::new(0.6, 0.0, 0.8)),
            spin_rad_s: Vector3::new(0.0, -2.0, 0.0),
        };
        let mut path = Path::default();
        let last = State {
            time_s: 2.0,
            position_m: Vector3::new(0.25, 0.0, start.height_m),
            velocity_m_s: start.velocity_m_s,
            axis: start.axis,
            spin_rad_s: start.spin_rad_s,
        };
        continue_flight(&mut path, &last, &model, &[2.0, 2.5, 3.5]);
        let theta = libm::atan2(0.6, 0.8);
        for (seen, t) in path.seen.iter().zip([0.0, 0.5, 1.5]) {
            let expected = [
                0.25 + 0.5 * t,
                3.0 + 1.5 * t - 0.5 * 9.81 * t * t,
                theta - 2.0 * t,
            ];
            assert!(
                seen.iter()
                    .zip(expected)
                    .all(|(a, b)| (a - b).abs() < 1e-14),
                "{seen:?}"
            );
        }
        // at 1.5 s it would be below the ground
        assert_eq!(path.valid, 2);
    }
}
