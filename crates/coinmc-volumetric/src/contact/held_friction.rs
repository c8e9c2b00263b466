//! Friction against rolling and pivoting that holds: the torques that keep a rate at zero.
//!
//! Dry friction at rest takes whatever value within its limit keeps the rate at zero, and does no
//! work. The smoothed sign of [`Dynamics::friction_torques`] cannot: to resist a torque T it needs a
//! creep in proportion, and loses the power T² `smoothing_time`/inertia.
//!
//! On a thin coin that rolls along its side that loss is all that matters. Its rocking from rim to
//! rim, at the rate ω_y, turns the axis of its roll and so loads pivoting friction with a torque of
//! (ka − kt) ω_y ω_a = ¼ ω_y ω_a (thin coin, upright, stuck contact); a coin that spins on the
//! spot loads contour friction with (5/2) ω_y ω_z. ω_y is at most about h, the speed that carries
//! the coin out of its well. Where these torques are below the limits, friction holds, and the
//! rocking loses only the share of order h² that the impact of a rim takes (Housner, Bull. Seismol.
//! Soc. Am. 53 (1963) 403). The creep takes a share of the order of `smoothing_time` in a unit of
//! time, whatever h: as much as impacts at H/R = .1, 100 times as much at .01. Coins that roll until
//! they have become slow enough to topple then end on their side. Where h is large against the
//! friction lengths, friction slides while the coin rocks, and the smoothed sign does no harm.
//!
//! # The torques
//! T = N C/s about x and N P about the vertical, |C| <= ρ_c, |P| <= ρ_p, act on ω_x = s ψ' and ω_z.
//! From the rates of ω_a and ω_θ ([`super::rim`]) and θ' = ω_y,
//!
//! ω_x' = e_x − N(m_xx C/s + m_xz P),   e_x = r_x fy − c ω_y (Ω_a − φ'c) + ω_y ω_z,
//! ω_z' = e_z − N(m_xz C/s + m_zz P),   e_z = r_z fy + s ω_y (Ω_a − φ'c) − ω_y ω_x,
//!
//! r_x = R s/ka + h c/kt, r_z = R c/ka − h s/kt, with fy as it is without friction lengths. In slip
//! m_xx = A = s²/ka + c²/kt, m_zz = G = c²/ka + s²/kt, m_xz = c s(1/ka − 1/kt). Where the contact
//! sticks, fy follows the torques, and r_x²/K_yy, r_z²/K_yy and r_x r_z/K_yy are to be subtracted.
//!
//! The torques returned are those for which ω_x' = −ω_x/τ and ω_z' = −ω_z/τ, τ = `smoothing_time`,
//! confined to their limits: a rate at zero stays there without loss, one that is far from it meets
//! the whole of dry friction. Each is confined in turn, given the other (Gauss–Seidel); in a thin
//! coin one of the two always slides until the end: that against rolling in a coin that rolls, that
//! against pivoting in a coin that spins.

use super::dynamics::{Dynamics, Quotients};
use crate::body::levers;
use coinmc_lanes::Lane;

/// Half thickness over friction length below which friction holds a rocking coin. Measured: from 8
/// on P(side) is the same with the smoothed sign to 1e-4, from 5 down it is not
/// (docs/validation/spatial.md).
const HELD: f64 = 10.0;

/// What the torques depend on besides the constants of the scene.
pub(super) struct Load<'a, L> {
    pub(super) s: L,
    pub(super) c: L,
    pub(super) inverse: &'a Quotients<L>,
    pub(super) wy: L,
    pub(super) wa: L,
    pub(super) wt: L,
    /// Ω_a − φ'c.
    pub(super) excess: L,
    pub(super) normal: L,
    /// fy without friction lengths.
    pub(super) fy: L,
    /// How much fy follows the torques: 1/K_yy where the contact sticks, 0 in slip.
    pub(super) follows: L,
}

/// Whether friction holds the rocking of a coin of this half thickness on its side.
pub(super) fn holds_rocking(half: f64, contour: f64, pivoting: f64) -> bool {
    half < HELD * contour.max(pivoting)
}

/// `x`, at most `most` in size.
#[inline(always)]
fn confined<L: Lane>(x: L, most: L) -> L {
    x.min(most).max(-most)
}

impl Dynamics {
    /// (t_a, t_θ): torques of contour and pivoting friction per normal force, where they hold.
    #[inline(always)]
    pub(super) fn held_torques<L: Lane>(&self, load: &Load<'_, L>) -> (L, L) {
        let k = L::splat;
        let Load { s, c, wy, .. } = *load;
        let (radius, half) = levers(&self.body, s, c);
        let (ikt, ika) = (k(self.inverse_kt), k(self.inverse_ka));
        let (rx, rz) = (
            radius * s * ika + half * c * ikt,
            radius * c * ika - half * s * ikt,
        );
        let follows = load.follows;
        let mxx = s * s * ika + c * c * ikt - rx * rx * follows;
        let mzz = c * c * ika + s * s * ikt - rz * rz * follows;
        let mxz = c * s * (ika - ikt) - rx * rz * follows;
        let (wx, wz) = (load.wa * s + load.wt * c, load.wa * c - load.wt * s);
        let turning = wy * load.excess;
        let (fy, rate) = (load.fy, k(self.holding_rate));
        let ex = rx * fy - c * turning + wy * wz + wx * rate;
        let ez = rz * fy + s * turning - wy * wx + wz * rate;
        // a contact that does not press leaves the surface after this step
        let per_normal = k(1.0) / load.normal.max(k(f64::MIN_POSITIVE));
        let (ex, ez) = (ex * per_normal, ez * per_normal);
        let (ixx, izz) = (k(1.0) / mxx, k(1.0) / mzz);
        let most_x = k(self.friction.contour) * load.inverse.sin;
        let most_z = k(self.friction.pivoting);
        let first = confined(ex * ixx, most_x);
        let about = confined((ez - mxz * first) * izz, most_z);
        let along = confined((ex - mxz * about) * ixx, most_x);
        let about = confined((ez - mxz * along) * izz, most_z);
        (along * s + about * c, along * c - about * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Friction};
    use crate::contact::integrator::step;
    use crate::contact::rim::{Mode, OMEGA_A, OMEGA_T, OMEGA_Y, RimState, TILT};
    use crate::drag::Drag;
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;
    use std::f64::consts::FRAC_PI_2;

    /// A thin coin whose rocking friction holds.
    fn thin(ratio: f64, friction: Friction) -> Dynamics {
        let body = Body::new(&Coin::cylinder(ratio, 0.01).expect("a valid coin"));
        let still = Drag {
            linear: 0.0,
            angular: 0.0,
        };
        Dynamics::new(body, friction, still, body.ka / body.kt, 1e-2)
    }

    fn friction(contour: f64, pivoting: f64) -> Friction {
        Friction {
            mu: 0.3,
            contour,
            pivoting,
        }
    }

    /// ω_x and ω_z, and the rates at which they change, from the rates of the state.
    fn turning(state: &RimState<f64>, rates: &RimState<f64>) -> [(f64, f64); 2] {
        let (s, c) = libm::sincos(state[TILT]);
        let along = s * state[OMEGA_A] + c * state[OMEGA_T];
        let about = c * state[OMEGA_A] - s * state[OMEGA_T];
        let wy = state[OMEGA_Y];
        [
            (along, s * rates[OMEGA_A] + c * rates[OMEGA_T] + wy * about),
            (about, c * rates[OMEGA_A] - s * rates[OMEGA_T] - wy * along),
        ]
    }

    /// A coin that spins keeps its ω_x at zero, one that rolls its ω_z, whatever loads them within
    /// the limits of friction, and whether the contact sticks or slips.
    #[test]
    fn a_rate_at_zero_stays_there() {
        let dynamics = thin(0.02, friction(0.1, 0.1));
        for trial in 0..2000 {
            let mut dice = Dice::new(310, trial);
            let spins = dice.chance();
            let (mode, [slip_x, slip_y]) = if dice.chance() {
                (Mode::Stick, [0.0; 2])
            } else {
                let slip = dice.between(0.1, 0.5);
                (Mode::Slip, [slip, slip * dice.between(-0.2, 0.2)])
            };
            let tilt = FRAC_PI_2 - dice.between(0.0, 0.01);
            let (s, c) = libm::sincos(tilt);
            let fast = dice.between(0.5, 2.0);
            let (along, about) = if spins { (0.0, fast) } else { (fast, 0.0) };
            let state = [
                tilt,
                dice.between(-0.01, 0.01),
                along * s + about * c,
                along * c - about * s,
                slip_x,
                slip_y,
            ];
            let now = dynamics.rates(&state, mode);
            let held = turning(&state, &now.state)[usize::from(!spins)];
            assert!(held.0.abs() < 1e-15 && held.1.abs() < 1e-13, "{held:?}");
        }
    }

    /// Far within their limits, both torques are those of the two equations of the module's text but for what two
    /// sweeps of Gauss and Seidel leave: q and q² of the pivoting torque, q = m_xz²/(m_xx m_zz).
    #[test]
    fn two_sweeps_solve_for_both_torques() {
        let dynamics = thin(0.3, friction(1e6, 1e6));
        let (kt, ka) = (dynamics.body.kt, dynamics.body.ka);
        for trial in 0..1000 {
            let mut dice = Dice::new(324, trial);
            let (s, c) = libm::sincos(dice.between(0.3, 1.5));
            let quotients = dynamics.quotients(s, c);
            let mut part = || dice.between(-1.0, 1.0);
            let (wy, wa, wt, excess, fy) = (part(), part(), part(), part(), part());
            let (normal, follows) = (
                1.5 + part(),
                if part() > 0.0 {
                    dynamics.inverse_kyy
                } else {
                    0.0
                },
            );
            let load = Load {
                s,
                c,
                inverse: &quotients,
                wy,
                wa,
                wt,
                excess,
                normal,
                fy,
                follows,
            };
            let (radius, half) = (dynamics.body.radius, dynamics.body.half);
            let (rx, rz) = (
                radius * s / ka + half * c / kt,
                radius * c / ka - half * s / kt,
            );
            let mxx = s * s / ka + c * c / kt - rx * rx * follows;
            let mzz = c * c / ka + s * s / kt - rz * rz * follows;
            let mxz = c * s * (1.0 / ka - 1.0 / kt) - rx * rz * follows;
            let (wx, wz) = (wa * s + wt * c, wa * c - wt * s);
            let ex = rx * fy - c * wy * excess + wy * wz + wx * dynamics.holding_rate;
            let ez = rz * fy + s * wy * excess - wy * wx + wz * dynamics.holding_rate;
            let det = normal * (mxx * mzz - mxz * mxz);
            let (along, about) = ((mzz * ex - mxz * ez) / det, (mxx * ez - mxz * ex) / det);
            let (ta, tt) = dynamics.held_torques(&load);
            let off = (ta * s + tt * c - along, ta * c - tt * s - about);
            let q = mxz * mxz / (mxx * mzz);
            let left = (q * mxz / mxx * about, -(q * q) * about);
            let error = (off.0 - left.0).abs() + (off.1 - left.1).abs();
            assert!(error < 1e-11 * (along.abs() + about.abs()), "{error:e}");
        }
    }

    /// A coin that turns upright on the spot, and rocks so little that contour friction holds,
    /// loses no energy as long as it stands on one rim. (The smoothed sign takes 3e-3 of the
    /// rocking.)
    #[test]
    fn held_rocking_loses_nothing() {
        let dynamics = thin(0.01, friction(3e-3, 0.0));
        let (radius, half) = (dynamics.body.radius, dynamics.body.half);
        let energy = |state: &RimState<f64>| {
            let [tilt, wy, wa, wt, ..] = *state;
            let (s, c) = libm::sincos(tilt);
            let sideways = radius * wa + half * wt;
            let turning = dynamics.body.kt * (wy * wy + wt * wt) + dynamics.body.ka * wa * wa;
            0.5 * (wy * wy + sideways * sideways + turning) + half * c + radius * s
        };
        let (s, c) = libm::sincos(FRAC_PI_2 - 1e-3);
        let mut state = [FRAC_PI_2 - 1e-3, -2e-3, 0.25 * c, -0.25 * s, 0.0, 0.0];
        let before = energy(&state);
        let rocking = 0.5 * (1.0 + dynamics.body.kt) * state[OMEGA_Y].powi(2);
        let mut steps = 0;
        while state[TILT] < FRAC_PI_2 {
            let rates = |state: &RimState<f64>| dynamics.rates(state, Mode::Stick).state;
            state = step(&state, &rates(&state), 1e-3, 1.0, rates).state;
            steps += 1;
        }
        assert!(steps > 500, "{steps}");
        let lost = (before - energy(&state)).abs() / rocking;
        assert!(lost < 1e-6, "{lost:e}");
    }

    /// A rate far from zero meets the whole of dry friction, as the smoothed sign has it.
    #[test]
    fn fast_rates_meet_dry_friction() {
        let dynamics = thin(0.02, friction(5e-3, 4e-3));
        let smoothed = dynamics.with_known::<false, false>();
        assert!(dynamics.holds() && !smoothed.holds());
        for mode in [Mode::Stick, Mode::Slip] {
            for (along, about) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let state = [1.2, 0.1, along - 0.3 * about, -about, 0.2, 0.1];
                let (held, dry) = (dynamics.rates(&state, mode), smoothed.rates(&state, mode));
                for (held, dry) in held.state.iter().zip(dry.state) {
                    assert!((held - dry).abs() < 1e-13, "{mode:?} {held} {dry}");
                }
            }
        }
    }

    #[test]
    fn thick_coins_are_left_to_the_smoothed_sign() {
        assert!(holds_rocking(0.05, 0.01, 0.0));
        assert!(holds_rocking(0.05, 0.0, 0.01));
        assert!(!holds_rocking(0.11, 0.01, 0.01));
        assert!(!holds_rocking(0.005, 0.0, 0.0));
    }
}
