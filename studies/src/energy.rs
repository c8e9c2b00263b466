//! Whether anything but gravity gives energy to the coin.

use crate::survey::{
    Examiner, case_cells, examine, stress_box, survey, with_case_columns, worst_text,
};
use crate::worst::Worst;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Event, EventKind, Observer, Preset};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Energy {
    /// Impacts and contact phases examined, over all scenes
    #[arg(long, visible_alias = "tosses", value_parser = number::count,
          default_value = "30_000_000", value_name = "N")]
    events: u64,
}

/// What energy passes through.
const KINDS: [&str; 4] = ["impact", "sticking", "sliding", "gliding"];
/// Kinds that should keep the energy: a corner that does not move, and one without friction.
const CONSERVING: [usize; 2] = [1, 3];

/// One kind of event of one case.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    events: u64,
    gain: Worst,
    loss: Worst,
}

/// Keeps the books of one case.
struct Ledger<'a> {
    case: &'a Case,
    toss: u64,
    /// The last event and the energy at it.
    last: Option<(EventKind, f64)>,
    kinds: [Balance; 4],
}

impl Energy {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let presets = [Preset::CleanFlat, Preset::Robot];
        let cases = stress_box(&presets, &[0.0, 0.3, 0.5, 0.8, 0.95, 1.0]);
        let quota = self.events.div_ceil(cases.len() as u64);
        let ledgers = survey(&cases, |case| {
            let mut ledger = Ledger::new(case);
            examine(case, seed, quota, &mut ledger);
            ledger
        });
        let columns = with_case_columns(&["kind", "events", "worst_gain", "worst_loss"]);
        let mut record = Table::new("Relative changes of energy", &columns);
        for ledger in &ledgers {
            for (kind, balance) in KINDS.iter().zip(&ledger.kinds) {
                if balance.events > 0 {
                    record.push(ledger.row(kind, balance));
                }
            }
        }
        let mut report = Report::new(record);
        report.show(summary(&ledgers));
        report.remark(
            "Relative to the energy before; a negative gain is a loss. gliding: sliding without \
             friction. It and sticking should keep the energy, so their largest loss is shown too: \
             1e-11 or so where a corner comes to rest, whose last slip is taken out.",
        );
        report
    }
}

fn summary(ledgers: &[Ledger<'_>]) -> Table {
    let columns = ["kind", "events", "worst gain (where)", "worst loss (where)"];
    let mut table = Table::new("Relative changes of energy", &columns);
    for (i, kind) in KINDS.iter().enumerate() {
        let events: u64 = ledgers.iter().map(|ledger| ledger.kinds[i].events).sum();
        let worst = |of: fn(&Balance) -> Worst| {
            let all = ledgers
                .iter()
                .map(|ledger| (ledger.case, of(&ledger.kinds[i])));
            worst_text(Worst::over(all))
        };
        let loss = if CONSERVING.contains(&i) {
            worst(|balance| balance.loss)
        } else {
            String::new()
        };
        table.push(vec![
            (*kind).to_owned(),
            events.to_string(),
            worst(|balance| balance.gain),
            loss,
        ]);
    }
    table
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

    fn row(&self, kind: &str, balance: &Balance) -> Vec<String> {
        let mut cells = case_cells(self.case);
        cells.extend([
            kind.to_owned(),
            balance.events.to_string(),
            number::tiny(balance.gain.value),
            number::tiny(balance.loss.value),
        ]);
        cells
    }

    /// What has just ended with an event of this kind; `None` for flights and what has no length.
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
    fn gains_are_booked_where_they_arise_and_flights_are_not() {
        let case = Case::new(Preset::Robot, 0.01, 1.0, 0.5, 0.3);
        let mut ledger = Ledger::new(&case);
        ledger.begin(5);
        // energies 2, 8 (a flight, not booked), 2, 3.125, 2
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
