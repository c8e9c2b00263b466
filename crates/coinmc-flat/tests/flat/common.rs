//! Engines, launches and states in units of the coin that the tests share.

use coinmc_core::{Engine, EventKind, Face, Launch, Outcome, Scene, State};
use coinmc_flat::{FlatEngine, ImpactLaw, Moreau, Settings};
use coinmc_testkit::{Dice, Recorder};
use nalgebra::{UnitVector3, Vector3};

pub(crate) fn engine(scene: &Scene) -> FlatEngine<Moreau> {
    FlatEngine::new(scene, &Settings::default(), Moreau).expect("valid settings")
}

pub(crate) fn engine_with(scene: &Scene, settings: Settings) -> FlatEngine<Moreau> {
    FlatEngine::new(scene, &settings, Moreau).expect("valid settings")
}

/// A planar launch in units of D and sqrt(D/g): height of the centre, velocity, angle θ of u from
/// the vertical, angular velocity θ'.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start {
    pub(crate) z: f64,
    pub(crate) vx: f64,
    pub(crate) vz: f64,
    pub(crate) theta: f64,
    pub(crate) omega: f64,
}

impl Start {
    /// A low toss with enough energy for a few impacts at any e: each face occurs.
    pub(crate) fn lively(dice: &mut Dice) -> Self {
        Self {
            z: dice.between(1.5, 4.0),
            vx: dice.between(-1.0, 1.0),
            vz: dice.between(-1.0, 1.0),
            theta: dice.between(0.0, std::f64::consts::TAU),
            omega: dice.between(-3.0, 3.0),
        }
    }

    pub(crate) fn launch(&self, scene: &Scene) -> Launch {
        let (length, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
        let (sin, cos) = libm::sincos(self.theta);
        Launch {
            height_m: self.z * length,
            velocity_m_s: Vector3::new(self.vx, 0.0, self.vz) * (length / time),
            axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
            spin_rad_s: Vector3::new(0.0, self.omega / time, 0.0),
        }
    }
}

/// An observed state in units of D and sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    pub(crate) kind: EventKind,
    pub(crate) time: f64,
    pub(crate) x: f64,
    pub(crate) z: f64,
    pub(crate) vx: f64,
    pub(crate) vz: f64,
    /// Angle of u from the vertical, in (−π, π].
    pub(crate) theta: f64,
    pub(crate) omega: f64,
}

/// The toss and its events.
pub(crate) fn record<L: ImpactLaw>(
    engine: &FlatEngine<L>,
    scene: &Scene,
    launch: &Launch,
) -> (Outcome, Vec<Moment>) {
    let mut recorder = Recorder::default();
    let outcome = engine.toss(&mut (), launch, &mut recorder);
    let moments = recorder
        .0
        .iter()
        .map(|event| moment(scene, event.kind, &event.state))
        .collect();
    (outcome, moments)
}

pub(crate) fn moment(scene: &Scene, kind: EventKind, state: &State) -> Moment {
    let (length, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
    Moment {
        kind,
        time: state.time_s / time,
        x: state.position_m.x / length,
        z: state.position_m.z / length,
        vx: state.velocity_m_s.x * time / length,
        vz: state.velocity_m_s.z * time / length,
        theta: libm::atan2(state.axis.x, state.axis.z),
        omega: state.spin_rad_s.y * time,
    }
}

/// The section of the coin as four corners in its own frame (across, along u), in units of D, and
/// k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Section {
    pub(crate) radius: f64,
    pub(crate) half_height: f64,
    pub(crate) k: f64,
}

impl Section {
    pub(crate) fn new(scene: &Scene) -> Self {
        let d = scene.coin.rim_distance_m();
        Self {
            radius: scene.coin.radius_m() / d,
            half_height: scene.coin.height_m() / 2.0 / d,
            k: scene.coin.transverse_gyration_m2() / (d * d),
        }
    }

    /// The corners relative to the centre for u = (sin θ, cos θ).
    pub(crate) fn corners(&self, theta: f64) -> [(f64, f64); 4] {
        let (sin, cos) = libm::sincos(theta);
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(a, b)| {
            let (across, along) = (a * self.radius, b * self.half_height);
            (across * cos + along * sin, -across * sin + along * cos)
        })
    }

    /// The lowest corner relative to the centre.
    pub(crate) fn lowest(&self, theta: f64) -> (f64, f64) {
        let corners = self.corners(theta);
        let lowest = corners.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        lowest.expect("four corners")
    }

    /// Depth of the lowest corner below the centre.
    pub(crate) fn reach(&self, theta: f64) -> f64 {
        let (sin, cos) = libm::sincos(theta);
        self.radius * sin.abs() + self.half_height * cos.abs()
    }

    /// The face on which the coin comes to rest from the well of this angle.
    pub(crate) fn face(&self, theta: f64) -> Face {
        let cos = libm::cos(theta);
        if cos.abs() <= self.half_height {
            Face::Side
        } else if cos > 0.0 {
            Face::Heads
        } else {
            Face::Tails
        }
    }
}

impl Moment {
    /// Mechanical energy in m g D.
    pub(crate) fn energy(&self, k: f64) -> f64 {
        0.5 * (self.vx * self.vx + self.vz * self.vz + k * self.omega * self.omega) + self.z
    }
}
