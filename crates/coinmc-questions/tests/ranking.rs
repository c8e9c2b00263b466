//! Rankings against closed forms.

use coinmc_core::Face;
use coinmc_questions::{
    Interval, QuestionError, Rank, Ranking, Template, Unknown, Workers, document_of_ranking,
    picture_of_ranking, rank,
};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// A coin that does not bounce and lands at a tilt that is uniform from 0 to `to`.
const TILTED: &str = "seed = 3\ncoin.ratio = 1.0\nsampling.method = 'random'\n\
                      surface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
                      launch = { height_m = 0.5, orientation.tilt_deg.uniform = { from = 0, to = 90 }, spin.about = { axis = [0, 1, 0], rate_rad_s = 0 } }\n\
                      engine.flat = {}\nestimate.confidence = 0.999";
const RATIO: &str = "coin.ratio";
const TO: &str = "launch.orientation.tilt_deg.uniform.to";
const FRICTION: &str = "surface.friction";

fn unknown(key: &str, from: f64, to: f64) -> Unknown {
    let key = key.to_owned();
    Unknown { key, from, to }
}

fn question() -> Rank {
    Rank {
        face: Face::Side,
        unknowns: vec![
            unknown(FRICTION, 0.1, 0.5),
            unknown(RATIO, 0.4, 2.0),
            unknown(TO, 70.0, 90.0),
        ],
        samples: 4000,
        tosses: 20_000,
    }
}

fn ask(question: &Rank, threads: usize) -> Result<Ranking, QuestionError> {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: NonZeroUsize::new(threads),
        cancel: &cancel,
        made: &|_| (),
    };
    rank(&Template::new("inline", TILTED, &[]), question, &workers)
}

/// The side comes up if the axis is within atan(x/2) of the horizontal: of a tilt uniform up to τ ≤ 90°
/// with the probability 1 − (90° − atan(x/2))/τ, or 0.
fn p_side(ratio: f64, to_deg: f64) -> f64 {
    let critical = 90.0 - libm::atan(0.5 * ratio) * 180.0 / PI;
    (1.0 - critical / to_deg).max(0.0)
}

/// Mean, variance and both kinds of indices of p(u, v) over the unit square, by the midpoint rule.
fn by_quadrature(p: impl Fn(f64, f64) -> f64) -> (f64, f64, [f64; 2], [f64; 2]) {
    const N: usize = 400;
    let at = |i: usize| (i as f64 + 0.5) / N as f64;
    let n = N as f64;
    let mean_over = |f: &dyn Fn(usize) -> f64| (0..N).map(f).sum::<f64>() / n;
    let mean = mean_over(&|i| mean_over(&|j| p(at(i), at(j))));
    let squares = mean_over(&|i| mean_over(&|j| p(at(i), at(j)) * p(at(i), at(j))));
    let variance = squares - mean * mean;
    let given = |mean_given: &dyn Fn(usize) -> f64| {
        mean_over(&|i| mean_given(i) * mean_given(i)) - mean * mean
    };
    let of_u = given(&|i| mean_over(&|j| p(at(i), at(j)))) / variance;
    let of_v = given(&|j| mean_over(&|i| p(at(i), at(j)))) / variance;
    (mean, variance, [of_u, of_v], [1.0 - of_v, 1.0 - of_u])
}

fn holds(interval: Interval, known: f64, width: f64) {
    let Interval { lo, hi, .. } = interval;
    assert!(lo <= known && known <= hi, "{interval:?} {known}");
    assert!(interval.half_width() < width, "{interval:?}");
}

/// All intervals of 99.9 % hold the numbers of the closed form.
#[test]
fn indices_are_those_of_the_closed_form() {
    let (mean, variance, first, total) =
        by_quadrature(|u, v| p_side(0.4 + 1.6 * u, 70.0 + 20.0 * v));
    // the indices differ, and so do first and total, so that none passes for another
    assert!(
        first[0] > first[1] + 0.3 && total[0] > first[0] + 1e-3,
        "{first:?} {total:?}"
    );
    let ranking = ask(&question(), 2).expect("an answer");
    holds(ranking.mean, mean, 0.02);
    holds(ranking.deviation, variance.sqrt(), 0.01);
    assert_eq!(ranking.undecided, 0);
    let of = |key: &str| {
        let mut numbers = ranking.numbers.iter();
        numbers
            .find(|ranked| ranked.unknown.key == key)
            .expect("asked for")
    };
    for (index, key) in [RATIO, TO].into_iter().enumerate() {
        holds(of(key).first.expect("it moves"), first[index], 0.1);
        holds(of(key).total.expect("it moves"), total[index], 0.1);
    }
    holds(of(FRICTION).first.expect("others move"), 0.0, 0.1);
    holds(of(FRICTION).total.expect("others move"), 0.0, 0.1);
    let order: Vec<&str> = ranking
        .numbers
        .iter()
        .map(|ranked| &*ranked.unknown.key)
        .collect();
    assert_eq!(order, [RATIO, TO, FRICTION]);
}

/// The bars lead to the probabilities of the closed form, and what has no effect moves nothing.
#[test]
fn ends_are_those_of_the_closed_form() {
    let ranking = ask(&question(), 2).expect("an answer");
    let p = ranking.p;
    let own = p_side(1.0, 90.0);
    assert!(p.lo < own && own < p.hi, "{p:?} {own}");
    let [ratio, to, friction] = &ranking.numbers[..] else {
        panic!("three");
    };
    assert_eq!((ratio.value, to.value, friction.value), (1.0, 90.0, 0.3));
    // the difference's interval is about the estimate of the config's own
    for (end, known) in [
        (ratio.ends[0], p_side(0.4, 90.0)),
        (ratio.ends[1], p_side(2.0, 90.0)),
        (to.ends[0], p_side(1.0, 70.0)),
    ] {
        let error = p.half_width();
        assert!(
            (end.value - known).abs() < end.half_width() + error,
            "{end:?} {known}"
        );
    }
    assert_eq!(friction.ends.map(|end| end.value), [p.p; 2]);
    assert_eq!(friction.swing(), 0.0);
}

#[test]
fn rankings_do_not_depend_on_threads() {
    let question = Rank {
        samples: 100,
        tosses: 1000,
        ..question()
    };
    assert_eq!(
        ask(&question, 1).expect("one"),
        ask(&question, 3).expect("three")
    );
}

/// Where nothing moves there is nothing to divide.
#[test]
fn a_probability_that_does_not_move_has_no_indices() {
    let question = Rank {
        unknowns: vec![unknown(FRICTION, 0.1, 0.5)],
        samples: 300,
        ..question()
    };
    let ranking = ask(&question, 2).expect("an answer");
    assert_eq!(ranking.deviation.lo, 0.0);
    assert_eq!(
        (ranking.numbers[0].first, ranking.numbers[0].total),
        (None, None)
    );
    assert!(document_of_ranking(&ranking)["rows"][0]["first"].is_null());
}

#[test]
fn a_ranking_is_a_tornado() {
    let question = Rank {
        samples: 100,
        tosses: 1000,
        ..question()
    };
    let ranking = ask(&question, 2).expect("an answer");
    let svg = picture_of_ranking(&ranking);
    // two bars for each, and the background and two keys
    assert_eq!(svg.matches("<rect").count(), 2 * 3 + 3);
    assert!(svg.contains(RATIO) && svg.contains("70 to 90") && !svg.contains("NaN"));
    assert_eq!(ranking.tosses, question.tosses_planned());
}

#[test]
fn questions_without_sense_are_refused() {
    let refused = |change: &dyn Fn(&mut Rank)| {
        let mut question = Rank {
            samples: 100,
            tosses: 1000,
            ..question()
        };
        change(&mut question);
        ask(&question, 1).expect_err("refused").to_string()
    };
    assert!(refused(&|q| q.unknowns.clear()).starts_with("say what is unknown"));
    assert!(refused(&|q| q.samples = 5).starts_with("at least 64 samples"));
    assert!(refused(&|q| q.samples = 1 << 40).starts_with("at most 1000000 samples"));
    assert!(refused(&|q| q.tosses = 5).starts_with("at least 256 tosses"));
    assert!(refused(&|q| q.unknowns[1].to = 0.1).starts_with("the range must lead"));
    assert!(refused(&|q| q.unknowns[1] = q.unknowns[0].clone()).contains("given twice"));
    assert!(refused(&|q| q.unknowns[0].key = "surface.frction".to_owned()).contains("choose from"));
    let both = refused(&|q| {
        q.unknowns[0].key = "surface.frction".to_owned();
        q.unknowns[1].key = "coin.ratoi".to_owned();
    });
    for near in ["`surface.friction`?)", "`coin.ratio`?)"] {
        assert!(both.contains(near), "{both}");
    }
    let negative = refused(&|q| q.unknowns[0].from = -1.0);
    assert!(negative.contains("surface.friction"), "{negative}");
}

/// With nine impacts at most the friction decides how many tosses are undecided, not seen to move P: no index is told.
#[test]
fn undecided_tosses_leave_open_whether_the_probability_moves() {
    let text = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\nlaunch.preset = 'robot'\n\
                engine.flat.max_impacts = 9";
    let question = Rank {
        face: Face::Side,
        unknowns: vec![unknown(FRICTION, 0.1, 0.5)],
        samples: 64,
        tosses: 512,
    };
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|_| (),
    };
    let found = rank(&Template::new("inline", text, &[]), &question, &workers).expect("an answer");
    let places = 3 * 64 * 32;
    let open = found.undecided as f64 / f64::from(places);
    assert!(
        open > 0.1 && found.mean.hi > found.mean.value + 0.8 * open,
        "{found:?}"
    );
    assert!(
        found.deviation.lo == 0.0 && found.deviation.hi > 0.4 * open,
        "{found:?}"
    );
    let number = &found.numbers[0];
    assert!(number.first.is_none() && number.total.is_none());
    for (end, undecided) in number.ends.iter().zip(number.undecided) {
        assert!(end.hi > end.value + undecided as f64 / 512.0, "{number:?}");
        assert!(end.lo > end.value - 0.1, "{number:?}");
    }
    let document = document_of_ranking(&found);
    assert_eq!(document["rows"][0]["undecided_from"], number.undecided[0]);
}
