//! The page's answers are the program's.

use coinmc::config;
use coinmc::run::{Count, count};
use coinmc_core::Tally;
use coinmc_page::answer;
use serde_json::{Value, json};
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

const FLAT: &str = "seed = 7\ncoin.ratio = 1.5\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 2000";
const SPACE: &str = "coin.ratio = 0.9\nsurface.material = 'felt'\nlaunch.preset = 'clean'\n\
                     engine.volumetric = {}\nstop.tosses = 300";

fn ask(question: &Value) -> Value {
    serde_json::from_str(&answer(&question.to_string())).unwrap()
}

fn tossed(config: &str, from: u64, to: u64) -> Value {
    ask(&json!({ "ask": "toss", "config": config, "from": from, "to": to }))["tally"].clone()
}

/// However the tosses are divided, as the page divides them by the speed of its workers.
#[test]
fn pieces_add_up_to_the_counts_of_a_run() {
    for (config, ends) in [
        (FLAT, vec![0, 32, 33, 900, 2000]),
        (SPACE, vec![0, 1, 128, 300]),
    ] {
        let plan = config::parse("config", config, &[]).unwrap();
        let options = Count {
            threads: NonZeroUsize::new(2),
            cancel: &AtomicBool::new(false),
            sink: &(),
        };
        let row = &count(&plan, &options).unwrap().results.rows[0];
        let mut sums = [0; Tally::COUNTERS.len()];
        for piece in ends.windows(2) {
            let tally = tossed(config, piece[0], piece[1]);
            for (sum, counter) in sums.iter_mut().zip(Tally::COUNTERS) {
                *sum += tally[counter.name].as_u64().unwrap();
            }
        }
        assert_eq!(Tally::from_array(sums), row.tally);
        let tally: serde_json::Map<_, _> = Tally::COUNTERS
            .iter()
            .zip(sums)
            .map(|(counter, sum)| (counter.name.to_owned(), json!(sum)))
            .collect();
        let told = ask(&json!({ "ask": "estimate", "config": config, "tally": tally }));
        for (name, estimate) in [
            ("heads", row.heads),
            ("tails", row.tails),
            ("side", row.side),
        ] {
            let face = &told["faces"][name];
            // numbers are written exactly, and read here to an ulp
            for (end, value) in [("p", estimate.p), ("lo", estimate.lo), ("hi", estimate.hi)] {
                assert!((face[end].as_f64().unwrap() - value).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn a_toss_is_drawn_from_its_launch_to_its_end() {
    let plan = config::parse("config", SPACE, &[]).unwrap();
    let outcome = coinmc_trace::outcome(&plan, 0, 5).unwrap();
    let drawn = ask(&json!({ "ask": "motion", "config": SPACE, "toss": 5, "most": 200 }));
    assert_eq!(drawn["outcome"], coinmc_trace::outcome_name(&outcome));
    let states = drawn["states"].as_array().unwrap();
    let events = drawn["events"].as_array().unwrap();
    let most = 201 + events.len();
    assert!((100..=most).contains(&states.len()), "{}", states.len());
    let drawn_at: Vec<&Value> = states.iter().map(|state| &state[0]).collect();
    assert!(events.iter().all(|event| drawn_at.contains(&&event[0])));
    assert_eq!(states[0][0], 0.0);
    assert_eq!(states.last().unwrap()[0], drawn["duration_s"]);
    assert_eq!(events[0][1], "launched");
    assert_eq!(events.last().unwrap()[1], "ended");
}

#[test]
fn the_fair_ratio_is_that_of_the_question() {
    use coinmc_questions::{Question, Template, Workers, document, fair};
    let told = ask(&json!({
        "ask": "fair", "config": FLAT, "half_width": 0.05, "max_tosses": 20_000,
    }));
    let question = Question {
        half_width: 0.05,
        max_tosses: 20_000,
        numerical_tosses: 0,
        ..Question::default()
    };
    let workers = Workers {
        threads: NonZeroUsize::new(2),
        cancel: &AtomicBool::new(false),
        made: &|_| (),
    };
    let found = fair(&Template::new("config", FLAT, &[]), &question, &workers).unwrap();
    let expected: Value =
        serde_json::from_str(&document(&found, (None, &[]), &[]).to_string()).unwrap();
    assert_eq!(told, expected);
}

#[test]
fn what_is_wrong_is_said() {
    let error = |question: Value| ask(&question)["error"].as_str().unwrap().to_owned();
    assert!(answer("{").contains("no question"));
    assert!(error(json!({ "ask": "tos" })).contains("unknown variant `tos`"));
    let toss = |config: &str, point: usize, from: u64, to: u64| {
        error(json!({ "ask": "toss", "config": config, "point": point, "from": from, "to": to }))
    };
    assert!(toss("coin.ratoi = 1", 0, 0, 1).contains("did you mean `ratio`?"));
    assert!(toss(FLAT, 1, 0, 1).contains("outside the plan"));
    assert!(toss(FLAT, 0, 2, 1).contains("outside the plan"));
    let exact = "coin.ratio = 1\nengine.analytic.rule = 'arc'";
    assert!(toss(exact, 0, 0, 1).contains("closed form"));
    let tally = json!({ "heads": 1_u64 << 54 });
    let estimate = json!({ "ask": "estimate", "config": FLAT, "tally": tally });
    assert!(error(estimate).contains("at most"));
    let estimate = json!({ "ask": "estimate", "config": FLAT, "tally": { "haeds": 1 } });
    assert!(error(estimate).contains("haeds"));
    let motion = json!({ "ask": "motion", "config": FLAT, "toss": 2000, "most": 10 });
    assert!(error(motion).contains("there is no toss 2000"));
    let check = ask(&json!({ "ask": "check", "config": "coin.ratoi = 1" }));
    assert_eq!(check["problems"][0]["line"], 1);
    let check = ask(&json!({ "ask": "check", "config": SPACE }));
    assert_eq!(
        (&check["tosses"], &check["points"][0]["engine"]),
        (&json!(300), &json!("volumetric"))
    );
}

#[test]
fn the_choices_are_those_of_configs() {
    let about = ask(&json!({ "ask": "about" }));
    let names = |list: &str| -> Vec<String> {
        let list = about[list].as_array().unwrap().iter();
        list.map(|one| one["name"].as_str().unwrap().to_owned())
            .collect()
    };
    assert!(names("materials").len() > 5 && names("launches").len() > 5);
    for material in names("materials") {
        let config = SPACE.replace("felt", &material);
        assert!(ask(&json!({ "ask": "check", "config": config }))["problems"].is_null());
    }
    for launch in names("launches") {
        let config = SPACE.replace("clean", &launch);
        assert!(ask(&json!({ "ask": "check", "config": config }))["problems"].is_null());
    }
}
