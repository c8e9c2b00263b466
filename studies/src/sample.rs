//! Random scenes and launches from all over the box that the engine has to survive.

use coinmc_bench::Case;
use coinmc_core::{Coin, Launch, Orientation, Scene, Surface, UniformSource};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;
use std::fmt;

/// Dimensions of the random numbers; launches have the first ten.
const RATIO: u32 = 16;
const RADIUS: u32 = 17;
const RESTITUTION: u32 = 18;
const FRICTION: u32 = 19;
const CONTOUR: u32 = 20;
const PIVOTING: u32 = 21;
const SPIN: u32 = 22;
const SPIN_AXIS: [u32; 2] = [23, 24];
const HEIGHT: u32 = 25;

/// Share of tosses at either end of a range.
const AT_AN_END: f64 = 0.1;

/// A toss in a scene of its own.
pub(crate) struct Sample {
    pub(crate) scene: Scene,
    pub(crate) launch: Launch,
}

impl Sample {
    /// Toss number `toss` of a seed.
    ///
    /// H/R 1e-4 … 1e4 and R 1e-6 … 1e3 m; e 0 … 1; μ 1e-3 … 10 or 0; friction lengths 1e-5 … 0.1 R
    /// or 0; spin 1e-2 … 1e5 rad/s or 0; height 1e-3 … 1e3 R or 0. Log-uniform but for e, which is
    /// uniform. A tenth of the tosses has each end of e and μ, and 0 of the others.
    pub(crate) fn new(seed: u64, toss: u64) -> Self {
        Self::in_scene(seed, toss, toss)
    }

    /// The same launch in the scene of toss number `scene`.
    pub(crate) fn in_scene(seed: u64, scene: u64, toss: u64) -> Self {
        let scene = random_scene(seed, scene);
        let mut uniforms = Case::stream(seed).toss(toss);
        let mut at = |dimension| uniforms.uniform(dimension);
        let spin = or_zero(at(SPIN), 1e-2, 1e5);
        let direction = direction(SPIN_AXIS.map(&mut at));
        let height = scene.coin.radius_m() * or_zero(at(HEIGHT), 1e-3, 1e3);
        Self {
            scene,
            launch: Launch {
                height_m: height,
                velocity_m_s: Vector3::zeros(),
                axis: Orientation::Isotropic.axis(&mut uniforms),
                spin_rad_s: direction.into_inner() * spin,
            },
        }
    }

    /// The same scene and a launch in the plane, for the flat engine: u anywhere in the xz plane,
    /// the spin about y in either direction.
    pub(crate) fn in_plane(seed: u64, scene: u64, toss: u64) -> Self {
        let mut sample = Self::in_scene(seed, scene, toss);
        let mut uniforms = Case::stream(seed).toss(toss);
        let (sin, cos) = libm::sincos(TAU * uniforms.uniform(SPIN_AXIS[0]));
        let forwards = uniforms.uniform(SPIN_AXIS[1]) < 0.5;
        let launch = &mut sample.launch;
        let spin = launch.spin_rad_s.norm();
        launch.axis = UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos));
        launch.spin_rad_s = Vector3::new(0.0, if forwards { spin } else { -spin }, 0.0);
        sample
    }

    /// Spin in units of sqrt(g/D): how often the coin turns while it topples.
    pub(crate) fn turns(&self) -> f64 {
        self.launch.spin_rad_s.norm() * self.scene.time_scale_s()
    }

    /// Bounces lose nothing.
    pub(crate) fn is_elastic(&self) -> bool {
        self.scene.surface.restitution() == 1.0
    }
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (coin, surface) = (&self.scene.coin, &self.scene.surface);
        let radius = coin.radius_m();
        write!(
            f,
            "H/R {:.3e} R {:.3e} m e {:.4} mu {:.3e} rho/R {:.1e} {:.1e} spin {:.2e} rad/s height \
             {:.2e} R",
            coin.ratio(),
            radius,
            surface.restitution(),
            surface.friction(),
            surface.rolling_friction_m() / radius,
            surface.pivoting_friction_m() / radius,
            self.launch.spin_rad_s.norm(),
            self.launch.height_m / radius,
        )
    }
}

/// The scene of toss number `toss` of a seed.
fn random_scene(seed: u64, toss: u64) -> Scene {
    let mut uniforms = Case::stream(seed).toss(toss);
    let mut at = |dimension| uniforms.uniform(dimension);
    let radius = logarithmic(at(RADIUS), 1e-6, 1e3);
    let coin = Coin::cylinder(logarithmic(at(RATIO), 1e-4, 1e4), radius);
    let coin = coin.expect("both are positive");
    let (low, high) = (AT_AN_END, 1.0 - AT_AN_END);
    let restitution = ((at(RESTITUTION) - low) / (high - low)).clamp(0.0, 1.0);
    let friction = match at(FRICTION) {
        p if p < low => 0.0,
        p if p > high => 10.0,
        p => logarithmic((p - low) / (high - low), 1e-3, 10.0),
    };
    let lengths = [CONTOUR, PIVOTING].map(|d| radius * or_zero(at(d), 1e-5, 0.1));
    let surface = Surface::new(restitution, friction)
        .and_then(|surface| surface.with_friction_lengths(lengths[0], lengths[1]))
        .expect("in range");
    let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2);
    scene.expect("gravity is positive")
}

/// Log-uniform.
fn logarithmic(p: f64, from: f64, to: f64) -> f64 {
    from * libm::pow(to / from, p)
}

/// Zero for a tenth of all p, else log-uniform.
fn or_zero(p: f64, from: f64, to: f64) -> f64 {
    if p < AT_AN_END {
        0.0
    } else {
        logarithmic((p - AT_AN_END) / (1.0 - AT_AN_END), from, to)
    }
}

/// Uniform on the sphere.
fn direction([height, azimuth]: [f64; 2]) -> UnitVector3<f64> {
    let z = 2.0 * height - 1.0;
    let (sin, cos) = libm::sincos(TAU * azimuth);
    let across = (1.0 - z * z).sqrt();
    UnitVector3::new_normalize(Vector3::new(across * cos, across * sin, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_reach_the_ends_and_stay_inside() {
        let samples: Vec<Sample> = (0..3000).map(|toss| Sample::new(1, toss)).collect();
        let share = |of: &dyn Fn(&Sample) -> bool| {
            samples.iter().filter(|sample| of(sample)).count() as f64 / 3000.0
        };
        // a tenth each; five standard errors of 3000 are 0.027
        let tenth = |share: f64| (share - 0.1).abs() < 0.028;
        assert!(tenth(share(&|s| s.is_elastic())));
        assert!(tenth(share(&|s| s.scene.surface.restitution() == 0.0)));
        assert!(tenth(share(&|s| s.scene.surface.friction() == 10.0)));
        assert!(tenth(share(&|s| s.launch.height_m == 0.0)));
        for sample in &samples {
            let (coin, rate) = (&sample.scene.coin, sample.launch.spin_rad_s.norm());
            assert!((1e-4..1e4).contains(&coin.ratio()) && (1e-6..1e3).contains(&coin.radius_m()));
            assert!((0.0..1.000_001e5).contains(&rate), "{rate}");
        }
    }
}
