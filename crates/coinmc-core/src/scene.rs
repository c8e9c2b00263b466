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
}
