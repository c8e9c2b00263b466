//! How a run is shared out to the jobs of a cluster.

use crate::command_line::quoted;
use crate::terminal::{count, duration};
use coinmc::plan::{Plan, Stop};
use coinmc::run::chunks;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;

/// A job should take as long as this, or half of its time limit if that is less, …
const TARGET: Duration = Duration::from_mins(30);
/// … and not be shorter than this: a queue is not for minutes.
const LEAST: Duration = Duration::from_mins(10);
/// Chunks that keep a core busy until the last job of a part ends.
const CHUNKS_A_CORE: u64 = 2;

/// The machines there are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Machines {
    pub(super) nodes: u32,
    pub(super) cores: u32,
    pub(super) walltime: Duration,
}

/// A run in jobs.
#[derive(Debug, PartialEq)]
pub(super) struct Jobs {
    /// How many: parts of the run.
    pub(super) number: u32,
    /// How long each takes.
    pub(super) each: Duration,
    /// How long all take.
    pub(super) all: Duration,
    /// What submits them; `None` where a part has no job because the run has no parts.
    pub(super) submit: Option<String>,
    /// What may go wrong.
    pub(super) warning: Option<&'static str>,
}

impl Jobs {
    /// Jobs for a run that takes so many seconds of one core; `run` is the command for all of it.
    pub(super) fn of(plan: &Plan, run: &str, core_s: f64, machines: &Machines) -> Self {
        let Machines {
            nodes,
            cores,
            walltime,
        } = *machines;
        let node_s = core_s / f64::from(cores);
        if !matches!(plan.stop, Stop::Tosses(_)) {
            let all = seconds(node_s / f64::from(nodes));
            return Self {
                number: 1,
                each: all,
                all,
                submit: None,
                warning: Some(
                    "a run that stops at targets has no parts: give a fixed number of tosses, or run it \
                     with an executor (docs/guide/cluster.md)",
                ),
            };
        }
        let jobs = number(node_s, machines, chunks(plan).unwrap_or(1));
        let each = seconds(node_s / f64::from(jobs));
        let rounds = jobs.div_ceil(nodes);
        let warning = (each > walltime).then_some(
            "the jobs are longer than their time limit: a job that was stopped goes on when it is submitted \
             again",
        );
        Self {
            number: jobs,
            each,
            all: each.saturating_mul(rounds),
            submit: Some(sbatch(run, jobs, machines)),
            warning,
        }
    }

    pub(super) fn in_words(&self, machines: &Machines) -> String {
        let jobs = count(u64::from(self.number), "job");
        let cores = count(u64::from(machines.cores), "core");
        let nodes = count(u64::from(machines.nodes), "node");
        format!(
            "{jobs} of about {} on {cores} each; on {nodes} all take about {}",
            duration(self.each),
            duration(self.all)
        )
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "jobs": self.number,
            "job_s": self.each.as_secs_f64(),
            "time_s": self.all.as_secs_f64(),
            "submit": self.submit,
            "warning": self.warning,
        })
    }
}

/// How many jobs: as long as they should be, on all nodes if that leaves them long enough, each with enough
/// chunks for its cores.
fn number(node_s: f64, machines: &Machines, chunks: u64) -> u32 {
    let half = machines.walltime.as_secs_f64() / 2.0;
    let target = TARGET.as_secs_f64().min(half);
    let by_target = (node_s / target).ceil();
    let by_least = (node_s / LEAST.as_secs_f64()).floor();
    let jobs = by_target.max(by_least.min(f64::from(machines.nodes)));
    let most = chunks / (u64::from(machines.cores) * CHUNKS_A_CORE);
    // saturates
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let jobs = (jobs as u64).clamp(1, most.max(1));
    u32::try_from(jobs).unwrap_or(u32::MAX)
}

fn seconds(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
}

/// The command that submits the jobs to Slurm.
fn sbatch(run: &str, jobs: u32, machines: &Machines) -> String {
    let (cores, limit) = (machines.cores, machines.walltime.as_secs());
    let (hours, minutes, seconds) = (limit / 3600, limit / 60 % 60, limit % 60);
    let job = format!(
        "{run} --shard $SLURM_ARRAY_TASK_ID/{jobs} --threads {cores} --out parts/$SLURM_ARRAY_TASK_ID"
    );
    format!(
        "sbatch --array=1-{jobs} --ntasks=1 --cpus-per-task={cores} \
         --time={hours:02}:{minutes:02}:{seconds:02} --wrap {}",
        quoted(&job)
    )
}

/// The command that runs a config with these values of `--set`, for a shell.
pub(super) fn run<'a>(config: &Path, sets: impl Iterator<Item = &'a str>) -> String {
    let sets = sets.map(|set| format!(" --set {}", quoted(set)));
    let mut config = config.to_string_lossy();
    if config.starts_with('-') {
        // no option
        config = format!("./{config}").into();
    }
    format!("coinmc run {}{}", quoted(&config), sets.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_limit;

    fn plan(stop: &str) -> Plan {
        let text = format!(
            "coin.ratio = 1\nsurface = {{ restitution = 0.5, friction = 0.3 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\nstop = {{ {stop} }}"
        );
        coinmc::config::parse("test", &text, &[]).unwrap()
    }

    fn jobs(core_hours: f64, nodes: u32, walltime: &str) -> Jobs {
        let machines = Machines {
            nodes,
            cores: 10,
            walltime: time_limit::duration(walltime).unwrap(),
        };
        Jobs::of(
            &plan("tosses = 1e12"),
            "coinmc run a.toml",
            3600.0 * core_hours,
            &machines,
        )
    }

    #[test]
    fn jobs_last_between_ten_minutes_and_half_of_their_limit() {
        let minutes = |jobs: &Jobs| jobs.each.as_secs() / 60;
        let many = jobs(1000.0, 4, "1h");
        assert_eq!(
            (many.number, minutes(&many), many.all.as_secs()),
            (200, 30, 90_000)
        );
        // fewer nodes than there are, rather than jobs of a minute
        let few = jobs(10.0, 100, "1h");
        assert_eq!((few.number, minutes(&few)), (6, 10));
        assert_eq!(jobs(0.1, 100, "1h").number, 1);
        let short = jobs(1000.0, 4, "00:30:00");
        assert_eq!(
            (short.number, minutes(&short), short.warning),
            (400, 15, None)
        );
        let text = many.submit.unwrap();
        assert!(
            text.contains("--array=1-200 ") && text.contains("--time=01:00:00"),
            "{text}"
        );
    }

    #[test]
    fn a_shell_reads_back_what_is_submitted() {
        let sets = ["stop.tosses=1e9", "coin.ratio=[1, 2]"].into_iter();
        let run = run(Path::new("my coin.toml"), sets);
        assert_eq!(
            run,
            "coinmc run 'my coin.toml' --set stop.tosses=1e9 --set 'coin.ratio=[1, 2]'"
        );
        assert_eq!(quoted(&run).matches(r"'\''").count(), 4);
        // no option
        let dash = self::run(Path::new("-dash.toml"), std::iter::empty());
        assert_eq!(dash, "coinmc run ./-dash.toml");
    }

    #[test]
    fn what_stops_at_targets_has_no_jobs() {
        let machines = Machines {
            nodes: 2,
            cores: 2,
            walltime: TARGET,
        };
        let jobs = Jobs::of(&plan("half_width = 1e-3"), "coinmc run a", 1e6, &machines);
        assert!(jobs.submit.is_none() && jobs.warning.is_some());
    }
}
