//! The engines and their settings.

mod impact_laws;

use super::Absent::{Is, Required};
use super::rapier;
use super::terms::{default, field, fields, number, table};
use super::{Bounds, Fallback, Field, Kind, TableKind, Whole, Word};
use coinmc_analytic::Rule as ClosedForm;
use coinmc_flat as flat;
use coinmc_volumetric as volumetric;
use impact_laws::impact_laws;

/// The name of the decision that needs no number.
pub(in crate::config) const ENERGY: &str = "energy";

/// Limit of the small numbers below which motion counts as none.
const SMALL: Bounds = above_zero(0.1);

/// The tags of `[engine.…]`.
pub(super) fn engines() -> Vec<Field> {
    let rules = ClosedForm::ALL.map(|rule| Word {
        name: rule.name(),
        doc: rule.assumption(),
    });
    let analytic = fields(vec![field(
        "rule",
        "The closed form.",
        Kind::Word(rules.to_vec()),
        Required,
    )]);
    vec![
        table(
            "flat",
            "The toss in a vertical plane, impact by impact.",
            in_the_plane(),
            Required,
        ),
        table(
            "volumetric",
            "The toss in space, impact by impact.",
            in_space(),
            Required,
        ),
        table(
            "rapier",
            "The toss in space in time steps, on the physics engine Rapier.",
            rapier::settings(),
            Required,
        ),
        table(
            "analytic",
            "A closed form in the ratio alone: no toss is made.",
            analytic,
            Required,
        ),
    ]
}

fn in_the_plane() -> TableKind {
    let settings = flat::Settings::default();
    let fraction = number(
        "energy_fraction",
        "Decided when the energy has fallen to this fraction of its first value, or earlier if \
         certain.",
        Bounds::open(0.0, 1.0),
        Required,
    );
    fields(vec![
        impact_laws(settings.law.name()),
        field(
            "decision",
            DECISION,
            Kind::Choice(
                vec![Word {
                    name: ENERGY,
                    doc: "when energy alone makes it certain",
                }],
                vec![fraction],
            ),
            Is(Fallback::Word(ENERGY)),
        ),
        zeno(settings.zeno),
        number(
            "tolerance",
            "Relative error allowed per step of sliding contact and of impacts resolved in time.",
            Bounds::closed(1e-12, 1e-2),
            default(settings.tolerance),
        ),
        count(
            "max_impacts",
            "Impacts after which a toss is given up as undecided.",
            settings.max_impacts,
        ),
    ])
}

fn in_space() -> TableKind {
    let settings = volumetric::Settings::default();
    let law = |law: volumetric::Law| Word {
        name: law.name(),
        doc: match law {
            volumetric::Law::Moreau => MOREAU,
            volumetric::Law::ChatterjeeRuina => CHATTERJEE_RUINA,
            volumetric::Law::Stronge => {
                "Stronge's energetic restitution, slip followed through its reversals"
            }
        },
    };
    let decision = |decision: volumetric::Decision| Word {
        name: decision.name(),
        doc: match decision {
            volumetric::Decision::Tilting => {
                "when the energy that can still tilt the coin is too small; its bias is measured"
            }
            volumetric::Decision::Energy => {
                "when the whole energy is too small: rigorous, and slower"
            }
        },
    };
    fields(vec![
        law_field(volumetric::Law::ALL.map(law).to_vec(), settings.law.name()),
        field(
            "decision",
            DECISION,
            Kind::Word(volumetric::Decision::ALL.map(decision).to_vec()),
            Is(Fallback::Word(settings.decision.name())),
        ),
        zeno(settings.zeno),
        number(
            "tolerance",
            "Error allowed per step of sustained contact, relative to the speed that carries the coin out of \
             its shallower well.",
            Bounds::closed(1e-12, 1e-2),
            default(settings.tolerance),
        ),
        number(
            "stick_speed",
            "Slip, in sqrt(g D), below which a contact point that can stick does; D is the distance \
             of the rim from the centre.",
            SMALL,
            default(settings.stick_speed),
        ),
        number(
            "smoothing_time",
            "Time, in sqrt(D/g), over which rolling and pivoting friction end the last of a rotation.",
            SMALL,
            default(settings.smoothing_time),
        ),
        count(
            "max_impacts",
            "Impacts after which a toss is given up as undecided.",
            settings.max_impacts,
        ),
        count(
            "max_steps",
            "Steps of sustained contact after which a toss is given up as undecided.",
            settings.max_steps,
        ),
        number(
            "time_limit",
            "Simulated time, in sqrt(D/g), after which a toss is given up as undecided.",
            above_zero(1e15),
            default(settings.time_limit),
        ),
    ])
}

pub(super) const DECISION: &str = "When the face of a toss counts as decided.";
const MOREAU: &str = "Newton restitution, Coulomb friction against the final slip";
const CHATTERJEE_RUINA: &str = "Chatterjee & Ruina (1998), tangential restitution 0";

fn law_field(laws: Vec<Word>, fallback: &'static str) -> Field {
    field(
        "law",
        "Law of impact.",
        Kind::Word(laws),
        Is(Fallback::Word(fallback)),
    )
}

fn zeno(fallback: f64) -> Field {
    number(
        "zeno",
        "A sequence of bounces becomes sustained contact when the rest of it would turn the coin by \
         less than about this angle, rad.",
        above_zero(1.0),
        default(fallback),
    )
}

pub(super) fn count(key: &'static str, doc: &'static str, fallback: u32) -> Field {
    field(
        key,
        doc,
        Kind::Integer(Whole {
            low: 1,
            high: u64::from(u32::MAX),
        }),
        Is(Fallback::Integer(u64::from(fallback))),
    )
}

pub(super) const fn above_zero(high: f64) -> Bounds {
    Bounds {
        low: 0.0,
        high,
        open: (true, false),
    }
}
