//! The events within an impact: corners touch and leave, begin to slide and stop.

use super::equations::{Body, CORNERS, Grip, State};
use super::impact_state::ImpactState;
use super::scale::Scale;
use crate::dormand_prince::Step;

/// A margin of friction is broken this far below zero, in its own unit; nearer, it is rounding.
const BROKEN: f64 = 1e-12;

impl ImpactState {
    /// The first margin that breaks in a step, and the share of the step after which it does: just
    /// beyond the event, so that the next step begins behind it.
    pub(super) fn first_event(&self, step: &Step<11>) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        for which in 0..2 * CORNERS {
            let after = self.margin(&step.end, which);
            if after < 0.0 {
                let share = self.crossing(step, which, after);
                if first.is_none_or(|(earliest, _)| share < earliest) {
                    first = Some((share, which));
                }
            }
        }
        first
    }

    /// Where a margin breaks, as the far end of the bracket: by false position in the Illinois
    /// variant, with some bisections.
    fn crossing(&self, step: &Step<11>, which: usize, end: f64) -> f64 {
        let (mut near, mut far) = (0.0, 1.0);
        let mut low = self.margin(&step.at(0.0), which).max(f64::MIN_POSITIVE);
        let mut high = end;
        for round in 0..60 {
            let cut = far - high * (far - near) / (high - low);
            // every third cut is a bisection, lest a curved margin slows convergence
            let share = if round % 3 == 2 || !(cut > near && cut < far) {
                f64::midpoint(near, far)
            } else {
                cut
            };
            let margin = self.margin(&step.at(share), which);
            if margin < 0.0 {
                (far, high) = (share, margin);
                if margin > -BROKEN {
                    break;
                }
                low *= 0.5;
            } else {
                (near, low) = (share, margin.max(f64::MIN_POSITIVE));
                high *= 0.5;
            }
            if far - near < 1e-14 {
                break;
            }
        }
        far
    }

    /// A dimensionless margin: clearance of each corner first, then friction of each corner.
    fn margin(&self, y: &State, which: usize) -> f64 {
        if which < CORNERS {
            return self.body.clearance(y, which) / self.scale.length;
        }
        let which = which - CORNERS;
        let unit = match self.body.corners[which].grip {
            Grip::Slides(_) => self.scale.speed,
            _ => self.scale.force,
        };
        self.body.hold(y, which) / unit + BROKEN
    }

    /// Changes the grip of the corner whose margin has broken.
    pub(super) fn change(&mut self, margin: usize) {
        let which = margin % CORNERS;
        match (self.body.corners[which].grip, margin < CORNERS) {
            (Grip::Apart, _) => self.touch(which),
            // its spring is unloaded when it touches again
            (_, true) => self.body.corners[which].grip = Grip::Apart,
            (Grip::Slides(direction), _) => {
                let normal = self.body.normal(which, &self.body.place(&self.y, which));
                *Body::spring(&mut self.y, which) =
                    direction * self.body.mu * normal / self.body.tangential;
                self.body.corners[which].grip = Grip::Sticks;
            }
            (Grip::Sticks | Grip::Smooth, _) => {
                let stretch = *Body::spring(&mut self.y, which);
                self.body.corners[which].grip = Grip::Slides(1.0_f64.copysign(stretch));
            }
        }
    }

    /// A corner begins to touch.
    pub(super) fn touch(&mut self, which: usize) {
        let at = self.body.place(&self.y, which);
        // a corner that comes down faster than the first sets the scale: on the scale of a grazing
        // touch, its impact would be resolved a thousand times too finely
        if at.rate > self.scale.speed {
            self.scale = Scale::new(self.body.stiffness, self.body.mass(&at), at.rate);
        }
        let corner = &mut self.body.corners[which];
        corner.damping = self.strength / at.rate.max(self.slowest);
        corner.grip = if self.body.mu == 0.0 {
            Grip::Smooth
        } else if at.slip == 0.0 {
            Grip::Sticks
        } else {
            Grip::Slides(1.0_f64.copysign(at.slip))
        };
        *Body::spring(&mut self.y, which) = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dormand_prince::System;
    use crate::laws::line_contact::equations::Corner;

    /// A corner under the centre, as deep as it gets, that slides to the right and is about to stop.
    fn sliding() -> (ImpactState, Step<11>) {
        let corner = |gap: f64, grip: Grip| Corner {
            x: 0.0,
            z: -1.0,
            gap,
            grip,
            damping: 0.0,
        };
        let mut corners = [corner(1.0, Grip::Apart); CORNERS];
        corners[0] = corner(0.0, Grip::Slides(1.0));
        let body = Body {
            inertia: 0.3,
            stiffness: 1e6,
            mu: 0.3,
            tangential: 0.0,
            corners,
        };
        let mut state = ImpactState::new(body, [0.0, -1.0, 0.0], (1.0, 1.0), (0.0, 0.8), 1e-6);
        state.y[1] = -state.scale.length;
        state.y[4] = 0.0;
        let h = 0.05 * state.scale.time;
        let rates = state.body.rates(&state.y);
        let braking = -(rates[3] + rates[5] * state.body.corners[0].z);
        state.y[3] = 0.4 * braking * h;
        let rates = state.body.rates(&state.y);
        let step = Step::take(&state.body, &state.y, &rates, h);
        (state, step)
    }

    /// The instant at which friction takes the corner along is found to rounding, just beyond it, so that the next
    /// step begins behind it.
    #[test]
    fn events_are_located_just_beyond_their_margin() {
        let (state, step) = sliding();
        let (share, which) = state.first_event(&step).expect("it stops");
        assert_eq!(which, CORNERS);
        assert!(share > 0.1 && share < 0.9, "{share}");
        let hold = |share: f64| state.body.hold(&step.at(share), 0) / state.scale.speed;
        assert!(hold(share) < -0.9 * BROKEN && hold(share) > -2.1 * BROKEN);
        assert!(hold(0.999 * share) > 0.0);
        // nothing breaks where the margin is only rounding below zero
        let (mut state, mut step) = sliding();
        step.end[3] -= state.scale.speed * (hold(1.0) + 0.5 * BROKEN);
        assert_eq!(state.first_event(&step), None);
        step.end[3] -= state.scale.speed * BROKEN;
        assert!(state.first_event(&step).is_some());
        state.change(CORNERS);
        assert_eq!(state.body.corners[0].grip, Grip::Sticks);
    }

    /// The instant at which a corner leaves the surface is found to rounding of its depth, just beyond it.
    #[test]
    fn a_corner_that_leaves_is_found_just_above_the_surface() {
        for share in [0.1, 0.35, 0.8] {
            let (mut state, _) = sliding();
            let length = state.scale.length;
            let h = 0.3 * state.scale.time;
            // slower and slower, so that the height is no line in time
            state.body.corners[0].grip = Grip::Smooth;
            state.y[3] = 0.0;
            state.y[4] = 0.7;
            state.y[1] = -0.7 * share * h;
            let rates = state.body.rates(&state.y);
            let step = Step::take(&state.body, &state.y, &rates, h);
            let (found, which) = state.first_event(&step).expect("it leaves");
            assert_eq!(which, 0);
            let depth = |share: f64| state.body.clearance(&step.at(share), 0) / length;
            assert!(
                depth(found) < 0.0 && depth(found) > -1.1 * BROKEN,
                "{}",
                depth(found)
            );
        }
    }
}
