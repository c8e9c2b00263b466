//! The energy balance of contact phases against an independent integration.

use crate::balance::Reference;
use crate::survey::{EXAMINED_IMPACTS, Examiner, FRICTION, examine, survey, volumetric};
use crate::worst::Worst;
use coinmc_bench::{Case, Table, number};
use coinmc_core::{Event, EventKind, Observer, Preset, State};
use coinmc_volumetric::Settings;

/// (H/R, e, ρ/R) of the scenes whose contact phases are followed again.
const BALANCED: [(f64, f64, f64); 6] = [
    (0.25, 0.5, 0.01),
    (0.85, 0.0, 0.01),
    (0.85, 0.5, 0.003),
    (0.85, 0.0, 0.0),
    (0.85, 0.5, 0.03),
    (2.0, 0.0, 0.003),
];

/// Follows the contact phases of one case again.
struct Balance {
    reference: Reference,
    toss: u64,
    start: Option<(State, bool)>,
    /// |energy at the end − the reference's| in m g D, of each phase.
    differences: Vec<f64>,
    worst: Worst,
    /// Phases that the reference cannot follow.
    left_out: u64,
}

/// Contact phases against their independent integration: so many phases, over all scenes, for each
/// of two settings.
pub(crate) fn balance(seed: u64, phases: u64) -> Table {
    let default = Settings::default();
    let tight = Settings {
        tolerance: 1e-10,
        stick_speed: 1e-5,
        ..default
    };
    let quota = phases.div_ceil(BALANCED.len() as u64);
    let jobs: Vec<(Case, &str, Settings)> = [("default", default), ("tight", tight)]
        .into_iter()
        .flat_map(|(name, settings)| {
            BALANCED.map(|(ratio, e, rho)| {
                let case = Case::new(Preset::Clean, 0.01, ratio, e, FRICTION);
                (case.rolling(rho), name, settings)
            })
        })
        .collect();
    let found = survey(&jobs, |(case, _, settings)| {
        let mut balance = Balance::new(case, settings.smoothing_time);
        let settings = Settings {
            max_impacts: EXAMINED_IMPACTS,
            ..*settings
        };
        examine(
            case,
            &volumetric(case, &settings),
            seed,
            quota,
            &mut balance,
        );
        balance
    });
    let mut table = Table::new(
        "Energy at the end of contact phases against an independent integration, m g D",
        &Case::columns(&[
            "settings", "phases", "median", "99_%", "worst", "toss", "left_out",
        ]),
    );
    for ((case, name, _), found) in jobs.iter().zip(&found) {
        let mut row = case.cells();
        row.push((*name).to_owned());
        row.extend(found.cells());
        table.push(row);
    }
    table
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
