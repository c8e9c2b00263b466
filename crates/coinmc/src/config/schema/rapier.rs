//! The settings of the engine in time steps.

use super::Absent::Is;
use super::engines::{DECISION, above_zero, count};
use super::terms::{default, field, fields, number};
use super::{Fallback, Field, Kind, TableKind, Whole, Word};
use coinmc_rapier::{Decision, Flight, FrictionModel, Gyroscopic, Settings, Standing};

/// The table `[engine.rapier]`.
pub(super) fn settings() -> TableKind {
    let settings = Settings::default();
    fields(vec![
        number(
            "step_s",
            "Time step, s.",
            above_zero(100.0),
            default(settings.step_s),
        ),
        field(
            "substeps",
            "Substeps of every step, in each of which contacts are solved once.",
            Kind::Integer(Whole { low: 1, high: 1000 }),
            Is(Fallback::Integer(u64::from(settings.substeps))),
        ),
        choice(
            "friction_model",
            "How friction is solved.",
            FrictionModel::ALL.map(|model| (model.name(), friction(model))),
            settings.friction_model.name(),
        ),
        number(
            "prediction",
            "Gap below which Rapier sees a contact, as a fraction of the distance of the rim from \
             the centre.",
            above_zero(1.0),
            default(settings.prediction),
        ),
        flag(
            "ccd",
            "Rapier's continuous collision detection; it does nothing for a plane.",
            settings.ccd,
        ),
        choice(
            "gyroscopic",
            "Who adds the gyroscopic torque, if there is one.",
            Gyroscopic::ALL.map(|by| (by.name(), gyroscopic(by))),
            settings.gyroscopic.name(),
        ),
        choice(
            "flight",
            "What of free flight is computed in closed form instead of stepped.",
            Flight::ALL.map(|part| (part.name(), flight(part))),
            settings.flight.name(),
        ),
        choice(
            "standing",
            "Who slows a coin that stands on its rim and spins, where drag alone does, without \
             gyroscopic torque.",
            Standing::ALL.map(|by| (by.name(), standing(by))),
            settings.standing.name(),
        ),
        field(
            "tosses_at_once",
            "Tosses that share one world; 1 where ccd is on.",
            Kind::Integer(Whole { low: 1, high: 1000 }),
            Is(Fallback::Integer(u64::from(settings.tosses_at_once))),
        ),
        choice(
            "decision",
            DECISION,
            Decision::ALL.map(|decision| (decision.name(), decided(decision))),
            settings.decision.name(),
        ),
        number(
            "max_gain",
            "Rise of the energy above its value at launch, as a fraction of it, beyond which a toss \
             has failed.",
            above_zero(1e6),
            default(settings.max_gain),
        ),
        count(
            "max_steps",
            "Steps after which a toss is given up as undecided.",
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

fn choice<const N: usize>(
    key: &'static str,
    doc: &'static str,
    words: [(&'static str, &'static str); N],
    fallback: &'static str,
) -> Field {
    let words = words.map(|(name, doc)| Word { name, doc });
    field(
        key,
        doc,
        Kind::Word(words.to_vec()),
        Is(Fallback::Word(fallback)),
    )
}

fn flag(key: &'static str, doc: &'static str, fallback: bool) -> Field {
    field(key, doc, Kind::Boolean, Is(Fallback::Boolean(fallback)))
}

fn friction(model: FrictionModel) -> &'static str {
    match model {
        FrictionModel::Coulomb => "Coulomb's cone at every contact point",
        FrictionModel::Simplified => {
            "one cone amid the contact points and a torque about the normal: Rapier's own default"
        }
    }
}

fn gyroscopic(by: Gyroscopic) -> &'static str {
    match by {
        Gyroscopic::Exact => "this engine, after every step, without gain of energy",
        Gyroscopic::Rapier => "Rapier, by an explicit term that gains energy",
    }
}

fn flight(part: Flight) -> &'static str {
    match part {
        Flight::Contact => "all of it, to the moment of contact",
        Flight::Steps => "whole steps, up to the last one that ends clear of the surface",
        Flight::Off => "none",
    }
}

fn standing(by: Standing) -> &'static str {
    match by {
        Standing::Drag => "this engine, by a third at a time, without the steps between",
        Standing::Rapier => "Rapier, step by step",
    }
}

fn decided(decision: Decision) -> &'static str {
    match decision {
        Decision::Tilting => "when the energy that can still tilt the coin is too small",
        Decision::Energy => "when the whole energy is too small",
        Decision::Rest => "when the coin has come to rest",
    }
}
