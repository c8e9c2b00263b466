//! Pictures of answers that are known.

use super::*;
use crate::aim::{Aim, Parameter};
use coinmc_core::{Face, IntervalMethod};

fn parameter(key: &str, from: f64, to: f64, values: usize) -> Parameter {
    let key = key.to_owned();
    Parameter {
        key,
        from,
        to,
        values,
    }
}

/// An answer whose face is the more likely the higher the place's number, of 1000 tosses each.
fn answer(parameters: Vec<Parameter>, own: Vec<f64>) -> Aimed {
    let plane = crate::aim::plane::Plane::new(&parameters);
    let estimate = |shown| Estimate::new(shown, 0, 1000, 0.95, IntervalMethod::Wilson);
    let place = |index: usize| Place {
        values: plane.at(index),
        estimate: estimate(100 * index as u64),
    };
    let last = plane.len() - 1;
    Aimed {
        question: Aim {
            face: Face::Heads,
            parameters,
            tosses: 1000,
            final_tosses: 1000,
            clumsiness: vec![],
        },
        map: (0..=last).map(place).collect(),
        best: place(last),
        worst: place(0),
        baseline: Place {
            values: own,
            estimate: estimate(250),
        },
        clumsy: vec![],
        confidence: 0.95,
        engine: "flat",
        law: "moreau",
        tosses: 0,
    }
}

/// The fills of the cells, in order.
fn fills(svg: &str) -> Vec<&str> {
    let cells = svg.split("<g ").nth(1).expect("cells");
    let cells = cells.split("</g>").next().expect("an end");
    let fill = |line| str::split(line, '"').nth(9);
    cells.lines().skip(1).filter_map(fill).collect()
}

#[test]
fn a_plane_is_a_heat_map() {
    let plane = vec![
        parameter("launch.height_m", 0.1, 2.0, 2),
        parameter("launch.a<b", 0.0, 4.0, 3),
    ];
    let svg = picture(&answer(plane, vec![0.5, 1.0]));
    let shares = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
    assert_eq!(fills(&svg), shares.map(colour::viridis));
    // the first parameter along x, the second upwards: the best place is at the upper right
    let (x, y) = (
        frame::LEFT + 0.75 * frame::WIDTH,
        frame::TOP + frame::HEIGHT / 6.0,
    );
    let best = format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6.0\" fill=\"#ffffff\"");
    assert!(svg.contains(&best), "{svg}");
    assert!(svg.contains(">0.500 (0.469 to 0.531)</text>"));
    assert!(svg.contains("launch.height_m") && svg.contains("launch.a&lt;b"));
    assert!(!svg.contains("NaN"));
}

/// The config's own launch is marked where it lies in the plane.
#[test]
fn marks_stay_inside() {
    let line = || vec![parameter("launch.height_m", 0.0, 1.0, 5)];
    let lines = |own| picture(&answer(line(), vec![own])).matches("<line").count();
    // a cross is four lines with its border, and its interval one
    assert_eq!(lines(0.5), lines(3.0) + 5);
}

#[test]
fn one_parameter_is_a_curve_with_a_band() {
    let svg = picture(&answer(
        vec![parameter("launch.height_m", 0.0, 1.0, 5)],
        vec![0.5],
    ));
    let points = |element: &str| {
        let found = svg
            .split(&format!("<{element} points=\""))
            .nth(1)
            .expect("points");
        found.split('"').next().expect("an end").split(' ').count()
    };
    assert_eq!((points("polyline"), points("polygon")), (5, 10));
    assert!(!svg.contains("NaN"));
}
