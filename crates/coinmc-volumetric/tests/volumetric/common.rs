//! Scenes, random numbers, launches and the recorder that the tests share.

use coinmc_core::{
    Coin, Domain, DynEngine, Engine, Event, EventKind, Face, Launch, Observer, Outcome, Preset,
    Scene, State, Stream, Surface, TossUniforms, UniformSource,
};
use coinmc_oracle::{Model, Motion};
use coinmc_volumetric::{Law, Settings};
use nalgebra::{UnitVector3, Vector3};

/// R = 1 cm, g = 9.81 m/s², both friction lengths `rho` radii.
pub(crate) fn scene(ratio: f64, restitution: f64, friction: f64, rho: f64) -> Scene {
    let radius = 0.01;
    let coin = Coin::cylinder(ratio, radius).expect("a valid coin");
    let surface = Surface::new(restitution, friction)
        .and_then(|surface| surface.with_friction_lengths(rho * radius, rho * radius))
        .expect("a valid surface");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid gravity")
}

/// An engine of any law.
pub(crate) struct Tosser(DynEngine);

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

pub(crate) fn stream(seed: u64) -> Stream {
    Stream::new(seed, Domain::Launch, 0)
}

/// Toss number `toss` of a preset.
pub(crate) fn preset(preset: Preset, scene: &Scene, seed: u64, toss: u64) -> Launch {
    preset
        .distribution()
        .launch(&scene.coin, &mut stream(seed).toss(toss))
}

/// Random numbers of one trial, taken one after the other.
pub(crate) struct Dice {
    uniforms: TossUniforms,
    next: u32,
}

impl Dice {
    pub(crate) fn new(seed: u64, trial: u64) -> Self {
        Self {
            uniforms: stream(seed).toss(trial),
            next: 0,
        }
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        self.next += 1;
        from + (to - from) * self.uniforms.uniform(self.next - 1)
    }

    /// Log-uniform.
    pub(crate) fn scale(&mut self, from: f64, to: f64) -> f64 {
        libm::exp(self.between(libm::log(from), libm::log(to)))
    }

    pub(crate) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        // the share lies in (0, 1): the index within the slice
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (self.between(0.0, 1.0) * choices.len() as f64) as usize;
        choices[index.min(choices.len() - 1)]
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = libm::sincos(self.between(0.0, std::f64::consts::TAU));
        let s = ((1.0 - z) * (1.0 + z)).sqrt();
        Vector3::new(s * cos, s * sin, z)
    }

    /// Uniform in the cube of half width `size`.
    pub(crate) fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-size, size))
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
    /// A toss low and lively enough for a few impacts at any e: some end on each face.
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

/// Keeps all events of a toss.
#[derive(Default)]
pub(crate) struct Recorder(pub(crate) Vec<Event>);

impl Observer for Recorder {
    fn event(&mut self, event: &Event) {
        // more than a toss of any test has: one that never ends must not fill the memory
        assert!(self.0.len() < 1_000_000, "no end: {event:?}");
        self.0.push(*event);
    }
}

/// Keeps all events of a toss, and the coin at the multiples of a time.
pub(crate) struct Sampler {
    /// Instants a second.
    pub(crate) rate_hz: f64,
    pub(crate) taken: u32,
    pub(crate) events: Vec<Event>,
    /// Under the kind of the event before each.
    pub(crate) samples: Vec<Event>,
}

impl Sampler {
    pub(crate) fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            taken: 0,
            events: Vec::new(),
            samples: Vec::new(),
        }
    }
}

impl Observer for Sampler {
    fn event(&mut self, event: &Event) {
        assert!(self.events.len() < 1_000_000, "no end: {event:?}");
        self.events.push(*event);
    }

    fn wants_at_s(&self) -> f64 {
        // one that never ends must not fill the memory
        if self.taken < 1_000_000 {
            f64::from(self.taken) / self.rate_hz
        } else {
            f64::INFINITY
        }
    }

    fn sample(&mut self, state: &State) {
        assert_eq!(state.time_s, self.wants_at_s());
        self.taken += 1;
        let before = self.events.last().expect("a launch");
        assert!(before.state.time_s <= state.time_s);
        self.samples.push(Event {
            kind: before.kind,
            state: *state,
        });
    }
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

/// Heads and tails exchanged.
pub(crate) fn turned(face: Option<Face>) -> Option<Face> {
    face.map(|face| match face {
        Face::Heads => Face::Tails,
        Face::Tails => Face::Heads,
        Face::Side => Face::Side,
    })
}

/// Mean and standard error of paired differences.
pub(crate) fn paired(differences: &[f64]) -> (f64, f64) {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let square = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n;
    (mean, (square / n).sqrt())
}

pub(crate) fn side(outcome: &Outcome) -> f64 {
    f64::from(u8::from(outcome.face() == Some(Face::Side)))
}
