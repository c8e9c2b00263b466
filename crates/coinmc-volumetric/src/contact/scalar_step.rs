//! One try of a step of one toss, by code that leaves out what the scene lacks: what the compiler knows to
//! be absent takes no operations.

use super::dynamics::Dynamics;
use super::integrator::{Trial, step};
use super::rim::{Mode, Rates, RimFlow, RimState};

/// A step to try, of this length from `state`, whose rates are `now`.
#[derive(Clone, Copy)]
pub(crate) struct ScalarStep<'a> {
    pub(crate) state: &'a RimState<f64>,
    pub(crate) now: &'a Rates<f64>,
    pub(crate) mode: Mode,
    pub(crate) length: f64,
    pub(crate) tolerance: f64,
}

impl ScalarStep<'_> {
    /// The end of the step, and the rates there, on level ground.
    #[inline]
    pub(crate) fn run(&self, dynamics: &Dynamics) -> (Trial<f64, 6>, Rates<f64>) {
        if !dynamics.is_ordinary() {
            return self.run_any(dynamics);
        }
        if dynamics.drag.acts() {
            self.run_known(&dynamics.with_known::<true, false>().with_sharp_rims())
        } else {
            self.run_known(&dynamics.with_known::<false, false>())
        }
    }

    /// The same of a rim that touches ahead of its lowest point.
    #[inline]
    pub(crate) fn run_ahead(&self, dynamics: &Dynamics, ahead: f64) -> (Trial<f64, 6>, Rates<f64>) {
        if dynamics.is_ordinary() && !dynamics.drag.acts() {
            let known = dynamics.with_known::<false, false>();
            self.run_known(&known.touching_ahead(ahead))
        } else {
            self.run_any(&dynamics.touching_ahead(ahead))
        }
    }

    #[inline(never)]
    fn run_any(&self, dynamics: &Dynamics) -> (Trial<f64, 6>, Rates<f64>) {
        if dynamics.body.rim == 0.0 {
            self.run_in(&dynamics.with_sharp_rims(), self.mode)
        } else {
            self.run_in(dynamics, self.mode)
        }
    }

    /// With the mode known to the compiler, too.
    #[inline(always)]
    fn run_known(&self, dynamics: &Dynamics) -> (Trial<f64, 6>, Rates<f64>) {
        match self.mode {
            Mode::Stick => self.run_in(dynamics, Mode::Stick),
            Mode::Slip => self.run_in(dynamics, Mode::Slip),
        }
    }

    #[inline(always)]
    fn run_in(&self, dynamics: &Dynamics, mode: Mode) -> (Trial<f64, 6>, Rates<f64>) {
        let mut last = *self.now;
        let flow = RimFlow {
            dynamics,
            mode,
            last: &mut last,
        };
        let rates = &self.now.state;
        let trial = step(self.state, rates, self.length, self.tolerance, flow);
        (trial, last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Friction};
    use crate::drag::Drag;

    /// Whatever the code leaves out, a step is that of the plain equations of the whole scene: with rounded rims, drag,
    /// a pull, friction that holds, a conical edge, or none of them, on level ground and ahead of the lowest point.
    #[test]
    fn a_step_leaves_out_only_what_the_scene_lacks() {
        let body = Body {
            radius: 0.7,
            half: 0.5,
            rim: 0.0,
            kt: 0.35,
            ka: 0.22,
        };
        let friction = Friction {
            mu: 0.3,
            contour: 0.013,
            pivoting: 0.021,
        };
        let air = Drag {
            linear: 0.4,
            angular: 0.3,
        };
        let airless = Drag {
            linear: 0.0,
            angular: 0.0,
        };
        let rough = Friction {
            pivoting: 0.06,
            ..friction
        };
        let round = Body { rim: 0.1, ..body };
        let scene = |body, friction, drag| Dynamics::new(body, friction, drag, 0.6, 1e-2);
        let scenes = [
            scene(body, friction, airless),
            scene(body, friction, air),
            scene(round, friction, airless),
            scene(round, friction, air),
            scene(body, rough, airless),
            scene(body, rough, air),
            scene(body, friction, airless).pulled_by([0.1, -0.2]),
            scene(body, friction, air).pulled_by([0.1, -0.2]),
            scene(body, friction, airless).on_rim(-0.1),
        ];
        for (number, dynamics) in scenes.iter().enumerate() {
            for mode in [Mode::Stick, Mode::Slip] {
                for ahead in [0.0, 0.15] {
                    let whole = dynamics.touching_ahead(ahead);
                    let state = [0.9, 0.3, -0.4, 0.02, 0.6, -0.2];
                    let now = whole.rates(&state, mode);
                    let tried = ScalarStep {
                        state: &state,
                        now: &now,
                        mode,
                        length: 0.05,
                        tolerance: 1e-4,
                    };
                    let expected = step(&state, &now.state, 0.05, 1e-4, |at: &_| {
                        whole.rates(at, mode).state
                    });
                    let last = whole.rates(&expected.state, mode);
                    let mut found = vec![tried.run_ahead(dynamics, ahead)];
                    if ahead == 0.0 {
                        found.push(tried.run(dynamics));
                    }
                    for (trial, rates) in found {
                        for i in 0..6 {
                            let off = [
                                trial.state[i] - expected.state[i],
                                rates.state[i] - last.state[i],
                            ];
                            assert!(
                                off.iter().all(|off| off.abs() < 1e-12),
                                "{number} {mode:?} {ahead} {off:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}
