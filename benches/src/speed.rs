//! Speed of the engines, of the runner and of two threads, and peak memory.
//!
//! Absolute rates depend on the machine and its other work. Ratios compare runs that follow each
//! other directly; the median over several repeats is shown.

use crate::run_apart::{RunApart, Toss};
use anyhow::Context;
use clap::Args;
use coinmc::run::{Chunk, run_chunk};
use coinmc_bench::runs::{plan, run_once};
use coinmc_bench::{Case, Report, Table, Workload, number, space_workloads, workloads};
use coinmc_core::{Engine, Preset, run_tosses};
use coinmc_flat::Settings;
use std::hint::black_box;
use std::num::NonZeroUsize;
use std::time::Instant;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Speed {
    /// Tosses of each timed run
    #[arg(long, value_parser = number::count, default_value = "2_000_000", value_name = "N")]
    tosses: u64,

    /// Timed runs of each kind
    #[arg(long, value_parser = number::count, default_value = "5", value_name = "N")]
    repeats: u64,

    /// Tosses of the larger run whose memory is measured; the smaller has a hundredth
    #[arg(long, value_parser = number::count, default_value = "100_000_000", value_name = "N")]
    memory_tosses: u64,
}

/// The flat toss that all rates are compared with.
const REFERENCE: &str = "toss clean-flat x=1.2 e=0.5 mu=0.3";

/// Something to time.
type Task<'a> = Box<dyn Fn() -> anyhow::Result<()> + 'a>;

fn task((work, count): &(Workload, u64)) -> Task<'_> {
    Box::new(|| {
        black_box(work.run(0..*count));
        Ok(())
    })
}

impl Speed {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let columns = ["measured", "of", "median", "lowest", "highest"];
        let title = format!("{} repeats of {} tosses", self.repeats, self.tosses);
        let mut record = Table::new(title, &columns);
        self.time_engine(&mut record)?;
        for friction in [0.0, 0.3] {
            self.time_runner(friction, seed, &mut record)?;
        }
        self.measure_memory(&mut record)?;
        let mut report = Report::new(record);
        report.remark(
            "Times are relative to the bare loop that came before. The second bare loop shows how \
             far noise alone moves the median.",
        );
        Ok(report)
    }

    /// Rates on one core, each relative to one flat toss's, and the launch's share of a toss.
    fn time_engine(&self, record: &mut Table) -> anyhow::Result<()> {
        // many works, not compared to the per cent; a toss in space takes ten times as long
        let flat = workloads().into_iter();
        let flat = flat.map(|work| (work, self.tosses.div_ceil(4)));
        let space = space_workloads().into_iter();
        let space = space.map(|work| (work, self.tosses.div_ceil(40)));
        let works: Vec<(Workload, u64)> = flat.chain(space).collect();
        let tasks: Vec<Task<'_>> = works.iter().map(task).collect();
        let seconds = self.interleave(&tasks)?;
        let rates: Vec<Vec<f64>> = works
            .iter()
            .zip(&seconds)
            .map(|((_, count), seconds)| seconds.iter().map(|s| *count as f64 / s).collect())
            .collect();
        let place = |name: &str| works.iter().position(|(work, _)| work.name == name);
        let reference = place(REFERENCE);
        let reference =
            reference.with_context(|| format!("no workload is called `{REFERENCE}`"))?;
        for ((work, _), rates_of_work) in works.iter().zip(&rates) {
            record.push(row("rate per second", &work.name, rates_of_work, 0));
            let relative = ratios(rates_of_work, &rates[reference]);
            record.push(row("rate/flat rate", &work.name, &relative, 3));
        }
        for (i, (toss, _)) in works.iter().enumerate() {
            if let Some(launch) = toss.launch().and_then(|name| place(&name)) {
                let shares = ratios(&seconds[launch], &seconds[i]);
                record.push(row("launch/toss", &toss.name, &shares, 3));
            }
        }
        Ok(())
    }

    /// The runner against the bare loop, and against itself on two threads.
    fn time_runner(&self, friction: f64, seed: u64, record: &mut Table) -> anyhow::Result<()> {
        let tosses = self.tosses;
        let plan = plan(&format!(
            "seed = {seed}\ncoin.ratio = 1.2\ncoin.radius_m = 0.01\nsurface.restitution = 0.5\n\
             surface.friction = {friction:?}\nlaunch.preset = 'clean-flat'\n\
             engine.flat.law = 'moreau'\nstop.tosses = {tosses}\n"
        ))?;
        let case = Case::new(Preset::CleanFlat, 0.01, 1.2, 0.5, friction);
        let bare = || -> Task<'_> {
            Box::new(|| {
                bare_loop(&case, seed, tosses);
                Ok(())
            })
        };
        let threads = |n| -> Task<'_> {
            let plan = &plan;
            Box::new(move || run_once(plan, NonZeroUsize::new(n)).map(|_| ()))
        };
        let chunk: Task<'_> = Box::new(|| {
            run_chunk(
                &plan,
                &Chunk {
                    point: 0,
                    tosses: 0..tosses,
                },
            )?;
            Ok(())
        });
        let seconds = self.interleave(&[bare(), bare(), chunk, threads(1), threads(2)])?;
        let of = format!("clean-flat x=1.2 e=0.5 mu={friction}");
        for (name, other) in [
            ("bare loop again", 1),
            ("one chunk", 2),
            ("run, 1 thread", 3),
        ] {
            let ratios = ratios(&seconds[other], &seconds[0]);
            record.push(row(&format!("{name}/bare loop"), &of, &ratios, 3));
        }
        let speedup = ratios(&seconds[3], &seconds[4]);
        record.push(row("speed-up of 2 threads", &of, &speedup, 3));
        Ok(())
    }

    fn measure_memory(&self, record: &mut Table) -> anyhow::Result<()> {
        for tosses in [self.memory_tosses.div_ceil(100), self.memory_tosses] {
            let run = RunApart {
                toss: Toss::Flat,
                tosses,
                threads: None,
            };
            let megabytes = run.measure()?.peak_kb / 1024.0;
            record.push(row(
                "peak memory in MiB",
                &format!("{tosses} tosses"),
                &[megabytes],
                1,
            ));
        }
        Ok(())
    }

    /// Seconds of each task in each repeat. Every other repeat goes backwards, so that a drift of
    /// the machine's speed favours none.
    fn interleave(&self, tasks: &[Task<'_>]) -> anyhow::Result<Vec<Vec<f64>>> {
        let mut seconds = vec![Vec::new(); tasks.len()];
        for repeat in 0..self.repeats {
            for i in 0..tasks.len() {
                let i = if repeat % 2 == 0 {
                    i
                } else {
                    tasks.len() - 1 - i
                };
                let start = Instant::now();
                tasks[i]()?;
                seconds[i].push(start.elapsed().as_secs_f64());
            }
        }
        Ok(seconds)
    }
}

/// What any caller of the engine would write.
fn bare_loop(case: &Case, seed: u64, tosses: u64) {
    let engine = case.engine(&Settings::default());
    let (launches, stream) = (case.launches(), Case::stream(seed));
    let scene = &case.scene;
    black_box(run_tosses(
        &engine,
        &mut engine.workspace(),
        scene,
        &launches,
        &stream,
        0..tosses,
    ));
}

fn ratios(above: &[f64], below: &[f64]) -> Vec<f64> {
    above.iter().zip(below).map(|(a, b)| a / b).collect()
}

fn row(measured: &str, of: &str, values: &[f64], decimals: usize) -> Vec<String> {
    let mut row = vec![measured.to_owned(), of.to_owned()];
    row.extend(number::spread(values).map(|value| format!("{value:.decimals$}")));
    row
}
