//! Films and fits that the tests of this folder and of its neighbours share.

mod aloft;
mod bounces;
mod limits;

use super::Fit;
use super::problem::{Point, Problem, Task, Weighing};
use crate::drop::FilmedDrop;
use crate::law::Model;
use crate::parameter::{Parameter, Shared};
use crate::synthetic::Synthetic;
use coinmc_core::Coin;
use coinmc_flat::Law;

pub(super) const SIGMA: [f64; 3] = [2e-4, 5e-4, 3e-3];
pub(super) const START: [f64; 6] = [0.1, 0.2, 5.0, 0.3, 0.4, 7.0];

pub(crate) fn model() -> Model {
    Model {
        law: Law::Moreau,
        coin: Coin::cylinder(1.0, 0.01).expect("a coin"),
        gravity_m_s2: 9.81,
    }
}

/// A fit of nothing, to be filled in.
pub(crate) fn blank() -> Fit {
    Fit {
        model: model(),
        parameters: Vec::new(),
        shared: Shared::default(),
        drops: Vec::new(),
        noise: Vec::new(),
        n: 0,
        fitted: 0,
        log_likelihood: 0.0,
        confidence: 0.95,
        remarks: Vec::new(),
        residuals: Vec::new(),
    }
}

/// A drop that falls for so long, s, without touching the ground.
pub(super) fn aloft(seed: u64, duration_s: f64) -> FilmedDrop {
    let film = Synthetic {
        seed,
        start: START,
        duration_s,
        ..Synthetic::default()
    };
    film.film(&model()).expect("a film")
}

/// All frames of the drops, at the states that they were made from.
pub(super) fn at_the_truth<'a>(task: &'a Task<'a>, free: &[Parameter]) -> Problem<'a> {
    let weighing = Weighing {
        frames: task.drops.iter().map(|drop| drop.frames.len()).collect(),
        sigma: SIGMA,
    };
    let point = Point {
        shared: Shared::default(),
        starts: vec![START; task.drops.len()],
    };
    Problem::new(task, weighing, free, point)
}

/// The first frames of the film that [`Synthetic`] makes by default, which bounces, at what it was made from.
pub(super) fn at_bounces<'a>(task: &'a Task<'a>, free: &[Parameter], frames: usize) -> Problem<'a> {
    let film = Synthetic::default();
    let weighing = Weighing {
        frames: vec![frames],
        sigma: [5e-4, 5e-4, 0.5_f64.to_radians()],
    };
    let point = Point {
        shared: film.shared,
        starts: vec![film.start],
    };
    Problem::new(task, weighing, free, point)
}
