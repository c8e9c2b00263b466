//! A corner that slides with friction: integrated in time with error control and events.

mod equations;
mod events;

use crate::motion::Motion;
use crate::shape::Shape;
use crate::watch::Watch;
use coinmc_core::Observer;
use coinmc_core::trig::sin_cos;
use equations::{Arrival, JAM, Slide, Sliding};
use events::Margins;

/// How a sliding phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlideEnd {
    /// Slip has come to zero.
    Stops,
    /// The contact force has vanished.
    LiftsOff,
    /// The next corner has come down: flat on an edge.
    Flat,
    /// The force that sliding needs grows without bound: Painlevé's configuration.
    Jams,
    /// Energy has fallen below the barrier: the face is certain.
    Certain,
    /// Out of steps.
    Lost,
}

/// What the sliding phase is told beside the motion.
pub(crate) struct SlideTask<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) mu: f64,
    /// Slip velocity; its sign, or where it is zero that of the slip about to begin.
    pub(crate) slip: f64,
    pub(crate) tolerance: f64,
    pub(crate) max_steps: u32,
}

/// Slides until the phase ends. The motion is left on its corner; returns why, the slip and the
/// steps taken.
pub(crate) fn slide<O: Observer>(
    motion: &mut Motion,
    task: &SlideTask,
    watch: &mut Watch<'_, O>,
) -> (SlideEnd, f64, u32) {
    let shape = task.shape;
    let direction = 1.0_f64.copysign(task.slip);
    let sliding = Sliding {
        k: shape.k,
        friction: task.mu * direction,
    };
    let margins = Margins {
        shape,
        quadrant: motion.quadrant,
        direction,
    };
    let mut energy = motion.energy(shape.k);
    let mut y = [motion.delta, motion.omega, task.slip, motion.x];
    // a fraction of the time in which the fastest thing here turns by one
    let mut h = 0.2 / (1.0 + motion.omega.abs());
    let mut steps = 0;
    let mut rejected_in_a_row = 0;
    let end = loop {
        let Some(rates) = sliding.rates(&y) else {
            break SlideEnd::Jams;
        };
        if sliding.openness(y[0]) < JAM || rejected_in_a_row > 40 {
            break SlideEnd::Jams;
        }
        if steps == task.max_steps {
            break SlideEnd::Lost;
        }
        steps += 1;
        let start = Arrival { state: y, rates };
        let Some((next, error)) = sliding.step_with_error(&start, h) else {
            h *= 0.25;
            rejected_in_a_row += 1;
            continue;
        };
        if error > task.tolerance {
            h *= growth(task.tolerance, error).max(0.1);
            rejected_in_a_row += 1;
            continue;
        }
        if let Some(shorter) = margins.dip(&start, &next, h)
            && shorter < 0.99 * h
        {
            h = shorter;
            rejected_in_a_row += 1;
            continue;
        }
        rejected_in_a_row = 0;
        let event = margins.first_event(&sliding, &start, &next, h);
        let (taken, state) = event.map_or((h, next.state), |(taken, state, _)| (taken, state));
        let before = *motion;
        y = state;
        motion.time += taken;
        watch.passed(before.time, motion.time, |t| {
            let mut motion = before;
            // a part of a step that was accepted is a step that can be made
            if let Some((mut y, _)) = sliding.step(&start, t) {
                place(&mut motion, &mut y, energy, shape.k);
            }
            motion
        });
        place(motion, &mut y, energy, shape.k);
        energy = energy.min(motion.energy(shape.k));
        if let Some((.., end)) = event {
            break end;
        }
        if energy < 1.0 {
            break SlideEnd::Certain;
        }
        h = (h * growth(task.tolerance, error).clamp(0.2, 4.0)).min(0.5 / (1.0 + y[1].abs()));
    };
    if end == SlideEnd::Flat {
        // exactly flat, so that the next quadrant begins where this one ended
        motion.delta = shape.last_angle(motion.quadrant, y[0]);
        let (sin, cos) = sin_cos(motion.delta);
        motion.set_on_corner(sin, cos, y[1], y[2]);
        motion.cap_energy(shape.k, energy);
    }
    let slip = if end == SlideEnd::Stops { 0.0 } else { y[2] };
    (end, slip, steps)
}

/// By how much the next step may be longer: the usual exponent for a pair of order 5(4), and the
/// usual caution.
#[inline]
fn growth(tolerance: f64, error: f64) -> f64 {
    0.9 * libm::pow(tolerance / error.max(1e-30), 0.2)
}

/// Writes the integrated state back, taking out what truncation added to the energy; the slip
/// shrinks with the other velocities.
#[inline]
fn place(motion: &mut Motion, y: &mut Slide, energy_before: f64, k: f64) {
    let (sin, cos) = sin_cos(y[0]);
    motion.delta = y[0];
    motion.x = y[3];
    motion.set_on_corner(sin, cos, y[1], y[2]);
    motion.cap_energy(k, energy_before);
    y[1] = motion.omega;
    y[2] = motion.vx - motion.omega * cos;
}
