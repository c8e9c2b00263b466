//! What the rest of the program knows of this engine.

use crate::engine::VolumetricEngine;
use crate::impact::ImpactLaw;
use crate::laws::{LAWS, LawVisitor};
use crate::settings::{Decision, Settings, SettingsError};
use coinmc_core::schema::Values;
use coinmc_core::{
    Answer, DynEngine, EngineChoice, EngineDescriptor, EngineError, EngineKind, EngineSettings,
    Finer, Landing, Remark, Scene,
};
use std::fmt::Debug;

/// The engine, as configs and results know it.
pub const ENGINE: EngineDescriptor = EngineDescriptor {
    name: "volumetric",
    doc: "The toss in space, impact by impact.",
    kind: EngineKind::Spatial,
    stepped: false,
    laws: &LAWS,
    unmodelled: &[],
    finer: &[
        ("decision", Finer::Word("energy")),
        ("zeno", Finer::Times(0.25)),
        ("tolerance", Finer::Times(0.1)),
        ("stick_speed", Finer::Times(0.25)),
        ("smoothing_time", Finer::Times(0.25)),
        ("ground_step", Finer::Times(0.5)),
    ],
    remarks: &[
        Remark::PERFECT_PLANE,
        Remark::LONG_WAVES,
        Remark {
            applies: |scene| {
                let surface = &scene.surface;
                surface.landing() == Landing::Bouncing && surface.restitution() == 1.0
            },
            text: "restitution = 1 loses no energy in a frictionless impact: tosses may stay undecided \
                   up to engine.volumetric.max_impacts",
        },
        Remark {
            applies: |scene| {
                let surface = &scene.surface;
                let endless = surface.table_radius_m().is_none();
                endless && surface.tilt().is_some() && surface.roughness().is_some()
            },
            text: "surface.table_tilt_deg on endless rough ground: thick coins roll down up to \
                   engine.volumetric.max_steps and stay undecided; surface.table_radius_m lets them leave",
        },
        Remark {
            applies: |scene| {
                let ground = scene.surface.roughness();
                let length = ground.map_or(f64::INFINITY, |ground| ground.correlation_length_m());
                scene.coin.rim_radius_m() > length
            },
            text: "coin.rim_radius_m is more than roughness_wavelength_m / 2π: the law of rough ground takes rims to be \
                   sharper than the waves, and lets a round one into hollows that it would bridge",
        },
        Remark {
            applies: rolls_for_ever,
            text: "surface.rolling_friction_m = 0: nothing stops a coin that rolls on its rim; tosses \
                   that roll from face to side and back stay undecided, never_settles or up to \
                   engine.volumetric.max_steps",
        },
    ],
    schema: Settings::schema,
    read: |values| Settings::read(values).map(EngineChoice::new),
};

/// Whether a coin can roll without any loss.
fn rolls_for_ever(scene: &Scene) -> bool {
    let surface = &scene.surface;
    surface.landing() == Landing::Bouncing
        && surface.friction() > 0.0
        && surface.rolling_friction_m() == 0.0
        && scene.drag().is_none()
}

impl EngineSettings for Settings {
    fn descriptor(&self) -> &'static EngineDescriptor {
        &ENGINE
    }

    fn law(&self) -> &'static str {
        self.law.name()
    }

    fn explain(&self, scene: &Scene) -> String {
        let decided = match self.decision {
            Decision::Tilting => {
                "until the energy that can still tilt the coin is too small to carry it over its rim"
            }
            Decision::Energy => "until energy alone decides the face",
        };
        let threshold = if scene.surface.restitution_threshold_m_s() > 0.0 {
            " (restitution 0 below its threshold)"
        } else {
            ""
        };
        format!(
            "flight in closed form, impacts by the law {}{threshold}, sustained contact on the rim \
             and on the side, {decided}",
            self.law.name()
        )
    }

    fn flight_limit_s(&self, scene: &Scene) -> Option<f64> {
        Some(self.time_limit * scene.time_scale_s())
    }

    fn build(&self, scene: &Scene) -> Result<Answer, EngineError> {
        let engine = self.engine(scene).map_err(EngineError::new)?;
        Ok(Answer::Tosses(engine))
    }
}

/// Builds the engine of a law.
struct Build<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
}

impl LawVisitor for Build<'_> {
    type Output = Result<DynEngine, SettingsError>;

    fn visit<I: ImpactLaw + Debug + Send + 'static>(self, law: I) -> Self::Output {
        VolumetricEngine::new(self.scene, self.settings, law).map(DynEngine::new)
    }
}

impl Settings {
    /// An engine for this scene with the law of the settings.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Engine, Scene, Surface};
    /// use coinmc_volumetric::{Lanes, Settings};
    /// let scene = Scene::new(Coin::cylinder(0.85, 0.01)?, Surface::new(0.5, 0.3)?, 9.81)?;
    /// let engine = Settings::default().engine(&scene)?.with_lanes(Lanes::Scalar)?;
    /// assert_eq!(engine.lanes(), Lanes::Scalar);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn engine(&self, scene: &Scene) -> Result<DynEngine, SettingsError> {
        let settings = self;
        self.law.visit(Build { scene, settings })
    }

    /// The settings that the values of the engine's table give.
    pub(crate) fn read(values: &Values) -> Result<Self, EngineError> {
        let settings = Self::from_values(values)?;
        settings.validate().map_err(EngineError::new)?;
        Ok(settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Law;
    use crate::toss::tests::generic_scene;

    /// Settings name their law, and tell of it, of the decision and of a threshold of restitution if there is one.
    #[test]
    fn settings_tell_what_is_computed() {
        let plain = generic_scene(|plane| plane);
        let scene = generic_scene(|plane| {
            plane
                .with_restitution_threshold(0.2)
                .expect("a valid threshold")
        });
        let mut told = Vec::new();
        for law in Law::ALL {
            for decision in Decision::ALL {
                let settings = Settings {
                    law,
                    decision,
                    ..Settings::default()
                };
                assert_eq!(settings.descriptor().name, "volumetric");
                assert_eq!(EngineSettings::law(&settings), law.name());
                let text = settings.explain(&scene);
                assert!(
                    text.contains(law.name()) && text.contains("threshold"),
                    "{text}"
                );
                assert_eq!(text.contains("energy alone"), decision == Decision::Energy);
                assert!(!settings.explain(&plain).contains("threshold"));
                assert!(!told.contains(&text));
                told.push(text);
            }
        }
    }

    /// The limit of time is counted in sqrt(D/g), D the distance of the rim from the centre: of a coin with H/R = 1.5
    /// and R = 8 mm, 1 cm.
    #[test]
    fn the_limit_of_time_is_in_units_of_the_coin() {
        let coin = coinmc_core::Coin::cylinder(1.5, 0.008).expect("a valid coin");
        let surface = coinmc_core::Surface::new(0.5, 0.3).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.0).expect("a valid scene");
        let settings = Settings {
            time_limit: 600.0,
            ..Settings::default()
        };
        let limit = settings
            .flight_limit_s(&scene)
            .expect("flight in closed form");
        assert!((limit - 20.0).abs() < 1e-12, "{limit}");
    }
}
