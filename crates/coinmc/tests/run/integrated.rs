//! Points that are integrated instead of tossed: the same numbers however the run was cut,
//! interrupted or resumed, and those of random tosses.

use crate::support::{
    Ear, assert_same, contents, put_tallies, resealed, run_whole, run_with, tallies,
};
use coinmc::OnDemand;
use coinmc::plan::{Plan, StoppedBy};
use coinmc::results::{Row, fair_ratios};
use coinmc::run::{Count, Part, Progress, ProgressSink, Status, count, integrate_point, merge};
use std::fs;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

const ENGINES: &str = "launch.preset = 'hand'\nengine.volumetric = {}\n";

/// Three ratios of a coin that stays where it lands.
fn plan_of(engine: &str, stop: &str, more: &str) -> Plan {
    let text = format!(
        "seed = 7\ncoin.ratio = [0.5, 1.0, 2.0]\nsurface.landing = 'adhesive'\n{engine}\
         stop = {{ {stop} }}\n{more}\n"
    );
    coinmc::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

fn plan() -> Plan {
    plan_of(ENGINES, "tosses = 20_000", "")
}

fn counted(plan: &Plan, threads: usize) -> OnDemand<Row> {
    let options = Count {
        threads: NonZeroUsize::new(threads),
        cancel: &AtomicBool::new(false),
        sink: &(),
    };
    count(plan, &options).unwrap().results.rows
}

#[test]
fn a_run_integrates_and_reports_it() {
    let (dir, plan) = (tempfile::tempdir().unwrap(), plan());
    let report = run_whole(&plan, dir.path());
    assert_eq!((report.status, report.tosses), (Status::Complete, 0));
    assert_eq!(plan.tosses_planned(), 0);
    for (point, row) in report.results.rows.iter().enumerate() {
        let alone = integrate_point(&plan, point, u64::MAX).unwrap().unwrap();
        let by = StoppedBy::Tosses;
        assert_eq!(*row, Row::integrated(&plan, point, &alone, by));
        assert_eq!((row.interval, row.sampling), ("student-t", "quasi-random"));
        assert!(
            row.evaluations >= 1024 && row.evaluations <= 20_000,
            "{row:?}"
        );
        assert_eq!((row.tally.tosses(), row.side.n), (0, row.evaluations));
        assert!(
            row.half_width() < 2e-4 && row.side.lo < row.side.p,
            "{row:?}"
        );
    }
    for threads in [1, 2, 5] {
        assert_eq!(counted(&plan, threads), report.results.rows);
    }
    let csv = fs::read_to_string(dir.path().join("results.csv")).unwrap();
    let mut lines = csv.lines();
    assert!(lines.next().unwrap().contains(",sampling,evaluations,"));
    // counts of tosses have no relative error where there are none
    assert!(lines.all(|line| line.contains(",student-t,,,,,") && line.contains(",quasi-random,")));
}

#[test]
fn a_run_killed_or_damaged_anywhere_has_the_same_results() {
    let (whole, other, plan) = (
        tempfile::tempdir().unwrap(),
        tempfile::tempdir().unwrap(),
        plan(),
    );
    run_whole(&plan, whole.path());
    let before = contents(whole.path());
    let again = run_whole(&plan, whole.path());
    assert_eq!((again.reused_chunks, before), (3, contents(whole.path())));

    let ear = Ear::that_cancels_at(1);
    let stopped = run_with(&plan, other.path(), Part::WHOLE, 1, &ear).unwrap();
    assert!(matches!(
        stopped.status,
        Status::Interrupted | Status::Complete
    ));
    run_whole(&plan, other.path());
    assert_same(whole.path(), other.path());

    // one of another version, and half a text
    let mut texts = tallies(other.path());
    texts[0] = resealed(&texts[0], |text| {
        text.replacen("integral 1", "integral 2", 1)
    });
    texts[1] = format!("{}\n", &texts[1][..texts[1].len() / 2]);
    put_tallies(other.path(), &texts);
    let ear = Ear::default();
    run_with(&plan, other.path(), Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(ear.warnings().len(), 2, "{:?}", ear.warnings());
    fs::remove_file(other.path().join("tallies.rejected.txt")).unwrap();
    assert_same(whole.path(), other.path());
}

#[test]
fn parts_of_a_run_merge_to_the_whole() {
    let dir = tempfile::tempdir().unwrap();
    let plan = plan();
    let at = |name: &str| dir.path().join(name);
    run_whole(&plan, &at("whole"));
    let parts: Vec<_> = (1..=2)
        .map(|index| {
            let part = Part::new(index, 2).unwrap();
            let out = at(&format!("part-{index}"));
            let report = run_with(&plan, &out, part, 1, &Ear::default()).unwrap();
            assert_eq!(report.status, Status::Part);
            // nothing more is to come of what this part integrated
            for row in &report.results.rows {
                assert_eq!(row.stopped_by.is_reached(), row.evaluations > 0, "{row:?}");
            }
            out
        })
        .collect();
    let error = merge(&parts[..1], &at("half"), &()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "1 chunk is in none of the parts: point 1. Run this part (again): 2/2"
    );
    merge(&parts, &at("merged"), &()).unwrap();
    assert_same(&at("whole"), &at("merged"));
}

#[test]
fn exact_rules_need_no_work_and_no_file() {
    let clean = "launch.preset = 'clean'\nengine.volumetric = {}\n";
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    for stop in ["tosses = 20_000", "half_width = 1e-3, max_tosses = 1e6"] {
        let plan = plan_of(clean, stop, "");
        let out = at(&format!("{stop:.6}"));
        let report = run_whole(&plan, &out);
        assert_eq!((report.status, report.tosses), (Status::Complete, 0));
        assert!(!out.join("tallies.txt").exists());
        for (point, row) in report.results.rows.iter().enumerate() {
            let alone = integrate_point(&plan, point, u64::MAX).unwrap().unwrap();
            assert_eq!(Some(alone), plan.known(point));
            let by = StoppedBy::ClosedForm;
            assert_eq!(*row, Row::integrated(&plan, point, &alone, by));
            assert_eq!((row.interval, row.sampling), ("exact", "closed-form"));
        }
        assert_eq!(run_whole(&plan, &out).results, report.results);
    }
    let plan = plan_of(clean, "tosses = 20_000", "");
    let parts = [1, 2].map(|index| {
        let out = at(&format!("part-{index}"));
        run_with(
            &plan,
            &out,
            Part::new(index, 2).unwrap(),
            1,
            &Ear::default(),
        )
        .unwrap();
        out
    });
    merge(&parts, &at("merged"), &()).unwrap();
    assert_same(&at("tosses"), &at("merged"));
}

/// 2e5 tosses, six faces: one of 6e4 such runs has a face beyond 4 standard errors in one of them.
#[test]
fn forced_random_tosses_agree() {
    for engine in [
        "launch.preset = 'table1'\nengine.volumetric = {}\n",
        "launch.preset = 'robot'\nengine.flat = {}\n",
    ] {
        let integrated = counted(&plan_of(engine, "tosses = 200_000", ""), 2);
        let random = plan_of(engine, "tosses = 200_000", "sampling.method = 'random'");
        assert_eq!(random.tosses_planned(), 600_000);
        for (row, tossed) in integrated.iter().zip(counted(&random, 2)) {
            assert_eq!((tossed.sampling, tossed.evaluations), ("random", 0));
            for (a, b) in [
                (&row.heads, &tossed.heads),
                (&row.tails, &tossed.tails),
                (&row.side, &tossed.side),
            ] {
                let error = (a.p * (1.0 - a.p) / 200_000.0).sqrt();
                assert!(
                    (a.p - b.p).abs() < 4.0 * error + a.half_width(),
                    "{a:?} {b:?}"
                );
            }
        }
    }
}

#[test]
fn closed_forms_are_exact_and_few_random_numbers_are_quasi_random() {
    let clean = "launch.preset = 'clean'\nengine.volumetric = {}\n";
    for row in counted(&plan_of(clean, "tosses = 100_000", ""), 1) {
        assert_eq!((row.interval, row.sampling), ("exact", "closed-form"));
        assert_eq!((row.evaluations, row.half_width()), (0, 0.0));
    }
    // let go below the distance of its rim: nothing is known but by tossing
    let low = "launch = { preset = 'robot', height_m = 0.005 }\nengine.flat = {}\n";
    let random = plan_of(low, "tosses = 100_000", "sampling.method = 'random'");
    let tossed = counted(&plan_of(low, "tosses = 100_000", ""), 2);
    for (row, random) in tossed.iter().zip(counted(&random, 2)) {
        assert_eq!((row.sampling, row.evaluations), ("quasi-random", 1 << 16));
        // both ends of two intervals of 95 %, each doubled: one in 1e4 a row
        let apart = (row.side.p - random.side.p).abs();
        assert!(
            apart < 2.0 * (row.half_width() + random.half_width()),
            "{row:?}"
        );
        assert!(row.half_width() < random.half_width(), "{row:?}");
    }
}

/// A single random number that leads round thousands of times is not integrated as if it were
/// known. Both ends of two intervals of 95 %, each doubled: one in 1e4 a row.
#[test]
fn one_random_number_of_many_turns_is_not_exact() {
    for launch in [
        "height_m = 1.0, spin = { about = { axis = [0, 1, 0], rate_rad_s = { uniform = { from = -1e5, \
         to = 1e5 } } } }",
        "height_m = { uniform = { from = 1.0, to = 2.0 } }, \
         spin = { about = { axis = [0, 1, 0], rate_rad_s = 1e5 } }",
    ] {
        let engine = format!(
            "launch = {{ orientation = {{ tilt_deg = 0 }}, {launch} }}\nengine.volumetric = {{}}\n"
        );
        let random = plan_of(&engine, "tosses = 50_000", "sampling.method = 'random'");
        let random = counted(&random, 2);
        for (row, random) in counted(&plan_of(&engine, "tosses = 50_000", ""), 2)
            .iter()
            .zip(random)
        {
            assert_eq!((row.interval, row.evaluations), ("student-t", 1 << 15));
            let apart = (row.side.p - random.side.p).abs();
            assert!(
                apart < 2.0 * (row.half_width() + random.half_width()),
                "{row:?}"
            );
        }
    }
}

/// A toss that its limit of time ends shows no face: it is counted, not called exact.
#[test]
fn tosses_that_reach_the_time_limit_are_counted() {
    let flat = "launch = { height_m = 0.0113, orientation = { tilt_deg = 0 }, \
                spin = { about = { axis = [0, 1, 0], rate_rad_s = 0 } } }\n";
    for (limit, undecided) in [("1.0", 100), ("1e3", 0)] {
        let engine = format!("{flat}engine.volumetric.time_limit = {limit}\n");
        let row = &counted(&plan_of(&engine, "tosses = 100", ""), 1)[0];
        assert_eq!(row.tally.time_limit, undecided, "{row:?}");
        assert_eq!(row.interval == "exact", undecided == 0, "{row:?}");
    }
}

/// Records the number of planned tosses.
#[derive(Default)]
struct Planned(Mutex<Vec<u64>>);

impl ProgressSink for Planned {
    fn progress(&self, progress: &Progress) {
        self.0.lock().unwrap().push(progress.tosses_planned);
    }

    fn warning(&self, message: &str) {
        panic!("{message}");
    }
}

/// Integrated points do not reduce the tosses planned for the others.
#[test]
fn the_tosses_planned_are_those_of_tossed_points() {
    let text = "coin.ratio = [0.5, 1.0, 2.0]\nsurface.landing = 'adhesive'\n\
                launch = { preset = 'table1', height_m = [5.0, 0.001] }\nengine.volumetric = {}\n\
                stop.tosses = 40_000";
    let plan = coinmc::config::parse("test", text, &[]).unwrap();
    let planned = Planned::default();
    let options = Count {
        threads: NonZeroUsize::new(2),
        cancel: &AtomicBool::new(false),
        sink: &planned,
    };
    count(&plan, &options).unwrap();
    let heard = planned.0.into_inner().unwrap();
    assert!(
        heard.len() > 3 && heard.iter().all(|&n| n == 120_000),
        "{heard:?}"
    );
}

/// A step in many dimensions is tossed at random as ever.
#[test]
fn points_that_quadrature_does_not_improve_are_tossed() {
    let low = "launch = { preset = 'table1', height_m = 0.005 }\nengine.volumetric = {}\n";
    let rows = counted(&plan_of(low, "tosses = 1000", ""), 1);
    assert!(
        rows.iter()
            .all(|row| row.sampling == "random" && row.tally.tosses() == 1000)
    );
}

#[test]
fn a_half_width_is_reached_or_reported_as_missed() {
    let stop = |width| format!("half_width = {width}, max_tosses = 10_000");
    let dir = tempfile::tempdir().unwrap();
    let wide = run_whole(&plan_of(ENGINES, &stop(1e-2), ""), &dir.path().join("wide"));
    assert_eq!(wide.status, Status::Complete);
    let narrow = run_whole(
        &plan_of(ENGINES, &stop(1e-7), ""),
        &dir.path().join("narrow"),
    );
    assert_eq!(narrow.status, Status::ShortOfTarget { points: 3 });
    for (wide, narrow) in wide.results.rows.iter().zip(&narrow.results.rows) {
        assert!(wide.half_width() <= 1e-2 && narrow.half_width() > 1e-7);
        assert!(wide.evaluations <= narrow.evaluations);
        let by = [wide.stopped_by, narrow.stopped_by];
        assert_eq!(by, [StoppedBy::Targets, StoppedBy::Evaluations]);
    }
}

/// An integral shows no face, however often: its half width alone decides.
#[test]
fn integrals_are_not_asked_how_often_a_face_was_seen() {
    let plan = plan_of(ENGINES, "half_width = 1e-2, events = 1_000_000", "");
    let dir = tempfile::tempdir().expect("a directory");
    let report = run_whole(&plan, dir.path());
    assert_eq!(report.status, Status::Complete);
    for row in &report.results.rows {
        let seen = row.side.p * row.evaluations as f64;
        assert!(row.evaluations > 0 && seen < 1e6, "{row:?}");
        assert_eq!(row.stopped_by, StoppedBy::Targets, "{row:?}");
    }
}

/// Whoever asks for few evaluations gets no more than the plan allows, and no fewer than an interval needs.
#[test]
fn a_point_alone_has_as_many_evaluations_as_were_asked_for() {
    let plan = plan_of(ENGINES, "half_width = 1e-7, max_tosses = 10_000", "");
    let evaluations = |most| {
        let integral = integrate_point(&plan, 0, most).expect("a point of the plan");
        integral.expect("a point that is integrated").evaluations
    };
    // looks are at powers of two, from 1024 on
    let most = [0, 1024, 4095, 4096, u64::MAX];
    assert_eq!(most.map(evaluations), [1024, 1024, 2048, 4096, 8192]);
}

/// Paired points share their scrambles as they share their tosses, others share neither.
#[test]
fn paired_points_share_their_scrambles() {
    let same = |paired: &str| {
        let text = format!(
            "seed = 3\n{paired}coin.ratio = 1.0\ncoin.radius_m = [0.01, 0.0100000000001]\n\
             surface.landing = 'adhesive'\n{ENGINES}stop.tosses = 1000\n"
        );
        let plan = coinmc::config::parse("test", &text, &[]).unwrap();
        let rows = counted(&plan, 1);
        (rows[0].side.p - rows[1].side.p).abs() < 1e-9
    };
    assert!(same("paired = true\n") && !same(""));
}

#[test]
fn the_fair_ratio_is_found_through_integrals() {
    let text = "coin.ratio = { from = 0.9, to = 1.4, steps = 21 }\nsurface.landing = 'adhesive'\n\
                launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1e5";
    let plan = coinmc::config::parse("test", text, &[]).unwrap();
    let report = run_whole(&plan, tempfile::tempdir().unwrap().path());
    let [fair] = &fair_ratios(&report.results, 1.0 / 3.0)[..] else {
        panic!("one crossing")
    };
    let arc = 2.0 / 3.0_f64.sqrt();
    assert!((fair.ratio - arc).abs() < 1e-5, "{fair:?}");
    assert!(fair.lo.unwrap() < arc && arc < fair.hi.unwrap(), "{fair:?}");
}

#[test]
fn integration_is_explained() {
    let explained = |engine: &str, more: &str| {
        let plan = plan_of(engine, "tosses = 10", more);
        let [all] = &plan.explain()[..] else { panic!() };
        (all.computed.clone(), all.skipped.join("; "))
    };
    let hand = explained(ENGINES, "");
    assert!(
        hand.0
            .starts_with("quadrature: the rate of spin in closed form"),
        "{}",
        hand.0
    );
    assert!(hand.0.contains("other 3 random numbers"), "{}", hand.0);
    assert!(
        hand.1
            .contains("sampling.method = \"random\" tosses all the same"),
        "{}",
        hand.1
    );
    let drop = explained("launch.preset = 'drop'\nengine.volumetric = {}\n", "");
    assert!(
        drop.0
            .starts_with("closed form zone, exact: P(side) = x/sqrt(x² + 4)"),
        "{}",
        drop.0
    );
    let flat = explained("launch.preset = 'clean-flat'\nengine.flat = {}\n", "");
    assert!(flat.0.starts_with("closed form arc, exact"), "{}", flat.0);
    let random = explained(ENGINES, "sampling.method = 'random'");
    assert!(random.0.contains("to the first contact"), "{}", random.0);
    assert!(!random.1.contains("random tosses"), "{}", random.1);
    let low = explained(
        "launch = { preset = 'robot', height_m = 0.005 }\nengine.flat = {}\n",
        "",
    );
    assert!(
        low.0.contains("the 2 random numbers of their launches"),
        "{}",
        low.0
    );
    // a coin that is let go so low may touch before the height at which its face is known
    let search = "the search for the first contact";
    assert!(hand.1.contains(search) && !low.1.contains(search));
}

/// The method is part of what a plan is.
#[test]
fn the_method_is_part_of_the_plan_hash() {
    let hash = |more| plan_of(ENGINES, "tosses = 10", more).hash();
    assert_eq!(hash(""), hash("sampling.method = 'auto'"));
    assert_ne!(hash(""), hash("sampling.method = 'random'"));
}
