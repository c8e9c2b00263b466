//! The keys of `[launch]`.

use super::Absent::{Omitted, Required};
use super::{Bounds, Condition, Field, Kind, Rule, TableKind, Word};
use coinmc_core::Preset;
use coinmc_core::schema::{field, fields, marginal, marginal_kind, table};

/// Limit of every component of a velocity, m/s.
const SPEED: Bounds = Bounds::closed(-1e6, 1e6);

/// Limit of every rate of turning, rad/s.
const RATE: Bounds = Bounds::closed(-1e9, 1e9);

/// `[launch]`.
pub(super) fn launch() -> TableKind {
    let presets = Preset::ALL.map(|preset| Word {
        name: preset.name(),
        doc: preset.source(),
    });
    let words = vec![
        Word {
            name: "isotropic",
            doc: "uniform on the sphere",
        },
        Word {
            name: "euler-angles",
            doc: "three uniform Euler angles",
        },
    ];
    TableKind {
        fields: vec![
            field(
                "preset",
                "A launch with a name and a source; the other keys replace parts of it.",
                Kind::Word(presets.to_vec()),
                Omitted,
            ),
            marginal(
                "height_m",
                "Height of the centre above the surface, m. A coin that would begin inside the \
                 surface is lifted until it touches.",
                Bounds::closed(0.0, 1e6),
                Omitted,
            ),
            field(
                "velocity_m_s",
                "Velocity of the centre, m/s; z points up. At rest if neither this nor a preset is \
                 given.",
                Kind::Vector(Box::new(marginal_kind(SPEED))),
                Omitted,
            ),
            field(
                "orientation",
                "How the coin is turned.",
                Kind::Choice(words, orientations()),
                Omitted,
            ),
            field(
                "spin",
                "How the coin spins.",
                Kind::Choice(vec![], spins()),
                Omitted,
            ),
        ],
        rules: vec![Rule::Unless {
            condition: Condition::Given("preset"),
            keys: &["height_m", "orientation", "spin"],
            fallback: None,
        }],
    }
}

fn orientations() -> Vec<Field> {
    vec![
        marginal(
            "tilt_deg",
            "Angle of the heads normal from the vertical, in the xz plane, degrees.",
            Bounds::closed(-36_000.0, 36_000.0),
            Required,
        ),
        field(
            "axis",
            "Always this direction of the heads normal, of any length.",
            direction(),
            Required,
        ),
    ]
}

fn spins() -> Vec<Field> {
    let about = fields(vec![
        field(
            "axis",
            "The axis, of any length; y for a flat toss.",
            direction(),
            Required,
        ),
        marginal("rate_rad_s", "Signed rate, rad/s.", RATE, Required),
    ]);
    let precessing = fields(vec![
        marginal(
            "rate_rad_s",
            "Angular momentum over transverse moment, rad/s.",
            RATE,
            Required,
        ),
        marginal(
            "psi_deg",
            "Angle between angular momentum and the coin's axis, degrees.",
            Bounds::closed(0.0, 180.0),
            Required,
        ),
    ]);
    vec![
        field(
            "components_rad_s",
            "Component by component in the laboratory frame, rad/s.",
            Kind::Vector(Box::new(marginal_kind(RATE))),
            Required,
        ),
        table(
            "about",
            "About a fixed axis of the laboratory.",
            about,
            Required,
        ),
        table("precessing", "A free symmetric top.", precessing, Required),
    ]
}

fn direction() -> Kind {
    Kind::Vector(Box::new(Kind::Number(Bounds::closed(-1e6, 1e6))))
}
