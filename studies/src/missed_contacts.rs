//! Every flight between two events, sampled densely.

use crate::legs::Legs;
use crate::survey::{
    Examiner, case_cells, examine, stress_box, survey, with_case_columns, worst_text,
};
use crate::worst::Worst;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Event, Observer, Preset, State};
use std::f64::consts::PI;

/// Even samples of a flight.
const SAMPLES: u32 = 400;
/// Beside them, samples that close in on each end by factors of two.
const CLOSING_IN: std::ops::Range<i32> = 10..40;
/// Penetration, in D, that is no rounding error: a contact was passed over.
const MISSED: f64 = 1e-12;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct MissedContacts {
    /// Flights sampled, over all scenes
    #[arg(long, visible_alias = "tosses", value_parser = number::count,
          default_value = "1_000_000", value_name = "N")]
    flights: u64,
}

/// Samples the flights of one case.
#[derive(Clone, Copy)]
struct FlightScan<'a> {
    case: &'a Case,
    toss: u64,
    /// Where the flight under way began.
    legs: Legs,
    flights: u64,
    missed: u64,
    penetration: Worst,
    residual: Worst,
    mismatch: Worst,
    energy: Worst,
}

impl MissedContacts {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let presets = [Preset::CleanFlat, Preset::Robot];
        let cases = stress_box(&presets, &[0.0, 0.3, 0.5, 0.8, 0.95, 1.0]);
        let quota = self.flights.div_ceil(cases.len() as u64);
        let scans = survey(&cases, |case| {
            let mut scan = FlightScan::new(case);
            examine(case, seed, quota, &mut scan);
            scan
        });
        let columns = [
            "flights",
            "missed",
            "penetration",
            "residual",
            "mismatch",
            "energy_change",
        ];
        let title = "Flights against dense sampling (lengths in D)";
        let mut record = Table::new(title, &with_case_columns(&columns));
        for scan in &scans {
            record.push(scan.row());
        }
        let missed = (0..scans.len()).filter(|&i| scans[i].missed > 0);
        let shown = record.select("Scenes with missed contacts", missed);
        let mut report = Report::new(record);
        report.show(shown);
        let sum = |count: fn(&FlightScan<'_>) -> u64| scans.iter().map(count).sum::<u64>();
        report.remark(format!(
            "{} of {} flights pass over a contact (deeper than {MISSED:e} D at one of {SAMPLES} even \
             samples and {} towards the ends)",
            sum(|scan| scan.missed),
            sum(|scan| scan.flights),
            2 * CLOSING_IN.len(),
        ));
        let worst = |of: fn(&FlightScan<'_>) -> Worst| {
            worst_text(Worst::over(scans.iter().map(|scan| (scan.case, of(scan)))))
        };
        report.remark(format!(
            "worst penetration, D: {}",
            worst(|scan| scan.penetration)
        ));
        report.remark(format!(
            "worst distance from the surface at contact, D: {}",
            worst(|s| s.residual)
        ));
        report.remark(format!(
            "worst distance of the state at contact from the closed form, D and rad: {}",
            worst(|scan| scan.mismatch)
        ));
        report.remark(format!(
            "worst relative change of energy in flight: {}",
            worst(|s| s.energy)
        ));
        report
    }
}

impl<'a> FlightScan<'a> {
    fn new(case: &'a Case) -> Self {
        let none = Worst::default();
        Self {
            case,
            toss: 0,
            legs: Legs::default(),
            flights: 0,
            missed: 0,
            penetration: none,
            residual: none,
            mismatch: none,
            energy: none,
        }
    }

    fn row(&self) -> Vec<String> {
        let mut cells = case_cells(self.case);
        cells.extend([self.flights.to_string(), self.missed.to_string()]);
        let worst = [self.penetration, self.residual, self.mismatch, self.energy];
        cells.extend(worst.map(|worst| number::tiny(worst.value)));
        cells
    }

    /// Height of the lowest corner after `t` from `state`, in D. From the section's geometry, not
    /// from the engine's quadrants.
    fn gap(&self, state: &State, t: f64) -> f64 {
        let scene = &self.case.scene;
        let (sin, cos) = libm::sincos(tilt(state) + state.spin_rad_s.y * t);
        let lowest = 0.5 * scene.coin.height_m() * cos.abs() + scene.coin.radius_m() * sin.abs();
        let height =
            state.position_m.z + t * (state.velocity_m_s.z - 0.5 * scene.gravity_m_s2() * t);
        (height - lowest) / scene.coin.rim_distance_m()
    }

    /// Looks at a flight from its start and, in the second half, back from its end: each half is
    /// then exact where the coin is near the surface.
    fn scan(&mut self, start: &State, end: &State) {
        let scene = &self.case.scene;
        // not from the clock, which has long run on
        let duration = (start.velocity_m_s.z - end.velocity_m_s.z) / scene.gravity_m_s2();
        let mut deepest = Worst::default();
        let mut sample = |state, t| {
            let depth = -self.gap(state, t);
            deepest.see(depth, self.toss);
        };
        for i in 1..SAMPLES {
            let share = f64::from(i) / f64::from(SAMPLES);
            if 2 * i < SAMPLES {
                sample(start, share * duration);
            } else {
                sample(end, (share - 1.0) * duration);
            }
        }
        for halvings in CLOSING_IN {
            let t = duration * 0.5_f64.powi(halvings);
            sample(start, t);
            sample(end, -t);
        }
        self.flights += 1;
        self.missed += u64::from(deepest.value > MISSED || deepest.value.is_nan());
        self.penetration.see(deepest.value, self.toss);
        self.residual.see(self.gap(end, 0.0).abs(), self.toss);
        self.mismatch
            .see(self.mismatch(start, end, duration), self.toss);
        let (before, after) = (start.energy_j_kg(scene), end.energy_j_kg(scene));
        self.energy.see((after / before - 1.0).abs(), self.toss);
    }

    /// How far the end lies from where the closed form leads from the start.
    fn mismatch(&self, start: &State, end: &State, t: f64) -> f64 {
        let scene = &self.case.scene;
        let (from, to) = (start.position_m, end.position_m);
        let mean_rise = 0.5 * (start.velocity_m_s.z + end.velocity_m_s.z);
        let along = (to.x - from.x - start.velocity_m_s.x * t).abs();
        let up = (to.z - from.z - mean_rise * t).abs();
        let turned = tilt(end) - tilt(start) - start.spin_rad_s.y * t;
        // whole turns do not show
        let angle = (turned - (turned / (2.0 * PI)).round() * 2.0 * PI).abs();
        let lengths = along.max(up) / scene.coin.rim_distance_m();
        if angle.is_nan() {
            angle
        } else {
            lengths.max(angle)
        }
    }
}

/// Angle of the axis from the vertical, rad.
fn tilt(state: &State) -> f64 {
    libm::atan2(state.axis.x, state.axis.z)
}

impl Observer for FlightScan<'_> {
    fn event(&mut self, event: &Event) {
        if let Some((start, end)) = self.legs.see(event) {
            self.scan(&start, &end);
        }
    }
}

impl Examiner for FlightScan<'_> {
    fn begin(&mut self, toss: u64) {
        (self.toss, self.legs) = (toss, Legs::default());
    }

    fn examined(&self) -> u64 {
        self.flights
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitVector3, Vector3};

    /// A coin of R = 1 cm and H = 2 cm that drops from 0.5 m while it turns at 20 rad/s.
    fn state(case: &Case, t: f64) -> State {
        let (sin, cos) = libm::sincos(20.0 * t);
        let g = case.scene.gravity_m_s2();
        State {
            time_s: t,
            position_m: Vector3::new(0.0, 0.0, 0.5 - 0.5 * g * t * t),
            velocity_m_s: Vector3::new(0.0, 0.0, -g * t),
            axis: UnitVector3::new_normalize(Vector3::new(sin, 0.0, cos)),
            spin_rad_s: Vector3::new(0.0, 20.0, 0.0),
        }
    }

    /// First contact of that flight, by bisection of the first sample below the surface.
    fn contact(scan: &FlightScan<'_>, case: &Case) -> f64 {
        let start = state(case, 0.0);
        let is_below = |i: &i32| scan.gap(&start, f64::from(*i) * 1e-4) < 0.0;
        let first = (1..10_000).find(is_below).unwrap();
        let (mut above, mut below) = (f64::from(first - 1) * 1e-4, f64::from(first) * 1e-4);
        for _ in 0..60 {
            let middle = f64::midpoint(above, below);
            if scan.gap(&start, middle) < 0.0 {
                below = middle;
            } else {
                above = middle;
            }
        }
        above
    }

    #[test]
    fn a_flight_to_the_first_contact_is_clear_and_a_longer_one_is_not() {
        let case = Case::new(Preset::Robot, 0.01, 2.0, 0.5, 0.3);
        let mut scan = FlightScan::new(&case);
        let t = contact(&scan, &case);
        scan.scan(&state(&case, 0.0), &state(&case, t));
        assert_eq!((scan.flights, scan.missed), (1, 0));
        assert!(scan.residual.value < 1e-12 && scan.energy.value < 1e-14);
        assert!(scan.mismatch.value < 1e-12, "{}", scan.mismatch.value);
        scan.scan(&state(&case, 0.0), &state(&case, t + 1e-6));
        assert_eq!((scan.flights, scan.missed), (2, 1));
    }

    #[test]
    fn an_end_that_the_start_does_not_lead_to_shows() {
        let case = Case::new(Preset::Robot, 0.01, 2.0, 0.5, 0.3);
        let mut scan = FlightScan::new(&case);
        let mut end = state(&case, 0.1);
        end.position_m.x += 1e-6;
        scan.scan(&state(&case, 0.0), &end);
        assert!(scan.mismatch.value > 1e-5);
    }
}
