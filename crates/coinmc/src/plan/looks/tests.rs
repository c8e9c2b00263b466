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
