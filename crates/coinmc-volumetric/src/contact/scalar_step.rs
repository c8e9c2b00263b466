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
