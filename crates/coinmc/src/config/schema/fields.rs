//! Every key of the config format: its meaning, unit, limits and default.
//!
//! The limits are far outside anything that can be tossed; they keep typing errors and arithmetic
//! overflow out.

use super::launch::launch;
use super::terms::{default, field, fields, number, table};
use super::{Absent, Bounds, Condition, Fallback, Field, Kind, Rule, TableKind, Whole, Word};
use crate::plan::{MAX_POINTS, MAX_TOSSES};
use coinmc_analytic::Rule as ClosedForm;
use coinmc_core::{IntervalMethod, Landing, Scene};
use coinmc_flat::{Law, Settings};

use Absent::{Is, Omitted, Required};

/// The whole document.
pub(in crate::config) fn root() -> TableKind {
    const SEED_MAX: u64 = i64::MAX as u64;
    TableKind {
        fields: vec![
            field(
                "seed",
                "Key of all random numbers: the same seed, config and program version give the same \
                 counts.",
                Kind::Integer(Whole {
                    low: 0,
                    high: SEED_MAX,
                }),
                Is(Fallback::Integer(1)),
            ),
            field(
                "paired",
                "All points share their random numbers, which sharpens differences between points.",
                Kind::Boolean,
                Is(Fallback::Boolean(false)),
            ),
            table(
                "coin",
                "What is tossed: a cylinder of height H and radius R.",
                coin(),
                Required,
            ),
            table("surface", "What the coin lands on.", surface(), Omitted),
            table(
                "environment",
                "Where it happens.",
                environment(),
                Is(Fallback::Table),
            ),
            table("launch", "How the coin is let go.", launch(), Omitted),
            field(
                "engine",
                "Who follows the toss; exactly one.",
                Kind::Choice(vec![], engines()),
                Required,
            ),
            table("stop", "When a point has enough tosses.", stop(), Omitted),
            table(
                "estimate",
                "How intervals are computed.",
                estimate(),
                Is(Fallback::Table),
            ),
            table(
                "sweep",
                "How the axes of a sweep combine.",
                sweep(),
                Is(Fallback::Table),
            ),
        ],
        rules: vec![Rule::Unless {
            condition: Condition::Tag("engine", "analytic"),
            keys: &["surface", "launch", "stop"],
            fallback: None,
        }],
    }
}

/// The keys of a range; the bounds are those of the number that is swept.
pub(in crate::config) fn range(bounds: Bounds) -> TableKind {
    let steps = Whole {
        low: 2,
        high: MAX_POINTS,
    };
    fields(vec![
        field("from", "First value.", Kind::Real(bounds), Required),
        field(
            "to",
            "Last value, larger than the first.",
            Kind::Real(bounds),
            Required,
        ),
        field(
            "steps",
            "How many values, both ends included.",
            Kind::Integer(steps),
            Required,
        ),
        field(
            "scale",
            "Even steps, or even ratios between steps.",
            Kind::Word(vec![
                Word {
                    name: "linear",
                    doc: "even steps",
                },
                Word {
                    name: "log",
                    doc: "even ratios; both ends above 0",
                },
            ]),
            Is(Fallback::Word("linear")),
        ),
    ])
}

fn coin() -> TableKind {
    let moment = Kind::Number(Bounds::open(0.0, 1e30));
    fields(vec![
        number(
            "ratio",
            "Height over radius, H/R.",
            Bounds::closed(1e-12, 1e12),
            Required,
        ),
        number(
            "radius_m",
            "Radius R, m.",
            Bounds::closed(1e-9, 1e6),
            default(0.01),
        ),
        number(
            "mass_kg",
            "Mass, kg. It cancels everywhere; only given moments of inertia refer to it.",
            Bounds::closed(1e-12, 1e12),
            default(0.01),
        ),
        field(
            "axial_moment_kg_m2",
            "Moment of inertia about the coin's axis, kg m², of a hollow or loaded coin; a uniform \
             cylinder's if absent.",
            moment.clone(),
            Omitted,
        ),
        field(
            "transverse_moment_kg_m2",
            "Moment of inertia about a diameter through the centre, kg m²; a uniform cylinder's if \
             absent.",
            moment,
            Omitted,
        ),
    ])
}

fn surface() -> TableKind {
    let landing = vec![
        Word {
            name: landing_name(Landing::Bouncing),
            doc: "impacts, rocking, sliding, settling",
        },
        Word {
            name: landing_name(Landing::Adhesive),
            doc: "the first contact decides",
        },
    ];
    TableKind {
        fields: vec![
            number(
                "restitution",
                "Coefficient of restitution e at the contact point.",
                Bounds::closed(0.0, 1.0),
                Omitted,
            ),
            number(
                "friction",
                "Coefficient of friction μ.",
                Bounds::closed(0.0, 1e6),
                Omitted,
            ),
            field(
                "landing",
                "What a contact does.",
                Kind::Word(landing),
                Is(Fallback::Word(landing_name(Landing::Bouncing))),
            ),
        ],
        rules: vec![Rule::Unless {
            condition: Condition::Word("landing", landing_name(Landing::Adhesive)),
            keys: &["restitution", "friction"],
            fallback: Some(Fallback::Number(0.0)),
        }],
    }
}

/// The word for a way of landing.
pub(in crate::config) const fn landing_name(landing: Landing) -> &'static str {
    match landing {
        Landing::Bouncing => "bouncing",
        Landing::Adhesive => "adhesive",
    }
}

fn environment() -> TableKind {
    fields(vec![number(
        "gravity_m_s2",
        "Acceleration of gravity, m/s².",
        Bounds::closed(1e-6, 1e6),
        default(Scene::STANDARD_GRAVITY_M_S2),
    )])
}

fn engines() -> Vec<Field> {
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
            flat(),
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

fn flat() -> TableKind {
    let settings = Settings::default();
    let law = |law: Law| Word {
        name: law.name(),
        doc: match law {
            Law::Moreau => "Newton restitution, Coulomb friction against the final slip",
            Law::ChatterjeeRuina => "Chatterjee & Ruina (1998), tangential restitution 0",
        },
    };
    let fraction = number(
        "energy_fraction",
        "Decided when the energy has fallen to this fraction of its first value, or earlier if \
         certain.",
        Bounds::open(0.0, 1.0),
        Required,
    );
    fields(vec![
        field(
            "law",
            "Law of impact.",
            Kind::Word(Law::ALL.map(law).to_vec()),
            Is(Fallback::Word(settings.law.name())),
        ),
        field(
            "decision",
            "When the face of a toss counts as decided.",
            Kind::Choice(
                vec![Word {
                    name: "certain",
                    doc: "when energy alone makes it certain",
                }],
                vec![fraction],
            ),
            Is(Fallback::Word("certain")),
        ),
        number(
            "zeno",
            "A sequence of bounces becomes sustained contact when the rest of it would turn the \
             coin by less than about this angle, rad.",
            Bounds {
                low: 0.0,
                high: 1.0,
                open: (true, false),
            },
            default(settings.zeno),
        ),
        number(
            "tolerance",
            "Relative error allowed per step of sliding contact.",
            Bounds::closed(1e-12, 1e-2),
            default(settings.tolerance),
        ),
        field(
            "max_impacts",
            "Impacts after which a toss is given up as undecided.",
            Kind::Integer(Whole {
                low: 1,
                high: u64::from(u32::MAX),
            }),
            Is(Fallback::Integer(u64::from(settings.max_impacts))),
        ),
    ])
}

fn stop() -> TableKind {
    let tosses = Kind::Integer(Whole {
        low: 1,
        high: MAX_TOSSES,
    });
    TableKind {
        fields: vec![
            field("tosses", "Tosses per point.", tosses.clone(), Omitted),
            field(
                "half_width",
                "Toss until every face's interval is no wider than ± this.",
                Kind::Real(Bounds {
                    low: 1e-7,
                    high: 0.5,
                    open: (false, true),
                }),
                Omitted,
            ),
            field(
                "max_tosses",
                "Tosses at which a point stops short of its half_width (100 million if absent).",
                tosses,
                Omitted,
            ),
        ],
        rules: vec![
            Rule::ExactlyOne(&["tosses", "half_width"]),
            Rule::GoesWith {
                key: "max_tosses",
                other: "half_width",
                fallback: Fallback::Integer(100_000_000),
            },
        ],
    }
}

fn estimate() -> TableKind {
    let method = |method: IntervalMethod, doc| Word {
        name: method.name(),
        doc,
    };
    fields(vec![
        field(
            "confidence",
            "Probability that an interval holds the true value.",
            Kind::Real(Bounds {
                low: 0.5,
                high: 1.0,
                open: (false, true),
            }),
            default(0.95),
        ),
        field(
            "interval",
            "How intervals are computed when the number of tosses is fixed.",
            Kind::Word(vec![
                method(IntervalMethod::Wilson, "coverage close to nominal, short"),
                method(
                    IntervalMethod::ClopperPearson,
                    "coverage never below nominal, longer",
                ),
            ]),
            Is(Fallback::Word(IntervalMethod::default().name())),
        ),
    ])
}

fn sweep() -> TableKind {
    fields(vec![field(
        "mode",
        "Every combination of the axes, or their first values, their second values, …",
        Kind::Word(vec![
            Word {
                name: "grid",
                doc: "every combination",
            },
            Word {
                name: "zip",
                doc: "side by side; all axes are equally long",
            },
        ]),
        Is(Fallback::Word("grid")),
    )])
}
