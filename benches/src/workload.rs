//! Pieces of work that are timed and whose instructions are counted, by name.

use crate::Case;
use coinmc_core::{Engine, Material, Philox4x64, Preset, run_tosses};
use coinmc_flat::{Law, Settings};
use coinmc_volumetric::Lanes;
use std::hint::black_box;
use std::ops::Range;

const SEED: u64 = 1;

/// A named piece of work that can be done any number of times.
///
/// # Example
/// ```
/// use coinmc_bench::workloads;
/// let philox = workloads().into_iter().find(|work| work.name == "philox").unwrap();
/// assert_eq!(philox.run(0..10), philox.run(0..4).wrapping_add(philox.run(4..10)));
/// ```
#[derive(Debug, Clone)]
pub struct Workload {
    /// What the tables call it.
    pub name: String,
    task: Task,
}

#[derive(Debug, Clone)]
enum Task {
    /// Tosses under Moreau's law, with these lanes.
    Toss(Case, Lanes),
    /// Tosses under Chatterjee and Ruina's, one after the other.
    TossChatterjeeRuina(Case),
    /// Tosses in space under Moreau's law, with these lanes.
    TossInSpace(Case, Lanes),
    /// Tosses in space under Stronge's, one after the other.
    TossStronge(Case),
    /// Launches, not followed.
    Launch(Case),
    /// Blocks of four random words.
    Philox,
}

/// Flat ones, one after the other (so that their instructions are the same on every processor):
/// tosses first, then the parts a toss is made of.
pub fn workloads() -> Vec<Workload> {
    use Preset::{CleanFlat, Robot};
    let case = |preset, ratio, e, mu| Case::new(preset, 0.01, ratio, e, mu);
    let mut list: Vec<Workload> = [
        case(CleanFlat, 1.2, 0.5, 0.0),
        case(CleanFlat, 1.2, 0.5, 0.3),
        case(Robot, 1.2, 0.5, 0.0),
        case(Robot, 1.2, 0.5, 0.3),
        case(CleanFlat, 1.2, 0.0, 0.0),
        case(CleanFlat, 1.2, 0.0, 0.3),
        case(CleanFlat, 0.1, 0.5, 0.3),
        case(CleanFlat, 10.0, 0.5, 0.3),
    ]
    .into_iter()
    .map(|case| Workload::toss_flat(case, Lanes::Scalar))
    .collect();
    let other_law = case(CleanFlat, 1.2, 0.5, 0.3);
    list.push(Workload::new(
        format!("toss {} chatterjee-ruina", short(&other_law)),
        Task::TossChatterjeeRuina(other_law),
    ));
    for preset in [CleanFlat, Robot] {
        let adhesive = case(preset, 1.2, 0.0, 0.0).adhesive();
        list.push(Workload::new(
            format!("first contact {preset} x=1.2"),
            Task::Toss(adhesive, Lanes::Scalar),
        ));
    }
    for preset in [CleanFlat, Robot] {
        list.push(Workload::new(
            launch_name(preset),
            Task::Launch(case(preset, 1.2, 0.0, 0.0)),
        ));
    }
    list.push(Workload::new("philox".to_owned(), Task::Philox));
    list
}

/// Tosses in space, one after the other (so that their instructions are the same on every
/// processor): those with asked rates first.
pub fn space_workloads() -> Vec<Workload> {
    let clean = |ratio, e, rho| Case::new(Preset::Clean, 0.01, ratio, e, 0.3).rolling(rho);
    let cases = [
        clean(0.85, 0.5, 0.01),
        clean(0.85, 0.5, 0.003),
        clean(0.85, 0.0, 0.01),
        clean(2.0, 0.0, 0.003),
        clean(0.25, 0.5, 0.01),
        Case::new(Preset::Clean, 0.01, 0.85, 0.5, 0.0),
        Case::table1(1.0).rolling(0.01),
    ];
    let toss = |case| Workload::toss_in_space(case, Lanes::Scalar);
    let mut list: Vec<Workload> = cases.into_iter().map(toss).collect();
    let other_law = clean(0.85, 0.5, 0.01);
    list.push(Workload::new(
        format!("toss {} stronge", short(&other_law)),
        Task::TossStronge(other_law),
    ));
    list
}

/// Tosses by hand on rough ground, one after the other: on steel, where many coins roll on one rim for
/// long, and on wood, where they hop.
pub fn rough_workloads() -> Vec<Workload> {
    let chosen = |material: &Material| ["steel", "wood"].contains(&material.name);
    let work = |material: Material| {
        let task = Task::TossInSpace(Case::by_hand(0.7, &material), Lanes::Scalar);
        Workload::new(format!("toss hand x=0.7 {}", material.name), task)
    };
    let materials = Material::ALL.into_iter().filter(chosen);
    materials.map(work).collect()
}

fn launch_name(preset: Preset) -> String {
    format!("launch {preset}")
}

/// The case without its radius, which is 1 cm in all of them.
fn short(case: &Case) -> String {
    case.to_string().replace(" R=0.01", "")
}

fn toss_name(case: &Case, lanes: Lanes) -> String {
    match lanes {
        Lanes::Scalar => format!("toss {}", short(case)),
        _ => format!("toss {} {lanes}", short(case)),
    }
}

/// These lanes, or the best there are.
fn available(lanes: Lanes) -> Lanes {
    lanes.available().unwrap_or_else(|_| Lanes::best())
}

impl Workload {
    fn new(name: String, task: Task) -> Self {
        Self { name, task }
    }

    /// Flat tosses with these lanes, or the best there are.
    pub fn toss_flat(case: Case, lanes: Lanes) -> Self {
        Self::new(toss_name(&case, lanes), Task::Toss(case, available(lanes)))
    }

    /// Tosses in space with these lanes, or the best there are.
    pub fn toss_in_space(case: Case, lanes: Lanes) -> Self {
        let task = Task::TossInSpace(case, available(lanes));
        Self::new(toss_name(&case, lanes), task)
    }

    /// The case, of tosses in space under Moreau's law.
    pub fn case_in_space(&self) -> Option<Case> {
        match self.task {
            Task::TossInSpace(case, _) => Some(case),
            _ => None,
        }
    }

    /// Of flat tosses, the name of the workload that makes their launches alone.
    pub fn launch(&self) -> Option<String> {
        match &self.task {
            Task::Toss(case, _) | Task::TossChatterjeeRuina(case) => Some(launch_name(case.preset)),
            Task::TossInSpace(..) | Task::TossStronge(_) | Task::Launch(_) | Task::Philox => None,
        }
    }

    /// Does numbers `range.start .. range.end` of it. Returns a sum over the results, which
    /// depends on the numbers only, so that no compiler can leave any of the work out.
    pub fn run(&self, range: Range<u64>) -> u64 {
        match &self.task {
            Task::Toss(case, lanes) => toss_flat(case, Law::Moreau, *lanes, range),
            Task::TossChatterjeeRuina(case) => {
                toss_flat(case, Law::ChatterjeeRuina, Lanes::Scalar, range)
            }
            Task::TossInSpace(case, lanes) => {
                toss_in_space(case, coinmc_volumetric::Law::Moreau, *lanes, range)
            }
            Task::TossStronge(case) => {
                toss_in_space(case, coinmc_volumetric::Law::Stronge, Lanes::Scalar, range)
            }
            Task::Launch(case) => launches(case, range),
            Task::Philox => philox(range),
        }
    }
}

fn toss_flat(case: &Case, law: Law, lanes: Lanes, range: Range<u64>) -> u64 {
    let settings = Settings {
        law,
        ..Settings::default()
    };
    let engine = case.engine(&settings).with_lanes(lanes);
    tosses(&engine.expect("lanes are available"), case, range)
}

fn toss_in_space(case: &Case, law: coinmc_volumetric::Law, lanes: Lanes, range: Range<u64>) -> u64 {
    let settings = coinmc_volumetric::Settings {
        law,
        ..coinmc_volumetric::Settings::default()
    };
    let engine = settings.engine(&case.scene);
    let engine = engine.expect("the defaults are in range");
    let engine = engine.with_lanes(lanes).expect("lanes are available");
    tosses(&engine, case, range)
}

fn tosses<E: Engine>(engine: &E, case: &Case, range: Range<u64>) -> u64 {
    let (launches, stream) = (case.launches(), Case::stream(SEED));
    let mut workspace = engine.workspace();
    let tally = run_tosses(
        engine,
        &mut workspace,
        &case.scene,
        &launches,
        &stream,
        range,
    );
    tally.heads + tally.impacts
}

fn launches(case: &Case, range: Range<u64>) -> u64 {
    let (launches, stream) = (case.launches(), Case::stream(SEED));
    range.fold(0, |sum: u64, toss| {
        let launch = black_box(launches.launch(&case.scene.coin, &mut stream.toss(toss)));
        sum.wrapping_add(launch.spin_rad_s.y.to_bits())
    })
}

fn philox(range: Range<u64>) -> u64 {
    let generator = Philox4x64::new([SEED, 0]);
    range.fold(0, |sum: u64, toss| {
        let block = generator.block([0, black_box(toss), 0, 0]);
        block.into_iter().fold(sum, u64::wrapping_add)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_work_does_not_depend_on_how_it_is_cut() {
        let all = [workloads(), space_workloads(), rough_workloads()].concat();
        for (i, work) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|other| other.name != work.name));
            let parts = work.run(0..30).wrapping_add(work.run(30..100));
            assert_eq!(work.run(0..100), parts, "{}", work.name);
        }
    }
}
