//! Conversion between the motion of a coin and the state of its contact; impulses in contact.

use super::dynamics::Dynamics;
use super::rim::{OMEGA_A, OMEGA_T, OMEGA_Y, RimState, SLIP_X, SLIP_Y, TILT};
use crate::body::levers;
use crate::impact::{ContactPoint, Impulse};
use crate::motion::{FLAT, Motion, Spin};
use crate::series::sin_cos_tilt;
use coinmc_lanes::{Lane, Mask};

/// The state of a motion whose lowest point stays on the surface.
pub(crate) fn rim_state(
    dynamics: &Dynamics,
    motion: &Motion<f64>,
    spin: &Spin<f64>,
) -> RimState<f64> {
    let mut point = motion.contact_point(&dynamics.body, spin);
    if dynamics.ahead != 0.0 {
        point.slip_x -= dynamics.drift(motion.sin, motion.cos, spin.axial, spin.turn);
    }
    [
        // the azimuth of a level coin is not defined: start where it is
        libm::atan2(motion.sin, motion.cos).max(FLAT),
        spin.tilt,
        spin.axial,
        spin.turn,
        point.slip_x,
        point.slip_y,
    ]
}

/// Sets the motion of a state.
#[inline(always)]
pub(crate) fn place<L: Lane>(
    dynamics: &Dynamics,
    state: &RimState<L>,
    motion: &mut Motion<L>,
    spin: &mut Spin<L>,
) {
    let least = L::splat(dynamics.least_cos);
    place_at_tilt(dynamics, state, motion, spin, |motion, sin, cos| {
        motion.set_tilt_above(sin, cos, least);
    });
}

/// The same for a coin whose axis may point down.
pub(crate) fn place_unfolded(
    dynamics: &Dynamics,
    state: &RimState<f64>,
    motion: &mut Motion<f64>,
    spin: &mut Spin<f64>,
) {
    place_at_tilt(dynamics, state, motion, spin, |motion, sin, cos| {
        (motion.sin, motion.cos) = (sin, cos);
    });
}

#[inline(always)]
fn place_at_tilt<L: Lane>(
    dynamics: &Dynamics,
    state: &RimState<L>,
    motion: &mut Motion<L>,
    spin: &mut Spin<L>,
    set_tilt: impl FnOnce(&mut Motion<L>, L, L),
) {
    let (s, c) = sin_cos_tilt(state[TILT]);
    let (radius, half) = (L::splat(dynamics.body.radius), L::splat(dynamics.body.half));
    *spin = Spin {
        tilt: state[OMEGA_Y],
        axial: state[OMEGA_A],
        turn: state[OMEGA_T],
    };
    set_tilt(motion, s, c);
    motion.vz = spin.tilt * (radius * c - half * s);
    motion.z = half * c + radius * s;
    motion.vx = state[SLIP_X] + spin.tilt * (motion.z + L::splat(dynamics.body.rim));
    if dynamics.ahead != 0.0 {
        motion.vx += dynamics.drift(s, c, spin.axial, spin.turn);
    }
    let (radius, half) = levers(&dynamics.body, s, c);
    motion.vy = state[SLIP_Y] - radius * spin.axial - half * spin.turn;
    motion.set_spin(spin, dynamics.axial_factor);
}

/// Sets the motion of a state, with no more energy than `ceiling`: all velocities are scaled
/// together.
#[inline(always)]
pub(super) fn place_below<L: Lane>(
    dynamics: &Dynamics,
    state: &mut RimState<L>,
    motion: &mut Motion<L>,
    spin: &mut Spin<L>,
    ceiling: L,
) {
    place(dynamics, state, motion, spin);
    let kinetic = motion.kinetic(&dynamics.body, spin);
    let allowed = ceiling - motion.z;
    let over = allowed.lt(kinetic);
    if over.any() {
        // at rest the height alone may exceed the energy, by rounding
        let kinetic = kinetic.max(L::splat(f64::MIN_POSITIVE));
        let scale = (allowed.max(L::splat(0.0)) / kinetic).sqrt();
        let scale = L::select(over, scale, L::splat(1.0));
        for component in &mut state[OMEGA_Y..=SLIP_Y] {
            *component *= scale;
        }
        place(dynamics, state, motion, spin);
    }
}

/// The state with another slip: an impulse at the contact point changes it, and leaves the normal
/// velocity as it is.
pub(super) fn change_slip(
    dynamics: &Dynamics,
    state: &RimState<f64>,
    gx: f64,
    gy: f64,
) -> RimState<f64> {
    let mut after = after_impulse(dynamics, state, |point| {
        let k = point.matrix(&dynamics.body);
        // at constant normal velocity; det K = K_xx + K_zz − 1 in the xz plane
        let x = (gx - point.slip_x) * k.zz / (k.xx + k.zz - 1.0);
        Impulse {
            x,
            y: (gy - point.slip_y) / k.yy,
            z: -(k.xz / k.zz) * x,
            contour: 0.0,
            pivoting: 0.0,
        }
    });
    (after[SLIP_X], after[SLIP_Y]) = (gx, gy);
    after
}

/// The state after an impulse at the contact point.
pub(super) fn after_impulse(
    dynamics: &Dynamics,
    state: &RimState<f64>,
    impulse: impl FnOnce(&ContactPoint<f64>) -> Impulse<f64>,
) -> RimState<f64> {
    let mut motion = Motion::still();
    let mut spin = Spin::still();
    place(dynamics, state, &mut motion, &mut spin);
    let point = motion.contact_point(&dynamics.body, &spin);
    motion.apply_impulse(&mut spin, &dynamics.body, &point, impulse(&point));
    let after = motion.contact_point(&dynamics.body, &spin);
    [
        state[TILT],
        spin.tilt,
        spin.axial,
        spin.turn,
        after.slip_x,
        after.slip_y,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Friction;
    use crate::contact::tests::{STILL, dynamics};
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// The centre's velocity, the angular momentum about it and the arm of the contact point, in the triad's frame.
    fn vectors(dynamics: &Dynamics, state: &RimState<f64>) -> [Vector3<f64>; 3] {
        let [tilt, wy, wa, wt, gx, gy] = *state;
        let (s, c) = libm::sincos(tilt);
        let (u, across) = (Vector3::new(s, 0.0, c), Vector3::new(c, 0.0, -s));
        let body = &dynamics.body;
        let arm = across * body.radius - u * body.half;
        let spin = u * wa + across * wt + Vector3::y() * wy;
        let turning = u * body.ka * wa + (across * wt + Vector3::y() * wy) * body.kt;
        [Vector3::new(gx, gy, 0.0) - spin.cross(&arm), turning, arm]
    }

    /// One impulse at the contact point explains the changes of velocity and of angular momentum; the point has
    /// the slip that was asked for, and stays on the surface.
    #[test]
    fn another_slip_comes_from_one_impulse_at_the_contact_point() {
        let friction = Friction {
            mu: 0.3,
            contour: 0.0,
            pivoting: 0.0,
        };
        for trial in 0..500 {
            let mut dice = Dice::new(320, trial);
            let dynamics = dynamics(libm::exp(dice.between(-3.0, 1.0)), friction, STILL, true);
            let mut part = || dice.between(-1.0, 1.0);
            let state = [1.0 + 0.5 * part(), part(), part(), part(), part(), part()];
            let asked = [part(), part()];
            let after = change_slip(&dynamics, &state, asked[0], asked[1]);
            assert_eq!([after[SLIP_X], after[SLIP_Y]], asked);
            let [before, turned, arm] = vectors(&dynamics, &state);
            let [velocity, turning, _] = vectors(&dynamics, &after);
            let impulse = velocity - before;
            let off = turning - turned - arm.cross(&impulse);
            assert!(off.norm() < 1e-13, "{off}");
        }
    }
}
