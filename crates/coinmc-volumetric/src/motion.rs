//! The motion of the coin, and the frame in which it is expressed.
//!
//! # The folded frame
//! Heads and tails are mirror images of each other, and the physics does not depend on directions
//! in the plane. So the motion is expressed in a frame that turns with the coin, and that is
//! reflected so that u always points up. x is the horizontal direction in which u leans, z is up,
//! y = z × x:
//!
//! u = (s, 0, c) with s, c >= 0,  e_θ = (c, 0, −s),  y.
//!
//! A separate flag tells which face this u belongs to. The lowest point is then always r = R
//! e_θ − h u (h = H/2), that is rx = c R − s h, rz = −c h − s R. No formula has a separate case for
//! the other rim, and u → −u gives bit-identical numbers.
//!
//! # Rounded rims
//! A coin with rims rounded with the radius r is a smaller cylinder with a layer of thickness r. Its
//! lowest point is the smaller cylinder's, and r below that: r = R_c e_θ − h_c u − r z. So every height
//! is measured from r above the surface, and flights, wells and energies are those of the smaller
//! cylinder. What changes are the levers: rz = −c h_c − s R_c − r, and since z = c u − s e_θ,
//!
//! slip_y = v_y + (R_c + s r) ω_a + (h_c + c r) ω_θ.
//!
//! # The rotation vector
//! The axis of a free symmetric top turns about the fixed angular momentum, at the angular velocity
//! Ω = L/I_t with the components Ω_a = ω_a I_a/I_t along u and Ω_t = ω_θ, Ω_y = ω_y across u.
//! Without gyroscopic torque it turns about the fixed ω. In both cases u turns about Ω, and only
//! Ω_a/ω_a differs.

use crate::body::{Body, levers};
use crate::impact::{ContactPoint, Impulse};
use coinmc_core::DecisionState;
use coinmc_lanes::{Lane, Mask};

/// Position and velocity in the folded frame; lengths in D, times in sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<L> {
    /// s, c: sine and cosine of the tilt of u.
    pub(crate) sin: L,
    pub(crate) cos: L,
    /// Ω, of the module's text.
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
    /// ω_a, about u.
    pub(crate) axial: L,
    /// ω_θ, about e_θ: it turns u about the vertical.
    pub(crate) turn: L,
    /// ω_y: it changes the tilt of u.
    pub(crate) tilt: L,
}

/// Smallest sine of the tilt: the frame needs a direction in which u leans, and quotients by s must
/// stay finite.
pub(crate) const LEAST_SIN: f64 = 1e-18;
/// A coin tilted by less than this, in rad, is level: all points of its lower rim are at the
/// surface. A coin in contact that does not roll round its rim before comes down on its face at
/// this tilt.
pub(crate) const FLAT: f64 = 1e-9;

impl<T: Copy> Motion<T> {
    /// The motion as an array, for memory.
    #[inline(always)]
    pub(crate) fn columns(&self) -> [T; 9] {
        [
            self.sin, self.cos, self.ox, self.oy, self.oz, self.vx, self.vy, self.vz, self.z,
        ]
    }

    /// The motion of [`columns`](Self::columns).
    #[inline(always)]
    pub(crate) fn from_columns(columns: &[T; 9]) -> Self {
        let [sin, cos, ox, oy, oz, vx, vy, vz, z] = *columns;
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
    /// The angular velocity as an array, for memory.
    #[inline(always)]
    pub(crate) fn columns(&self) -> [T; 3] {
        [self.axial, self.turn, self.tilt]
    }

    /// The angular velocity of [`columns`](Self::columns).
    #[inline(always)]
    pub(crate) fn from_columns(&[axial, turn, tilt]: &[T; 3]) -> Self {
        Self { axial, turn, tilt }
    }
}

/// [`Lane::select`] for each of several numbers.
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
        Self::from_columns(&select_all(mask, &yes.columns(), &no.columns()))
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
        Self::from_columns(&select_all(mask, &yes.columns(), &no.columns()))
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
        self.set_tilt_above(sin, cos, L::splat(0.0));
    }

    /// The same with another least cosine.
    #[inline(always)]
    pub(crate) fn set_tilt_above(&mut self, sin: L, cos: L, least: L) {
        self.sin = sin.max(L::splat(LEAST_SIN));
        self.cos = cos.max(least);
    }

    /// Sets the tilt of a coin that is exactly on its side.
    pub(crate) fn lay_on_side(&mut self) {
        self.sin = L::splat(1.0);
        self.cos = L::splat(0.0);
    }

    /// Turns the frame about the vertical by half a turn.
    pub(crate) fn reverse_frame(&mut self) {
        self.ox = -self.ox;
        self.oy = -self.oy;
        self.vx = -self.vx;
        self.vy = -self.vy;
    }

    /// Turns the frame about the vertical so that x points along the unit vector (`nx`, `ny`).
    #[inline(always)]
    pub(crate) fn align(&mut self, nx: L, ny: L) {
        (self.vx, self.vy) = (self.vx * nx + self.vy * ny, self.vy * nx - self.vx * ny);
        (self.ox, self.oy) = (self.ox * nx + self.oy * ny, self.oy * nx - self.ox * ny);
    }

    /// The height of the centre at which the lowest point touches the surface. (All heights are those
    /// above r, see [`Units::rim_m`](coinmc_core::Units::rim_m).)
    #[inline(always)]
    pub(crate) fn rest_height(&self, body: &Body) -> L {
        L::splat(body.half) * self.cos + L::splat(body.radius) * self.sin
    }

    /// The angular velocity; `axial_factor` is Ω_a/ω_a.
    #[inline(always)]
    pub(crate) fn spin(&self, axial_factor: f64) -> Spin<L> {
        Spin {
            axial: (self.ox * self.sin + self.oz * self.cos) * L::splat(1.0 / axial_factor),
            turn: self.ox * self.cos - self.oz * self.sin,
            tilt: self.oy,
        }
    }

    /// ω_z, at which the coin turns about the vertical with this spin.
    #[inline(always)]
    pub(crate) fn turning(&self, spin: &Spin<L>) -> L {
        spin.axial * self.cos - spin.turn * self.sin
    }

    #[inline(always)]
    pub(crate) fn set_spin(&mut self, spin: &Spin<L>, axial_factor: f64) {
        let axial = spin.axial * L::splat(axial_factor);
        self.ox = axial * self.sin + spin.turn * self.cos;
        self.oz = axial * self.cos - spin.turn * self.sin;
        self.oy = spin.tilt;
    }

    /// The lowest point, as an impact law sees it.
    #[inline(always)]
    pub(crate) fn contact_point(&self, body: &Body, spin: &Spin<L>) -> ContactPoint<L> {
        let (radius, half) = (L::splat(body.radius), L::splat(body.half));
        let rx = radius * self.cos - half * self.sin;
        let rz = -(half * self.cos + radius * self.sin) - L::splat(body.rim);
        let (radius, half) = levers(body, self.sin, self.cos);
        ContactPoint {
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

    /// Applies an impulse at the lowest point.
    #[inline(always)]
    pub(crate) fn apply_impulse(
        &mut self,
        spin: &mut Spin<L>,
        body: &Body,
        point: &ContactPoint<L>,
        p: Impulse<L>,
    ) {
        let jump = p.velocity_jump(body, point);
        self.vx += jump.vx;
        self.vy += jump.vy;
        self.vz += jump.vz;
        spin.tilt += jump.omega_y;
        spin.axial += jump.spin;
        spin.turn += jump.turn;
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

    /// Mechanical energy per m g D. The potential energy is zero at the surface.
    #[inline(always)]
    pub(crate) fn energy(&self, body: &Body, spin: &Spin<L>) -> L {
        self.kinetic(body, spin) + self.z
    }

    /// What the decision rule depends on.
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

    /// Removes what rounding and truncation have added to the energy since it was `before`, so that
    /// no contact gains energy. All velocities are scaled together, which keeps every constraint on
    /// them.
    #[inline(always)]
    pub(crate) fn cap_energy(&mut self, body: &Body, spin: &mut Spin<L>, before: L) {
        let kinetic = self.kinetic(body, spin);
        let allowed = before - self.z;
        let over = allowed.lt(kinetic);
        if over.any() {
            // at rest the height alone may exceed the energy, by rounding
            let kinetic = kinetic.max(L::splat(f64::MIN_POSITIVE));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Rigid;
    use nalgebra::Vector3;

    /// Rims, tilts, velocities and angular velocities without special values.
    fn coins() -> impl Iterator<Item = (Body, Rigid)> {
        [(0.0, 0.4), (0.15, 0.4), (0.15, 1.3)]
            .into_iter()
            .map(|(rim, tilt)| {
                let body = Rigid::generic_body(rim);
                let velocity = Vector3::new(0.3, -0.7, -1.1);
                let omega = Vector3::new(1.7, -2.3, 0.9);
                (body, Rigid::new(&body, tilt, velocity, omega))
            })
    }

    fn near(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() < 1e-13,
            "{found} instead of {expected}"
        );
    }

    /// Ω is the angular momentum over I_t, from which the angular velocity comes back.
    #[test]
    fn the_rotation_vector_is_that_of_the_angular_momentum() {
        for (body, coin) in coins() {
            let factor = body.axial_factor(true);
            let (motion, spin) = coin.folded(factor, 1.0);
            let expected = coin.angular_momentum() / body.kt;
            near(motion.ox, expected.x);
            near(motion.oy, expected.y);
            near(motion.oz, expected.z);
            let again = motion.spin(factor);
            near(again.axial, spin.axial);
            near(again.turn, spin.turn);
            near(again.tilt, spin.tilt);
            near(motion.turning(&spin), coin.omega.z);
        }
    }

    /// The lowest point, its height and its velocity v + ω × r are those of the coin in vectors.
    #[test]
    fn the_contact_point_moves_with_the_coin() {
        for (body, coin) in coins() {
            let (motion, spin) = coin.folded(body.axial_factor(true), 1.0);
            let point = motion.contact_point(&body, &spin);
            let (arm, velocity) = (coin.arm, coin.at_contact());
            near(point.rx, arm.x);
            near(point.rz, arm.z);
            near(point.slip_x, velocity.x);
            near(point.slip_y, velocity.y);
            near(point.approach, velocity.z);
            near(motion.rest_height(&body), -arm.z - body.rim);
            near(
                point.spin * point.cos - point.turn * point.sin,
                coin.omega.z,
            );
        }
    }

    /// An impulse with friction of all kinds changes the motion as Newton and Euler have it, and its work is the
    /// kinetic energy that the coin gains.
    #[test]
    fn an_impulse_changes_momentum_and_angular_momentum() {
        let p = Impulse {
            x: 0.31,
            y: -0.53,
            z: 1.7,
            contour: 0.11,
            pivoting: -0.07,
        };
        for (body, coin) in coins() {
            let factor = body.axial_factor(true);
            let (mut motion, mut spin) = coin.folded(factor, 1.0);
            let point = motion.contact_point(&body, &spin);
            near(motion.kinetic(&body, &spin), coin.kinetic());
            near(motion.energy(&body, &spin), coin.kinetic() + 1.0);
            motion.apply_impulse(&mut spin, &body, &point, p);
            motion.set_spin(&spin, factor);
            let after = coin.after(&p);
            let (expected, turns) = after.folded(factor, 1.0);
            for (found, expected) in motion.columns().into_iter().zip(expected.columns()) {
                near(found, expected);
            }
            for (found, expected) in spin.columns().into_iter().zip(turns.columns()) {
                near(found, expected);
            }
            near(p.work(&body, &point), after.kinetic() - coin.kinetic());
        }
    }

    /// Energy above the cap is taken from all velocities in the same proportion; what is below it stays.
    #[test]
    fn a_cap_leaves_the_energy_and_the_directions() {
        for (body, coin) in coins() {
            let (z, before) = (0.6, 1.9);
            let (mut motion, mut spin) = coin.folded(1.0, z);
            let (was, turned) = (motion, spin);
            motion.cap_energy(&body, &mut spin, before);
            near(motion.energy(&body, &spin), before);
            let share = motion.vx / was.vx;
            assert!(0.0 < share && share < 1.0, "{share}");
            for (new, old) in [
                (motion.vy, was.vy),
                (motion.vz, was.vz),
                (spin.axial, turned.axial),
                (spin.turn, turned.turn),
                (spin.tilt, turned.tilt),
            ] {
                near(new, share * old);
            }
            near(motion.z, z);
            let capped = (motion.columns(), spin.columns());
            motion.cap_energy(&body, &mut spin, before + 0.5);
            assert_eq!((motion.columns(), spin.columns()), capped);
            // the height alone takes more: the coin comes to rest
            motion.cap_energy(&body, &mut spin, 0.5 * z);
            assert_eq!(motion.kinetic(&body, &spin), 0.0);
        }
    }

    /// Turning the frame keeps every vector, seen along the new axes.
    #[test]
    fn a_turned_frame_shows_the_same_vectors() {
        for (body, coin) in coins() {
            let (was, _) = coin.folded(body.axial_factor(true), 1.0);
            let (ny, nx) = libm::sincos(0.7);
            let mut turned = was;
            turned.align(nx, ny);
            let (x, y) = (Vector3::new(nx, ny, 0.0), Vector3::new(-ny, nx, 0.0));
            let (v, o) = (coin.velocity, Vector3::new(was.ox, was.oy, was.oz));
            near(turned.vx, v.dot(&x));
            near(turned.vy, v.dot(&y));
            near(turned.ox, o.dot(&x));
            near(turned.oy, o.dot(&y));
            let (mut half, mut reversed) = (was, was);
            half.align(-1.0, 0.0);
            reversed.reverse_frame();
            for (half, reversed) in half.columns().into_iter().zip(reversed.columns()) {
                near(half, reversed);
            }
        }
    }
}
