//! What the rest of the program knows of this engine.

use crate::laws::LAWS;
use crate::settings::{Decision, Settings};
use coinmc_core::schema::Values;
use coinmc_core::{
    Answer, EngineChoice, EngineDescriptor, EngineError, EngineKind, EngineSettings, Finer,
    Landing, Remark, Scene, Unmodelled,
};

/// The engine, as configs and results know it.
pub const ENGINE: EngineDescriptor = EngineDescriptor {
    name: "flat",
    doc: "The toss in a vertical plane, impact by impact.",
    kind: EngineKind::Planar,
    stepped: false,
    laws: &LAWS,
    unmodelled: &UNMODELLED,
    finer: &[
        ("zeno", Finer::Times(0.25)),
        ("tolerance", Finer::Times(0.1)),
    ],
    remarks: &[Remark {
        applies: |scene| {
            let surface = &scene.surface;
            surface.landing() == Landing::Bouncing && surface.restitution() == 1.0
        },
        text: "restitution = 1 loses no energy in a frictionless impact: tosses may stay undecided up \
               to engine.flat.max_impacts",
    }],
    schema: Settings::schema,
    read: |values| Settings::read(values).map(EngineChoice::new),
};

const UNMODELLED: [Unmodelled; 14] = [
    Unmodelled {
        table: "coin",
        key: "rim_radius_m",
        message: "engine.flat models sharp rims: `coin.rim_radius_m` must be 0",
        help: "remove `rim_radius_m`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "coin",
        key: "draft_deg",
        message: "engine.flat models cylinders: `coin.draft_deg` must be 0",
        help: "remove `draft_deg`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "coin",
        key: "centre_of_mass_over_height",
        message: "engine.flat models coins with their centre of mass in the middle: \
                  `coin.centre_of_mass_over_height` must be 0",
        help: "remove `centre_of_mass_over_height`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "rolling_friction_m",
        message: "engine.flat models no rolling friction: `surface.rolling_friction_m` must be 0",
        help: "remove `rolling_friction_m`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "pivoting_friction_m",
        message: "engine.flat models no pivoting friction: `surface.pivoting_friction_m` must be 0",
        help: "remove `pivoting_friction_m`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "contact_patch_m",
        message: "engine.flat models no pivoting friction: `surface.contact_patch_m` must be 0",
        help: "remove `contact_patch_m`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "restitution_threshold_m_s",
        message: "engine.flat models no restitution threshold: `surface.restitution_threshold_m_s` \
                  must be 0",
        help: "remove `restitution_threshold_m_s`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "restitution_exponent",
        message: "engine.flat models no restitution that depends on speed: \
                  `surface.restitution_exponent` must be 0",
        help: "remove `restitution_exponent`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "roughness_slope",
        message: "engine.flat models no roughness: `surface.roughness_slope` must be 0",
        help: "remove `roughness_slope` and `roughness_wavelength_m`, or toss in space with \
               [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "table_radius_m",
        message: "engine.flat models no edge of the table: `surface.table_radius_m` must be absent",
        help: "remove `table_radius_m`, or toss with [engine.volumetric]",
    },
    Unmodelled {
        table: "surface",
        key: "table_tilt_deg",
        message: "engine.flat models level tables only: `surface.table_tilt_deg` must be 0",
        help: "remove `table_tilt_deg`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "environment",
        key: "linear_drag_per_s",
        message: "engine.flat models no drag: `environment.linear_drag_per_s` must be 0",
        help: "remove `linear_drag_per_s`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "environment",
        key: "angular_drag_per_s",
        message: "engine.flat models no drag: `environment.angular_drag_per_s` must be 0",
        help: "remove `angular_drag_per_s`, or toss in space with [engine.volumetric]",
    },
    Unmodelled {
        table: "environment",
        key: "gyroscopic_torque",
        message: "engine.flat has no gyroscopic torque to switch off: \
                  `environment.gyroscopic_torque` must be true",
        help: "remove `gyroscopic_torque` (spin stays in the plane, where that torque is 0), or toss \
               in space with [engine.volumetric]",
    },
];

impl EngineSettings for Settings {
    fn descriptor(&self) -> &'static EngineDescriptor {
        &ENGINE
    }

    fn law(&self) -> &'static str {
        self.law.name()
    }

    fn explain(&self, _: &Scene) -> String {
        let decided = match self.decision {
            Decision::Energy => "until energy alone decides the face",
            Decision::EnergyFraction(_) => {
                "until the energy has fallen to the chosen fraction, and on until energy alone \
                 decides the face, to count disagreements"
            }
        };
        format!(
            "flight in closed form, impacts by the law {}, sustained contact, {decided}",
            self.law.name()
        )
    }

    fn flight_limit_s(&self, _: &Scene) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn build(&self, scene: &Scene) -> Result<Answer, EngineError> {
        let engine = self.engine(scene).map_err(EngineError::new)?;
        Ok(Answer::Tosses(engine))
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
