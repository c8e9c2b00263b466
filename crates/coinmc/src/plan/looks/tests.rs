//! Looks at points of which the probabilities are known.

use super::*;

const NONE: Targets = Targets {
    half_width: None,
    relative_error: None,
    events: None,
    face: None,
    max_tosses: 100_000_000,
    total_tosses: None,
    max_core_seconds: None,
    total_core_seconds: None,
};

/// What tosses with these probabilities of heads and side show on average.
fn mean(tosses: u64, heads: f64, side: f64) -> Tally {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let of = |p: f64| libm::round(p * tosses as f64) as u64;
    let (heads, side) = (of(heads), of(side));
    let tails = tosses - heads - side;
    Tally {
        heads,
        tails,
        side,
        ..Tally::default()
    }
}

/// The looks until the verdict, if every look shows the mean.
fn follow(targets: Targets, heads: f64, side: f64) -> (Looks, Verdict) {
    let mut looks = Looks::new(targets, 0.95);
    loop {
        let shown = if looks.is_pilot() {
            looks.pilot()
        } else {
            looks.counted()
        };
        match looks.look(&mean(shown, heads, side)) {
            Verdict::More => {}
            verdict => return (looks, verdict),
        }
    }
}

/// z² p (1 − p)/h² tosses have the half width h.
fn fixed(p: f64, half_width: f64) -> f64 {
    1.959_964_f64.powi(2) * p * (1.0 - p) / (half_width * half_width)
}

#[test]
fn hardly_more_tosses_than_by_a_design_that_knew_the_probability() {
    for (half_width, most) in [
        (2e-4, 1.04),
        (1e-3, 1.08),
        (5e-3, 1.22),
        (0.01, 1.32),
        (0.02, 1.55),
    ] {
        for (heads, side) in [(0.3, 0.4), (0.45, 0.1), (0.1, 0.8), (0.5, 0.0)] {
            let targets = Targets {
                half_width: Some(half_width),
                ..NONE
            };
            let (looks, verdict) = follow(targets, heads, side);
            let worst = [heads, side, 1.0 - heads - side]
                .map(|p| fixed(p, half_width))
                .into_iter()
                .fold(0.0, f64::max);
            let ratio = looks.stage().end as f64 / worst;
            assert_eq!(
                (verdict, looks.looked),
                (Verdict::Met, 0),
                "{half_width} {heads} {looks:?}"
            );
            assert!(ratio > 1.0 && ratio < most, "{half_width} {heads}: {ratio}");
            // where no face comes up in most tosses, a short pilot is as good as a long one
            let is_usual = heads.max(side) <= 0.5;
            assert!(!is_usual || ratio < 1.16, "{half_width} {heads}: {ratio}");
        }
    }
}

#[test]
fn a_rare_face_needs_a_longer_pilot() {
    let targets = Targets {
        relative_error: Some(0.1),
        ..NONE
    };
    for side in [0.01, 1e-3, 1e-4] {
        let (looks, verdict) = follow(targets, 0.5 * (1.0 - side), side);
        let fixed = 1.959_964_f64.powi(2) * (1.0 - side) / (side * 0.01);
        let ratio = looks.stage().end as f64 / fixed;
        assert_eq!(verdict, Verdict::Met);
        assert!(ratio < 2.1, "{side}: {ratio}");
        assert!(looks.pilot() as f64 > 0.1 * fixed);
    }
}

#[test]
fn what_cannot_be_reached_ends_at_the_limit_with_a_short_pilot() {
    let targets = Targets {
        relative_error: Some(0.1),
        max_tosses: 1_000_003,
        ..NONE
    };
    let (looks, verdict) = follow(targets, 0.5, 0.0);
    assert_eq!(verdict, Verdict::Short);
    assert_eq!(looks.stage().end, 1_000_003);
    assert!(looks.pilot() <= 1_000_003 / 8);
    // one look only, which has all of α
    assert_eq!((looks.looked, looks.confidence()), (0, 0.95));
}

#[test]
fn few_tosses_have_no_pilot() {
    let targets = Targets {
        half_width: Some(1e-3),
        max_tosses: 4095,
        ..NONE
    };
    let looks = Looks::new(targets, 0.9);
    assert_eq!((looks.stage(), looks.is_pilot()), (0..4095, false));
    assert!((looks.confidence() - 0.9).abs() < 1e-15);
}

/// 2 % without a face are more than ± .01, and not more than ± .03.
#[test]
fn too_many_undecided_tosses_end_a_point_early() {
    let verdict = |half_width, tosses_undecided: u64| {
        let targets = Targets {
            half_width: Some(half_width),
            ..NONE
        };
        let mut looks = Looks::new(targets, 0.95);
        loop {
            let shown = if looks.is_pilot() {
                looks.pilot()
            } else {
                looks.counted()
            };
            let undecided = shown * tosses_undecided / 1000;
            let tally = Tally {
                impact_limit: undecided,
                ..mean(shown - undecided, 0.3, 0.4)
            };
            match looks.look(&tally) {
                Verdict::More => {}
                verdict => return (verdict, looks),
            }
        }
    };
    let (given_up, looks) = verdict(0.01, 20);
    assert_eq!(given_up, Verdict::Short);
    // all of α, and no more tosses than without undecided ones
    assert!(looks.is_hopeless() && looks.stage().end < 15_000 && looks.confidence() == 0.95);
    let (met, looks) = verdict(0.03, 20);
    assert_eq!((met, looks.is_hopeless()), (Verdict::Met, false));
    assert_eq!(verdict(0.01, 0).0, Verdict::Met);
}

#[test]
fn targets_of_the_side_need_fewer_tosses_where_it_is_rare() {
    let of = |face| Targets {
        half_width: Some(0.002),
        face,
        ..NONE
    };
    let (all, _) = follow(of(None), 0.48, 0.04);
    let (side, verdict) = follow(of(Some(Face::Side)), 0.48, 0.04);
    assert_eq!(verdict, Verdict::Met);
    assert!(side.stage().end * 4 < all.stage().end);
}

#[test]
fn all_looks_together_have_the_confidence() {
    let targets = Targets {
        half_width: Some(1e-9),
        max_tosses: 1 << 40,
        ..NONE
    };
    let mut looks = Looks::new(targets, 0.95);
    looks.pilot = Some(1024);
    looks.stage = 1024..2048;
    let mut sum = 1.0 - looks.confidence();
    while looks.look(&mean(looks.counted(), 0.3, 0.4)) == Verdict::More {
        sum += 1.0 - looks.confidence();
    }
    assert!(looks.looked > 15);
    assert!((sum - 0.05).abs() < 1e-12, "{sum}");
}

/// Wilson's interval covers less than it states at some probabilities, and is shorter.
#[test]
fn targets_are_met_by_clopper_and_pearsons_interval() {
    let arm = |method| {
        let estimate = Estimate::new(900, 0, 3000, 0.95, method);
        estimate.half_width()
    };
    let (wilson, exact) = (
        arm(IntervalMethod::Wilson),
        arm(IntervalMethod::ClopperPearson),
    );
    assert!(wilson < exact);
    for (half_width, verdict) in [
        (0.5 * (wilson + exact), Verdict::Short),
        (exact, Verdict::Met),
    ] {
        let targets = Targets {
            half_width: Some(half_width),
            face: Some(Face::Side),
            max_tosses: 3000,
            ..NONE
        };
        let mut looks = Looks::new(targets, 0.95);
        assert_eq!(looks.look(&mean(3000, 0.3, 0.3)), verdict, "{half_width}");
    }
}

/// An excess that falls like 1/n, as of intervals, or like 1/n², as of a face that is never seen.
#[test]
fn the_number_of_tosses_without_excess_is_found() {
    for needed in [50.0, 3e4, 2e9] {
        for power in [1, 2] {
            let found = Looks::solve(0.5, |n| (needed / n).powi(power));
            // 24 halvings of the logarithm of what is missing, ln(2e9/32)
            assert!(
                (found / needed - 1.0).abs() < 2e-6,
                "{needed} {power}: {found}"
            );
        }
    }
    assert!(Looks::solve(0.5, |_| 1.1).is_infinite());
    // as many as a point may make, and no more
    let beyond = 1.01 * MOST;
    for power in [1, 2] {
        let found = Looks::solve(0.5, |n| (MOST / n).powi(power));
        assert!((found / MOST - 1.0).abs() < 2e-6, "{power}: {found}");
    }
    assert!(Looks::solve(0.5, |n| beyond / n).is_infinite());
}

/// A face that was never seen may have any probability, so nothing says that it takes many tosses.
#[test]
fn the_search_begins_at_the_fewest_tosses_where_a_face_was_never_seen() {
    for power in [1, 2] {
        let found = Looks::solve(0.0, |n| (50.0 / n).powi(power));
        // 24 halvings of ln(50/32) leave 2.7e-8; of ln(MOST/50), as from the most tosses, 2e-6
        assert!((found / 50.0 - 1.0).abs() < 1e-7, "{power}: {found}");
    }
}

/// Even if fewer would do: the excess that led there is not of the kind that the search is for.
#[test]
fn a_search_that_goes_beyond_what_a_point_may_make_finds_no_number() {
    let excess = |n: f64| if n < 1e10 { 1e30 } else { 0.5 };
    assert!(Looks::solve(0.5, excess).is_infinite());
}

/// Both ends of Wilson's interval are a toss farther out.
#[test]
fn the_excess_of_a_number_of_tosses_is_that_of_wilsons_interval_and_a_toss() {
    let targets = Targets {
        half_width: Some(0.01),
        ..NONE
    };
    let looks = Looks::new(targets, 0.95);
    for (p, undecided, n) in [(0.3, 0.0, 4000_u64), (0.3, 0.01, 4000), (0.0, 0.0, 500)] {
        let of = |p: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let count = libm::round(p * n as f64) as u64;
            count
        };
        let wilson = Estimate::new(of(p), of(undecided), n, 0.9, IntervalMethod::Wilson);
        let arm = wilson.half_width() + 1.0 / n as f64;
        let excess = looks.excess_at(p, undecided, n as f64, 0.9);
        let expected = (arm / 0.01).powi(2);
        assert!(
            (excess / expected - 1.0).abs() < 1e-12,
            "{excess} {expected}"
        );
    }
    // no more tosses are without a face than are left
    let all = looks.excess_at(0.9, 0.5, 1000.0, 0.9);
    let rest = looks.excess_at(0.9, 0.1, 1000.0, 0.9);
    assert!((all / rest - 1.0).abs() < 1e-12);
}

/// The worst probability within the errors counts: never more than that of 1/2, and on either side of what was
/// seen.
#[test]
fn a_margin_takes_the_worst_probability_within_it() {
    let (half_width, n) = (1e-3, 10_000_u32);
    let targets = Targets {
        half_width: Some(half_width),
        face: Some(Face::Side),
        ..NONE
    };
    let looks = Looks::new(targets, 0.95);
    let needed = |side, errors| {
        let of = |tosses: u64| {
            let tally = mean(tosses, 0.5 * (1.0 - side), side);
            looks.needed((&tally, f64::from(n)), 0.0, errors, 0.95)
        };
        // the same shares of more tosses, with the error of as many
        assert!((of(100 * u64::from(n)) / of(u64::from(n)) - 1.0).abs() < 1e-9);
        of(u64::from(n))
    };
    for (side, errors) in [
        (0.1, 0.0),
        (0.1, 2.0),
        (0.9, 2.0),
        (0.3, 4.0),
        (0.497, 2.0),
        (0.503, 2.0),
    ] {
        let error = errors * f64::sqrt(side * (1.0 - side) / f64::from(n));
        let worst = 0.5_f64.clamp(side - error, side + error);
        let count = fixed(worst, half_width);
        // Wilson's interval has its middle z² (1/2 - p)/n nearer to 1/2, and the toss on either side adds 1/n; both
        // to the arm h, of which n goes as the square.
        let shift = 1.959_964_f64.powi(2) * (0.5 - worst).abs() + 1.0;
        let expected = 1.003 * count * (1.0 + 2.0 * shift / (count * half_width));
        let ratio = needed(side, errors) / expected;
        assert!((ratio - 1.0).abs() < 3e-4, "{side} {errors}: {ratio}");
    }
}

/// 4 standard errors: the intervals of a half width h never get that short with a greater share than h without a
/// face.
#[test]
fn a_point_is_given_up_only_if_too_many_undecided_tosses_are_no_chance() {
    let of_half_width = |half_width| Targets {
        half_width: Some(half_width),
        ..NONE
    };
    let lets_hope = |half_width, n: u32, share: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let impact_limit = (share * f64::from(n)) as u64;
        let tally = Tally {
            impact_limit,
            ..mean(u64::from(n) - impact_limit, 0.3, 0.4)
        };
        Looks::new(of_half_width(half_width), 0.95).lets_hope(&tally, 0.95)
    };
    for (half_width, n) in [(0.01, 1 << 16), (0.3, 1 << 10)] {
        // u - 4 √(u (1 - u)/n) = h
        let error = |u: f64| SURE * (u * (1.0 - u) / f64::from(n)).sqrt();
        let border = (0..60).fold(half_width, |u, _| half_width + error(u));
        assert!(lets_hope(half_width, n, 0.0) && lets_hope(half_width, n, 0.97 * border));
        assert!(!lets_hope(half_width, n, 1.03 * border));
    }
    let targets = of_half_width(0.01);
    let looks = Looks::new(targets, 0.95);
    // few of few tosses say nothing
    let few = Tally {
        impact_limit: 1,
        ..mean(63, 0.3, 0.4)
    };
    assert!(looks.lets_hope(&few, 0.95));
    // what no number of tosses reaches is not the fault of undecided ones
    let relative = Targets {
        half_width: None,
        relative_error: Some(0.1),
        ..targets
    };
    let never_seen = Tally {
        impact_limit: 3000,
        ..mean(7000, 0.5, 0.0)
    };
    assert!(Looks::new(relative, 0.95).lets_hope(&never_seen, 0.95));
}

#[test]
fn a_forecast_is_what_is_tossed_in_the_end() {
    for (half_width, heads, side) in [(1e-3, 0.3, 0.4), (0.01, 0.45, 0.1), (5e-4, 0.1, 0.8)] {
        let targets = Targets {
            half_width: Some(half_width),
            ..NONE
        };
        let (looks, _) = follow(targets, heads, side);
        let forecast = Looks::new(targets, 0.95).forecast(&mean(4096, heads, side));
        let ratio = forecast as f64 / looks.stage().end as f64;
        assert!((0.94..1.06).contains(&ratio), "{half_width}: {ratio}");
        // with the very pilot that the looks have, and the margin of its error
        let (tally, fresh) = (mean(4096, heads, side), Looks::new(targets, 0.95));
        let needed = fresh.needed((&tally, 1.0), 0.0, 0.0, fresh.first_confidence());
        let seen = (&tally, looks.pilot() as f64);
        let at_most = fresh.needed_at_most(seen, fresh.hoped_undecided(&tally), needed);
        assert_eq!(forecast, ceil(at_most) + looks.pilot());
    }
    // at the limit there is none
    let short = Targets {
        half_width: Some(1e-3),
        max_tosses: 4000,
        ..NONE
    };
    assert_eq!(Looks::new(short, 0.95).forecast(&mean(64, 0.3, 0.4)), 4000);
    let few = Targets {
        half_width: Some(0.1),
        ..short
    };
    let tosses = Looks::new(few, 0.95).forecast(&mean(64, 0.3, 0.4)) as f64;
    assert!(
        (1.0..1.35).contains(&(tosses / fixed(0.4, 0.1))),
        "{tosses}"
    );
}

/// Of a rare face the pilot knows little, and the first look is late: by far more than 2 % above what is needed.
/// However many tosses tell its probability now, the forecast is what the looks make of it.
#[test]
fn a_forecast_knows_what_the_pilot_will_not() {
    let of_side = Targets {
        face: Some(Face::Side),
        ..NONE
    };
    for (targets, side) in [
        (
            Targets {
                events: Some(100),
                ..NONE
            },
            0.01,
        ),
        (
            Targets {
                relative_error: Some(0.1),
                ..of_side
            },
            0.02,
        ),
        (
            Targets {
                half_width: Some(0.005),
                ..of_side
            },
            0.02,
        ),
    ] {
        let heads = 0.5 * (1.0 - side);
        let (looks, _) = follow(targets, heads, side);
        for seen in [1 << 12, 1 << 20] {
            let forecast = Looks::new(targets, 0.95).forecast(&mean(seen, heads, side));
            let ratio = forecast as f64 / looks.stage().end as f64;
            // a pilot of whole counts
            assert!((0.8..1.25).contains(&ratio), "{targets:?} {seen}: {ratio}");
        }
    }
}

/// In the first stage after a pilot of 1024 tosses.
fn after_a_pilot() -> Looks {
    let targets = Targets {
        half_width: Some(1e-9),
        ..NONE
    };
    let mut looks = Looks::new(targets, 0.95);
    looks.pilot = Some(1024);
    looks.stage = 1024..2048;
    looks
}

#[test]
fn a_stage_that_is_cut_short_is_the_last_with_all_that_is_left_of_the_confidence() {
    let mut looks = after_a_pilot();
    let first = looks.confidence();
    assert!((first - (1.0 - 0.97 * 0.05)).abs() < 1e-12);
    assert_eq!(looks.look(&mean(1024, 0.3, 0.4)), Verdict::More);
    // two times as many counted tosses follow
    assert_eq!((looks.stage(), looks.counted()), (2048..4096, 3072));
    assert!((looks.wanted() - 2048.0).abs() < 1e-9);
    let mut cut = looks.clone();
    cut.end_after(100);
    assert_eq!(cut.stage(), 2048..2148);
    assert!((cut.confidence() - (1.0 - 0.03 * 0.05)).abs() < 1e-12);
    assert_eq!(cut.look(&mean(1124, 0.3, 0.4)), Verdict::Short);
    // more than it has changes nothing but that it is the last
    let mut whole = looks.clone();
    whole.end_after(1 << 40);
    assert_eq!(whole.stage(), 2048..4096);
    // nothing more: the look before was final, and had more of α than it took
    looks.end_after(0);
    assert!((looks.confidence() - 0.95).abs() < 1e-12);
    assert_eq!(looks.stage(), 2048..2048);
}

/// No look was before, so that there is none to be final: all of α is left.
#[test]
fn a_first_stage_without_tosses_has_all_of_the_confidence() {
    let mut looks = after_a_pilot();
    looks.end_after(0);
    assert_eq!((looks.stage(), looks.counted()), (1024..1024, 0));
    assert!((looks.confidence() - 0.95).abs() < 1e-12);
}

/// All points of a run share its limit, so a pilot must not take more than its part of that.
#[test]
fn a_pilot_is_at_most_an_eighth_and_a_bit_of_what_may_be_tossed() {
    let never_met = Targets {
        relative_error: Some(0.01),
        ..NONE
    };
    let pilot = |within: u64, later: Option<u64>| {
        let mut looks = Looks::within(never_met, 0.95, within);
        if let Some(tosses) = later {
            looks.limit_pilot(tosses);
        }
        while looks.is_pilot() {
            looks.look(&mean(looks.pilot(), 0.5, 0.0));
        }
        (looks.pilot(), looks.stage().end)
    };
    // 32 of such pilots, then there is no more hope that it sees the side
    assert_eq!(pilot(1 << 20, None), (1 << 15, NONE.max_tosses));
    assert_eq!(pilot(1 << 20, Some(1 << 14)), (1 << 9, NONE.max_tosses));
    assert_eq!(pilot(1 << 20, Some(1 << 30)), (1 << 15, NONE.max_tosses));
    // where a pilot does not pay, the limit is one of all tosses
    assert_eq!(pilot(4095, None), (0, 4095));
    assert_eq!(pilot(4096, None).1, NONE.max_tosses);
}

/// A pilot doubles for the last time at an eighth of what may be tossed, however much a longer one would save.
#[test]
fn a_pilot_of_a_rare_face_leaves_most_tosses_to_be_counted() {
    let targets = Targets {
        relative_error: Some(0.3),
        ..NONE
    };
    let limited = Targets {
        max_tosses: 1 << 16,
        ..targets
    };
    let pilot = |targets| follow(targets, 0.4995, 1e-3).0.pilot();
    assert!(pilot(targets) > limited.max_tosses / 4);
    assert_eq!(pilot(limited), limited.max_tosses / 4);
}

/// With the least limit that has one, too.
#[test]
fn a_forecast_has_the_pilot_that_the_looks_have() {
    for max_tosses in [4095, 4096] {
        let targets = Targets {
            half_width: Some(0.1),
            max_tosses,
            ..NONE
        };
        let looks = Looks::new(targets, 0.95);
        let alone = if looks.is_pilot() { looks.pilot() } else { 0 };
        let forecast = looks.forecast(&mean(64, 0.3, 0.4));
        let counted = (forecast - alone) as f64;
        // as above
        assert!(
            (1.0..1.35).contains(&(counted / fixed(0.4, 0.1))),
            "{max_tosses}: {forecast}"
        );
    }
}
