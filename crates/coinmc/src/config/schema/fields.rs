//! Every key of the config format: its meaning, unit, limits and default.
//!
//! The limits are far outside anything that can be tossed; they keep typing errors and arithmetic
//! overflow out.

use super::{Absent, Bounds, Condition, Fallback, Field, Kind, Rule, TableKind, Whole, Word};
use crate::engines::{ENGINES, WITHOUT_TOSSES};
use crate::plan::{MAX_POINTS, MAX_TOSSES, Sampling};
use coinmc_core::schema::{default, field, fields, table};
use coinmc_core::{
    Coin, EngineDescriptor, Face, IntervalMethod, LaunchDistribution, Scene, Surface,
};

use Absent::{Is, Omitted, Required};

/// The whole document.
pub(in crate::config) fn root() -> TableKind {
    TableKind {
        fields: vec![
            field(
                "seed",
                "Key of all random numbers: the same seed, config and program version give the same \
                 counts.",
                Kind::Integer(Whole {
                    low: 0,
                    high: u64::MAX,
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
                Coin::schema(),
                Required,
            ),
            table(
                "surface",
                "What the coin lands on.",
                Surface::schema(),
                Omitted,
            ),
            table(
                "environment",
                "Where it happens.",
                Scene::environment_schema(),
                Is(Fallback::Table),
            ),
            table(
                "launch",
                "How the coin is let go.",
                LaunchDistribution::schema(),
                Omitted,
            ),
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
                "sampling",
                "How launches are drawn where the first contact decides.",
                sampling(),
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
            condition: Condition::Tag("engine", WITHOUT_TOSSES.name),
            keys: &["surface", "launch", "stop"],
            fallback: None,
        }],
    }
}

/// The tags of `[engine.…]`.
fn engines() -> Vec<Field> {
    let tag =
        |engine: &EngineDescriptor| table(engine.name, engine.doc, (engine.schema)(), Required);
    ENGINES.map(tag).to_vec()
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

fn stop() -> TableKind {
    let tosses = Kind::Integer(Whole {
        low: 1,
        high: MAX_TOSSES,
    });
    let seconds = Kind::Real(Bounds {
        low: 0.0,
        high: 1e9,
        open: (true, false),
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
                "relative_error",
                "Toss until every face's interval is no wider than ± this share of its probability.",
                Kind::Real(Bounds {
                    low: 1e-6,
                    high: 1.0,
                    open: (false, true),
                }),
                Omitted,
            ),
            field(
                "events",
                "Toss until every face has been seen so many times.",
                tosses.clone(),
                Omitted,
            ),
            field(
                "face",
                "The face that these targets are of (each, if absent).",
                Kind::Word(faces()),
                Omitted,
            ),
            field(
                "max_tosses",
                "Tosses at which a point stops short of these targets (100 million if absent).",
                tosses,
                Omitted,
            ),
            field(
                "total_tosses",
                "Tosses of all points together at which the run stops short of these targets.",
                Kind::Integer(Whole {
                    low: 1,
                    high: MAX_TOSSES,
                }),
                Omitted,
            ),
            field(
                "max_core_seconds",
                "Computing time, in seconds of one core, at which a point stops short of these targets.",
                seconds.clone(),
                Omitted,
            ),
            field(
                "total_core_seconds",
                "Computing time of all points together, in seconds of one core, at which the run stops short \
                 of these targets.",
                seconds,
                Omitted,
            ),
        ],
        rules: rules_of_stop(),
    }
}

/// Keys of `[stop]` that each are a target, in place of a number of tosses.
pub(in crate::config) const TARGETS: [&str; 3] = ["half_width", "relative_error", "events"];

/// Tosses or targets, and what goes with targets.
fn rules_of_stop() -> Vec<Rule> {
    let goes_with_targets = |key| Rule::GoesWith {
        key,
        others: &TARGETS,
        fallback: None,
    };
    vec![
        Rule::Unless {
            condition: Condition::Either(&[
                Condition::Given("half_width"),
                Condition::Given("relative_error"),
                Condition::Given("events"),
            ]),
            keys: &["tosses"],
            fallback: None,
        },
        Rule::NotBoth(["tosses", "half_width"]),
        Rule::NotBoth(["tosses", "relative_error"]),
        Rule::NotBoth(["tosses", "events"]),
        Rule::GoesWith {
            key: "max_tosses",
            others: &TARGETS,
            fallback: Some(Fallback::Integer(100_000_000)),
        },
        goes_with_targets("face"),
        goes_with_targets("total_tosses"),
        goes_with_targets("max_core_seconds"),
        goes_with_targets("total_core_seconds"),
    ]
}

/// The faces by name.
fn faces() -> Vec<Word> {
    let faces = [
        (Face::Heads, "one of the flat faces"),
        (Face::Tails, "the other"),
        (Face::Side, "the curved one"),
    ];
    let word = |(face, doc): (Face, _)| Word {
        name: face.name(),
        doc,
    };
    faces.map(word).to_vec()
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

fn sampling() -> TableKind {
    let method = |method: Sampling, doc| Word {
        name: method.name(),
        doc,
    };
    fields(vec![field(
        "method",
        "How probabilities are found where landing = \"adhesive\" (engines flat and volumetric).",
        Kind::Word(vec![
            method(
                Sampling::Auto,
                "by closed form or quadrature, without tosses, wherever that is sharper",
            ),
            method(Sampling::Random, "by random tosses, as everywhere else"),
        ]),
        Is(Fallback::Word(Sampling::Auto.name())),
    )])
}

fn sweep() -> TableKind {
    fields(vec![field(
        "mode",
        "Every combination of the axes; or their first values, their second values, …; or points spread evenly \
         between the ends of their ranges.",
        Kind::Word(vec![
            Word {
                name: "grid",
                doc: "every combination",
            },
            Word {
                name: "zip",
                doc: "side by side; all axes are equally long",
            },
            Word {
                name: "sobol",
                doc: "ranges of equally many steps, which are taken as that many scrambled Sobol' points in \
                      the box between their ends",
            },
        ]),
        Is(Fallback::Word("grid")),
    )])
}
