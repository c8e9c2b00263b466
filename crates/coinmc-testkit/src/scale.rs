//! The same toss in other units.

use coinmc_core::{Coin, Drag, Launch, Roughness, Scene};

/// Lengths times `length`, times times `time`.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Factor of lengths.
    pub length: f64,
    /// Factor of times.
    pub time: f64,
}

impl Scale {
    /// The scene with coin, gravity, friction lengths, threshold and drag scaled. The coin is a
    /// cylinder of the default mass.
    ///
    /// # Panics
    /// If a scaled parameter is out of range.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let Self { length, time } = *self;
        let (coin, surface, drag) = (&scene.coin, &scene.surface, scene.drag());
        let threshold = surface.restitution_threshold_m_s() * length / time;
        let reference = surface.restitution_reference_m_s() * length / time;
        let exponent = surface.restitution_exponent();
        let rolling = surface.rolling_friction_m() * length;
        let surface = surface
            .with_friction_lengths(rolling, surface.pivoting_friction_m() * length)
            .and_then(|surface| surface.with_restitution_threshold(threshold))
            .and_then(|surface| surface.with_speed_dependent_restitution(exponent, reference))
            .expect("scaled lengths and speeds stay in range")
            .with_roughness(surface.roughness().map(|roughness| {
                Roughness::new(roughness.slope(), roughness.wavelength_m() * length)
                    .expect("a scaled wavelength stays positive")
            }));
        let coin = Coin::cylinder(coin.ratio(), coin.radius_m() * length).expect("R > 0");
        let gravity = scene.gravity_m_s2() * length / (time * time);
        let drag = Drag::new(drag.linear_per_s() / time, drag.angular_per_s() / time);
        Scene::new(coin, surface, gravity)
            .expect("gravity is positive")
            .with_drag(drag.expect("rates stay in range"))
            .with_gyroscopic_torque(scene.has_gyroscopic_torque())
    }

    /// The launch with height, velocity and spin scaled.
    #[must_use]
    pub fn launch(&self, launch: &Launch) -> Launch {
        Launch {
            height_m: launch.height_m * self.length,
            velocity_m_s: launch.velocity_m_s * (self.length / self.time),
            spin_rad_s: launch.spin_rad_s / self.time,
            ..*launch
        }
    }
}
