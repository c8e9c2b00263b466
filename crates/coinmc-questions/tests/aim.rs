//! Launches that force a face, asked of the engines themselves.

use coinmc_analytic::precession::thick;
use coinmc_core::Face;
use coinmc_questions::{Aim, Aimed, Parameter, QuestionError, Template, Workers, aim};
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A planar toss like the robot's, with a hand.
const ROBOT: &str = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                     engine.flat = {}\n[launch]\nheight_m = 0.3\n\
                     orientation.tilt_deg.normal = { mean = 20.0, sd = 10.0 }\n\
                     spin.about.axis = [0, 1, 0]\n\
                     spin.about.rate_rad_s.uniform = { from = 1.0, to = 5.0 }";
/// A drop without spin onto a surface to which the coin sticks.
const DROP: &str = "coin.ratio = 1.0\nengine.flat = {}\n\
                    surface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
                    [launch]\nheight_m = 0.5\n\
                    orientation.tilt_deg.normal = { mean = 120.0, sd = 10.0 }\n\
                    spin.about = { axis = [0, 1, 0], rate_rad_s = 0.0 }";
const TILT: &str = "launch.orientation.tilt_deg.normal.mean";

fn ask(text: &str, question: &Aim, threads: usize) -> Result<Aimed, QuestionError> {
    let cancel = AtomicBool::new(false);
    let made = AtomicU64::new(0);
    let workers = Workers {
        threads: NonZeroUsize::new(threads),
        cancel: &cancel,
        made: &|tosses| {
            made.fetch_add(tosses, Ordering::Relaxed);
        },
    };
    let answer = aim(&Template::new("inline", text, &[]), question, &workers);
    match &answer {
        Ok(answer) => assert_eq!(answer.tosses, made.into_inner()),
        // every problem is found before any toss
        Err(_) => assert_eq!(made.into_inner(), 0),
    }
    answer
}

fn parameter(key: &str, from: f64, to: f64, values: usize) -> Parameter {
    Parameter {
        key: key.to_owned(),
        from,
        to,
        values,
    }
}

fn plane() -> Aim {
    Aim {
        face: Face::Heads,
        parameters: vec![
            parameter(TILT, -60.0, 60.0, 5),
            parameter("launch.height_m", 0.01, 1.0, 4),
        ],
        tosses: 300,
        final_tosses: 1000,
        clumsiness: vec![0.5, 2.0],
    }
}

#[test]
fn the_answer_does_not_depend_on_the_number_of_threads() {
    let [one, three] = [1, 3].map(|threads| ask(ROBOT, &plane(), threads).expect("an answer"));
    assert_eq!(one, three);
    assert_eq!(
        one.tosses,
        plane().tosses_planned().expect("a sound question")
    );
    assert_eq!(one.map.len(), 20);
    assert_eq!(one.baseline.values, [20.0, 0.3]);
    assert!(one.best.estimate.lo > one.worst.estimate.hi);
    assert_eq!(one.best.estimate.n, 1000);
}

/// Heads is under the landing coin's centre if |tilt| < 90° − atan(x/2) = 63.43°, so a level drop
/// with a spread of σ forces it with P = erf(63.43°/(σ √2)). (The coin turned by 360° − 63.43° is
/// 30 σ away, and 3 σ at ten times the spread: 0.15 %, which is added.)
#[test]
fn clumsy_hands_spoil_a_sharp_optimum() {
    let question = Aim {
        face: Face::Heads,
        parameters: vec![parameter(TILT, -180.0, 180.0, 9)],
        tosses: 200,
        final_tosses: 20_000,
        clumsiness: vec![0.0, 1.0, 3.0, 6.0, 10.0],
    };
    let text = format!("{DROP}\n[estimate]\nconfidence = 0.9999");
    let answer = ask(&text, &question, 2).expect("an answer");
    assert_eq!((answer.best.values[0], answer.best.estimate.p), (0.0, 1.0));
    assert_eq!(
        (answer.worst.values[0].abs(), answer.worst.estimate.p),
        (180.0, 0.0)
    );
    assert_eq!(answer.clumsy[1].estimate, answer.best.estimate);
    let half = 90.0 - libm::atan(0.5).to_degrees();
    let mut before = 1.0;
    for clumsy in &answer.clumsy {
        let sd = 10.0 * clumsy.factor;
        let within = |tilt: f64| libm::erf(tilt / (sd * 2.0_f64.sqrt()));
        let exact = match clumsy.factor {
            0.0 => 1.0,
            _ => within(half) + within(360.0 + half) - within(360.0 - half),
        };
        let estimate = clumsy.estimate;
        assert!(
            (estimate.lo..=estimate.hi).contains(&exact),
            "{sd} {exact} {estimate:?}"
        );
        assert!(estimate.p <= before);
        before = estimate.p;
    }
    assert!(before < 0.6);
}

/// The same-side bias (Diaconis, Holmes & Montgomery, SIAM Review 49 (2007) 211): a thin coin that
/// starts heads up, precesses and is caught. The phase is uniform by the spread of the spin, 24 rad/s
/// over 0.76 s. The coin is small and slow to turn while it lands: R ω = 0.5 m/s is below the speed
/// of 5 m/s at which it comes, so that the first contact favours no phase.
#[test]
fn a_caught_coin_has_the_same_side_bias() {
    let text = "coin = { ratio = 0.001, radius_m = 0.002 }\nengine.volumetric = {}\n\
                surface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
                estimate.confidence = 0.999\n[launch]\npreset = 'hand'\n\
                spin.precessing.rate_rad_s.normal = { mean = 238.6, sd = 23.86 }\n\
                spin.precessing.psi_deg = 80";
    let question = Aim {
        face: Face::Heads,
        parameters: vec![parameter("launch.spin.precessing.psi_deg", 50.0, 80.0, 3)],
        tosses: 100_000,
        final_tosses: 100_000,
        clumsiness: vec![],
    };
    let answer = ask(text, &question, 2).expect("an answer");
    let psi: Vec<f64> = answer.map.iter().map(|place| place.values[0]).collect();
    assert_eq!(psi, [50.0, 65.0, 80.0]);
    for place in answer
        .map
        .iter()
        .chain([&answer.best, &answer.worst, &answer.baseline])
    {
        let exact = thick::probabilities(0.001, place.values[0].to_radians()).heads;
        let estimate = place.estimate;
        assert!(
            (estimate.lo..=estimate.hi).contains(&exact),
            "{place:?} {exact}"
        );
    }
    // tails would be as likely without the bias, which is 1 % at the least here
    assert!(answer.map.iter().all(|place| place.estimate.lo > 0.5));
    // the coin that precesses most shows its first face most often
    assert_eq!(
        (answer.best.values[0], answer.worst.values[0]),
        (50.0, 80.0)
    );
}

#[test]
fn an_aim_can_be_stopped() {
    let cancel = AtomicBool::new(false);
    let made = AtomicU64::new(0);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|tosses| {
            if made.fetch_add(tosses, Ordering::Relaxed) > 2000 {
                cancel.store(true, Ordering::Relaxed);
            }
        },
    };
    let stopped = aim(&Template::new("inline", ROBOT, &[]), &plane(), &workers);
    assert!(matches!(stopped, Err(QuestionError::Stopped)));
    assert!(made.into_inner() < 5000);
}

#[test]
fn questions_without_sense_are_refused() {
    let refused = |text: &str, change: fn(&mut Aim)| {
        let mut question = plane();
        change(&mut question);
        ask(text, &question, 1).expect_err("refused").to_string()
    };
    let with = |change: fn(&mut Aim)| refused(ROBOT, change);
    assert!(with(|q| q.parameters.clear()).starts_with("one or two different parameters"));
    assert!(with(|q| q.parameters[1] = q.parameters[0].clone()).ends_with("not 1"));
    assert!(with(|q| q.parameters[0].values = 1).starts_with("at least 2 values of `launch.o"));
    assert!(with(|q| q.parameters[0].to = f64::NAN).starts_with("the range must lead"));
    assert!(with(|q| q.parameters[0].to = -60.0).starts_with("the range must lead"));
    assert!(with(|q| q.parameters[0].values = 2501).starts_with("at most 10000 places"));
    assert!(with(|q| q.parameters[0].values = usize::MAX).starts_with("at most 10000 places"));
    assert!(with(|q| q.tosses = 0).starts_with("at least 1 tosses"));
    assert!(with(|q| q.final_tosses = u64::MAX).starts_with("at most 1000000000 tosses"));
    assert!(with(|q| q.clumsiness = vec![-1.0]).starts_with("a factor for the spread"));
    assert!(with(|q| q.clumsiness = vec![1.0; 101]).starts_with("at most 100 factors"));
    let unknown = with(|q| q.parameters[0].key = "coin.ratio".to_owned());
    assert!(unknown.contains("is no number of the launch") && unknown.contains(TILT));
    let negative = with(|q| q.parameters[1].from = -1.0);
    assert!(
        negative.starts_with("the config has problems"),
        "{negative}"
    );
    assert!(
        negative.contains("question:1:1") && !negative.contains("orientation"),
        "{negative}"
    );
    let sure = ROBOT.replace("sd = 10.0", "sd = 0.0").replace(
        "uniform = { from = 1.0, to = 5.0 }",
        "normal = { mean = 0.0, sd = 0.0 }",
    );
    assert!(refused(&sure, |_| ()).starts_with("nothing of the launch is spread"));
    let swept = ROBOT.replace("friction = 0.3", "friction = [0.1, 0.3]");
    assert_eq!(
        refused(&swept, |_| ()),
        "the config must be a single point, but sweeps friction"
    );
    let closed = "coin.ratio = 1.0\nengine.analytic.rule = 'arc'";
    assert!(refused(closed, |_| ()).starts_with("a closed form has no launch"));
}

/// Five times the width of the height's distribution would begin below the surface, at the lowest
/// place only.
#[test]
fn an_impossible_hand_is_refused_before_any_toss() {
    let text = ROBOT.replace(
        "height_m = 0.3",
        "height_m.uniform = { from = 0.4, to = 1.0 }",
    );
    let question = Aim {
        parameters: vec![parameter("launch.height_m.uniform.from", 0.1, 0.9, 5)],
        clumsiness: vec![1.0, 1.2, 1.5],
        ..plane()
    };
    let error = ask(&text, &question, 1).expect_err("refused");
    let message = error.to_string();
    assert!(
        message.starts_with("with 1.5 times the spread of the hand, `launch.height_m"),
        "{message}"
    );
    let QuestionError::Clumsy { factor, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(factor, 1.5);
}
