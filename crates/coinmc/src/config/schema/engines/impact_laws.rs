//! The laws of impact of the flat toss: some are names, some tables of what they need.

use super::super::Absent::{Is, Omitted, Required};
use super::super::terms::{default, field, fields, number, table};
use super::super::{Bounds, Fallback, Field, Kind, Rule, TableKind, Word};
use super::{CHATTERJEE_RUINA, MOREAU};
use coinmc_flat as flat;

/// The field `law` of the flat engine.
pub(super) fn impact_laws(fallback: &'static str) -> Field {
    let rigid = |law: flat::Law| Word {
        name: law.name(),
        doc: match law {
            flat::Law::ChatterjeeRuina => CHATTERJEE_RUINA,
            _ => MOREAU,
        },
    };
    let tables = vec![
        table(
            "gaek-sukhov",
            "Gaek & Sukhov's law as published: surface.restitution is the square root of its k.",
            gaek_sukhov(),
            Required,
        ),
        table(
            "half-sine",
            "A force that is half a sine in time.",
            half_sine(),
            Required,
        ),
        table(
            "line-contact",
            "Elastic line contact with damping and friction, resolved in time.",
            line_contact(),
            Required,
        ),
    ];
    field(
        "law",
        "Law of impact.",
        Kind::Choice(flat::Law::RIGID.map(rigid).to_vec(), tables),
        Is(Fallback::Word(fallback)),
    )
}

fn gaek_sukhov() -> TableKind {
    let lever = |lever: flat::Lever| Word {
        name: lever.name(),
        doc: match lever {
            flat::Lever::Height => "H cos θ, as published",
            flat::Lever::Diameter => "2R cos θ, the letter L of one of its formulas",
            flat::Lever::Corner => "R cos θ − (H/2) sin θ, that of the corner that touches",
        },
    };
    fields(vec![
        number(
            "eta_n_s",
            "Its constant η = 2·N_max·τ/π, the impulse that turns the coin, N s.",
            Bounds::closed(0.0, 1e12),
            Required,
        ),
        field(
            "lever",
            "Lever of that impulse, θ the tilt of the face.",
            Kind::Word(flat::Lever::ALL.map(lever).to_vec()),
            Is(Fallback::Word(flat::Lever::default().name())),
        ),
    ])
}

fn half_sine() -> TableKind {
    TableKind {
        fields: vec![
            number(
                "time_s",
                "How long the force acts, s.",
                Bounds::closed(1e-12, 1.0),
                Omitted,
            ),
            table(
                "contact",
                "What touches, if the time is to follow from it: that of a lossless line contact.",
                fields(materials()),
                Omitted,
            ),
            number(
                "peak_n",
                "Largest force, N; what the restitution asks for if absent.",
                Bounds::closed(1e-12, 1e15),
                Omitted,
            ),
        ],
        rules: vec![Rule::ExactlyOne(&["time_s", "contact"])],
    }
}

fn line_contact() -> TableKind {
    let mut all = materials();
    all.push(number(
        "tangential",
        "Stiffness along the surface over that along the normal (2(1 − ν)/(2 − ν) with the coin's ν \
         if absent).",
        Bounds::closed(1e-3, 1e3),
        Omitted,
    ));
    fields(all)
}

fn materials() -> Vec<Field> {
    let young = Bounds::closed(1e3, 1e15);
    let poisson = Bounds::closed(-0.99, 0.5);
    vec![
        number(
            "coin_young_pa",
            "Young's modulus of the coin, Pa.",
            young,
            Required,
        ),
        number(
            "coin_poisson",
            "Poisson's ratio of the coin.",
            poisson,
            default(0.3),
        ),
        number(
            "surface_young_pa",
            "Young's modulus of the surface, Pa.",
            young,
            Required,
        ),
        number(
            "surface_poisson",
            "Poisson's ratio of the surface.",
            poisson,
            default(0.3),
        ),
        number(
            "length_m",
            "Length of the line of contact, m.",
            Bounds::closed(1e-9, 1e6),
            Required,
        ),
    ]
}
