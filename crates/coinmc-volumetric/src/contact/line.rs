//! Sustained contact on the side: both rims on the surface, no tilt.
//!
//! With u = (1, 0, 0) the two contact points are r = (∓h, 0, −R) and slide at
//! γ_i = (v_x, v_y + R ω_a ∓ h ω_z). In the frame that turns with ω_z,
//!
//! v_x' = ω_z v_y + f_x,  v_y' = −ω_z v_x + f_y,  k_a ω_a' = R f_y − ρ_c σ_c,
//! k_t ω_z' = h (f_2y − f_1y) − ρ_p σ_p,
//!
//! with N_1 + N_2 = 1 (m g) and, as the coin does not tilt,
//! h (N_1 − N_2) = k_t Ω_a ω_z + R f_x, Ω_a = ω_a I_a/I_t: where that asks for a negative force,
//! the coin tips onto the other rim, if contact of that rim alone agrees. Friction is
//! f_i = −μ N_i γ_i/√(γ_i² + ε²), ε = `stick_speed`: sticking is a creep slower than ε. Straight rolling
//! and sliding is the textbook's: a slip v_y + R ω_a decays at the rate μ(1 + R²/k_a), and ω_a of a
//! rolling coin at ρ_c/(k_a + R²).
//!
//! It ends by the decision rule, by weight that holds both rims down for good (under the
//! tilting decision), by tipping, or, once no more than a creep is left besides straight rolling,
//! by the rest of that in closed form.

use super::follow::{Contact, Leave};
use super::integrator::{LEAST_STEP, is_accepted, next_length, shorter, step};
use super::rim::Law;
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use coinmc_core::{Decided, EventKind, Observer};
use std::f64::consts::FRAC_PI_2;

/// v_x, v_y, ω_a, ω_z.
type LineState = [f64; 4];

/// Rates, and the share of the weight that the rim at r = (−h, 0, −R) would bear if the coin could
/// not tip.
struct LineRates {
    rates: LineState,
    share: f64,
}

fn line_rates(law: &Law, state: &LineState, creep: f64) -> LineRates {
    let [vx, vy, wa, wz] = *state;
    let body = &law.body;
    let slip = [
        vy + body.radius * wa - body.half * wz,
        vy + body.radius * wa + body.half * wz,
    ];
    let slide = |y: f64| {
        let scale = -law.friction.mu / (vx * vx + y * y + creep * creep).sqrt();
        (scale * vx, scale * y)
    };
    let ((x1, y1), (x2, y2)) = (slide(slip[0]), slide(slip[1]));
    // h (2 N₁ − 1) = k_t Ω_a ω_z + R (N₁ x₁ + (1 − N₁) x₂)
    let gyro = body.kt * law.axial_factor * wa * wz;
    let share = (gyro + body.half + body.radius * x2) / (2.0 * body.half - body.radius * (x1 - x2));
    let first = share.clamp(0.0, 1.0);
    let second = 1.0 - first;
    let (fx, f1, f2) = (
        first * x1 + second * x2,
        first * y1 + second * y2,
        second * y2 - first * y1,
    );
    let (contour, pivoting) = law.twist(1.0, 0.0, wa, -wz);
    let (linear, angular) = (law.drag.linear, law.drag.angular);
    LineRates {
        rates: [
            wz * vy + fx - linear * vx,
            -wz * vx + f1 - linear * vy,
            (body.radius * f1 - contour) / body.ka - angular * wa,
            (body.half * f2 + pivoting) / body.kt - angular * wz,
        ],
        share,
    }
}

impl Contact<'_> {
    /// Follows the coin on its side until its face is decided or it tips. `true`: onto the rim
    /// that is lowest for the frame of `motion`; `false`: onto the other. Rolling straight counts
    /// as sticking.
    pub(crate) fn lie<O: Observer>(
        &mut self,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Result<bool, Leave> {
        let creep = self.settings.stick_speed;
        // ω_z = −ω_θ where u is horizontal
        let mut state = [motion.vx, motion.vy, spin.axial, -spin.turn];
        let mut length = 0.01;
        lay(self.law, &state, motion, spin);
        if O::ACTIVE && !self.rolls_straight(&state) {
            adapter.event(EventKind::Sliding, motion, spin);
        }
        loop {
            lay(self.law, &state, motion, spin);
            let decided = self.decide(motion, spin);
            if decided != Decided::Open {
                return Err(Leave::Decided(decided));
            }
            let now = line_rates(self.law, &state, creep);
            // not a number tips neither way, and is found out by the integrator
            let this_rim = now.share >= 1.0;
            if (this_rim || now.share <= 0.0) && self.tips(&state, this_rim) {
                return Ok(this_rim);
            }
            if self.rule.is_tilting() && self.lies_for_good(&state) {
                return Err(Leave::Decided(Decided::Side));
            }
            if self.rolls_straight(&state) {
                return Err(self.roll_out(&state, motion, spin, adapter));
            }
            if self.spent.time > self.settings.time_limit {
                return Err(Leave::Late);
            }
            let before = motion.kinetic(&self.law.body, spin);
            let trial = loop {
                self.spent.steps += 1;
                if self.spent.steps >= self.settings.max_steps || length < LEAST_STEP {
                    return Err(Leave::Lost);
                }
                let trial = step(&state, &now.rates, length, self.tolerance, |s: &_| {
                    line_rates(self.law, s, creep).rates
                });
                if is_accepted(trial.error) {
                    break trial;
                }
                length = shorter(length, trial.error);
            };
            let start = state;
            state = self.capped(trial.state, before);
            self.spent.time += length;
            adapter.passed(length, |t| {
                let rates = |s: &LineState| line_rates(self.law, s, creep).rates;
                let trial = step(&start, &now.rates, t, self.tolerance, rates);
                laid(self.law, &self.capped(trial.state, before))
            });
            length = next_length(length, trial.error);
        }
    }

    /// Whether contact of one rim alone, the lowest of the frame or the other, agrees that the coin
    /// tips onto it. (Friction that holds a rim may differ from that of its creep.)
    fn tips(&self, state: &LineState, this_rim: bool) -> bool {
        let [vx, vy, wa, wz] = *state;
        let side = if this_rim { 1.0 } else { -1.0 };
        let body = &self.law.body;
        let slip = side * (vy + body.radius * wa) - body.half * wz;
        let rim = [FRAC_PI_2, 0.0, side * wa, -wz, side * vx, slip];
        self.leans(rim)
    }

    /// Whether the weight holds the coin down on both rims with twice the moment that friction and
    /// gyroscopic torque can raise: μR + k_t|Ω_a ω_z| <= h/2, with ω_a as it is or as it would be
    /// in rolling. Friction then only slows the coin down.
    fn lies_for_good(&self, state: &LineState) -> bool {
        let [vx, vy, wa, wz] = *state;
        let Law { body, friction, .. } = self.law;
        let fastest = wa.abs().max((vx.abs() + vy.abs()) / body.radius);
        let gyroscopic = body.kt * self.law.axial_factor * fastest * wz.abs();
        2.0 * (friction.mu * body.radius + gyroscopic) <= body.half
    }

    /// Whether nothing is left but straight rolling and a creep.
    fn rolls_straight(&self, state: &LineState) -> bool {
        let [vx, vy, wa, wz] = *state;
        let body = &self.law.body;
        let slip = (vy + body.radius * wa).abs() + (body.half * wz).abs() + vx.abs();
        self.law.friction.mu > 0.0 && slip < self.settings.stick_speed
    }

    /// The state with no more kinetic energy than `most`.
    fn capped(&self, state: LineState, most: f64) -> LineState {
        let (motion, spin) = laid(self.law, &state);
        let kinetic = motion.kinetic(&self.law.body, &spin);
        if kinetic > most {
            let scale = (most / kinetic).sqrt();
            state.map(|x| x * scale)
        } else {
            state
        }
    }

    /// The rest of straight rolling, in closed form: v' = −a sgn v − bv with
    /// a = ρ_c R/(k_a + R²) and b = (kR² + k_a k_ω)/(k_a + R²), k and k_ω the rates of drag. With
    /// x = b|v₀|/a, v = v₀ [1 + (1 + 1/x)(e^(−bt) − 1)]; the creep dies away with it.
    fn roll_out<O: Observer>(
        &mut self,
        state: &LineState,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Leave {
        let Law {
            body,
            friction,
            drag,
            ..
        } = self.law;
        let r2 = body.radius * body.radius;
        let a = friction.contour * body.radius / (body.ka + r2);
        let b = (drag.linear * r2 + drag.angular * body.ka) / (body.ka + r2);
        let speed = state[1].abs();
        adapter.event(EventKind::Sticking, motion, spin);
        if a == 0.0 {
            // drag alone never quite stops it; without either it goes on for ever
            return if b > 0.0 {
                Leave::Decided(Decided::Side)
            } else {
                Leave::NeverSettles
            };
        }
        let dragged = b * speed >= 1e-12 * a;
        let time = if dragged {
            libm::log1p(b * speed / a) / b
        } else {
            speed / a
        };
        let left = |t: f64| {
            let lost = if dragged {
                -(1.0 + a / (b * speed)) * libm::expm1(-b * t)
            } else {
                t / time
            };
            (1.0 - lost).max(0.0)
        };
        // pieces over which an observer's place is a matter of Simpson's rule: exact without drag
        let pieces = (10.0 * b * time).ceil().max(1.0);
        let piece = time / pieces;
        let mut begun = 0.0;
        while begun < pieces {
            let start = begun * piece;
            adapter.passed(piece, |t| {
                laid(self.law, &state.map(|rate| rate * left(start + t)))
            });
            self.spent.time += piece;
            begun += 1.0;
        }
        lay(self.law, &[0.0; 4], motion, spin);
        Leave::Decided(Decided::Side)
    }
}

fn laid(law: &Law, state: &LineState) -> (Motion<f64>, Spin<f64>) {
    let (mut motion, mut spin) = (Motion::still(), Spin::still());
    lay(law, state, &mut motion, &mut spin);
    (motion, spin)
}

/// The motion of a coin on its side.
fn lay(law: &Law, state: &LineState, motion: &mut Motion<f64>, spin: &mut Spin<f64>) {
    let [vx, vy, wa, wz] = *state;
    *spin = Spin {
        axial: wa,
        turn: -wz,
        tilt: 0.0,
    };
    motion.lay_down();
    (motion.vx, motion.vy, motion.vz, motion.z) = (vx, vy, 0.0, law.body.radius);
    motion.set_spin(spin, law.axial_factor);
}
