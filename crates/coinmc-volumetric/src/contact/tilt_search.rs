//! The search for the length of the step that ends where another rim point touches.

use super::phase::{Exit, Phase, PhaseTransition};
use super::rim::{OMEGA_Y, RimState, TILT};
use super::step::SIDE_ANGLE;
use crate::motion::FLAT;

/// Most tries of a search; bisection alone needs as many.
const MOST_TRIES: u32 = 40;

/// Newton's method in a bracket for the step length at which the tilt reaches a goal. Each
/// evaluation is one try of the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TiltSearch {
    goal: f64,
    /// The exit at the goal.
    exit: Exit,
    low: f64,
    high: f64,
    /// Length of the last try, or of the next one.
    pub(crate) length: f64,
    tries: u32,
}

impl TiltSearch {
    /// The search, if the step of this length from `phase` to `state` passes a goal: level, or the
    /// tilt `side`.
    #[inline]
    pub(crate) fn within(
        phase: &Phase,
        state: &RimState<f64>,
        length: f64,
        side: f64,
    ) -> Option<Self> {
        let tilt = state[TILT];
        let arrives = tilt > side - SIDE_ANGLE && state[OMEGA_Y] > 0.0;
        // a tilt beyond the side has passed it within the step, even if it decreases again
        let (goal, exit) = if arrives || tilt > side + SIDE_ANGLE {
            (side, Exit::OtherRim)
        } else if tilt < FLAT && phase.state[TILT] > FLAT {
            (FLAT, Exit::Level)
        } else {
            return None;
        };
        Some(Self {
            goal,
            exit,
            low: 0.0,
            high: length,
            length,
            tries: 0,
        })
    }

    /// Whether the last try, which led to `state`, missed the goal; `length` is that of the next
    /// try then.
    pub(crate) fn needs_another_try(&mut self, state: &RimState<f64>) -> bool {
        let gap = state[TILT] - self.goal;
        if self.tries == MOST_TRIES || gap.abs() <= SIDE_ANGLE {
            return false;
        }
        self.tries += 1;
        // the side of the goal where the phase is (it may start at the goal itself, and come back)
        let before = if self.exit == Exit::OtherRim {
            -1.0
        } else {
            1.0
        };
        if gap * before > 0.0 {
            self.low = self.length;
        } else {
            self.high = self.length;
        }
        let newton = self.length - gap / state[OMEGA_Y];
        self.length = if newton > self.low && newton < self.high {
            newton
        } else {
            0.5 * (self.low + self.high)
        };
        true
    }

    /// Ends the step at the goal; returns the exit and the length of the step.
    pub(crate) fn finish(
        &self,
        phase: &mut Phase,
        mut state: RimState<f64>,
    ) -> (PhaseTransition, f64) {
        state[TILT] = self.goal;
        phase.state = state;
        (PhaseTransition::Leave(self.exit), self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::Dice;

    /// A step of length l turns the coin by l^n of its whole way: Newton's method is far beyond the bracket for small n,
    /// and creeps for large n. The step ends where the tilt is at its goal, the side or level.
    #[test]
    fn a_step_ends_where_the_tilt_reaches_its_goal() {
        for trial in 0..2_000 {
            let mut dice = Dice::new(519, trial);
            let (power, whole) = (libm::exp(dice.between(-2.0, 2.0)), dice.between(0.01, 1.0));
            let level = trial % 2 == 0;
            let side = 1.2;
            let start = if level {
                dice.between(0.01, 0.1)
            } else {
                dice.between(0.9, 1.19)
            };
            let goal = if level { FLAT } else { side };
            let reached = dice.between(0.05, 0.95) * whole;
            let turned = (goal - start) / libm::pow(reached, power);
            let after = |length: f64| {
                let mut state = [0.0; 6];
                state[TILT] = start + turned * libm::pow(length, power);
                state[OMEGA_Y] = turned * power * libm::pow(length, power - 1.0);
                state
            };
            let mut phase = Phase::none();
            phase.state[TILT] = start;
            assert!(TiltSearch::within(&phase, &after(0.9 * reached), whole, side).is_none());
            let mut search =
                TiltSearch::within(&phase, &after(whole), whole, side).expect("it passes");
            while search.needs_another_try(&after(search.length)) {
                assert!(search.low <= reached && reached <= search.high);
            }
            assert!(search.tries < MOST_TRIES);
            assert!((after(search.length)[TILT] - goal).abs() <= SIDE_ANGLE);
            let (transition, length) = search.finish(&mut phase, after(search.length));
            assert!(
                (length - reached).abs() < 1e-6 * whole,
                "{length} {reached}"
            );
            assert_eq!(phase.state[TILT].to_bits(), goal.to_bits());
            let exit = if level { Exit::Level } else { Exit::OtherRim };
            assert!(matches!(transition, PhaseTransition::Leave(found) if found == exit));
        }
    }

    /// A coin arrives at its side where it rises to it, or is beyond it whatever it does then; one that lies there or
    /// sinks from there does not. It becomes level only from above.
    #[test]
    fn a_step_arrives_where_the_tilt_passes_the_side_or_becomes_level() {
        let side = 1.3;
        let exit = |from: f64, tilt: f64, rate: f64| {
            let mut phase = Phase::none();
            phase.state[TILT] = from;
            let mut state = [0.0; 6];
            (state[TILT], state[OMEGA_Y]) = (tilt, rate);
            TiltSearch::within(&phase, &state, 0.1, side).map(|search| search.exit)
        };
        let (near, far) = (0.5 * SIDE_ANGLE, 2.0 * SIDE_ANGLE);
        for (tilt, rates) in [
            (side - far, [false; 3]),
            (side - near, [false, false, true]),
            (side + near, [false, false, true]),
            (side + far, [true; 3]),
        ] {
            for (rate, arrives) in [-0.2, 0.0, 0.2].into_iter().zip(rates) {
                let found = exit(1.1, tilt, rate);
                assert_eq!(found == Some(Exit::OtherRim), arrives, "{tilt} {rate}");
                assert!(arrives || found.is_none());
            }
        }
        assert_eq!(exit(2.0 * FLAT, 0.5 * FLAT, -0.1), Some(Exit::Level));
        assert_eq!(exit(2.0 * FLAT, 1.5 * FLAT, -0.1), None);
        assert_eq!(exit(FLAT, 0.5 * FLAT, -0.1), None);
        assert_eq!(exit(0.7 * FLAT, 0.5 * FLAT, -0.1), None);
    }
}
