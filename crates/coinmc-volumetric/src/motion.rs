//! The state of the toss and the frame it is held in.
//!
//! # The folded frame
//! Heads and tails are mirror images, and so is a turn of the world about the vertical: the state
//! is held in a frame that turns with the coin and is reflected so that u always points up.
//! x is the horizontal direction u leans to, z is up, y = z × x:
//!
//! u = (s, 0, c) with s, c >= 0,  e_θ = (c, 0, −s),  y.
//!
//! Whether +u itself is up is a flag beside the motion. The lowest point is then always
//! r = R e_θ − h u (h = H/2), that is rx = c R − s h, rz = −c h − s R; no formula has a case for
//! the other rim, and u → −u gives the same numbers to the last bit.
//!
//! # The rotation vector
//! A free symmetric top turns about its fixed angular momentum: Ω = L/I_t, with the components
//! Ω_a = ω_a I_a/I_t along u and Ω_t = ω_θ, Ω_y = ω_y across. Without gyroscopic torque it turns
//! about its fixed ω. Both flights are "u turns about Ω"; they differ in Ω_a/ω_a alone.

use crate::body::Body;
use crate::impact::{Impulse, Touch};
use coinmc_core::DecisionState;
use coinmc_lanes::{Lane, Mask};

/// Position and velocity in the folded frame; lengths in D, times in sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<L> {
    /// s, c: sine and cosine of the tilt of u.
    pub(crate) sin: L,
    pub(crate) cos: L,
    /// Ω, x component.
    pub(crate) ox: L,
    pub(crate) oy: L,
    pub(crate) oz: L,
    /// Velocity of the centre.
    pub(crate) vx: L,
    pub(crate) vy: L,
    pub(crate) vz: L,
    /// Height of the centre.
    pub(crate) z: L,
}

/// Angular velocity in the triad (u, e_θ, y).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spin<L> {
    pub(crate) axial: L,
    pub(crate) turn: L,
    pub(crate) tilt: L,
}

/// Least sine of the tilt: the frame needs a direction to lean to, and quotients by s stay finite.
pub(crate) const LEAST_SIN: f64 = 1e-18;

impl<T: Copy> Motion<T> {
    /// All numbers, for memory.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> [T; 9] {
        [
            self.sin, self.cos, self.ox, self.oy, self.oz, self.vx, self.vy, self.vz, self.z,
        ]
    }

    /// The motion of [`numbers`](Self::numbers).
    #[inline(always)]
    pub(crate) fn of(numbers: &[T; 9]) -> Self {
        let [sin, cos, ox, oy, oz, vx, vy, vz, z] = *numbers;
        Self {
            sin,
            cos,
            ox,
            oy,
            oz,
            vx,
            vy,
            vz,
            z,
        }
    }
}

impl<T: Copy> Spin<T> {
    /// All numbers, for memory.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> [T; 3] {
        [self.axial, self.turn, self.tilt]
    }

    /// The angular velocity of [`numbers`](Self::numbers).
    #[inline(always)]
    pub(crate) fn of(&[axial, turn, tilt]: &[T; 3]) -> Self {
        Self { axial, turn, tilt }
    }
}

/// [`Lane::select`] of several.
#[inline(always)]
fn select_all<L: Lane, const N: usize>(mask: L::Mask, yes: &[L; N], no: &[L; N]) -> [L; N] {
    let mut chosen = *no;
    for (chosen, yes) in chosen.iter_mut().zip(yes) {
        *chosen = L::select(mask, *yes, *chosen);
    }
    chosen
}

impl<L: Lane> Spin<L> {
    /// `yes` where the mask is set, else `no`.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self::of(&select_all(mask, &yes.numbers(), &no.numbers()))
    }

    pub(crate) fn still() -> Self {
        let zero = L::splat(0.0);
        Self {
            axial: zero,
            turn: zero,
            tilt: zero,
        }
    }
}

impl<L: Lane> Motion<L> {
    /// `yes` where the mask is set, else `no`.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self::of(&select_all(mask, &yes.numbers(), &no.numbers()))
    }

    pub(crate) fn still() -> Self {
        let zero = L::splat(0.0);
        Self {
            sin: zero,
            cos: L::splat(1.0),
            ox: zero,
            oy: zero,
            oz: zero,
            vx: zero,
            vy: zero,
            vz: zero,
            z: zero,
        }
    }

    #[inline(always)]
    pub(crate) fn set_tilt(&mut self, sin: L, cos: L) {
        self.sin = sin.max(L::splat(LEAST_SIN));
        self.cos = cos.max(L::splat(0.0));
    }

    /// The tilt of a coin exactly on its side.
    pub(crate) fn lay_down(&mut self) {
        self.sin = L::splat(1.0);
        self.cos = L::splat(0.0);
    }

    /// Half a turn of the frame about the vertical.
    pub(crate) fn turn_frame(&mut self) {
        self.ox = -self.ox;
        self.oy = -self.oy;
        self.vx = -self.vx;
        self.vy = -self.vy;
    }

    /// The horizontal axes turned so that x points along the unit vector (`nx`, `ny`).
    #[inline(always)]
    pub(crate) fn align(&mut self, nx: L, ny: L) {
        (self.vx, self.vy) = (self.vx * nx + self.vy * ny, self.vy * nx - self.vx * ny);
        (self.ox, self.oy) = (self.ox * nx + self.oy * ny, self.oy * nx - self.ox * ny);
    }

    /// Height of the centre when the lowest point touches.
    #[inline(always)]
    pub(crate) fn rest_height(&self, body: &Body) -> L {
        L::splat(body.half) * self.cos + L::splat(body.radius) * self.sin
    }

    /// Angular velocity; `axial_factor` is Ω_a/ω_a.
    #[inline(always)]
    pub(crate) fn spin(&self, axial_factor: f64) -> Spin<L> {
        Spin {
            axial: (self.ox * self.sin + self.oz * self.cos) * L::splat(1.0 / axial_factor),
            turn: self.ox * self.cos - self.oz * self.sin,
            tilt: self.oy,
        }
    }

    #[inline(always)]
    pub(crate) fn set_spin(&mut self, spin: &Spin<L>, axial_factor: f64) {
        let axial = spin.axial * L::splat(axial_factor);
        self.ox = axial * self.sin + spin.turn * self.cos;
        self.oz = axial * self.cos - spin.turn * self.sin;
        self.oy = spin.tilt;
    }

    /// What an impact law sees of the lowest point.
    #[inline(always)]
    pub(crate) fn touch(&self, body: &Body, spin: &Spin<L>) -> Touch<L> {
        let (radius, half) = (L::splat(body.radius), L::splat(body.half));
        let rx = radius * self.cos - half * self.sin;
        let rz = -(half * self.cos + radius * self.sin);
        Touch {
            sin: self.sin,
            cos: self.cos,
            rx,
            rz,
            slip_x: self.vx + spin.tilt * rz,
            slip_y: self.vy + radius * spin.axial + half * spin.turn,
            approach: self.vz - spin.tilt * rx,
            spin: spin.axial,
            turn: spin.turn,
        }
    }

    /// Takes up an impulse at the lowest point.
    #[inline(always)]
    pub(crate) fn strike(
        &mut self,
        spin: &mut Spin<L>,
        body: &Body,
        touch: &Touch<L>,
        p: Impulse<L>,
    ) {
        let kick = p.kick(body, touch);
        self.vx += kick.vx;
        self.vy += kick.vy;
        self.vz += kick.vz;
        spin.tilt += kick.omega_y;
        spin.axial += kick.spin;
        spin.turn += kick.turn;
    }

    /// Kinetic energy per m g D.
    #[inline(always)]
    pub(crate) fn kinetic(&self, body: &Body, spin: &Spin<L>) -> L {
        let (kt, ka) = (L::splat(body.kt), L::splat(body.ka));
        let across = spin.turn * spin.turn + spin.tilt * spin.tilt;
        L::splat(0.5)
            * (self.vx * self.vx
                + self.vy * self.vy
                + self.vz * self.vz
                + kt * across
                + ka * (spin.axial * spin.axial))
    }

    /// Mechanical energy per m g D, potential zero at the surface.
    #[inline(always)]
    pub(crate) fn energy(&self, body: &Body, spin: &Spin<L>) -> L {
        self.kinetic(body, spin) + self.z
    }

    /// What the decision depends on.
    #[inline(always)]
    pub(crate) fn decision_state(&self, body: &Body, spin: &Spin<L>) -> DecisionState<L> {
        DecisionState {
            energy: self.energy(body, spin),
            sin: self.sin,
            cos: self.cos,
            vx: self.vx,
            vy: self.vy,
            axial: spin.axial,
            vertical: self.oz,
        }
    }

    /// Takes back what rounding and truncation added to the energy since it was `before`: no
    /// contact ever gains energy. Velocities shrink together, so every constraint on them holds.
    #[inline(always)]
    pub(crate) fn cap_energy(&mut self, body: &Body, spin: &mut Spin<L>, before: L) {
        let kinetic = self.kinetic(body, spin);
        let allowed = before - self.z;
        let over = allowed.lt(kinetic);
        if over.any() {
            let scale = (allowed.max(L::splat(0.0)) / kinetic).sqrt();
            let scale = L::select(over, scale, L::splat(1.0));
            for velocity in [&mut self.vx, &mut self.vy, &mut self.vz] {
                *velocity *= scale;
            }
            for rate in [&mut spin.axial, &mut spin.turn, &mut spin.tilt] {
                *rate *= scale;
            }
        }
    }
}
