//! Either engine under random tosses from a huge box of scenes: errors, gains and limits by region.

mod found;
mod region;
mod witness;

use crate::sample::Sample;
use crate::survey::{EventDriven, PART, survey};
use anyhow::{anyhow, bail};
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Ended, Engine, Outcome};
use found::{Found, Hardest};
use region::AXES;
use std::ops::{ControlFlow, Range};
use std::panic::{self, AssertUnwindSafe};
use witness::{Seen, Witness};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Stability {
    /// The engine
    #[arg(long, value_enum, default_value_t = EventDriven::Flat)]
    engine: EventDriven,

    /// The law of impact, by the engine's name for it; by default the engine's default
    #[arg(long, value_name = "LAW")]
    law: Option<String>,

    /// Tosses
    #[arg(long, value_parser = number::count, default_value = "1e7", value_name = "N")]
    tosses: u64,

    /// Tosses of a scene: the first is observed on the scalar path, all are made in one batch
    #[arg(long, value_parser = number::count, default_value = "1", value_name = "N")]
    together: u64,

    /// Number of the first toss, to make a long study in parts
    #[arg(long, value_parser = number::count_or_zero, default_value = "0", value_name = "TOSS")]
    first: u64,

    /// Impacts after which a toss is given up
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    max_impacts: u64,

    /// The same where e = 1: such a coin may bounce forever
    #[arg(long, value_parser = number::count, default_value = "100", value_name = "N")]
    max_elastic: u64,

    /// Steps of sustained contact after which a toss in space is given up
    #[arg(long, value_parser = number::count, default_value = "2000", value_name = "N")]
    max_steps: u64,

    /// One observed toss of so many has its flights sampled densely
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    dense: u64,

    /// Makes this toss only
    #[arg(long, value_name = "TOSS")]
    only: Option<u64>,
}

/// The engines' settings with the limits of the command line: below e = 1, and at it.
struct Limits {
    flat: [coinmc_flat::Settings; 2],
    space: [coinmc_volumetric::Settings; 2],
}

impl Stability {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let limits = self.limits()?;
        if let Some(toss) = self.only {
            return Ok(self.one(seed, toss, &limits));
        }
        let end = self.first.checked_add(self.tosses);
        let end = end.ok_or_else(|| anyhow!("toss numbers end at {}", u64::MAX))?;
        if self.together > PART {
            bail!("--together is at most {PART}: the tosses of a scene are held in memory");
        }
        if !self.first.is_multiple_of(self.together) {
            bail!("--first must be a multiple of --together");
        }
        let part = PART.next_multiple_of(self.together);
        let starts = (0..self.tosses.div_ceil(part)).map(|index| self.first + index * part);
        let parts: Vec<Range<u64>> = starts.map(|start| start..(start + part).min(end)).collect();
        // a panic is counted and named; its message would disrupt the table
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
        let (mut flat, mut space) = (
            coinmc_flat::Settings::default(),
            coinmc_volumetric::Settings::default(),
        );
        space.max_steps = max_steps;
        if let Some(name) = &self.law {
            match self.engine {
                EventDriven::Flat => {
                    let laws = coinmc_flat::Law::RIGID;
                    flat.law = named(&laws, |law| law.name(), name)?;
                }
                EventDriven::Volumetric => {
                    let laws = coinmc_volumetric::Law::ALL;
                    space.law = named(&laws, |law| law.name(), name)?;
                }
            }
        }
        Ok(Limits {
            flat: impacts.map(|max_impacts| coinmc_flat::Settings {
                max_impacts,
                ..flat
            }),
            space: impacts.map(|max_impacts| coinmc_volumetric::Settings {
                max_impacts,
                ..space
            }),
        })
    }

    fn sample(&self, seed: u64, toss: u64) -> Sample {
        let scene = toss / self.together;
        match self.engine {
            EventDriven::Flat => Sample::in_plane(seed, scene, toss),
            EventDriven::Volumetric => Sample::in_scene(seed, scene, toss),
        }
    }

    fn find(&self, seed: u64, tosses: Range<u64>, limits: &Limits) -> Found {
        let mut found = Found::default();
        let mut first = tosses.start;
        while first < tosses.end {
            let numbers = first..(first + self.together).min(tosses.end);
            let samples: Vec<Sample> = numbers.map(|toss| self.sample(seed, toss)).collect();
            let looks = first.is_multiple_of(self.dense);
            let made = panic::catch_unwind(AssertUnwindSafe(|| {
                self.in_one_scene(&samples, looks, limits)
            }));
            match made {
                Ok(made) => {
                    for ((toss, sample), made) in (first..).zip(&samples).zip(made) {
                        found.add(toss, sample, Some(made));
                    }
                }
                Err(_) => {
                    for (toss, sample) in (first..).zip(&samples) {
                        found.add(toss, sample, None);
                    }
                }
            }
            first += self.together;
        }
        found
    }

    /// Makes the tosses of one scene: the first on the scalar path under observation, then all of
    /// them in one batch if there are several.
    fn in_one_scene(
        &self,
        samples: &[Sample],
        looks: bool,
        limits: &Limits,
    ) -> Vec<(Outcome, Seen)> {
        let (scene, elastic) = (&samples[0].scene, usize::from(samples[0].is_elastic()));
        let engine = match self.engine {
            EventDriven::Flat => limits.flat[elastic].engine(scene).ok(),
            EventDriven::Volumetric => limits.space[elastic].engine(scene).ok(),
        };
        make(&engine.expect("settings are in range"), samples, looks)
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
             of energy in flight. missed: flights that pass over a contact, of those sampled densely; \
             depth: the deepest of these, in D. n: spin in units of sqrt(g/D). differ: tosses whose \
             outcome in the batch is not that of the scalar path, of those made both ways.",
        );
        report.remark("--only TOSS repeats one toss.");
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

    /// One toss in detail.
    fn one(&self, seed: u64, toss: u64, limits: &Limits) -> Report {
        let sample = self.sample(seed, toss);
        let (outcome, seen) = self.in_one_scene(std::slice::from_ref(&sample), true, limits)[0];
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

/// The law of this name.
fn named<L: Copy>(laws: &[L], name_of: fn(&L) -> &'static str, name: &str) -> anyhow::Result<L> {
    let law = laws.iter().find(|law| name_of(law) == name);
    law.copied().ok_or_else(|| {
        let names: Vec<&str> = laws.iter().map(name_of).collect();
        anyhow!("no law is called `{name}`; there are {}", names.join(", "))
    })
}

fn make<E>(engine: &E, samples: &[Sample], looks: bool) -> Vec<(Outcome, Seen)>
where
    E: Engine<Workspace = ()>,
{
    let mut witness = Witness::new(&samples[0].scene, looks);
    let scalar = engine.toss(&mut (), &samples[0].launch, &mut witness);
    let mut made = vec![(scalar, witness.seen)];
    if samples.len() == 1 {
        return made;
    }
    made.resize(samples.len(), (scalar, Seen::nothing()));
    let launches = samples.iter().map(|sample| sample.launch);
    engine.toss_all(&mut (), launches, |number, outcome| {
        let toss = usize::try_from(number).expect("an index");
        made[toss].0 = *outcome;
        ControlFlow::Continue(())
    });
    made[0].1.agrees = Some(made[0].0 == scalar);
    made
}
