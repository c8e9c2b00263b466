//! Whether anything but gravity gives energy to the coin, with either event-driven engine and every
//! rigid law.

use crate::phases::balance;
use crate::survey::{
    EXAMINED_IMPACTS, EventDriven, Examiner, examine, planar_stress, survey, volumetric, worst_text,
};
use crate::worst::Worst;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Event, EventKind, Observer, Preset};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Energy {
    /// The engine
    #[arg(long, value_enum, default_value_t = EventDriven::Flat)]
    engine: EventDriven,

    /// Impacts and contact phases whose gain is examined, over all scenes and laws
    #[arg(long, visible_alias = "tosses", value_parser = number::count,
          default_value = "20_000_000", value_name = "N")]
    events: u64,

    /// In space: contact phases that are followed again independently, over all scenes, for each
    /// setting
    #[arg(long, value_parser = number::count, default_value = "20_000", value_name = "N")]
    phases: u64,
}

/// What changes the energy.
const KINDS: [&str; 4] = ["impact", "sticking", "sliding", "gliding"];
/// Kinds that conserve it in the plane: a corner that does not move, and one without friction.
const CONSERVING: [usize; 2] = [1, 3];

/// The settings of an engine, with its law.
#[derive(Debug, Clone, Copy)]
enum Settings {
    Flat(coinmc_flat::Settings),
    Volumetric(coinmc_volumetric::Settings),
}

/// One kind of event of one case.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    events: u64,
    gain: Worst,
    loss: Worst,
}

/// The energies of one case.
struct Ledger<'a> {
    case: &'a Case,
    toss: u64,
    /// The last event and the energy at it.
    last: Option<(EventKind, f64)>,
    kinds: [Balance; 4],
}

impl Settings {
    fn law(&self) -> &'static str {
        match self {
            Self::Flat(settings) => settings.law.name(),
            Self::Volumetric(settings) => settings.law.name(),
        }
    }

    fn examine(&self, case: &Case, seed: u64, quota: u64, ledger: &mut Ledger<'_>) {
        match self {
            Self::Flat(settings) => examine(case, &case.engine(settings), seed, quota, ledger),
            Self::Volumetric(settings) => {
                examine(case, &volumetric(case, settings), seed, quota, ledger);
            }
        }
    }
}

impl Energy {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let jobs = self.jobs();
        let quota = self.events.div_ceil(jobs.len() as u64);
        let ledgers = survey(&jobs, |(case, settings)| {
            let mut ledger = Ledger::new(case);
            settings.examine(case, seed, quota, &mut ledger);
            ledger
        });
        let columns = ["law", "kind", "events", "worst_gain", "worst_loss"];
        let mut record = Table::new("Relative changes of energy", &Case::columns(&columns));
        for ((_, settings), ledger) in jobs.iter().zip(&ledgers) {
            for (kind, balance) in KINDS.iter().zip(&ledger.kinds) {
                if balance.events > 0 {
                    record.push(ledger.row(settings.law(), kind, balance));
                }
            }
        }
        let mut report = Report::new(record);
        report.show(self.summary(&jobs, &ledgers));
        report.remark(
            "Relative to the energy before; a negative gain is a loss. gliding: sliding without \
             friction. In the plane gliding and sticking conserve the energy, so their largest loss \
             is shown too: 1e-11 or so where a corner comes to rest, whose last slip is removed.",
        );
        if self.engine == EventDriven::Volumetric {
            report.show(balance(seed, self.phases));
            report.remark(
                "The balance compares the energy at the end of a phase, in m g D, with that of the \
                 same phase followed by the oracle's Newton–Euler equations in steps of 0.001 \
                 sqrt(D/g) and less: it includes the error of the path. tight: tolerance 1e-10, \
                 stick_speed 1e-5.",
            );
        }
        report
    }

    /// Every mixture of bouncy and dull, smooth and rough, thin and thick, under every rigid law.
    fn jobs(&self) -> Vec<(Case, Settings)> {
        let max_impacts = EXAMINED_IMPACTS;
        match self.engine {
            EventDriven::Flat => {
                let presets = [Preset::CleanFlat, Preset::Robot];
                let cases = planar_stress(&presets, &[0.0, 0.3, 0.5, 0.8, 0.95, 1.0]).into_iter();
                let settings = |law| coinmc_flat::Settings {
                    law,
                    max_impacts,
                    ..coinmc_flat::Settings::default()
                };
                let laws = coinmc_flat::Law::RIGID.map(|law| Settings::Flat(settings(law)));
                cases.flat_map(|case| laws.map(|law| (case, law))).collect()
            }
            EventDriven::Volumetric => {
                let (restitutions, frictions) = ([0.0, 0.3, 0.5, 0.8, 1.0], [0.0, 0.3, 1.0, 10.0]);
                let ratios = [0.01, 0.25, 0.85, 2.0, 10.0];
                let cases = Case::grid(&[Preset::Clean], &restitutions, &frictions, &ratios);
                let settings = |law| coinmc_volumetric::Settings {
                    law,
                    max_impacts,
                    ..coinmc_volumetric::Settings::default()
                };
                let laws = coinmc_volumetric::Law::ALL;
                let laws = laws.map(|law| Settings::Volumetric(settings(law)));
                let rolling = |case: Case| [0.003, 0.03].map(|rho| case.rolling(rho));
                let cases = cases.into_iter().flat_map(rolling);
                cases.flat_map(|case| laws.map(|law| (case, law))).collect()
            }
        }
    }

    fn summary(&self, jobs: &[(Case, Settings)], ledgers: &[Ledger<'_>]) -> Table {
        let columns = [
            "law",
            "kind",
            "events",
            "worst gain (where)",
            "worst loss (where)",
        ];
        let mut table = Table::new("Relative changes of energy", &columns);
        let mut laws: Vec<&str> = Vec::new();
        for (_, settings) in jobs {
            if !laws.contains(&settings.law()) {
                laws.push(settings.law());
            }
        }
        for law in laws {
            let of_law = || {
                jobs.iter()
                    .zip(ledgers)
                    .filter(|((_, s), _)| s.law() == law)
            };
            for (i, kind) in KINDS.iter().enumerate() {
                let events: u64 = of_law().map(|(_, ledger)| ledger.kinds[i].events).sum();
                let worst = |of: fn(&Balance) -> Worst| {
                    let all = of_law().map(|(_, ledger)| (ledger.case, of(&ledger.kinds[i])));
                    worst_text(Worst::over(all))
                };
                let conserves = self.engine == EventDriven::Flat && CONSERVING.contains(&i);
                table.push(vec![
                    law.to_owned(),
                    (*kind).to_owned(),
                    events.to_string(),
                    worst(|balance| balance.gain),
                    if conserves {
                        worst(|balance| balance.loss)
                    } else {
                        String::new()
                    },
                ]);
            }
        }
        table
    }
}

impl<'a> Ledger<'a> {
    fn new(case: &'a Case) -> Self {
        Self {
            case,
            toss: 0,
            last: None,
            kinds: [Balance::default(); 4],
        }
    }

    fn row(&self, law: &str, kind: &str, balance: &Balance) -> Vec<String> {
        let mut cells = self.case.cells();
        cells.extend([
            law.to_owned(),
            kind.to_owned(),
            balance.events.to_string(),
            number::tiny(balance.gain.value),
            number::tiny(balance.loss.value),
        ]);
        cells
    }

    /// What ended with an event of this kind; `None` for flights and events without duration.
    fn kind(&self, from: EventKind, to: EventKind) -> Option<usize> {
        match (from, to) {
            (EventKind::Touching, EventKind::Impact) => Some(0),
            (EventKind::Sticking, _) => Some(1),
            (EventKind::Sliding, _) if self.case.scene.surface.friction() > 0.0 => Some(2),
            (EventKind::Sliding, _) => Some(3),
            _ => None,
        }
    }
}

impl Observer for Ledger<'_> {
    fn event(&mut self, event: &Event) {
        let energy = event.state.energy_j_kg(&self.case.scene);
        if let Some((from, before)) = self.last
            && let Some(kind) = self.kind(from, event.kind)
        {
            let gain = energy / before - 1.0;
            let balance = &mut self.kinds[kind];
            balance.events += 1;
            balance.gain.see(gain, self.toss);
            balance.loss.see(-gain, self.toss);
        }
        self.last = Some((event.kind, energy));
    }
}

impl Examiner for Ledger<'_> {
    fn begin(&mut self, toss: u64) {
        (self.toss, self.last) = (toss, None);
    }

    fn examined(&self) -> u64 {
        self.kinds.iter().map(|balance| balance.events).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::State;
    use nalgebra::Vector3;

    fn event(kind: EventKind, speed: f64) -> Event {
        let state = State {
            time_s: 0.0,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::new(speed, 0.0, 0.0),
            axis: Vector3::z_axis(),
            spin_rad_s: Vector3::zeros(),
        };
        Event { kind, state }
    }

    #[test]
    fn gains_count_where_they_arise_and_flights_do_not() {
        let case = Case::new(Preset::Robot, 0.01, 1.0, 0.5, 0.3);
        let mut ledger = Ledger::new(&case);
        ledger.begin(5);
        // energies 2, 8 (a flight, not counted), 2, 3.125, 2
        for (kind, speed) in [
            (EventKind::Launched, 2.0),
            (EventKind::Touching, 4.0),
            (EventKind::Impact, 2.0),
            (EventKind::Sliding, 2.0),
            (EventKind::LiftOff, 2.5),
            (EventKind::Ended, 2.0),
        ] {
            ledger.event(&event(kind, speed));
        }
        assert_eq!(ledger.examined(), 2);
        assert_eq!(
            (ledger.kinds[0].gain.value, ledger.kinds[0].events),
            (-0.75, 1)
        );
        assert_eq!(
            (ledger.kinds[2].gain.value, ledger.kinds[2].gain.toss),
            (0.5625, 5)
        );
    }
}
