//! Scenes and random motions that the tests share.

use coinmc_core::{Coin, Domain, Scene, Stream, Surface, TossUniforms, UniformSource};
use coinmc_oracle::{Model, Motion};
use nalgebra::Vector3;

/// R = 1 cm, g = 9.81 m/s², both friction lengths `rho` radii.
pub(crate) fn scene(ratio: f64, e: f64, mu: f64, rho: f64) -> Scene {
    let radius = 0.01;
    let surface = Surface::new(e, mu)
        .and_then(|surface| surface.with_friction_lengths(rho * radius, rho * radius))
        .expect("a good surface");
    let coin = Coin::cylinder(ratio, radius).expect("a good coin");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("good gravity")
}

/// Random numbers of one trial, one after the other.
pub(crate) struct Dice {
    uniforms: TossUniforms,
    next: u32,
}

impl Dice {
    pub(crate) fn new(seed: u64, trial: u64) -> Self {
        Self {
            uniforms: Stream::new(seed, Domain::Launch, 0).toss(trial),
            next: 0,
        }
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        self.next += 1;
        from + (to - from) * self.uniforms.uniform(self.next - 1)
    }

    pub(crate) fn vector(&mut self, most: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-most, most))
    }

    /// A motion in contact, tilted by `tilt`, at any azimuth and neither sinking nor rising.
    pub(crate) fn in_contact(&mut self, model: &Model, tilt: f64) -> Motion {
        let (s, c) = libm::sincos(tilt);
        let (sin, cos) = libm::sincos(self.between(0.0, std::f64::consts::TAU));
        let axis = Vector3::new(s * cos, s * sin, c);
        let mut motion = Motion {
            position: Vector3::zeros(),
            velocity: self.vector(1.0),
            axis,
            spin: self.vector(2.0),
        };
        motion.position.z = -motion.gap(model);
        // the gap's rate, with h = (H/2)|c| + R s
        let c_rate = motion.spin.cross(&axis).z;
        motion.velocity.z = c_rate * (model.half.copysign(c) - model.radius * c / s);
        motion
    }
}
