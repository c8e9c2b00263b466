//! Scenes, random numbers, launches and observers that the tests share.

use coinmc_core::{
    Coin, Domain, Engine, Event, EventKind, Face, Launch, Observer, Outcome, Preset, Scene, State,
    Stream, Surface, UniformSource,
};
use coinmc_flat::{FlatEngine, ImpactLaw, Moreau, Settings};
use nalgebra::{UnitVector3, Vector3};

/// R = 1 cm, g = 9.81 m/s².
pub(crate) fn scene(ratio: f64, restitution: f64, friction: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a valid coin");
    let surface = Surface::new(restitution, friction).expect("a valid surface");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid gravity")
}

pub(crate) fn engine(scene: &Scene) -> FlatEngine<Moreau> {
    FlatEngine::new(scene, &Settings::default(), Moreau).expect("valid settings")
}

pub(crate) fn engine_with(scene: &Scene, settings: Settings) -> FlatEngine<Moreau> {
    FlatEngine::new(scene, &settings, Moreau).expect("valid settings")
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
    uniforms: coinmc_core::TossUniforms,
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

/// Keeps all events of a toss.
#[derive(Default)]
pub(crate) struct Recorder(pub(crate) Vec<Event>);

impl Observer for Recorder {
    fn event(&mut self, event: &Event) {
        self.0.push(*event);
    }
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
        self.events.push(*event);
    }

    fn wants_at_s(&self) -> f64 {
        f64::from(self.taken) / self.rate_hz
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
