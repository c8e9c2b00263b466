//! What the rest of the program knows of this engine.

use crate::engine::RapierEngine;
use crate::settings::{Decision, Flight, Settings};
use coinmc_core::schema::Values;
use coinmc_core::{
    Answer, DynEngine, EngineChoice, EngineDescriptor, EngineError, EngineKind, EngineSettings,
    Finer, Landing, Remark, Scene, Unmodelled,
};

/// The engine, as configs and results know it.
pub const ENGINE: EngineDescriptor = EngineDescriptor {
    name: "rapier",
    doc: "The toss in space in time steps, on the physics engine Rapier.",
    kind: EngineKind::Spatial,
    stepped: true,
    laws: &[],
    unmodelled: &UNMODELLED,
    finer: &[("step_s", Finer::Times(0.5))],
    remarks: &[
        Remark::PERFECT_PLANE,
        Remark {
            applies: |scene| bounces(scene) && scene.surface.restitution() == 1.0,
            text: "restitution = 1 loses no energy in a frictionless impact: tosses may stay undecided \
                   up to engine.rapier.max_steps",
        },
        Remark {
            applies: bounces,
            text: "engine.rapier: the intervals hold the chance of the tosses, not the error of the \
                   time steps and of Rapier's impacts; docs/methods/rapier.md has measured it",
        },
    ],
    schema: Settings::schema,
    read: |values| Settings::read(values).map(EngineChoice::new),
};

const UNMODELLED: [Unmodelled; 7] = [
    Unmodelled {
        table: "coin",
        key: "rim_radius_m",
        message: "engine.rapier tosses sharp rims: `coin.rim_radius_m` must be 0",
        help: "remove `rim_radius_m`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "coin",
        key: "draft_deg",
        message: "engine.rapier tosses cylinders: `coin.draft_deg` must be 0",
        help: "remove `draft_deg`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "coin",
        key: "centre_of_mass_over_height",
        message: "engine.rapier tosses coins with their centre of mass in the middle: \
                  `coin.centre_of_mass_over_height` must be 0",
        help: "remove `centre_of_mass_over_height`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "restitution_exponent",
        message: "engine.rapier models no restitution that depends on speed: \
                  `surface.restitution_exponent` must be 0",
        help: "remove `restitution_exponent`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "roughness_slope",
        message: "engine.rapier models no roughness: `surface.roughness_slope` must be 0",
        help: "remove `roughness_slope` and `roughness_wavelength_m`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "table_radius_m",
        message: "engine.rapier models no edge of the table: `surface.table_radius_m` must be absent",
        help: "remove `table_radius_m`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "table_tilt_deg",
        message: "engine.rapier models level tables only: `surface.table_tilt_deg` must be 0",
        help: "remove `table_tilt_deg`, or toss with [engine.volumetric]",
    },
];

fn bounces(scene: &Scene) -> bool {
    scene.surface.landing() == Landing::Bouncing
}

impl EngineSettings for Settings {
    fn descriptor(&self) -> &'static EngineDescriptor {
        &ENGINE
    }

    /// Rapier has one law of impact; how it solves friction is what can be chosen.
    fn law(&self) -> &'static str {
        self.friction_model.name()
    }

    fn explain(&self, scene: &Scene) -> String {
        let flight = match self.flight {
            Flight::Contact => {
                "flight in closed form to every contact that ends more than a step of it, "
            }
            Flight::Steps => "flight in closed form by whole steps, ",
            Flight::Off => "",
        };
        let decided = match self.decision {
            Decision::Tilting => {
                "until the energy that can still tilt the coin is too small to carry it over its rim"
            }
            Decision::Energy => "until energy alone decides the face",
            Decision::Rest => "until the coin has come to rest",
        };
        let threshold = if scene.surface.restitution_threshold_m_s() > 0.0 {
            " (restitution 0 below its threshold)"
        } else {
            ""
        };
        format!(
            "{flight}steps of Rapier, {} substeps each, friction {}{threshold}, {decided}",
            self.substeps,
            self.friction_model.name()
        )
    }

    fn build(&self, scene: &Scene) -> Result<Answer, EngineError> {
        let engine = RapierEngine::new(scene, self).map_err(EngineError::new)?;
        Ok(Answer::Tosses(DynEngine::new(engine)))
    }
}

impl Settings {
    /// The settings that the values of the engine's table give.
    fn read(values: &Values) -> Result<Self, EngineError> {
        let settings = Self::from_values(values)?;
        settings.validate().map_err(EngineError::new)?;
        Ok(settings)
    }
}
