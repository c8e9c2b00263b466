//! Fair ratios of curves whose crossings are known.

use coinmc::plan::StoppedBy;
use coinmc::results::{FairRatio, Results, Row, fair_ratios, fair_values};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally, unit_interval};

const THIRD: f64 = 1.0 / 3.0;

fn row(parameters: &[(&str, f64)], side: Estimate) -> Row {
    Row {
        point: 0,
        parameters: parameters
            .iter()
            .map(|(name, x)| ((*name).into(), *x))
            .collect(),
        engine: "flat",
        law: "moreau",
        gyroscopic_torque: true,
        tally: Tally::default(),
        sampling: "random",
        evaluations: 0,
        heads: side,
        tails: side,
        side,
        same: None,
        left: None,
        interval: "wilson",
        stopped_by: StoppedBy::Tosses,
        pilot_tosses: 0,
        published: None,
    }
}

fn results(axes: &[&str], paired: bool, rows: Vec<Row>) -> Results {
    Results {
        plan_hash: String::new(),
        program_version: String::new(),
        config: String::new(),
        axes: axes.iter().map(|&axis| axis.to_owned()).collect(),
        paired,
        rows: rows.into(),
    }
}

fn with_arm(p: f64, arm: f64) -> Estimate {
    let method = IntervalMethod::Wilson;
    Estimate {
        p,
        lo: p - arm,
        hi: p + arm,
        n: 1,
        confidence: 0.95,
        method,
    }
}

/// Ratios from 0.5 to 2.5 in steps of `step`.
fn grid(step: f64) -> impl Iterator<Item = f64> {
    (0_u32..)
        .map(move |i| 0.5 + step * f64::from(i))
        .take_while(|&x| x < 2.5 + 1e-9)
}

fn crossings(step: f64, arm: f64, p: impl Fn(f64) -> f64) -> Vec<FairRatio> {
    let rows = grid(step)
        .map(|x| row(&[("ratio", x)], with_arm(p(x), arm)))
        .collect();
    fair_ratios(&results(&["ratio"], false, rows), THIRD)
}

/// Crosses 1/3 at 1.53 with slope 0.29, off the grids used here.
const TRUTH: f64 = 1.53;
fn smooth(x: f64) -> f64 {
    x * x / (x * x + 2.0 * TRUTH * TRUTH)
}

fn holds(fair: &FairRatio, x: f64) -> bool {
    fair.lo.is_none_or(|lo| lo <= x) && fair.hi.is_none_or(|hi| x <= hi)
}

#[test]
fn the_crossing_of_a_smooth_curve_is_accurate() {
    // error of the interpolation: the fourth power of the step
    for (step, tolerance) in [(0.4, 5e-3), (0.2, 3e-4), (0.1, 2e-5)] {
        let found = crossings(step, 0.0, smooth);
        assert_eq!(found.len(), 1);
        assert!(
            (found[0].ratio - TRUTH).abs() < tolerance,
            "{step}: {:?}",
            found[0]
        );
        assert!(holds(&found[0], TRUTH) && found[0].rising);
        let width = found[0].hi.unwrap() - found[0].lo.unwrap();
        // what a straight line would be wrong by, both ways: h²/4 · |p''|/p' <= h²/4 · 0.6
        assert!(width > 0.0 && width < 0.2 * step * step, "{step}: {width}");
    }
}

#[test]
fn half_widths_and_slope_give_the_interval() {
    // straight, with a point at the crossing: the interval is arm/slope to either side
    let straight = |x: f64| THIRD + 0.3 * (x - 1.5);
    let found = crossings(0.1, 0.003, straight);
    assert!((found[0].ratio - 1.5).abs() < 1e-12);
    for end in [found[0].lo, found[0].hi] {
        assert!(
            ((end.unwrap() - 1.5).abs() - 0.01).abs() < 1e-3,
            "{found:?}"
        );
    }
    // between two points errors that are independent partly cancel: 0.003/0.3 · sqrt(2 · (9/16)² + 2 · (1/16)²)
    let found = crossings(0.1, 0.003, |x| straight(x + 0.05));
    let half = (found[0].hi.unwrap() - found[0].lo.unwrap()) / 2.0;
    assert!((half - 0.0080).abs() < 3e-4, "{half}");
}

#[test]
fn curves_that_cross_twice_or_never_or_just_once() {
    let hump = |x: f64| 0.4 - 0.4 * (x - 1.5).powi(2);
    let found = crossings(0.1, 0.001, hump);
    let away = (0.4_f64 - THIRD).sqrt() / 0.4_f64.sqrt();
    assert_eq!(found.len(), 2);
    assert!(found[0].rising && !found[1].rising);
    assert!(holds(&found[0], 1.5 - away) && holds(&found[1], 1.5 + away));
    assert!(found[0].hi.unwrap() < found[1].lo.unwrap());

    assert_eq!(crossings(0.1, 0.5, |_| 0.2), []);
    assert_eq!(crossings(0.1, 0.0, |_| THIRD), []);
    assert_eq!(fair_ratios(&results(&["ratio"], false, vec![]), THIRD), []);
    let one = vec![row(&[("ratio", 1.0)], with_arm(THIRD, 0.1))];
    assert_eq!(fair_ratios(&results(&["ratio"], false, one), THIRD), []);
}

#[test]
fn two_points_give_a_wide_interval_and_it_is_open_beyond_the_sweep() {
    let two = |p: [f64; 2], arm| {
        let rows = [1.0, 2.0].into_iter().zip(p);
        let rows = rows
            .map(|(x, p)| row(&[("ratio", x)], with_arm(p, arm)))
            .collect();
        fair_ratios(&results(&["ratio"], false, rows), THIRD)
    };
    // rising or falling, the curve may cross anywhere between them
    for p in [[0.1, 0.6], [0.6, 0.1], [0.9, 0.001]] {
        let found = two(p, 0.01);
        let ends = [found[0].lo, found[0].hi].map(|end| end.expect("an end within the sweep"));
        assert!(
            (ends[0] - 1.0).abs() < 1e-12 && (ends[1] - 2.0).abs() < 1e-12,
            "{p:?}: {ends:?}"
        );
    }
    let found = two([0.33, 0.6], 0.01);
    assert_eq!(found[0].lo, None);
    assert!(found[0].hi.is_some());
    let found = two([0.6, 0.33], 0.01);
    assert!(!found[0].rising && found[0].hi.is_none());
}

#[test]
fn a_noisy_crossing_is_one_crossing() {
    // 0.02 up and down about a slope of 0.1: several crossings of the points, one of the curve
    let mut up = 1.0;
    let rows = grid(0.1).map(|x| {
        up = -up;
        row(
            &[("ratio", x)],
            with_arm(THIRD + 0.1 * (x - 1.52) + 0.02 * up, 0.03),
        )
    });
    let found = fair_ratios(&results(&["ratio"], false, rows.collect()), THIRD);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].rising && holds(&found[0], 1.52));
}

#[test]
fn every_combination_of_other_axes_has_its_own_crossing() {
    let mut rows = Vec::new();
    for e in [0.3, 0.6] {
        // out of order, and a point without tosses
        for x in grid(0.2).collect::<Vec<_>>().into_iter().rev() {
            let p = smooth(x - 0.1 * (e - 0.3));
            rows.push(row(&[("ratio", x), ("restitution", e)], with_arm(p, 0.001)));
        }
        rows.push(row(
            &[("ratio", 1.45), ("restitution", e)],
            with_arm(f64::NAN, 0.001),
        ));
    }
    let found = fair_ratios(&results(&["restitution", "ratio"], false, rows), THIRD);
    assert_eq!(found.len(), 2);
    for (fair, (e, x)) in found.iter().zip([(0.3, TRUTH), (0.6, TRUTH + 0.03)]) {
        assert_eq!(fair.at, [("restitution".to_owned(), e)]);
        assert!(holds(fair, x), "{fair:?}");
    }
}

struct Random(u64);

impl Random {
    /// splitmix64 (Steele, Lea & Flood 2014), to (0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        unit_interval(z ^ (z >> 31))
    }
}

/// 1000 sweeps of 2000 tosses a point, 95 % intervals. With a true coverage of 95 % fewer than
/// 929 hits have a probability of 0.2 %; more than 998 would say that the intervals are too long
/// to be of use (the band is a little wider than the statistics alone ask for).
#[test]
fn intervals_have_the_stated_coverage() {
    const SWEEPS: u32 = 1000;
    const TOSSES: u32 = 2000;
    for (seed, paired) in [(1, false), (2, true)] {
        let mut random = Random(seed);
        let (mut hits, mut single) = (0, 0);
        for _ in 0..SWEEPS {
            let shared: Vec<f64> = (0..TOSSES).map(|_| random.uniform()).collect();
            let rows = grid(0.1).map(|x| {
                let p = smooth(x);
                let side = if paired {
                    shared.iter().filter(|&&u| u < p).count()
                } else {
                    (0..TOSSES).filter(|_| random.uniform() < p).count()
                } as u64;
                let n = u64::from(TOSSES);
                let side = Estimate::new(side, 0, n, 0.95, IntervalMethod::Wilson);
                row(&[("ratio", x)], side)
            });
            let found = fair_ratios(&results(&["ratio"], paired, rows.collect()), THIRD);
            single += u32::from(found.len() == 1);
            hits += u32::from(found.iter().any(|fair| holds(fair, TRUTH)));
        }
        assert!((929..=998).contains(&hits), "paired {paired}: {hits}");
        assert!(single > SWEEPS * 19 / 20, "paired {paired}: {single}");
    }
}

#[test]
fn any_face_crosses_along_any_parameter() {
    let rows = grid(0.25).map(|x| {
        let axes = [("ratio", 1.0), ("restitution", x)];
        let heads = with_arm(0.5 - 0.1 * x, 0.01);
        Row {
            heads,
            ..row(&axes, with_arm(smooth(x), 0.01))
        }
    });
    let results = results(&["restitution"], false, rows.collect());
    let heads = fair_values(&results, Face::Heads, "restitution", 0.36);
    let [fair] = &heads[..] else {
        panic!("{heads:?}")
    };
    // a straight line is interpolated exactly; half way between points the arms of ± 0.01 are at most
    // as long, so that the band is crossed within 0.1 on either side
    assert!((fair.ratio - 1.4).abs() < 1e-9 && !fair.rising);
    let (lo, hi) = (fair.lo.unwrap(), fair.hi.unwrap());
    assert!(
        (1.3 - 1e-9..1.37).contains(&lo) && (1.43..1.5 + 1e-9).contains(&hi),
        "{lo} {hi}"
    );
    let side = fair_values(&results, Face::Side, "restitution", THIRD);
    assert!((side[0].ratio - TRUTH).abs() < 0.01);
    assert!(fair_ratios(&results, THIRD).is_empty());
    assert!(fair_values(&results, Face::Side, "no such thing", THIRD).is_empty());
}

/// A straight line of slope 0.3 that crosses 1/3 half way between two of its points, 0.1 apart, with arms
/// below and above each point. The polynomial through the four next points has, at the share t between
/// the middle two, the weights 1 + N and −N in all, N = t(1 − t)/2.
fn straight_with_arms(below: f64, above: f64, paired: bool) -> FairRatio {
    let rows = grid(0.1).map(|x| {
        let p = THIRD + 0.3 * (x - 1.55);
        let (lo, hi) = (p - below, p + above);
        let side = with_arm(p, 0.0);
        row(&[("ratio", x)], Estimate { lo, hi, ..side })
    });
    let found = fair_ratios(&results(&["ratio"], paired, rows.collect()), THIRD);
    let [fair] = &found[..] else {
        panic!("{found:?}")
    };
    assert!((fair.ratio - 1.55).abs() < 1e-12);
    fair.clone()
}

/// What points share they are wrong by together: their arms add up, weight by weight.
#[test]
fn arms_of_points_that_share_random_numbers_add_up() {
    let fair = straight_with_arms(0.003, 0.003, true);
    for away in [1.55 - fair.lo.unwrap(), fair.hi.unwrap() - 1.55] {
        let t = 0.5 + away / 0.1;
        let arm = 0.003 * (1.0 + t * (1.0 - t));
        assert!((0.3 * away - arm).abs() < 1e-9, "{away}");
    }
    let alone = straight_with_arms(0.003, 0.003, false);
    assert!(alone.hi.unwrap() < fair.hi.unwrap() && alone.lo.unwrap() > fair.lo.unwrap());
}

/// A point with a negative weight pulls the curve down where it is too high: its arm above is one below.
#[test]
fn a_negative_weight_turns_an_interval_round() {
    let (below, above) = (0.002, 0.01);
    let fair = straight_with_arms(below, above, true);
    // left of the crossing the curve is below the target, which the arm above still reaches
    for (away, own, other) in [
        (1.55 - fair.lo.unwrap(), above, below),
        (fair.hi.unwrap() - 1.55, below, above),
    ] {
        let t = 0.5 + away / 0.1;
        let negative = 0.5 * t * (1.0 - t);
        let arm = (1.0 + negative) * own + negative * other;
        assert!((0.3 * away - arm).abs() < 1e-9, "{away} {arm}");
    }
}

/// A curve that may cross to and fro, or not at all: both outer crossings, and one interval for both.
#[test]
fn an_even_number_of_crossings_in_one_band_is_told_by_its_first_and_last() {
    let hump = |x: f64| THIRD + 0.002 - 0.4 * (x - 1.5).powi(2);
    let found = crossings(0.1, 0.01, hump);
    assert_eq!(found.len(), 2, "{found:?}");
    let away = (0.002_f64 / 0.4).sqrt();
    assert!((found[0].ratio - (1.5 - away)).abs() < 1e-9 && found[0].rising);
    assert!((found[1].ratio - (1.5 + away)).abs() < 1e-9 && !found[1].rising);
    assert_eq!((found[0].lo, found[0].hi), (found[1].lo, found[1].hi));
    // symmetric, and as far as ± 0.01 may lift the hump, or a little less
    let (lo, hi) = (found[0].lo.unwrap(), found[0].hi.unwrap());
    assert!((lo + hi - 3.0).abs() < 1e-9 && (0.12..0.174).contains(&(hi - 1.5)));

    // 0.02 up and down in the middle of a hump
    let mut up = -1.0;
    let noisy = |x: f64| {
        up = -up;
        hump(x)
            + if (x - 1.5).abs() < 0.16 {
                0.02 * up
            } else {
                0.0
            }
    };
    let rows = grid(0.1).map({
        let mut noisy = noisy;
        move |x| row(&[("ratio", x)], with_arm(noisy(x), 0.03))
    });
    let found = fair_ratios(&results(&["ratio"], false, rows.collect()), THIRD);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].rising && !found[1].rising && found[0].ratio < found[1].ratio);
    assert_eq!((found[0].lo, found[0].hi), (found[1].lo, found[1].hi));
}

/// Points whose intervals just hold the target, with nothing between the two of them that does: the errors of two
/// points partly cancel there.
#[test]
fn a_band_may_let_go_of_the_target_between_points_that_hold_it() {
    let arm = 0.01;
    let found = crossings(0.1, arm, |x| {
        THIRD + if x < 1.55 { -0.95 * arm } else { 0.95 * arm }
    });
    let [fair] = &found[..] else {
        panic!("{found:?}")
    };
    assert!((fair.ratio - 1.55).abs() < 1e-9);
    // Right of 1.6 the curve lies above the straight line, and the band below reaches as far below that as the
    // arms do: from two points of arm 1 at the share t between them, and two further ones.
    for away in [fair.ratio - fair.lo.unwrap(), fair.hi.unwrap() - fair.ratio] {
        let t = away / 0.1 - 0.5;
        let weights = [
            -t * (1.0 - t) * (2.0 - t) / 6.0,
            (1.0 - t * t) * (2.0 - t) / 2.0,
            t * (1.0 + t) * (2.0 - t) / 2.0,
            -t * (1.0 - t * t) / 6.0,
        ];
        let reach = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        assert!((reach - 0.95).abs() < 1e-9, "{away}: {reach}");
        // the first of two such places
        assert!(t < 0.5, "{t}");
    }
}
