//! A search finds the same tosses as replaying all of them.

use crate::plans::{flat, space};
use coinmc::plan::Plan;
use coinmc_core::Face;
use coinmc_trace::{Condition, EndKind, Found, Length, Query, outcome, replay, search};

fn query(conditions: &[Condition], longest: Option<Length>, count: usize) -> Query<'_> {
    Query {
        points: &[0, 1],
        conditions,
        longest,
        count,
        limit: 1_000_000,
    }
}

/// All tosses of both points, in order.
fn every(plan: &Plan, tosses: u64) -> Vec<(usize, u64)> {
    (0..2)
        .flat_map(|point| (0..tosses).map(move |toss| (point, toss)))
        .filter(|_| !plan.points.is_empty())
        .collect()
}

fn keys(found: &[Found]) -> Vec<(usize, u64)> {
    found.iter().map(|f| (f.point, f.toss)).collect()
}

#[test]
fn the_first_that_show_a_face() {
    let plan = flat("moreau", 200);
    let all = every(&plan, 200);
    let sides: Vec<_> = all
        .iter()
        .filter(|(p, t)| outcome(&plan, *p, *t).unwrap().face() == Some(Face::Side))
        .copied()
        .collect();
    assert!(sides.len() > 5);
    let side = [Condition::Face(Face::Side)];
    let findings = search(&plan, &query(&side, None, 3), |_| true).unwrap();
    assert_eq!(keys(&findings.found), sides[..3]);
    assert!(!findings.is_cut);
    // it stops at the third
    let third = all.iter().position(|key| *key == sides[2]).unwrap() as u64;
    assert_eq!(findings.searched, third + 1);
    // asked for more than exist, it finds all
    let findings = search(&plan, &query(&side, None, 1000), |_| true).unwrap();
    assert_eq!(keys(&findings.found), sides);
    assert_eq!((findings.searched, findings.is_cut), (400, false));
}

#[test]
fn all_conditions_must_hold() {
    let plan = flat("moreau", 50);
    let both = [
        Condition::Face(Face::Side),
        Condition::Ended(EndKind::TimeLimit),
    ];
    assert!(
        search(&plan, &query(&both, None, 1), |_| true)
            .unwrap()
            .found
            .is_empty()
    );
    let both = [
        Condition::Face(Face::Heads),
        Condition::Ended(EndKind::Decided),
    ];
    let found = search(&plan, &query(&both, None, 50), |_| true)
        .unwrap()
        .found;
    assert!(!found.is_empty());
    assert!(found.iter().all(|f| f.outcome.face() == Some(Face::Heads)));
}

/// A toss, its duration and its impacts.
type Measured = ((usize, u64), f64, f64);

#[test]
fn the_longest_by_time_and_by_impacts() {
    let plan = space("moreau", 40);
    let all = every(&plan, 40);
    let measured: Vec<Measured> = all
        .iter()
        .map(|&(point, toss)| {
            let trace = replay(&plan, point, toss, 0.0).unwrap();
            (
                (point, toss),
                trace.duration_s(),
                f64::from(trace.outcome.impacts),
            )
        })
        .collect();
    let by = |key: fn(&Measured) -> f64| {
        let mut sorted = measured.clone();
        // stable: the first of equals stays first
        sorted.sort_by(|a, b| key(b).total_cmp(&key(a)));
        sorted[..5].iter().map(|m| m.0).collect::<Vec<_>>()
    };
    let find = |length| {
        let findings = search(&plan, &query(&[], Some(length), 5), |_| true).unwrap();
        assert_eq!(findings.searched, 80);
        keys(&findings.found)
    };
    assert_eq!(find(Length::Time), by(|m| m.1));
    assert_eq!(find(Length::Impacts), by(|m| m.2));
}

#[test]
fn limits_and_interruptions_are_reported() {
    let plan = flat("moreau", 200);
    let none = [Condition::Ended(EndKind::Failed)];
    let limited = Query {
        limit: 250,
        ..query(&none, None, 1)
    };
    let findings = search(&plan, &limited, |_| true).unwrap();
    assert_eq!((findings.searched, findings.is_cut), (250, true));
    let findings = search(&plan, &limited, |searched| searched < 100).unwrap();
    assert_eq!((findings.searched, findings.is_cut), (100, true));
    let findings = search(&plan, &query(&none, None, 1), |_| true).unwrap();
    assert_eq!((findings.searched, findings.is_cut), (400, false));
}
