//! Engines, launches and states in units of the coin that the tests share.

use coinmc_core::{DynEngine, Engine, Event, EventKind, Face, Launch, Observer, Outcome, Scene};
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::{Dice, Recorder};
use coinmc_volumetric::{Law, Settings};
use nalgebra::{UnitVector3, Vector3};

/// An engine of any law.
pub(crate) struct Tosser(pub(crate) DynEngine);

impl Tosser {
    /// With the default settings.
    pub(crate) fn new(scene: &Scene) -> Self {
        Self::with(scene, &Settings::default())
    }

    pub(crate) fn of(scene: &Scene, law: Law) -> Self {
        let settings = Settings {
            law,
            ..Settings::default()
        };
        Self::with(scene, &settings)
    }

    pub(crate) fn with(scene: &Scene, settings: &Settings) -> Self {
        Self(settings.engine(scene).expect("valid settings"))
    }

    pub(crate) fn toss(&self, launch: &Launch) -> Outcome {
        self.observe(launch, &mut ())
    }

    pub(crate) fn observe(&self, launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.0.toss(&mut (), launch, observer)
    }

    /// The toss and its events.
    pub(crate) fn record(&self, scene: &Scene, launch: &Launch) -> (Outcome, Vec<Moment>) {
        let mut recorder = Recorder::default();
        let outcome = self.observe(launch, &mut recorder);
        let moments = recorder.0.iter().map(|event| moment(scene, event));
        (outcome, moments.collect())
    }
}

/// A launch in units of D and sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start {
    pub(crate) z: f64,
    pub(crate) velocity: Vector3<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) spin: Vector3<f64>,
}

impl Start {
    /// A low toss with enough energy for a few impacts at any e: each face occurs.
    pub(crate) fn lively(dice: &mut Dice) -> Self {
        Self {
            z: dice.between(1.2, 4.0),
            velocity: dice.vector(1.0),
            axis: dice.direction(),
            spin: dice.vector(4.0),
        }
    }

    pub(crate) fn launch(&self, scene: &Scene) -> Launch {
        let (length, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
        Launch {
            height_m: self.z * length,
            velocity_m_s: self.velocity * (length / time),
            axis: UnitVector3::new_unchecked(self.axis),
            spin_rad_s: self.spin / time,
        }
    }
}

/// An observed state in the laboratory, in units of D and sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    pub(crate) kind: EventKind,
    pub(crate) time: f64,
    pub(crate) motion: Motion,
}

pub(crate) fn moment(scene: &Scene, event: &Event) -> Moment {
    let (length, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
    let state = &event.state;
    Moment {
        kind: event.kind,
        time: state.time_s / time,
        motion: Motion {
            position: state.position_m / length,
            velocity: state.velocity_m_s * (time / length),
            axis: state.axis.into_inner(),
            spin: state.spin_rad_s * time,
        },
    }
}

/// The pairs of events between which the coin flies.
pub(crate) fn flights(moments: &[Moment]) -> impl Iterator<Item = (&Moment, &Moment)> {
    moments.windows(2).filter_map(|pair| {
        let [from, to] = pair else { return None };
        let departs = matches!(
            from.kind,
            EventKind::Launched | EventKind::Impact | EventKind::LiftOff
        );
        (departs && to.kind == EventKind::Touching && to.time > from.time).then_some((from, to))
    })
}

/// The face on which a coin with this axis comes to rest without passing a rim.
pub(crate) fn well(model: &Model, axis: &Vector3<f64>) -> Face {
    if axis.z.abs() < model.half {
        Face::Side
    } else if axis.z > 0.0 {
        Face::Heads
    } else {
        Face::Tails
    }
}
