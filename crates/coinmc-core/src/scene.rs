//! The scene: coin, surface, gravity and drag.

use crate::schema::{Bounds, ReadError, TableKind, Values, default, fields, flag, number};
use crate::{Coin, Surface, SurfaceError};
use nalgebra::Vector3;

/// Everything about a toss that is not its launch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// What is tossed.
    pub coin: Coin,
    /// What it lands on.
    pub surface: Surface,
    gravity_m_s2: f64,
    drag: Drag,
    gyroscopic_torque: bool,
}

/// Linear drag in flight and in contact: v' = −linear·v, L' = −angular·L on top of all else.
///
/// # Example
/// ```
/// use coinmc_core::Drag;
/// assert!(Drag::new(1.0, 0.05).is_ok() && Drag::new(-1.0, 0.0).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Drag {
    linear_per_s: f64,
    angular_per_s: f64,
}

impl Drag {
    /// Rates of decay of the centre's velocity and of the angular momentum, 1/s.
    ///
    /// # Errors
    /// [`SurfaceError::Drag`] unless both are finite and not negative.
    pub fn new(linear_per_s: f64, angular_per_s: f64) -> Result<Self, SurfaceError> {
        for rate in [linear_per_s, angular_per_s] {
            if !(rate >= 0.0 && rate.is_finite()) {
                return Err(SurfaceError::Drag(rate));
            }
        }
        Ok(Self {
            linear_per_s,
            angular_per_s,
        })
    }

    /// Rate at which the centre's velocity decays, 1/s.
    pub fn linear_per_s(&self) -> f64 {
        self.linear_per_s
    }

    /// Rate at which the angular momentum decays, 1/s.
    pub fn angular_per_s(&self) -> f64 {
        self.angular_per_s
    }

    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        self.linear_per_s == 0.0 && self.angular_per_s == 0.0
    }
}

/// A parameter of a scene that results state.
#[derive(Debug, Clone, Copy)]
pub struct SceneParameter {
    /// The name of its column.
    pub name: &'static str,
    /// Its value in a scene.
    pub value: fn(&Scene) -> f64,
}

impl Scene {
    /// The parameters that every result states, swept or not, with their values: without them a toss is
    /// not defined.
    pub const PARAMETERS: [SceneParameter; 17] = [
        SceneParameter {
            name: "ratio",
            value: |scene| scene.coin.ratio(),
        },
        SceneParameter {
            name: "radius_m",
            value: |scene| scene.coin.radius_m(),
        },
        SceneParameter {
            name: "rim_radius_m",
            value: |scene| scene.coin.rim_radius_m(),
        },
        SceneParameter {
            name: "restitution",
            value: |scene| scene.surface.restitution(),
        },
        SceneParameter {
            name: "friction",
            value: |scene| scene.surface.friction(),
        },
        SceneParameter {
            name: "rolling_friction_m",
            value: |scene| scene.surface.rolling_friction_m(),
        },
        SceneParameter {
            name: "pivoting_friction_m",
            value: |scene| scene.surface.pivoting_friction_m(),
        },
        SceneParameter {
            name: "restitution_threshold_m_s",
            value: |scene| scene.surface.restitution_threshold_m_s(),
        },
        SceneParameter {
            name: "linear_drag_per_s",
            value: |scene| scene.drag().linear_per_s(),
        },
        SceneParameter {
            name: "angular_drag_per_s",
            value: |scene| scene.drag().angular_per_s(),
        },
        SceneParameter {
            name: "restitution_exponent",
            value: |scene| scene.surface.restitution_exponent(),
        },
        SceneParameter {
            name: "restitution_reference_m_s",
            value: |scene| scene.surface.restitution_reference_m_s(),
        },
        SceneParameter {
            name: "roughness_slope",
            value: |scene| scene.surface.given_roughness().map_or(0.0, |r| r.slope()),
        },
        SceneParameter {
            name: "roughness_wavelength_m",
            value: |scene| {
                scene
                    .surface
                    .given_roughness()
                    .map_or(0.0, |r| r.wavelength_m())
            },
        },
        SceneParameter {
            name: "table_radius_m",
            value: |scene| scene.surface.table_radius_m().unwrap_or(0.0),
        },
        SceneParameter {
            name: "table_tilt_deg",
            value: |scene| scene.surface.tilt().map_or(0.0, |tilt| tilt.angle_deg()),
        },
        SceneParameter {
            name: "table_downhill_deg",
            value: |scene| {
                scene
                    .surface
                    .tilt()
                    .map_or(0.0, |tilt| tilt.direction_deg())
            },
        },
    ];

    /// The keys of the table `[environment]` of a config.
    pub fn environment_schema() -> TableKind {
        let rate = Bounds::closed(0.0, 1e6);
        fields(vec![
            number(
                "gravity_m_s2",
                "Acceleration of gravity, m/s².",
                Bounds::closed(1e-6, 1e6),
                default(Self::STANDARD_GRAVITY_M_S2),
            ),
            number(
                "linear_drag_per_s",
                "Rate at which the velocity of the centre decays, 1/s.",
                rate,
                default(0.0),
            ),
            number(
                "angular_drag_per_s",
                "Rate at which the angular momentum decays, 1/s.",
                rate,
                default(0.0),
            ),
            flag(
                "gyroscopic_torque",
                "Whether the gyroscopic torque acts, as in nature. Without it a coin in flight turns \
                 about a fixed angular velocity, as in PhysX and Unity.",
                true,
            ),
        ])
    }

    /// The scene of a coin and a surface in the environment that a config gives.
    ///
    /// # Errors
    /// [`ReadError`] where [`SurfaceError`] applies.
    pub fn read(coin: Coin, surface: Surface, environment: &Values) -> Result<Self, ReadError> {
        let number = |key| environment.number(key);
        let drag = Drag::new(number("linear_drag_per_s")?, number("angular_drag_per_s")?);
        let drag = drag.map_err(|error| ReadError::new(error.to_string()))?;
        let gyroscopic_torque = environment.boolean("gyroscopic_torque")?;
        Self::new(coin, surface, number("gravity_m_s2")?)
            .map(|scene| scene.with_drag(drag))
            .map(|scene| scene.with_gyroscopic_torque(gyroscopic_torque))
            .map_err(|error| ReadError::new(error.to_string()).at("gravity_m_s2"))
    }

    /// Standard acceleration of gravity as the literature on coins rounds it, m/s².
    pub const STANDARD_GRAVITY_M_S2: f64 = 9.81;

    /// A coin, a surface and the acceleration of gravity.
    ///
    /// # Errors
    /// [`SurfaceError::Gravity`] unless `gravity_m_s2` is positive and finite;
    /// [`SurfaceError::Roughness`] if the surface's waves are too short for the coin;
    /// [`SurfaceError::Conical`] or [`SurfaceError::Loaded`] where such a coin is not modelled.
    pub fn new(coin: Coin, surface: Surface, gravity_m_s2: f64) -> Result<Self, SurfaceError> {
        if let Some(roughness) = surface.roughness() {
            roughness.check_for(&coin)?;
        }
        if let Some((_, error)) = surface.unfit_for(&coin) {
            return Err(error);
        }
        if gravity_m_s2 > 0.0 && gravity_m_s2.is_finite() {
            Ok(Self {
                coin,
                surface,
                gravity_m_s2,
                drag: Drag::default(),
                gyroscopic_torque: true,
            })
        } else {
            Err(SurfaceError::Gravity(gravity_m_s2))
        }
    }

    /// The same scene with drag.
    pub fn with_drag(self, drag: Drag) -> Self {
        Self { drag, ..self }
    }

    /// The same scene with or without the gyroscopic torque ω × Iω. Without it a coin turns about
    /// a fixed ω instead of a fixed L, which it does not keep: unphysical, and what PhysX (hence
    /// Unity) does unless told otherwise.
    pub fn with_gyroscopic_torque(self, gyroscopic_torque: bool) -> Self {
        Self {
            gyroscopic_torque,
            ..self
        }
    }

    /// The drag.
    pub fn drag(&self) -> Drag {
        self.drag
    }

    /// Whether ω × Iω acts, as it does in nature.
    pub fn has_gyroscopic_torque(&self) -> bool {
        self.gyroscopic_torque
    }

    /// Acceleration of gravity g, m/s².
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// The same scene with the gravity that presses a coin onto a tilted table, g cos β.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface, TableTilt};
    /// let surface = Surface::new(0.5, 0.3)?.with_tilt(TableTilt::new(10.0, 0.0)?)?;
    /// let scene = Scene::new(Coin::cylinder(0.2, 0.01)?, surface, 10.0)?;
    /// assert!((scene.pressed_onto_table().gravity_m_s2() - 9.848).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn pressed_onto_table(&self) -> Self {
        let cos = self.surface.tilt().map_or(1.0, |tilt| tilt.cos());
        Self {
            gravity_m_s2: self.gravity_m_s2 * cos,
            ..*self
        }
    }

    /// The weight per unit mass, m/s²: g downwards; in [axes of the table](crate::TableTilt) on a tilted
    /// one.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface, TableTilt};
    /// let surface = Surface::new(0.5, 0.3)?.with_tilt(TableTilt::new(10.0, 0.0)?)?;
    /// let scene = Scene::new(Coin::cylinder(0.2, 0.01)?, surface, 10.0)?;
    /// let weight = scene.weight_m_s2();
    /// assert!((weight.x - 1.736).abs() < 1e-3 && (weight.z + 9.848).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn weight_m_s2(&self) -> Vector3<f64> {
        let weight = Vector3::new(0.0, 0.0, -self.gravity_m_s2);
        self.surface
            .tilt()
            .map_or(weight, |tilt| tilt.in_table_axes(&weight))
    }

    /// sqrt(D/g), s: the time scale of a coin toppling over its rim.
    pub fn time_scale_s(&self) -> f64 {
        (self.coin.rim_distance_m() / self.gravity_m_s2).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_each_range_are_in_and_beyond_is_out() {
        assert!(Surface::new(0.0, 0.0).is_ok() && Surface::new(1.0, 1e6).is_ok());
        for (e, mu) in [
            (-1e-9, 0.0),
            (1.0 + 1e-9, 0.0),
            (0.5, -1e-9),
            (f64::NAN, 0.0),
        ] {
            assert!(Surface::new(e, mu).is_err(), "{e} {mu}");
        }
        assert!(Surface::new(0.5, f64::INFINITY).is_err());
        let surface = Surface::new(0.5, 0.3).unwrap();
        for bad in [-1e-9, f64::NAN, f64::INFINITY] {
            assert!(surface.with_friction_lengths(bad, 0.0).is_err());
            assert!(surface.with_friction_lengths(0.0, bad).is_err());
            assert!(surface.with_restitution_threshold(bad).is_err());
            assert!(surface.with_speed_dependent_restitution(bad, 1.0).is_err());
            assert!(surface.with_speed_dependent_restitution(0.25, bad).is_err());
            assert!(Drag::new(bad, 0.0).is_err() && Drag::new(0.0, bad).is_err());
        }
        assert!(surface.with_speed_dependent_restitution(1.0, 1e-9).is_ok());
        assert!(
            surface
                .with_speed_dependent_restitution(1.001, 1.0)
                .is_err()
        );
        let coin = Coin::cylinder(1.0, 1.0).unwrap();
        for g in [0.0, -9.81, f64::NAN, f64::INFINITY] {
            assert!(Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), g).is_err());
        }
    }
    #[test]
    fn waves_too_short_for_the_coin_are_refused_where_there_are_waves() {
        let coin = Coin::cylinder(0.2, 0.01).unwrap();
        let on = |slope, wavelength_m| {
            let roughness = crate::Roughness::new(slope, wavelength_m).unwrap();
            let surface = Surface::new(0.5, 0.3).unwrap();
            Scene::new(coin, surface.with_roughness(Some(roughness)), 9.81)
        };
        assert!(on(0.05, 5e-5).unwrap().surface.roughness().is_some());
        assert!(on(0.0, 1e-9).unwrap().surface.roughness().is_none());
        assert!(matches!(on(0.05, 4e-5), Err(SurfaceError::Roughness(_))));
    }

    fn on(surface: Surface, gravity: f64) -> Scene {
        let coin = Coin::cylinder(0.2, 0.01).expect("a good coin");
        Scene::new(coin, surface, gravity).expect("a good scene")
    }

    fn wood() -> Surface {
        Surface::new(0.5, 0.3).expect("a good surface")
    }

    /// A coin that falls from rest for sqrt(D/g) falls by D/2, on every planet.
    #[test]
    fn the_time_scale_is_that_of_a_fall_through_half_a_rim_distance() {
        for gravity in [1.62, 9.81, 24.8, 300.0] {
            let scene = on(wood(), gravity);
            assert_eq!(scene.gravity_m_s2(), gravity);
            let fall = 0.5 * gravity * scene.time_scale_s().powi(2);
            assert!((fall / (0.5 * scene.coin.rim_distance_m()) - 1.0).abs() < 1e-15);
        }
    }

    /// A tilted table turns the weight and keeps its size: g sin β is left along the table, g cos β presses.
    #[test]
    fn a_tilted_table_splits_the_weight() {
        let tilt = crate::TableTilt::new(9.0, 130.0).expect("a good tilt");
        let scene = on(wood().with_tilt(tilt).expect("friction enough"), 9.81);
        let (weight, pressed) = (scene.weight_m_s2(), scene.pressed_onto_table());
        assert!((weight.norm() / 9.81 - 1.0).abs() < 1e-15);
        let (sin, cos) = libm::sincos(9.0_f64.to_radians());
        let [ex, ey] = tilt.downhill();
        assert!((weight.z + 9.81 * cos).abs() < 1e-14);
        assert!((weight.x * ex + weight.y * ey - 9.81 * sin).abs() < 1e-14);
        assert!((pressed.gravity_m_s2() - 9.81 * cos).abs() < 1e-14);
        // on a level table all of it presses
        let level = on(wood(), 9.81);
        assert_eq!(level.weight_m_s2(), Vector3::new(0.0, 0.0, -9.81));
        assert_eq!(level.pressed_onto_table(), level);
    }

    #[test]
    fn the_gyroscopic_torque_acts_unless_it_is_left_out() {
        let scene = on(wood(), 9.81);
        let without = scene.with_gyroscopic_torque(false);
        assert!(scene.has_gyroscopic_torque() && !without.has_gyroscopic_torque());
        assert_eq!(without.with_gyroscopic_torque(true), scene);
    }

    /// A scene of which no two numbers are alike is told in full, so that its toss can be repeated.
    #[test]
    fn a_result_states_every_number_of_its_scene() {
        let roughness = crate::Roughness::new(0.03, 2e-3).expect("rough ground");
        let tilt = crate::TableTilt::new(4.0, 25.0).expect("a good tilt");
        let surface = Surface::new(0.55, 0.35)
            .and_then(|surface| surface.with_friction_lengths(5e-5, 6e-6))
            .and_then(|surface| surface.with_restitution_threshold(0.02))
            .and_then(|surface| surface.with_speed_dependent_restitution(0.25, 0.7))
            .and_then(|surface| surface.with_table_radius(0.4))
            .and_then(|surface| surface.with_tilt(tilt))
            .expect("a surface");
        let coin = Coin::cylinder(0.15, 0.012).and_then(|coin| coin.with_rim_radius(3e-4));
        let surface = surface.with_roughness(Some(roughness));
        let scene = Scene::new(coin.expect("a euro"), surface, 9.81)
            .expect("a scene")
            .with_drag(Drag::new(0.8, 0.06).expect("drag"));
        let given: [_; Scene::PARAMETERS.len()] = [
            ("ratio", 0.15),
            ("radius_m", 0.012),
            ("rim_radius_m", 3e-4),
            ("restitution", 0.55),
            ("friction", 0.35),
            ("rolling_friction_m", 5e-5),
            ("pivoting_friction_m", 6e-6),
            ("restitution_threshold_m_s", 0.02),
            ("linear_drag_per_s", 0.8),
            ("angular_drag_per_s", 0.06),
            ("restitution_exponent", 0.25),
            ("restitution_reference_m_s", 0.7),
            ("roughness_slope", 0.03),
            ("roughness_wavelength_m", 2e-3),
            ("table_radius_m", 0.4),
            ("table_tilt_deg", 4.0),
            ("table_downhill_deg", 25.0),
        ];
        for (parameter, (name, value)) in Scene::PARAMETERS.iter().zip(given) {
            assert_eq!((parameter.name, (parameter.value)(&scene)), (name, value));
        }
    }

    /// Slope 0 is a plane whatever its waves, but a sweep over the slope has one wavelength for all of it.
    #[test]
    fn a_result_states_the_wavelength_of_a_plane_as_given() {
        let plane = crate::Roughness::new(0.0, 2e-3).expect("a plane");
        let scene = on(wood().with_roughness(Some(plane)), 9.81);
        let wavelength = Scene::PARAMETERS
            .iter()
            .find(|parameter| parameter.name == "roughness_wavelength_m")
            .expect("a column");
        assert_eq!((wavelength.value)(&scene), 2e-3);
        assert!(scene.surface.roughness().is_none());
    }
}
