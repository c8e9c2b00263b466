//! Either engine under random tosses from a huge box of scenes: errors, gains and limits by region.

mod found;
mod region;
mod witness;

use super::space::{PART, Sample};
use super::survey;
use crate::number;
use crate::report::{Report, Table};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc_core::{Ended, Engine, Outcome};
use coinmc_flat::AnyFlatEngine;
use coinmc_volumetric::AnyVolumetricEngine;
use found::{Found, Hardest};
use region::AXES;
use std::ops::Range;
use std::panic::{self, AssertUnwindSafe};
use witness::{Seen, Witness};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Stability {
    /// The engine
    #[arg(long, value_enum, default_value_t = Which::Flat)]
    engine: Which,

    /// Tosses, each with a scene of its own
    #[arg(long, value_parser = number::count, default_value = "1e7", value_name = "N")]
    tosses: u64,

    /// Number of the first toss: a long study may be made in parts
    #[arg(long, value_parser = number::count_or_zero, default_value = "0", value_name = "TOSS")]
    first: u64,

    /// Impacts after which a toss is given up
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    max_impacts: u64,

    /// The same where e = 1: such a coin may bounce for ever
    #[arg(long, value_parser = number::count, default_value = "100", value_name = "N")]
    max_elastic: u64,

    /// Steps of sustained contact after which a toss in space is given up
    #[arg(long, value_parser = number::count, default_value = "2000", value_name = "N")]
    max_steps: u64,

    /// One toss of so many has its flights sampled densely
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    looked_into: u64,

    /// Makes this toss alone
    #[arg(long, value_name = "TOSS")]
    only: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// In the plane
    Flat,
    /// In space
    Space,
}

/// The engines' settings, limits as asked for: below e = 1, and at it.
struct Limits {
    flat: [coinmc_flat::Settings; 2],
    space: [coinmc_volumetric::Settings; 2],
}

impl Stability {
    pub(crate) fn carry_out(&self, seed: u64) -> anyhow::Result<Report> {
        let limits = self.limits()?;
        if let Some(toss) = self.only {
            return Ok(self.alone(seed, toss, &limits));
        }
        let end = self.first.checked_add(self.tosses);
        let end = end.ok_or_else(|| anyhow!("toss numbers end at {}", u64::MAX))?;
        let starts = (0..self.tosses.div_ceil(PART)).map(|part| self.first + part * PART);
        let parts: Vec<Range<u64>> = starts.map(|start| start..(start + PART).min(end)).collect();
        // a panic is counted and named; its message would tear the table
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| {}));
        let found = survey(&parts, |part| self.find(seed, part.clone(), &limits));
        panic::set_hook(hook);
        let total = found.into_iter().reduce(Found::merge).unwrap_or_default();
        Ok(self.report(seed, &total))
    }

    fn limits(&self) -> anyhow::Result<Limits> {
        let most = |limit: u64| u32::try_from(limit).map_err(|_| anyhow!("at most {}", u32::MAX));
        let impacts = [most(self.max_impacts)?, most(self.max_elastic)?];
        let max_steps = most(self.max_steps)?;
        Ok(Limits {
            flat: impacts.map(|max_impacts| coinmc_flat::Settings {
                max_impacts,
                ..coinmc_flat::Settings::default()
            }),
            space: impacts.map(|max_impacts| coinmc_volumetric::Settings {
                max_impacts,
                max_steps,
                ..coinmc_volumetric::Settings::default()
            }),
        })
    }

    fn sample(&self, seed: u64, toss: u64) -> Sample {
        match self.engine {
            Which::Flat => Sample::in_plane(seed, toss),
            Which::Space => Sample::new(seed, toss),
        }
    }

    fn find(&self, seed: u64, tosses: Range<u64>, limits: &Limits) -> Found {
        let mut found = Found::default();
        for toss in tosses {
            let sample = self.sample(seed, toss);
            let looks = toss.is_multiple_of(self.looked_into);
            let made = panic::catch_unwind(AssertUnwindSafe(|| self.toss(&sample, looks, limits)));
            found.add(toss, &sample, made.ok());
        }
        found
    }

    /// Follows a toss and watches it.
    fn toss(&self, sample: &Sample, looks: bool, limits: &Limits) -> (Outcome, Seen) {
        let mut witness = Witness::new(&sample.scene, looks);
        let elastic = usize::from(sample.is_elastic());
        let outcome = match self.engine {
            Which::Flat => {
                let engine = AnyFlatEngine::new(&sample.scene, &limits.flat[elastic]);
                let engine = engine.expect("settings are in range");
                engine.toss(&mut (), &sample.launch, &mut witness)
            }
            Which::Space => {
                let engine = AnyVolumetricEngine::new(&sample.scene, &limits.space[elastic]);
                let engine = engine.expect("settings are in range");
                engine.toss(&mut (), &sample.launch, &mut witness)
            }
        };
        (outcome, witness.seen)
    }

    fn report(&self, seed: u64, found: &Found) -> Report {
        let mut record = Table::new(
            "By region of the box, one parameter at a time",
            &found::COLUMNS,
        );
        for (axis, regions) in AXES.iter().zip(&found.regions) {
            for (i, region) in regions.iter().enumerate() {
                if region.tally.tosses() > 0 {
                    record.push(region.row(axis.name, axis.label(i)));
                }
            }
        }
        record.push(found.total().row("all", String::new()));
        let mut report = Report::new(record.clone());
        report.show(record);
        report.show(self.hardest(seed, &found.hardest));
        report.remark(
            "gain: of energy in an impact or a contact phase, relative to the energy before. residual: \
             distance of the lowest point from the surface at a contact, in D. drift: relative change \
             of energy in flight. missed: flights that pass over a contact, of those looked into; \
             depth: the deepest of these, in D. n: spin in units of sqrt(g/D).",
        );
        report.remark("--only TOSS makes a toss again, alone.");
        report
    }

    fn hardest(&self, seed: u64, hardest: &Hardest) -> Table {
        let mut table = Table::new("Hardest tosses", &["why", "value", "toss", "scene"]);
        for (why, value, toss) in hardest.rows() {
            let scene = self.sample(seed, toss).to_string();
            table.push(vec![why.to_owned(), value, toss.to_string(), scene]);
        }
        table
    }

    /// One toss, told in full.
    fn alone(&self, seed: u64, toss: u64, limits: &Limits) -> Report {
        let sample = self.sample(seed, toss);
        let (outcome, seen) = self.toss(&sample, true, limits);
        let mut table = Table::new(sample.to_string(), &["what", "value"]);
        let ended = match outcome.ended {
            Ended::Decided(face) => format!("{face:?}"),
            other => format!("{other:?}"),
        };
        for (what, value) in [
            ("ended", ended),
            ("impacts", outcome.impacts.to_string()),
            ("contact steps", outcome.contact_steps.to_string()),
            ("jams", outcome.jams.to_string()),
            ("gain", number::tiny(seen.gain)),
            ("residual", number::tiny(seen.residual)),
            ("drift", number::tiny(seen.drift)),
            ("depth", number::tiny(seen.depth)),
            ("flights", seen.flights.to_string()),
            ("missed", seen.missed.to_string()),
        ] {
            table.push(vec![what.to_owned(), value]);
        }
        let mut report = Report::new(table);
        report.remark(format!("{:?}\n{:?}", sample.scene, sample.launch));
        report
    }
}
