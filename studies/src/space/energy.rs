//! Whether anything but gravity gives energy to the coin, and whether friction takes what it should.

use super::balance::Reference;
use super::{cells, columns, examine};
use crate::survey::{Examiner, survey, worst_text};
use crate::worst::Worst;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Event, EventKind, Observer, Preset, State};
use coinmc_volumetric::{Law, Settings};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceEnergy {
    /// Impacts and contact phases whose gain is looked at, over all scenes and laws
    #[arg(long, visible_alias = "tosses", value_parser = number::count,
          default_value = "20_000_000", value_name = "N")]
    events: u64,

    /// Contact phases that are followed again independently, over all scenes, for each setting
    #[arg(long, value_parser = number::count, default_value = "20_000", value_name = "N")]
    phases: u64,
}

/// What energy passes through.
const KINDS: [&str; 3] = ["impact", "sticking", "sliding"];

/// (H/R, e, ρ/R) of the scenes whose contact phases are followed again.
const BALANCED: [(f64, f64, f64); 6] = [
    (0.25, 0.5, 0.01),
    (0.85, 0.0, 0.01),
    (0.85, 0.5, 0.003),
    (0.85, 0.0, 0.0),
    (0.85, 0.5, 0.03),
    (2.0, 0.0, 0.003),
];

/// A case under a law.
type Scene = (Case, Law);

/// One kind of event of one case.
#[derive(Debug, Clone, Copy, Default)]
struct Gain {
    events: u64,
    worst: Worst,
}

/// Keeps the books of one case.
struct Ledger<'a> {
    case: &'a Case,
    toss: u64,
    /// The last event and the energy at it.
    last: Option<(EventKind, f64)>,
    kinds: [Gain; 3],
}

/// Follows the contact phases of one case again.
struct Balance {
    reference: Reference,
    toss: u64,
    start: Option<(State, bool)>,
    /// |energy at the end − the reference's| in m g D, of each phase.
    differences: Vec<f64>,
    worst: Worst,
    /// Phases that the reference did not get through.
    left_out: u64,
}

impl SpaceEnergy {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let scenes = scenes();
        let quota = self.events.div_ceil(scenes.len() as u64);
        let ledgers = survey(&scenes, |(case, law)| {
            let settings = Settings {
                law: *law,
                ..Settings::default()
            };
            let mut ledger = Ledger::new(case);
            examine(case, &settings, seed, quota, &mut ledger);
            ledger
        });
        let mut record = Table::new(
            "Gains of energy, relative to the energy before",
            &columns(&["law", "kind", "events", "worst_gain"]),
        );
        for ((_, law), ledger) in scenes.iter().zip(&ledgers) {
            for (kind, gain) in KINDS.iter().zip(&ledger.kinds) {
                if gain.events > 0 {
                    let mut row = cells(ledger.case);
                    row.extend([law.name(), kind].map(str::to_owned));
                    row.extend([gain.events.to_string(), number::tiny(gain.worst.value)]);
                    record.push(row);
                }
            }
        }
        let mut report = Report::new(record);
        report.show(summary(&scenes, &ledgers));
        report.show(self.balance(seed));
        report.remark(
            "A negative gain is a loss. The balance compares the energy at the end of a phase, in \
             m g D, with that of the same phase followed by the oracle's Newton–Euler equations in \
             steps of 0.001 sqrt(D/g) and less: it holds the error of the path as well as that of \
             the balance along it. tight: tolerance 1e-10, stick 1e-5.",
        );
        report
    }

    /// Contact phases against their independent integration.
    fn balance(&self, seed: u64) -> Table {
        let default = Settings::default();
        let tight = Settings {
            tolerance: 1e-10,
            stick_speed: 1e-5,
            ..default
        };
        let quota = self.phases.div_ceil(BALANCED.len() as u64);
        let jobs: Vec<(Case, &str, Settings)> = [("default", default), ("tight", tight)]
            .into_iter()
            .flat_map(|(name, settings)| {
                BALANCED.map(|(ratio, e, rho)| {
                    let case = Case::new(Preset::Clean, 0.01, ratio, e, super::FRICTION);
                    (case.rolling(rho), name, settings)
                })
            })
            .collect();
        let found = survey(&jobs, |(case, _, settings)| {
            let mut balance = Balance::new(case, settings.smoothing_time);
            examine(case, settings, seed, quota, &mut balance);
            balance
        });
        let mut table = Table::new(
            "Energy at the end of contact phases against an independent integration, m g D",
            &columns(&[
                "settings", "phases", "median", "99_%", "worst", "toss", "left_out",
            ]),
        );
        for ((case, name, _), found) in jobs.iter().zip(&found) {
            let mut row = cells(case);
            row.push((*name).to_owned());
            row.extend(found.cells());
            table.push(row);
        }
        table
    }
}

/// Every mixture of bouncy and dull, smooth and rough, thin and thick, under every law.
fn scenes() -> Vec<Scene> {
    let (restitutions, frictions) = ([0.0, 0.3, 0.5, 0.8, 1.0], [0.0, 0.3, 1.0, 10.0]);
    let ratios = [0.01, 0.25, 0.85, 2.0, 10.0];
    let cases = Case::grid(&[Preset::Clean], &restitutions, &frictions, &ratios);
    let rolling = cases
        .into_iter()
        .flat_map(|case| [0.003, 0.03].map(|rho| case.rolling(rho)));
    rolling
        .flat_map(|case| Law::ALL.map(|law| (case, law)))
        .collect()
}

fn summary(scenes: &[Scene], ledgers: &[Ledger<'_>]) -> Table {
    let columns = ["law", "kind", "events", "worst gain (where)"];
    let mut table = Table::new("Gains of energy, relative to the energy before", &columns);
    for law in Law::ALL {
        let of_law = || scenes.iter().zip(ledgers).filter(|((_, l), _)| *l == law);
        for (i, kind) in KINDS.iter().enumerate() {
            let events: u64 = of_law().map(|(_, ledger)| ledger.kinds[i].events).sum();
            let all = of_law().map(|(_, ledger)| (ledger.case, ledger.kinds[i].worst));
            table.push(vec![
                law.name().to_owned(),
                (*kind).to_owned(),
                events.to_string(),
                worst_text(Worst::over(all)),
            ]);
        }
    }
    table
}

impl<'a> Ledger<'a> {
    fn new(case: &'a Case) -> Self {
        Self {
            case,
            toss: 0,
            last: None,
            kinds: [Gain::default(); 3],
        }
    }
}

/// What has just ended with an event of this kind; `None` for flights and what has no length.
fn kind(from: EventKind, to: EventKind) -> Option<usize> {
    match (from, to) {
        (EventKind::Touching, EventKind::Impact) => Some(0),
        (EventKind::Sticking, _) => Some(1),
        (EventKind::Sliding, _) => Some(2),
        _ => None,
    }
}

impl Observer for Ledger<'_> {
    fn event(&mut self, event: &Event) {
        let energy = event.state.energy_j_kg(&self.case.scene);
        if let Some((from, before)) = self.last
            && let Some(kind) = kind(from, event.kind)
        {
            let gain = &mut self.kinds[kind];
            gain.events += 1;
            gain.worst.see(energy / before - 1.0, self.toss);
        }
        self.last = Some((event.kind, energy));
    }
}

impl Examiner for Ledger<'_> {
    fn begin(&mut self, toss: u64) {
        (self.toss, self.last) = (toss, None);
    }

    fn examined(&self) -> u64 {
        self.kinds.iter().map(|gain| gain.events).sum()
    }
}

impl Balance {
    fn new(case: &Case, smoothing_time: f64) -> Self {
        Self {
            reference: Reference::new(&case.scene, smoothing_time),
            toss: 0,
            start: None,
            differences: Vec::new(),
            worst: Worst::default(),
            left_out: 0,
        }
    }

    fn compare(&mut self, start: &State, sticks: bool, end: &State) {
        let duration = end.time_s - start.time_s;
        if duration <= 0.0 {
            return;
        }
        match self.reference.energy_after(start, sticks, duration) {
            Some(expected) => {
                let difference = (self.reference.energy(end) - expected).abs();
                self.differences.push(difference);
                self.worst.see(difference, self.toss);
            }
            None => self.left_out += 1,
        }
    }

    fn cells(&self) -> Vec<String> {
        let mut sorted = self.differences.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |percent: usize| sorted.get(sorted.len() * percent / 100).copied();
        let tiny = |value: Option<f64>| value.map_or("none".to_owned(), number::tiny);
        vec![
            sorted.len().to_string(),
            tiny(at(50)),
            tiny(at(99)),
            tiny(sorted.last().copied()),
            self.worst.toss.to_string(),
            self.left_out.to_string(),
        ]
    }
}

impl Observer for Balance {
    fn event(&mut self, event: &Event) {
        if let Some((start, sticks)) = self.start.take() {
            self.compare(&start, sticks, &event.state);
        }
        // along its side the coin touches with both rims, which the reference does not know
        let on_one_rim = event.state.axis.z.abs() > 0.0;
        self.start = match event.kind {
            EventKind::Sticking if on_one_rim => Some((event.state, true)),
            EventKind::Sliding if on_one_rim => Some((event.state, false)),
            _ => None,
        };
    }
}

impl Examiner for Balance {
    fn begin(&mut self, toss: u64) {
        (self.toss, self.start) = (toss, None);
    }

    fn examined(&self) -> u64 {
        self.differences.len() as u64 + self.left_out
    }
}
