//! Either engine under random tosses from a huge box of scenes: errors, gains and limits by region.

mod found;
mod region;
mod witness;

use crate::space::{PART, Sample};
use crate::survey::survey;
use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum};
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
    #[arg(long, value_enum, default_value_t = Which::Flat)]
    engine: Which,

    /// Tosses
    #[arg(long, value_parser = number::count, default_value = "1e7", value_name = "N")]
    tosses: u64,

    /// Tosses of a scene: the first is watched, all are made side by side
    #[arg(long, value_parser = number::count, default_value = "1", value_name = "N")]
    together: u64,

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

    /// One toss of so many, if it is watched, has its flights sampled densely
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
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let limits = self.limits()?;
        if let Some(toss) = self.only {
            return Ok(self.alone(seed, toss, &limits));
        }
        let end = self.first.checked_add(self.tosses);
        let end = end.ok_or_else(|| anyhow!("toss numbers end at {}", u64::MAX))?;
        if self.together > PART {
            bail!("--together is at most {PART}: the tosses of a scene are held in memory");
        }
        if !self.first.is_multiple_of(self.together) {
            bail!("--first is no multiple of --together");
        }
        let part = PART.next_multiple_of(self.together);
        let starts = (0..self.tosses.div_ceil(part)).map(|index| self.first + index * part);
        let parts: Vec<Range<u64>> = starts.map(|start| start..(start + part).min(end)).collect();
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
        let scene = toss / self.together;
        match self.engine {
            Which::Flat => Sample::in_plane(seed, scene, toss),
            Which::Space => Sample::in_scene(seed, scene, toss),
        }
    }

    fn find(&self, seed: u64, tosses: Range<u64>, limits: &Limits) -> Found {
        let mut found = Found::default();
        let mut first = tosses.start;
        while first < tosses.end {
            let numbers = first..(first + self.together).min(tosses.end);
            let samples: Vec<Sample> = numbers.map(|toss| self.sample(seed, toss)).collect();
            let looks = first.is_multiple_of(self.looked_into);
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

    /// Follows tosses of one scene: the first is watched, and is made again side by side with the
    /// others if there are any.
    fn in_one_scene(
        &self,
        samples: &[Sample],
        looks: bool,
        limits: &Limits,
    ) -> Vec<(Outcome, Seen)> {
        let (scene, elastic) = (&samples[0].scene, usize::from(samples[0].is_elastic()));
        match self.engine {
            Which::Flat => {
                let engine = limits.flat[elastic].engine(scene);
                make(&engine.expect("settings are in range"), samples, looks)
            }
            Which::Space => {
                let engine = limits.space[elastic].engine(scene);
                make(&engine.expect("settings are in range"), samples, looks)
            }
        }
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
             depth: the deepest of these, in D. n: spin in units of sqrt(g/D). differ: tosses that end \
             otherwise side by side than alone, of those made both ways.",
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

fn make<E>(engine: &E, samples: &[Sample], looks: bool) -> Vec<(Outcome, Seen)>
where
    E: Engine<Workspace = ()>,
{
    let mut witness = Witness::new(&samples[0].scene, looks);
    let alone = engine.toss(&mut (), &samples[0].launch, &mut witness);
    let mut made = vec![(alone, witness.seen)];
    if samples.len() == 1 {
        return made;
    }
    made.resize(samples.len(), (alone, Seen::nothing()));
    let launches = samples.iter().map(|sample| sample.launch);
    engine.toss_all(&mut (), launches, |number, outcome| {
        let toss = usize::try_from(number).expect("an index");
        made[toss].0 = *outcome;
        ControlFlow::Continue(())
    });
    made[0].1.agrees = Some(made[0].0 == alone);
    made
}
