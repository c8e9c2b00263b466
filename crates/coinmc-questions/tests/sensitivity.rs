//! Sensitivities of the engines themselves.

use coinmc_core::Face;
use coinmc_questions::sensitivity::{Sensitivity, Steps, parameters, sensitivities};
use coinmc_questions::{Interval, Question, QuestionError, Root, Template, Workers, fair};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// Nothing bounces and every landing angle is as likely, P(side) = (2/π) atan(x/2); tossed at random.
const ARC: &str = "seed = 3\ncoin.ratio = 1.0\nsampling.method = 'random'\n\
                   surface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
                   launch.preset = 'clean-flat'\nengine.flat = {}\nestimate.confidence = 0.999";

fn ask(text: &str, steps: &Steps, threads: usize) -> Result<Vec<Sensitivity>, QuestionError> {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: NonZeroUsize::new(threads),
        cancel: &cancel,
        made: &|_| (),
    };
    sensitivities(&Template::new("inline", text, &[]), steps, &workers)
}

fn steps(keys: &[&str], tosses: u64) -> Steps {
    Steps {
        keys: keys.iter().map(|key| (*key).to_owned()).collect(),
        step: 0.05,
        tosses,
    }
}

/// dP/d ln x = (2/π) 2x/(4 + x²), within an interval of 99.9 % and the error of the step, s²/24 of the third
/// derivative: below 0.001.
#[test]
fn the_derivative_is_that_of_the_closed_form() {
    let found = ask(ARC, &steps(&["coin.ratio"], 200_000), 2).expect("an answer");
    let side = found[0].of(Face::Side);
    let exact = (2.0 / PI) * 2.0 / 5.0;
    assert!(
        side.lo - 1e-3 < exact && exact < side.hi + 1e-3,
        "{side:?} {exact}"
    );
    // the same tosses: few change, so the interval is short
    // two independent estimates would have 2 · 3.29 · sqrt(2 · .21/200,000)/ln 1.05 = .2
    assert!(side.hi - side.lo < 0.04, "{side:?}");
    let p = (2.0 / PI) * libm::atan(0.5);
    let elasticity = found[0].elasticity(Face::Side);
    assert!(
        (elasticity.value - exact / p).abs() < 0.05,
        "{elasticity:?}"
    );
    let sum: f64 = Face::ALL.map(|face| found[0].of(face).value).iter().sum();
    assert!(sum.abs() < 1e-12);
}

/// A number at the end of its range moves to one side, by the same factor: not past its end, and not by half.
#[test]
fn a_number_at_the_end_of_its_range_moves_inwards() {
    let end = ARC.replace("restitution = 0.0", "restitution = 1.0");
    let found = ask(&end, &steps(&["surface.restitution"], 512), 2).expect("an answer");
    assert_eq!(found[0].values, [1.0 / 1.05, 1.0]);
    assert!(found[0].is_one_sided());
    let inside = ask(ARC, &steps(&["coin.ratio"], 512), 2).expect("an answer");
    assert!(!inside[0].is_one_sided());
    let ratio = inside[0].values[1] / inside[0].values[0];
    assert!((ratio - 1.05).abs() < 1e-12, "{ratio}");
}

/// The same tosses as a pair around the middle of the two values makes. (From 0.98 rounding leads to the same values.)
#[test]
fn a_one_sided_step_gives_the_derivative_from_that_side() {
    let bouncing = |restitution: f64| {
        format!(
            "seed = 3\ncoin.ratio = 1.0\nsurface = {{ restitution = {restitution}, friction = 0.3 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\nestimate.confidence = 0.999"
        )
    };
    let found = ask(&bouncing(0.98), &steps(&["surface.restitution"], 512), 2).expect("an answer");
    assert_eq!(found[0].values, [0.98 / 1.05, 0.98]);
    let below = ask(
        &bouncing(0.98 / 1.05_f64.sqrt()),
        &steps(&["surface.restitution"], 512),
        2,
    );
    let below = below.expect("an answer");
    let [mine, twin] = [&found[0], &below[0]].map(|one| one.of(Face::Side).value);
    assert_eq!(below[0].values, found[0].values);
    assert_eq!(mine, twin);
}

#[test]
fn sensitivities_do_not_depend_on_threads() {
    let all = steps(&[], 2048);
    assert_eq!(
        ask(ARC, &all, 1).expect("one"),
        ask(ARC, &all, 3).expect("three")
    );
}

/// All numbers but 0, and not the mass of a uniform coin. Where nothing bounces friction changes no toss.
#[test]
fn what_has_no_effect_changes_no_toss() {
    let template = Template::new("inline", ARC, &[]);
    let keys: Vec<String> = parameters(&template)
        .expect("parameters")
        .into_iter()
        .map(|parameter| parameter.key)
        .collect();
    assert!(keys.contains(&"surface.friction".to_owned()), "{keys:?}");
    assert!(
        keys.contains(&"environment.gravity_m_s2".to_owned()),
        "{keys:?}"
    );
    assert!(!keys.contains(&"coin.mass_kg".to_owned()), "{keys:?}");
    assert!(
        !keys.contains(&"surface.restitution".to_owned()),
        "{keys:?}"
    );
    let found = ask(ARC, &steps(&["surface.friction"], 2048), 1).expect("an answer");
    assert_eq!(
        (found[0].changed, found[0].of(Face::Side).value),
        (0.0, 0.0)
    );
    let loaded = ARC.replace(
        "coin.ratio = 1.0",
        "coin = { ratio = 1.0, axial_moment_kg_m2 = 4e-7 }",
    );
    let with_mass = parameters(&Template::new("inline", loaded, &[])).expect("parameters");
    assert!(
        with_mass
            .iter()
            .any(|parameter| parameter.key == "coin.mass_kg")
    );
}

/// P(side) = (2/π) atan(x/2) grows by .993 % for a per cent of x = .2. A step by a factor of 2 in all is right
/// to the second order: ln 2/12 squared, 4 %, at an elasticity of 1.
#[test]
fn an_elasticity_is_that_in_the_middle_of_the_step() {
    let arc = ARC.replace("ratio = 1.0", "ratio = 0.2");
    let wide = Steps {
        step: 1.0,
        ..steps(&["coin.ratio"], 100_000)
    };
    let found = ask(&arc, &wide, 2).expect("an answer");
    let Interval { value, lo, hi } = found[0].elasticity(Face::Side);
    let p = |x: f64| std::f64::consts::FRAC_2_PI * libm::atan(0.5 * x);
    let (low, high) = (p(0.2 * 0.5_f64.sqrt()), p(0.2 * 2.0_f64.sqrt()));
    let expected = 2.0 * (high - low) / (high + low) / std::f64::consts::LN_2;
    assert!(lo < expected && expected < hi, "{value}: {lo} to {hi}");
    assert!((value - 0.993).abs() < 0.06, "{value}");
}

/// The fair ratio moves against what raises P(side), and by the ratio's own derivative one for one.
#[test]
fn a_root_moves_against_the_probability() {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|_| (),
    };
    let template = Template::new("inline", ARC, &[]);
    let question = Question {
        half_width: 0.01,
        numerical_tosses: 0,
        ..Question::default()
    };
    let answer = fair(&template, &question, &workers).expect("an answer");
    let root = answer.curves[0].roots().next().expect("a root").clone();
    let at_root = ARC.replace("ratio = 1.0", &format!("ratio = {:?}", root.value));
    let found = ask(&at_root, &steps(&["coin.ratio"], 100_000), 2).expect("an answer");
    let shift = found[0].shift(Face::Side, &root);
    // dx*/d ln x = −x
    assert!(
        shift.lo < -root.value && -root.value < shift.hi,
        "{shift:?} {}",
        root.value
    );
}

#[test]
fn questions_without_sense_are_refused() {
    let refused = |text: &str, steps: &Steps| ask(text, steps, 1).expect_err("refused").to_string();
    let ratio = steps(&["coin.ratio"], 1000);
    assert!(
        refused(
            ARC,
            &Steps {
                step: 0.0,
                ..ratio.clone()
            }
        )
        .starts_with("the step must be")
    );
    assert!(
        refused(
            ARC,
            &Steps {
                tosses: 1,
                ..ratio.clone()
            }
        )
        .starts_with("at least 256 tosses")
    );
    assert!(refused(ARC, &steps(&["coin.ratoi"], 1000)).contains("choose from coin."));
    let all = refused(
        ARC,
        &steps(&["coin.ratoi", "coin.ratio", "surface.tilt"], 5),
    );
    for told in [
        "at least 256 tosses",
        "`coin.ratoi` (did you mean `coin.ratio`?), `surface.tilt` are not numbers",
    ] {
        assert!(all.contains(told), "{all}");
    }
    let swept = ARC.replace("ratio = 1.0", "ratio = [1.0, 2.0]");
    assert!(refused(&swept, &ratio).ends_with("but sweeps ratio"));
}

/// Of tosses with nine impacts at most a part is undecided: no derivative is known better than their share allows.
#[test]
fn undecided_tosses_widen_every_interval() {
    let scene = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\nlaunch.preset = 'robot'\n\
                 engine.flat.max_impacts = 9";
    let found = ask(scene, &steps(&["surface.friction"], 1000), 2).expect("an answer");
    let one = &found[0];
    let per_log = 1.0 / libm::log1p(0.05);
    let [first, second] = one.undecided.map(|undecided| undecided as f64 / 1000.0);
    assert!(first > 0.1 && second > 0.1, "{:?}", one.undecided);
    for face in Face::ALL {
        let Interval { value, lo, hi } = one.of(face);
        assert!(lo < value - 0.5 * first * per_log, "{lo} {value}");
        assert!(hi > value + 0.5 * second * per_log, "{hi} {value}");
    }
    // a face that undecided tosses may have shown has a smaller elasticity for its derivative
    let side = one.of(Face::Side);
    let elasticity = one.elasticity(Face::Side);
    let p = one.p[Face::Side as usize];
    assert!(
        (elasticity.lo - side.lo / p).abs() < 1e-9 && (elasticity.hi - side.hi / p).abs() < 1e-9
    );
    let rising = Sensitivity {
        faces: [Interval {
            value: 0.4,
            lo: 0.2,
            hi: 0.6,
        }; 3],
        ..one.clone()
    };
    let hidden = 0.5 * (first + second);
    assert!((rising.elasticity(Face::Side).lo - 0.2 / (p + hidden)).abs() < 1e-12);
}

/// The end of a derivative that is farther away gives the farther end of the shift, on the other side.
#[test]
fn a_shift_is_as_lopsided_as_its_derivative() {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|_| (),
    };
    let question = Question {
        half_width: 0.05,
        numerical_tosses: 0,
        ..Question::default()
    };
    let answer = fair(&Template::new("inline", ARC, &[]), &question, &workers).expect("an answer");
    let root = Root {
        slope: 0.5,
        slope_error: 0.0,
        ..answer.curves[0].roots().next().expect("a root").clone()
    };
    let found = ask(ARC, &steps(&["surface.friction"], 512), 1).expect("an answer");
    let one = Sensitivity {
        faces: [Interval {
            value: 0.1,
            lo: 0.0,
            hi: 0.4,
        }; 3],
        ..found[0].clone()
    };
    let rising = one.shift(Face::Side, &root);
    assert!(
        (rising.lo + 0.8).abs() < 1e-12 && rising.hi.abs() < 1e-12,
        "{rising:?}"
    );
    let falling = one.shift(
        Face::Side,
        &Root {
            slope: -0.5,
            ..root
        },
    );
    assert!(
        (falling.hi - 0.8).abs() < 1e-12 && falling.lo.abs() < 1e-12,
        "{falling:?}"
    );
}
