//! The stiff limit: what line contact and half sine become as the contact gets stiffer or shorter.
//!
//! An impact in which the corner slides one way is Moreau's in the limit. Where it sticks or slides
//! back, the limit is a law of its own, that of the frozen coin: it keeps what the spring along the
//! surface gives back, and normal restitution that depends on when the grip changes. Both limits
//! are approached with the first power of the time of contact, as K^(−9/19).

use super::{distance, impact, line, materials, pulse, scene, touch};
use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Launch, Scene};
use coinmc_flat::{Law, LineContact, PulseTime};
use coinmc_testkit::Dice;

/// How many times as stiff as PLA on wood.
const STIFFER: [f64; 6] = [1e-2, 1.0, 1e2, 1e4, 1e6, 1e8];
/// Stands for infinitely stiff.
const RIGID: f64 = 1e16;
const TOLERANCE: f64 = 1e-11;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct ImpactLimit {
    /// Impacts of each kind
    #[arg(long, value_parser = number::count, default_value = "200", value_name = "N")]
    impacts: u64,
}

/// A kind of impact and a law whose stiffness can be chosen.
struct Kind {
    name: &'static str,
    law: &'static str,
    with: fn(f64) -> Law,
    sample: fn(u64, u64) -> (Scene, Launch),
}

const KINDS: [Kind; 6] = [
    Kind {
        name: "no friction",
        law: "line-contact",
        with: |stiffer| line(materials(stiffer), LineContact::mindlin(super::POISSON)),
        sample: |seed, trial| any(seed, trial, 0.0, 1.0),
    },
    Kind {
        name: "slides one way",
        law: "line-contact",
        with: |stiffer| line(materials(stiffer), LineContact::mindlin(super::POISSON)),
        sample: |seed, trial| any(seed, trial, 0.2, 10.0),
    },
    Kind {
        name: "grip changes",
        law: "line-contact",
        with: |stiffer| line(materials(stiffer), LineContact::mindlin(super::POISSON)),
        sample: |seed, trial| any(seed, trial, 0.5, 1.0),
    },
    Kind {
        name: "grip changes (hard to shear)",
        law: "line-contact",
        with: |stiffer| line(materials(stiffer), 300.0),
        sample: |seed, trial| any(seed, trial, 0.5, 1.0),
    },
    Kind {
        name: "no friction",
        law: "half-sine",
        with: |stiffer| pulse(PulseTime::Contact(materials(stiffer))),
        sample: |seed, trial| any(seed, trial, 0.0, 1.0),
    },
    Kind {
        name: "grip changes",
        law: "half-sine",
        with: |stiffer| pulse(PulseTime::Contact(materials(stiffer))),
        sample: |seed, trial| any(seed, trial, 0.5, 1.0),
    },
];

/// A random impact at this friction, the centre moving sideways at about `sideways` m/s.
fn any(seed: u64, trial: u64, friction: f64, sideways: f64) -> (Scene, Launch) {
    let mut dice = Dice::new(seed, trial);
    let scene = scene(dice.scale(0.5, 2.0), dice.between(0.3, 0.9), friction);
    let vx = dice.pick(&[-1.0, 1.0]) * sideways * dice.between(0.5, 1.0);
    let theta = dice.between(0.25, 1.3);
    let launch = touch(
        theta,
        vx,
        -dice.between(1.0, 2.0),
        dice.between(-10.0, 10.0),
    );
    (scene, launch)
}

/// Medians over the impacts of a kind at a stiffness.
struct Medians {
    time_s: f64,
    to_moreau: f64,
    to_limit: f64,
}

impl ImpactLimit {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let columns = [
            "law",
            "impacts",
            "stiffer",
            "time_ms",
            "to_moreau_m_s",
            "to_limit_m_s",
            "order",
        ];
        let title = format!(
            "Velocity after an impact, against Moreau's law and against the stiff limit: medians of {} \
             impacts at 1 to 2 m/s; order: of to_limit in the time of contact, since the row before",
            self.impacts
        );
        let mut record = Table::new(title, &columns);
        let all = survey(&KINDS, |kind| {
            STIFFER.map(|stiffer| medians(kind, stiffer, seed, self.impacts))
        });
        for (kind, medians) in KINDS.iter().zip(all) {
            let mut last: Option<&Medians> = None;
            for (stiffer, now) in STIFFER.iter().zip(&medians) {
                let order = last.map_or_else(String::new, |last| {
                    let change = libm::log(last.to_limit / now.to_limit);
                    format!("{:.2}", change / libm::log(last.time_s / now.time_s))
                });
                record.push(vec![
                    kind.law.to_owned(),
                    kind.name.to_owned(),
                    format!("{stiffer:e}"),
                    format!("{:.1e}", now.time_s * 1e3),
                    format!("{:.1e}", now.to_moreau),
                    format!("{:.1e}", now.to_limit),
                    order,
                ]);
                last = Some(now);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "stiffer: Young's moduli over those of PLA on wood (3 and 10 GPa). The paper's time of \
             contact is 1 ms.",
        );
        report
    }
}

fn medians(kind: &Kind, stiffer: f64, seed: u64, impacts: u64) -> Medians {
    let (mut times, mut to_moreau, mut to_limit) = (Vec::new(), Vec::new(), Vec::new());
    for trial in 0..impacts {
        let (scene, launch) = (kind.sample)(seed, trial);
        let found = impact(&scene, (kind.with)(stiffer), TOLERANCE, &launch);
        let rigid = impact(&scene, Law::Moreau, TOLERANCE, &launch);
        let limit = impact(&scene, (kind.with)(RIGID), TOLERANCE, &launch);
        times.push(found.after.time_s);
        to_moreau.push(distance(&scene, &found.after, &rigid.after));
        to_limit.push(distance(&scene, &found.after, &limit.after));
    }
    Medians {
        time_s: number::median(&times),
        to_moreau: number::median(&to_moreau),
        to_limit: number::median(&to_limit),
    }
}
