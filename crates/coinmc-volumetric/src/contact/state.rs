//! From the motion of a coin to the state of its contact, and back; impulses in contact.

use super::follow::FLAT;
use super::rim::{Law, OMEGA_A, OMEGA_T, OMEGA_Y, RimState, SLIP_X, SLIP_Y, TILT};
use crate::impact::{Impulse, Touch};
use crate::motion::{Motion, Spin};
use crate::series::sin_cos_tilt;
use coinmc_lanes::{Lane, Mask};

/// The contact's state of a motion whose lowest point stays on the surface.
pub(super) fn rim_state(law: &Law, motion: &Motion<f64>, spin: &Spin<f64>) -> RimState<f64> {
    let touch = motion.touch(&law.body, spin);
    [
        // a level coin begins where the azimuth is a number
        libm::atan2(motion.sin, motion.cos).max(FLAT),
        spin.tilt,
        spin.axial,
        spin.turn,
        touch.slip_x,
        touch.slip_y,
    ]
}

/// The motion of a state.
#[inline(always)]
pub(crate) fn place<L: Lane>(
    law: &Law,
    state: &RimState<L>,
    motion: &mut Motion<L>,
    spin: &mut Spin<L>,
) {
    let (s, c) = sin_cos_tilt(state[TILT]);
    let (radius, half) = (L::splat(law.body.radius), L::splat(law.body.half));
    *spin = Spin {
        tilt: state[OMEGA_Y],
        axial: state[OMEGA_A],
        turn: state[OMEGA_T],
    };
    motion.set_tilt(s, c);
    motion.vx = state[SLIP_X] + spin.tilt * (half * c + radius * s);
    motion.vy = state[SLIP_Y] - radius * spin.axial - half * spin.turn;
    motion.vz = spin.tilt * (radius * c - half * s);
    motion.z = half * c + radius * s;
    motion.set_spin(spin, law.axial_factor);
}

/// The motion of a state, with no more energy than `ceiling`: the velocities shrink together.
#[inline(always)]
pub(super) fn place_below<L: Lane>(
    law: &Law,
    state: &mut RimState<L>,
    motion: &mut Motion<L>,
    spin: &mut Spin<L>,
    ceiling: L,
) {
    place(law, state, motion, spin);
    let kinetic = motion.kinetic(&law.body, spin);
    let allowed = ceiling - motion.z;
    let over = allowed.lt(kinetic);
    if over.any() {
        let scale = (allowed.max(L::splat(0.0)) / kinetic).sqrt();
        let scale = L::select(over, scale, L::splat(1.0));
        for component in &mut state[OMEGA_Y..=SLIP_Y] {
            *component *= scale;
        }
        place(law, state, motion, spin);
    }
}

/// The state with another slip, by an impulse at the contact that leaves its normal velocity.
pub(super) fn change_slip(law: &Law, state: &RimState<f64>, gx: f64, gy: f64) -> RimState<f64> {
    let mut after = kicked(law, state, |touch| {
        let k = touch.matrix(&law.body);
        // at constant normal velocity; det K = K_xx + K_zz − 1 in the xz plane
        let x = (gx - touch.slip_x) * k.zz / (k.xx + k.zz - 1.0);
        Impulse {
            x,
            y: (gy - touch.slip_y) / k.yy,
            z: -(k.xz / k.zz) * x,
            contour: 0.0,
            pivoting: 0.0,
        }
    });
    (after[SLIP_X], after[SLIP_Y]) = (gx, gy);
    after
}

/// The state after an impulse at the contact.
pub(super) fn kicked(
    law: &Law,
    state: &RimState<f64>,
    impulse: impl FnOnce(&Touch<f64>) -> Impulse<f64>,
) -> RimState<f64> {
    let mut motion = Motion::still();
    let mut spin = Spin::still();
    place(law, state, &mut motion, &mut spin);
    let touch = motion.touch(&law.body, &spin);
    motion.strike(&mut spin, &law.body, &touch, impulse(&touch));
    let after = motion.touch(&law.body, &spin);
    [
        state[TILT],
        spin.tilt,
        spin.axial,
        spin.turn,
        after.slip_x,
        after.slip_y,
    ]
}
