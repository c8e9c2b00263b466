//! Free flight in closed form, for any instant: the check of the engine's flights.
//!
//! In the laboratory frame and from the angular momentum alone: the axis goes round the fixed L at
//! the rate |L|/I_t. The engine's folded frame and its bounds have no part in it.

use crate::worst::largest;
use coinmc_core::{Coin, Scene, State};
use nalgebra::Vector3;

/// Even samples of a flight.
const SAMPLES: u32 = 400;
/// Beside them, samples that close in on each end by factors of two.
const CLOSING_IN: std::ops::Range<i32> = 10..40;
/// Penetration, in D, that is no rounding error: a contact was passed over.
const MISSED: f64 = 1e-12;

/// Angular momentum about the centre per mass, m²/s.
pub(crate) fn angular_momentum(coin: &Coin, state: &State) -> Vector3<f64> {
    let axis = state.axis.into_inner();
    let along = axis * state.spin_rad_s.dot(&axis);
    along * coin.axial_gyration_m2() + (state.spin_rad_s - along) * coin.transverse_gyration_m2()
}

/// A flight between two states, by each of them: near either end that one is exact.
pub(crate) struct Leg {
    pub(crate) from: Flight,
    pub(crate) back: Flight,
    pub(crate) duration: f64,
}

impl Leg {
    pub(crate) fn new(scene: &Scene, start: &State, end: &State) -> Self {
        Self {
            from: Flight::new(scene, start),
            back: Flight::new(scene, end),
            // not from the clock, which has long run on
            duration: (start.velocity_m_s.z - end.velocity_m_s.z) / scene.gravity_m_s2(),
        }
    }

    /// The largest penetration at many instants, in D; NaN if any is.
    pub(crate) fn depth(&self) -> f64 {
        let even = (1..SAMPLES).map(|i| {
            let share = f64::from(i) / f64::from(SAMPLES);
            if 2 * i < SAMPLES {
                self.from.gap(share * self.duration)
            } else {
                self.back.gap((share - 1.0) * self.duration)
            }
        });
        let towards_the_ends = CLOSING_IN.flat_map(|halvings| {
            let t = libm::ldexp(self.duration, -halvings);
            [self.from.gap(t), self.back.gap(-t)]
        });
        let gaps = even.chain(towards_the_ends);
        gaps.fold(f64::NEG_INFINITY, |depth, gap| largest(depth, -gap))
    }

    /// Whether a flight of this depth passes over a contact.
    pub(crate) fn is_missed(depth: f64) -> bool {
        depth > MISSED || depth.is_nan()
    }

    /// What counts as passing over a contact, for a report.
    pub(crate) fn criterion() -> String {
        let closing_in = 2 * CLOSING_IN.len();
        format!(
            "deeper than {MISSED:e} D at one of {SAMPLES} even samples and {closing_in} towards \
             the ends"
        )
    }
}

/// A flight without drag through a known state.
pub(crate) struct Flight {
    gravity: f64,
    radius: f64,
    half: f64,
    d: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    /// The part of u along L, the part across, and L̂ × u.
    along: Vector3<f64>,
    across: Vector3<f64>,
    ahead: Vector3<f64>,
    /// |L|/I_t.
    rate: f64,
}

impl Flight {
    pub(crate) fn new(scene: &Scene, state: &State) -> Self {
        let coin = &scene.coin;
        let axis = state.axis.into_inner();
        let momentum = angular_momentum(coin, state);
        let size = momentum.norm();
        let direction = if size > 0.0 { momentum / size } else { axis };
        let along = direction * direction.dot(&axis);
        Self {
            gravity: scene.gravity_m_s2(),
            radius: coin.radius_m(),
            half: 0.5 * coin.height_m(),
            d: coin.rim_distance_m(),
            position: state.position_m,
            velocity: state.velocity_m_s,
            along,
            across: axis - along,
            ahead: direction.cross(&axis),
            rate: size / coin.transverse_gyration_m2(),
        }
    }

    /// The axis `t` seconds later.
    pub(crate) fn axis(&self, t: f64) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(self.rate * t);
        self.along + self.across * cos + self.ahead * sin
    }

    /// The centre `t` seconds later.
    pub(crate) fn position(&self, t: f64) -> Vector3<f64> {
        let mut position = self.position + self.velocity * t;
        position.z -= 0.5 * self.gravity * t * t;
        position
    }

    /// Height of the lowest point `t` seconds later, in D.
    pub(crate) fn gap(&self, t: f64) -> f64 {
        let u = self.axis(t);
        // from the horizontal part: 1 − u_z² has no digits left near 0
        let sine = (u.x * u.x + u.y * u.y).sqrt();
        let height = self.position.z + t * (self.velocity.z - 0.5 * self.gravity * t);
        (height - self.half * u.z.abs() - self.radius * sine) / self.d
    }
}
