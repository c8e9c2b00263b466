//! A corner that slides with friction: integrated in time with error control and events.
//!
//! With n the direction of the slip γ, s = sin δ, c = cos δ and r = (−s, −c) the corner seen from
//! the centre, Newton–Euler with friction −μ n N and the corner kept on the plane give
//!
//! N = k(1 − ω²c)/A,  A = k + s² + μ n s c,
//! δ' = ω,  ω' = N(s + μ n c)/k,  γ' = ω²s − N[(1 + c²/k)μ n + s c/k].
//!
//! Integrated by Dormand & Prince's embedded pair of order 5(4), J. Comput. Appl. Math. 6 (1980)
//! 19. The phase ends at the first of: slip zero, force zero (ω²c = 1), flat, A → 0 (Painlevé's
//! configuration: see [`SlideEnd::Jams`]).

use crate::motion::Motion;
use crate::shape::Shape;
use coinmc_core::trig::sin_cos;

/// How a sliding phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlideEnd {
    /// Slip has come to zero.
    Stops,
    /// The contact force has vanished.
    LiftsOff,
    /// The next corner has come down: flat on an edge.
    Flat,
    /// A has fallen to almost zero: the force that sliding needs grows without bound.
    Jams,
    /// Energy has fallen below the barrier: the face is certain.
    Certain,
    /// Out of steps.
    Lost,
}

/// A/k below which the configuration counts as Painlevé's.
const JAM: f64 = 1e-2;

/// (δ, ω, γ, x)
type Slide = [f64; 4];

/// The equations of motion for one direction of slip.
struct Sliding {
    k: f64,
    /// μ n, signed friction.
    friction: f64,
}

impl Sliding {
    /// The right-hand side, and A/k.
    #[inline]
    fn rates(&self, y: &Slide) -> (Slide, f64) {
        let [delta, omega, slip, _] = *y;
        let (sin, cos) = sin_cos(delta);
        let w2 = omega * omega;
        let a = (self.k + sin * sin + self.friction * sin * cos) / self.k;
        let normal = (1.0 - w2 * cos) / a;
        let lever = (1.0 + cos * cos / self.k) * self.friction + sin * cos / self.k;
        let rates = [
            omega,
            normal * (sin + self.friction * cos) / self.k,
            w2 * sin - normal * lever,
            slip + omega * cos,
        ];
        (rates, a)
    }
}

/// One Dormand–Prince step: the new state and its error estimate, or `None` where a stage runs
/// into a Painlevé configuration.
fn dormand_prince(sliding: &Sliding, y: &Slide, h: f64) -> Option<(Slide, f64)> {
    const A: [[f64; 6]; 6] = [
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
            0.0,
            0.0,
        ],
        [
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
            0.0,
        ],
        [
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ];
    // fifth-order weights minus fourth-order ones
    const E: [f64; 7] = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];
    let mut stages = [[0.0; 4]; 7];
    let mut state = *y;
    for stage in 0..7 {
        if stage > 0 {
            state = combine(y, h, &A[stage - 1], &stages);
        }
        let (rates, a) = sliding.rates(&state);
        // negated so that a NaN ends here too
        if !(a > 0.5 * JAM && state[0].abs() < 2.0) {
            return None;
        }
        stages[stage] = rates;
    }
    let mut error: f64 = 0.0;
    for i in 0..3 {
        let e: f64 = E
            .iter()
            .zip(&stages)
            .map(|(weight, rates)| weight * rates[i])
            .sum();
        error = error.max((h * e).abs() / (1.0 + state[i].abs()));
    }
    Some((state, error))
}

fn combine(y: &Slide, h: f64, weights: &[f64; 6], stages: &[Slide; 7]) -> Slide {
    let mut state = *y;
    for (weight, rates) in weights.iter().zip(stages) {
        if *weight != 0.0 {
            for (value, rate) in state.iter_mut().zip(rates) {
                *value += h * weight * rate;
            }
        }
    }
    state
}

/// Slip this far backwards counts as zero, in sqrt(D g): a phase that begins at rest, perhaps with
/// zero acceleration, is not ended by the rounding of its first step.
const REST: f64 = 1e-12;

/// What ends the phase, positive while it goes on: slip, force, distance to flat.
fn margins(y: &Slide, direction: f64, shape: &Shape, quadrant: u8) -> [f64; 3] {
    let [delta, omega, slip, _] = *y;
    [
        direction * slip + REST,
        1.0 - omega * omega * sin_cos(delta).1,
        (shape.last_angle(quadrant, 1.0) - delta).min(delta + shape.first_span(quadrant)),
    ]
}

/// How near to its event a phase ends, in units of D, sqrt(D g) and m g.
const EVENT: f64 = 1e-14;

const ENDS: [SlideEnd; 3] = [SlideEnd::Stops, SlideEnd::LiftsOff, SlideEnd::Flat];

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
pub(crate) fn slide(motion: &mut Motion, task: &SlideTask) -> (SlideEnd, f64, u32) {
    let shape = task.shape;
    let direction = 1.0_f64.copysign(task.slip);
    let sliding = Sliding {
        k: shape.k,
        friction: task.mu * direction,
    };
    let mut energy = motion.energy(shape.k);
    let mut y = [motion.delta, motion.omega, task.slip, motion.x];
    // a sixteenth of the time in which the fastest thing here turns by one
    let mut h = 0.06 / (1.0 + motion.omega.abs());
    let mut steps = 0;
    let mut rejected_in_a_row = 0;
    let end = loop {
        if sliding.rates(&y).1 < JAM || rejected_in_a_row > 40 {
            break SlideEnd::Jams;
        }
        if steps == task.max_steps {
            break SlideEnd::Lost;
        }
        steps += 1;
        let Some((next, error)) = dormand_prince(&sliding, &y, h) else {
            h *= 0.25;
            rejected_in_a_row += 1;
            continue;
        };
        if error > task.tolerance {
            h *= (0.9 * fifth_root(task.tolerance / error)).max(0.1);
            rejected_in_a_row += 1;
            continue;
        }
        rejected_in_a_row = 0;
        let (taken, state, event) = first_event(&sliding, &y, (h, next), direction, motion, shape);
        y = state;
        motion.time += taken;
        place(motion, &mut y, energy, shape.k);
        energy = energy.min(motion.energy(shape.k));
        if let Some(end) = event {
            break end;
        }
        if energy < 1.0 {
            break SlideEnd::Certain;
        }
        h *= (0.9 * fifth_root(task.tolerance / error.max(1e-30))).clamp(0.2, 4.0);
        h = h.min(0.25 / (1.0 + y[1].abs()));
    };
    if end == SlideEnd::Flat {
        // exactly flat, so that the next quadrant begins where this one ended
        let outward = y[0];
        motion.delta = shape.last_angle(motion.quadrant, outward);
        let (sin, cos) = sin_cos(motion.delta);
        motion.set_on_corner(sin, cos, y[1], y[2]);
        motion.cap_energy(shape.k, energy);
    }
    let slip = if end == SlideEnd::Stops { 0.0 } else { y[2] };
    (end, slip, steps)
}

/// Writes the integrated state back, taking out what truncation added to the energy; the slip
/// shrinks with the other velocities.
fn place(motion: &mut Motion, y: &mut Slide, energy_before: f64, k: f64) {
    let (sin, cos) = sin_cos(y[0]);
    motion.delta = y[0];
    motion.x = y[3];
    motion.set_on_corner(sin, cos, y[1], y[2]);
    motion.cap_energy(k, energy_before);
    y[1] = motion.omega;
    y[2] = motion.vx - motion.omega * cos;
}

/// The earliest event within an accepted step, located on the length of the step (each trial is a
/// step from `y`, as accurate as the step itself): regula falsi on the margin that is broken, with
/// the Illinois weighting, and every third trial a bisection that guarantees the end.
fn first_event(
    sliding: &Sliding,
    y: &Slide,
    (h, next): (f64, Slide),
    direction: f64,
    motion: &Motion,
    shape: &Shape,
) -> (f64, Slide, Option<SlideEnd>) {
    let at = |state: &Slide| margins(state, direction, shape, motion.quadrant);
    let broken = |margin: &[f64; 3]| margin.iter().position(|m| *m < 0.0);
    let mut right = at(&next);
    let Some(mut which) = broken(&right) else {
        return (h, next, None);
    };
    let (mut inside, mut outside) = ((0.0, *y), h);
    let mut left = at(y);
    let mut weight = 1.0;
    for trial in 1..120 {
        let (a, b) = (left[which] * weight, -right[which]);
        let share = if trial % 3 == 0 || a + b <= 0.0 {
            0.5
        } else {
            a / (a + b)
        };
        let t = inside.0 + share * (outside - inside.0);
        let Some((state, _)) = dormand_prince(sliding, y, t) else {
            break;
        };
        let margin = at(&state);
        if let Some(first) = broken(&margin) {
            weight = if first == which { weight * 0.5 } else { 1.0 };
            (outside, right, which) = (t, margin, first);
        } else {
            (inside, left, weight) = ((t, state), margin, 1.0);
            right[which] *= 0.5;
        }
        if left[which] <= EVENT || outside - inside.0 <= EVENT * h {
            break;
        }
    }
    (inside.0, inside.1, Some(ENDS[which]))
}

/// x^(1/5), for the controller only (a factor within 1 % is as good).
fn fifth_root(x: f64) -> f64 {
    libm::pow(x, 0.2)
}
