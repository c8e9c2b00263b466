//! Every flight between two events, sampled densely, with either event-driven engine. The closed
//! form is that of space: a flight in the plane is a special case.

use crate::flight::{Leg, angular_momentum};
use crate::legs::Legs;
use crate::survey::{
    EXAMINED_IMPACTS, EventDriven, Examiner, examine, planar_stress, survey, volumetric, worst_text,
};
use crate::worst::Worst;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Event, Observer, Preset, State};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct MissedContacts {
    /// The engine
    #[arg(long, value_enum, default_value_t = EventDriven::Flat)]
    engine: EventDriven,

    /// Flights sampled, over all scenes
    #[arg(long, visible_alias = "tosses", value_parser = number::count,
          default_value = "1_000_000", value_name = "N")]
    flights: u64,
}

/// Samples the flights of one case.
#[derive(Clone, Copy)]
struct Scan<'a> {
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
    momentum: Worst,
}

/// Title, explanation and value of what a scan keeps the worst of.
type Kept = (&'static str, &'static str, fn(&Scan<'_>) -> Worst);

const KEPT: [Kept; 5] = [
    ("penetration", "penetration, D", |s| s.penetration),
    ("residual", "distance from the surface at contact, D", |s| {
        s.residual
    }),
    (
        "mismatch",
        "distance of the contact from where the closed form leads, D and rad",
        |s| s.mismatch,
    ),
    ("energy", "relative change of energy in flight", |s| {
        s.energy
    }),
    (
        "momentum",
        "change of angular momentum in flight, of the larger of |L| and I_t sqrt(g/D)",
        |s| s.momentum,
    ),
];

impl MissedContacts {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let cases = self.cases();
        let quota = self.flights.div_ceil(cases.len() as u64);
        let scans = survey(&cases, |case| self.scan(case, seed, quota));
        let mut more = vec!["flights", "missed"];
        more.extend(KEPT.map(|(title, ..)| title));
        let title = "Flights against dense sampling (lengths in D)";
        let mut record = Table::new(title, &Case::columns(&more));
        for scan in &scans {
            record.push(scan.row());
        }
        let missed = (0..scans.len()).filter(|&i| scans[i].missed > 0);
        let shown = record.select("Scenes with missed contacts", missed);
        let mut report = Report::new(record);
        report.show(shown);
        report.remark(format!(
            "{} of {} flights pass over a contact ({})",
            scans.iter().map(|scan| scan.missed).sum::<u64>(),
            scans.iter().map(|scan| scan.flights).sum::<u64>(),
            Leg::criterion(),
        ));
        for (_, what, of) in KEPT {
            let worst = Worst::over(scans.iter().map(|scan| (scan.case, of(scan))));
            report.remark(format!("worst {what}: {}", worst_text(worst)));
        }
        report
    }

    fn cases(&self) -> Vec<Case> {
        match self.engine {
            EventDriven::Flat => {
                let presets = [Preset::CleanFlat, Preset::Robot];
                planar_stress(&presets, &[0.0, 0.3, 0.5, 0.8, 0.95, 1.0])
            }
            EventDriven::Volumetric => cases_in_space(),
        }
    }

    fn scan<'a>(&self, case: &'a Case, seed: u64, quota: u64) -> Scan<'a> {
        let mut scan = Scan::new(case);
        match self.engine {
            EventDriven::Flat => {
                let engine = case.engine(&coinmc_flat::Settings {
                    max_impacts: EXAMINED_IMPACTS,
                    ..coinmc_flat::Settings::default()
                });
                examine(case, &engine, seed, quota, &mut scan);
            }
            EventDriven::Volumetric => {
                let settings = coinmc_volumetric::Settings {
                    max_impacts: EXAMINED_IMPACTS,
                    ..coinmc_volumetric::Settings::default()
                };
                let engine = volumetric(case, &settings);
                examine(case, &engine, seed, quota, &mut scan);
            }
        }
        scan
    }
}

/// Thin and thick, smooth and rough, dull and bouncy; from rest and vigorously spun.
fn cases_in_space() -> Vec<Case> {
    let presets = [Preset::Clean, Preset::Hand, Preset::Drop];
    let (restitutions, frictions) = ([0.0, 0.3, 0.5, 0.8, 0.95], [0.0, 0.3, 10.0]);
    let ratios = [0.01, 0.1, 0.85, 2.0, 10.0, 100.0];
    let cases = Case::grid(&presets, &restitutions, &frictions, &ratios);
    cases.into_iter().map(|case| case.rolling(0.01)).collect()
}

impl<'a> Scan<'a> {
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
            momentum: none,
        }
    }

    fn row(&self) -> Vec<String> {
        let mut row = self.case.cells();
        row.extend([self.flights.to_string(), self.missed.to_string()]);
        row.extend(KEPT.map(|(.., of)| number::tiny(of(self).value)));
        row
    }

    fn scan(&mut self, start: &State, end: &State) {
        let leg = Leg::new(&self.case.scene, start, end);
        let depth = leg.depth();
        self.flights += 1;
        self.missed += u64::from(Leg::is_missed(depth));
        self.penetration.see(depth, self.toss);
        self.residual.see(leg.back.gap(0.0).abs(), self.toss);
        self.compare(start, end, &leg);
    }

    /// The end of the flight, and the quantities that it should conserve.
    fn compare(&mut self, start: &State, end: &State, leg: &Leg) {
        let (from, duration) = (&leg.from, leg.duration);
        let scene = &self.case.scene;
        let mut expected = from.position(duration);
        // the duration is rounded; the mean rise is not
        let mean_rise = 0.5 * (start.velocity_m_s.z + end.velocity_m_s.z);
        expected.z = start.position_m.z + mean_rise * duration;
        let apart = (end.position_m - expected).norm() / scene.coin.rim_distance_m();
        let turned = (end.axis.into_inner() - from.axis(duration)).norm();
        self.mismatch.see(apart, self.toss);
        self.mismatch.see(turned, self.toss);
        let (before, after) = (start.energy_j_kg(scene), end.energy_j_kg(scene));
        self.energy.see((after / before - 1.0).abs(), self.toss);
        let (before, after) = (
            angular_momentum(&scene.coin, start),
            angular_momentum(&scene.coin, end),
        );
        let least = scene.coin.transverse_gyration_m2() / scene.time_scale_s();
        let change = (after - before).norm() / before.norm().max(least);
        self.momentum.see(change, self.toss);
    }
}

impl Observer for Scan<'_> {
    fn event(&mut self, event: &Event) {
        // two impacts at one instant, at one rim and then the other, enclose no flight
        let flown = |(start, end): &(State, State)| start.time_s < end.time_s;
        if let Some((start, end)) = self.legs.see(event).filter(flown) {
            self.scan(&start, &end);
        }
    }
}

impl Examiner for Scan<'_> {
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
    use crate::flight::Flight;
    use coinmc_core::Scene;
    use nalgebra::{UnitVector3, Vector3};

    /// A coin of R = 1 cm and H = 2 cm let go 0.5 m up with a spin that is oblique to its axis,
    /// moved to the time `t` by small steps of u' = ω × u.
    fn state(scene: &Scene, t: f64) -> State {
        let coin = &scene.coin;
        let momentum = Vector3::new(3.0, 14.0, 9.0) * coin.transverse_gyration_m2();
        let spin = |u: &Vector3<f64>| {
            let along = u * u.dot(&momentum);
            along / coin.axial_gyration_m2() + (momentum - along) / coin.transverse_gyration_m2()
        };
        let mut u = Vector3::z();
        let steps = 40_000;
        let h = t / f64::from(steps);
        for _ in 0..steps {
            let middle = u + spin(&u).cross(&u) * (0.5 * h);
            u += spin(&middle).cross(&middle) * h;
            u.normalize_mut();
        }
        let g = scene.gravity_m_s2();
        State {
            time_s: t,
            position_m: Vector3::new(0.0, 0.0, 0.5 - 0.5 * g * t * t),
            velocity_m_s: Vector3::new(0.0, 0.0, -g * t),
            axis: UnitVector3::new_normalize(u),
            spin_rad_s: spin(&u),
        }
    }

    #[test]
    fn the_closed_form_is_that_of_a_free_top() {
        let case = Case::new(Preset::Clean, 0.01, 2.0, 0.5, 0.3);
        let flight = Flight::new(&case.scene, &state(&case.scene, 0.0));
        let end = state(&case.scene, 0.3);
        // the steps above are of second order: (ωh)² ωt/6 for 17 rad/s, 0.3 s, 40000 of them
        assert!((flight.axis(0.3) - end.axis.into_inner()).norm() < 2e-8);
        assert!((flight.position(0.3) - end.position_m).norm() < 1e-12);
    }

    #[test]
    fn a_flight_that_goes_below_the_surface_shows() {
        let case = Case::new(Preset::Clean, 0.01, 2.0, 0.5, 0.3);
        let mut scan = Scan::new(&case);
        let start = state(&case.scene, 0.0);
        scan.scan(&start, &state(&case.scene, 0.3));
        assert_eq!((scan.flights, scan.missed), (1, 0));
        scan.scan(&start, &state(&case.scene, 0.32));
        assert_eq!((scan.flights, scan.missed), (2, 1));
    }
}
