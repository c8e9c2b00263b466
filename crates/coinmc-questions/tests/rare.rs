//! Rare faces against closed forms and brute force.

use coinmc::run::{TossSource, for_each_outcome, stream};
use coinmc_core::Face;
use coinmc_questions::{
    HowRare, QuestionError, Rareness, Template, Workers, document_of_rare, gain_expected, how_rare,
    scenes::EverydayScene,
};
use std::f64::consts::FRAC_2_PI;
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// Nothing bounces and every landing angle is as likely: P(side) = (2/π) atan(x/2).
fn arc(ratio: f64, seed: u64) -> Template {
    let text = format!(
        "seed = {seed}\ncoin.ratio = {ratio:?}\nsampling.method = 'random'\n\
         surface = {{ landing = 'adhesive', restitution = 0.0, friction = 0.3 }}\n\
         launch.preset = 'clean-flat'\nengine.flat = {{}}"
    );
    Template::new("inline", text, &[])
}

fn question() -> HowRare {
    HowRare {
        face: Face::Side,
        relative_error: 0.1,
        max_tosses: 10_000_000,
    }
}

fn ask(template: &Template, question: &HowRare, threads: usize) -> Result<Rareness, QuestionError> {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: NonZeroUsize::new(threads),
        cancel: &cancel,
        made: &|_| (),
    };
    how_rare(template, question, &workers)
}

fn felt(ratio: f64) -> Template {
    let felt = EverydayScene::named("felt").expect("a scene");
    felt.template(&[format!("coin.ratio={ratio:?}")
        .parse()
        .expect("an override")])
}

/// Of 100 intervals of 95 % at most 13 miss: if it were 5 %, more would with a probability of 5e-4. Every
/// answer is as short as asked for, and takes several times fewer tosses than brute force.
#[test]
fn intervals_hold_the_closed_form_as_often_as_they_say() {
    let known = FRAC_2_PI * libm::atan(0.005);
    let mut missed = 0;
    for seed in 0..100 {
        let answer = ask(&arc(0.01, seed), &question(), 2).expect("an answer");
        assert!(answer.reached, "{:?}", answer.p);
        assert!(answer.p.half_width() <= 0.1 * answer.p.value);
        assert!(answer.gain().tosses > 2.0, "{:?}", answer.gain());
        missed += usize::from(!(answer.p.lo <= known && known <= answer.p.hi));
    }
    assert!(missed <= 13, "{missed}");
}

/// A coin that is dropped onto soft ground.
fn dropped() -> Template {
    let text = "coin = { ratio = 0.1, radius_m = 0.0116 }\nlaunch.preset = 'drop'\nengine.volumetric = {}\n\
                surface = { restitution = 0.1, friction = 0.4, rolling_friction_m = 1e-3, \
                contact_patch_m = 1e-3 }";
    Template::new("inline", text, &[])
}

/// In space: 300,000 tosses by brute force, within 3.3 standard errors of the difference, false alarm 1e-3.
#[test]
fn brute_force_agrees_in_space() {
    let template = dropped();
    let answer = ask(&template, &question(), 2).expect("an answer");
    assert!(answer.reached, "{:?}", answer.p);
    assert!(answer.strata.iter().any(|stratum| stratum.chance < 0.7));
    assert!(answer.gain().tosses > 1.5, "{:?}", answer.gain());
    let plan = template.plan(&[]).expect("a plan");
    let (tosses, mut shown) = (300_000, 0);
    // other random numbers than those of the answer
    let stream = stream(&plan, 1);
    let source = TossSource::Drawn(&stream);
    for_each_outcome(&plan.points[0], source, 0..tosses, |_, outcome| {
        shown += u64::from(outcome.face() == Some(Face::Side));
        true
    })
    .expect("tosses");
    let p = shown as f64 / tosses as f64;
    let error = (p * (1.0 - p) / tosses as f64).sqrt();
    let other = answer.p.half_width() / 1.96;
    let z = (answer.p.value - p) / (error * error + other * other).sqrt();
    assert!(z.abs() < 3.3, "{z} {p} {:?}", answer.p);
}

/// On a hard table the coin forgets how it landed: nothing is gained, nothing is lost, and that is said.
#[test]
fn where_the_coin_bounces_nothing_is_gained() {
    let text = "coin.ratio = 0.3\nsurface = { restitution = 0.6, friction = 0.3 }\n\
                launch.preset = 'robot'\nengine.flat = {}";
    let template = Template::new("inline", text, &[]);
    let answer = ask(&template, &question(), 2).expect("an answer");
    assert!(
        (0.7..1.1).contains(&answer.gain().tosses),
        "{:?}",
        answer.gain()
    );
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|_| (),
    };
    let expected = |template: &Template| gain_expected(template, &question(), 65_536, &workers);
    let bounces = expected(&template).expect("a forecast").expect("seen");
    assert!((0.8..1.3).contains(&bounces.work), "{bounces:?}");
    let adhesive = expected(&arc(0.05, 1)).expect("a forecast").expect("seen");
    assert!(adhesive.tosses > 4.0, "{adhesive:?}");
}

#[test]
fn answers_do_not_depend_on_threads() {
    let of = |threads| {
        ask(
            &felt(0.3),
            &HowRare {
                relative_error: 0.4,
                ..question()
            },
            threads,
        )
    };
    assert_eq!(of(1).expect("one"), of(3).expect("three"));
}

/// A face that is hardly ever seen has an upper limit, and no gain.
#[test]
fn a_face_that_was_not_seen_has_an_upper_limit() {
    let question = HowRare {
        face: Face::Heads,
        max_tosses: 5000,
        ..question()
    };
    let template = Template::new(
        "inline",
        "coin.ratio = 1\nsurface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
         launch = { height_m = 0.5, orientation.tilt_deg.normal = { mean = 180, sd = 1 }, \
         spin.about = { axis = [0, 1, 0], rate_rad_s = 0 } }\nengine.flat = {}",
        &[],
    );
    let answer = ask(&template, &question, 1).expect("an answer");
    assert!(!answer.reached && answer.p.value == 0.0 && answer.p.lo == 0.0);
    assert!(answer.p.hi > 0.0 && answer.p.hi < 0.02, "{:?}", answer.p);
    assert!(answer.gain().tosses.is_nan());
    assert!(document_of_rare(&answer)["gain"].is_null());
}

/// Tosses stop at their limit, and the answer says that it is short of the error.
#[test]
fn a_limit_is_kept() {
    let question = HowRare {
        relative_error: 0.01,
        max_tosses: 20_000,
        ..question()
    };
    let answer = ask(&arc(0.05, 1), &question, 2).expect("an answer");
    assert!(!answer.reached);
    let made = answer.tosses + answer.pilot_tosses;
    // the number of tosses that come of launches is a matter of chance
    assert!((18_000..22_000).contains(&made), "{made}");
    let known = FRAC_2_PI * libm::atan(0.025);
    assert!(answer.p.lo < known && known < answer.p.hi);
}

#[test]
fn questions_without_sense_are_refused() {
    let refused = |template: &Template, question: HowRare| {
        ask(template, &question, 1)
            .expect_err("refused")
            .to_string()
    };
    let template = arc(1.0, 1);
    for relative_error in [0.0, 0.6, f64::NAN] {
        let question = HowRare {
            relative_error,
            ..question()
        };
        assert!(refused(&template, question).starts_with("the relative error must be"));
    }
    let few = HowRare {
        max_tosses: 10,
        ..question()
    };
    assert!(refused(&template, few).starts_with("at least 4096 tosses"));
    let swept = Template::new(
        "inline",
        "coin.ratio = [1, 2]\nsurface = { restitution = 0.5, friction = 0.3 }\n\
         launch.preset = 'robot'\nengine.flat = {}",
        &[],
    );
    assert!(refused(&swept, question()).contains("sweeps ratio"));
    let closed = Template::new(
        "inline",
        "coin.ratio = 1\nengine.analytic = { model = 'arc' }",
        &[],
    );
    assert!(refused(&closed, question()).contains("closed form"));
}

/// With nine impacts at most so many tosses are undecided that they limit the answer, not the number of tosses; the
/// gain is that of the tosses that are decided.
#[test]
fn undecided_tosses_that_limit_the_answer_are_told() {
    let scene = |impacts: u32| {
        let text = format!(
            "coin.ratio = 0.5\nsurface = {{ restitution = 0.5, friction = 0.3 }}\nlaunch.preset = 'robot'\n\
             engine.flat.max_impacts = {impacts}"
        );
        Template::new("inline", text, &[])
    };
    let question = HowRare {
        relative_error: 0.3,
        max_tosses: 20_000,
        ..question()
    };
    let open = ask(&scene(9), &question, 2).expect("an answer");
    assert!(!open.reached && open.is_limited_by_undecided(), "{open:?}");
    assert!(open.p.hi > 10.0 * open.without_undecided.hi, "{open:?}");
    assert_eq!(open.p.lo, open.without_undecided.lo);
    assert!(
        (0.2..5.0).contains(&open.gain().tosses),
        "{:?}",
        open.gain()
    );
    let document = document_of_rare(&open);
    assert_eq!(document["limited_by_undecided"], true);
    let usual = ask(&scene(100_000), &question, 2).expect("an answer");
    assert!(
        usual.reached && !usual.is_limited_by_undecided(),
        "{usual:?}"
    );
    assert_eq!(usual.p, usual.without_undecided);
    let few = HowRare {
        relative_error: 0.02,
        max_tosses: 5000,
        ..question
    };
    let short = ask(&scene(100_000), &few, 2).expect("an answer");
    assert!(
        !short.reached && !short.is_limited_by_undecided(),
        "{short:?}"
    );
}
