//! Random words, uniforms and launches as JSON, for the Python tests to check against NumPy's.

use coinmc_core::{Coin, Domain, Philox4x64, Preset, Stream, UniformSource};
use serde_json::{Value, json};

/// Cases of each kind.
const CASES: u64 = 500;

fn main() {
    let blocks: Vec<Value> = (0..CASES).map(block).collect();
    let uniforms: Vec<Value> = (0..CASES).map(uniform).collect();
    let launches: Vec<Value> = (0..CASES).map(launch).collect();
    println!(
        "{}",
        json!({ "blocks": blocks, "uniforms": uniforms, "launches": launches })
    );
}

/// Keys and counters from another key of the generator itself: any would do, if they are spread.
fn anything(case: u64, n: u64) -> [u64; 4] {
    Philox4x64::new([u64::MAX, 1]).block([case, n, 0, 0])
}

fn block(case: u64) -> Value {
    let [key0, key1, ..] = anything(case, 0);
    let counter = if case == 0 { [0; 4] } else { anything(case, 1) };
    let words = Philox4x64::new([key0, key1]).block(counter);
    json!({ "key": [key0, key1], "counter": counter, "words": words })
}

fn uniform(case: u64) -> Value {
    let [seed, point, toss, dimension] = anything(case, 2);
    let (point, dimension) = (
        point % 1000,
        u32::try_from(dimension % 16).expect("below 16"),
    );
    let u = Stream::new(seed, Domain::Launch, point)
        .toss(toss)
        .uniform(dimension);
    json!({ "seed": seed, "point": point, "toss": toss, "dimension": dimension, "uniform": u })
}

/// The robot's launch: its tilt and its spin are uniforms 0 and 3, scaled.
fn launch(toss: u64) -> Value {
    let coin = Coin::cylinder(1.5, 0.01).expect("a coin");
    let stream = Stream::new(1, Domain::Launch, 2);
    let launch = Preset::Robot
        .distribution()
        .launch(&coin, &mut stream.toss(toss));
    json!({
        "seed": 1, "point": 2, "toss": toss,
        "axis": launch.axis.as_slice(), "spin_rad_s": launch.spin_rad_s.as_slice(),
    })
}
