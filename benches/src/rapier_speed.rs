//! Tosses a second with all skips, against the naive loop at the same step.

use clap::Args;
use coinmc_bench::rapier::{RATIOS, Tosser, cases};
use coinmc_bench::{Case, Report, Stopwatch, Table, number};
use coinmc_rapier::{Account, Decision, Flight, Settings, Standing};

/// Tosses that share worlds, a toss that is made naively: enough to fill the worlds.
const MORE: u64 = 20;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierSpeed {
    /// Tosses of each scene, made naively and with skips
    #[arg(long, value_parser = number::count, default_value = "40", value_name = "N")]
    tosses: u64,

    /// Step in the scene clean, s
    #[arg(long, default_value_t = 1e-3, value_name = "S")]
    clean_step: f64,

    /// Step in the scene table1, s
    #[arg(long, default_value_t = 2e-2, value_name = "S")]
    table1_step: f64,
}

/// What one way of making tosses came to.
#[derive(Default)]
struct Way {
    tosses: u64,
    seconds: f64,
    steps: u64,
    undecided: u64,
}

impl Way {
    fn add(&mut self, account: &Account) {
        self.tosses += 1;
        self.steps += u64::from(account.steps);
        self.undecided += u64::from(account.outcome.face().is_none());
    }

    fn seconds_a_toss(&self) -> f64 {
        self.seconds / self.tosses as f64
    }

    fn steps_a_toss(&self) -> f64 {
        self.steps as f64 / self.tosses as f64
    }

    fn us_a_step(&self) -> f64 {
        1e6 * self.seconds / self.steps as f64
    }
}

/// All skips, several tosses at once; all skips, one at a time; none.
struct Ways {
    together: Way,
    alone: Way,
    naive: Way,
}

impl RapierSpeed {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let columns = [
            "scene",
            "ratio",
            "step_s",
            "standing",
            "tosses_a_second",
            "one_at_a_time",
            "naive",
            "times_as_fast",
            "alone_times_as_fast",
            "ratio_of_steps",
            "steps_a_toss",
            "naive_steps",
            "us_a_step",
            "alone_us",
            "naive_us",
            "naive_undecided",
        ];
        let title = format!(
            "Tosses a second on one core: all skips against stepped flight and waiting for rest, {} \
             tosses a scene",
            self.tosses
        );
        let mut record = Table::new(title, &columns);
        let mut table1 = Vec::new();
        for (scene, step) in [self.clean_step, self.table1_step].into_iter().enumerate() {
            // a coin of the scene clean, with gyroscopic torque, does not stand
            for standing in &Standing::ALL[..=scene] {
                for ratio in RATIOS {
                    let case = cases(ratio)[scene];
                    let ways = self.ways(&case, step, *standing, seed)?;
                    if scene == 1 && *standing == Standing::default() {
                        table1.push(ways.together.seconds_a_toss());
                    }
                    record.push(row(&case, step, *standing, &ways));
                }
            }
        }
        let mean = table1.iter().sum::<f64>() / table1.len() as f64;
        let mut report = Report::new(record);
        report.remark(format!(
            "1e6 tosses of table1, its ratios in equal parts, take {:.1} minutes on two such cores.",
            1e6 * mean / 60.0 / 2.0
        ));
        report.remark(
            "naive: Rapier steps the flight, one toss at a time, and a toss ends when the coin rests \
             or at the limit of time (naive_undecided: a coin that rolls or spins has no rest). \
             tosses_a_second, us_a_step: all skips, several tosses in one world; one_at_a_time, \
             alone_us: each in its own, the same launches as naive. Times are those a \
             thread had of a processor.",
        );
        Ok(report)
    }

    fn ways(
        &self,
        case: &Case,
        step_s: f64,
        standing: Standing,
        seed: u64,
    ) -> anyhow::Result<Ways> {
        let skips = Settings {
            step_s,
            standing,
            ..Settings::default()
        };
        let naive = Settings {
            flight: Flight::Off,
            decision: Decision::Rest,
            standing: Standing::Rapier,
            tosses_at_once: 1,
            ..skips
        };
        let alone = self.one_by_one(case, &skips, seed)?;
        let naive = self.one_by_one(case, &naive, seed)?;
        let mut together = Way::default();
        let clock = Stopwatch::start();
        let each = |_: &_, account: &Account| together.add(account);
        Tosser::new(case, &skips)?.examine_all(seed, 0..MORE * self.tosses, || true, each);
        together.seconds = clock.seconds();
        Ok(Ways {
            together,
            alone,
            naive,
        })
    }

    fn one_by_one(&self, case: &Case, settings: &Settings, seed: u64) -> anyhow::Result<Way> {
        let mut tosser = Tosser::new(case, settings)?;
        let mut way = Way::default();
        let clock = Stopwatch::start();
        for toss in 0..self.tosses {
            way.add(&tosser.examine(&case.launch(seed, toss)));
        }
        way.seconds = clock.seconds();
        Ok(way)
    }
}

fn row(case: &Case, step: f64, standing: Standing, ways: &Ways) -> Vec<String> {
    let Ways {
        together,
        alone,
        naive,
    } = ways;
    let rate = |way: &Way| 1.0 / way.seconds_a_toss();
    vec![
        case.preset.to_string(),
        case.scene.coin.ratio().to_string(),
        format!("{step:.0e}"),
        standing.name().to_owned(),
        format!("{:.0}", rate(together)),
        format!("{:.0}", rate(alone)),
        format!("{:.1}", rate(naive)),
        format!("{:.1}", rate(together) / rate(naive)),
        format!("{:.1}", rate(alone) / rate(naive)),
        format!("{:.1}", naive.steps as f64 / alone.steps as f64),
        format!("{:.0}", together.steps_a_toss()),
        format!("{:.0}", naive.steps_a_toss()),
        format!("{:.2}", together.us_a_step()),
        format!("{:.2}", alone.us_a_step()),
        format!("{:.2}", naive.us_a_step()),
        naive.undecided.to_string(),
    ]
}
