//! The equations of motion of a coin in sustained contact on one rim point.
//!
//! # State
//! The state is the tilt θ of u, ω in the triad (u, e_θ, y), and the slip velocity γ of the contact
//! point. The velocity of the centre follows from it, because the contact point stays on the
//! surface: v = (γx − ω_y rz, γy − R ω_a − h ω_θ, ω_y rx), h = H/2.
//!
//! # Derivation
//! The triad turns with W = (φ'c, ω_θ, ω_y), where φ' = −ω_θ/s is the rate of the azimuth, so
//! dL/dt + W × L = τ gives, with G = ω_θ(Ω_a − φ'c), Ω_a = ω_a I_a/I_t,
//!
//! ω_y' = G + (rz fx − rx N)/kt,
//! ω_a' = (R fy − N t_a)/ka,
//! ω_θ' = ω_y(φ'c − Ω_a) + (h fy − N t_θ)/kt,
//! t_a = ρ_c σ_c + ρ_p σ_p c,  t_θ = ρ_c σ_c c/s − ρ_p σ_p s,
//!
//! where σ_c and σ_p are the signs of ψ' = ω_a + ω_θ c/s and ω_z = ω_a c − ω_θ s. With
//! rx' = rz ω_y and rz' = −rx ω_y, the accelerations of the contact point are
//!
//! γ' = K_h f + K_xz N + b,  0 = Kxz fx + Kzz N + bz,
//! bx = φ'vy + rz G − rx ω_y²,
//! by = −φ'vx + h ω_y(φ'c − Ω_a) − N(R t_a/ka + h t_θ/kt),
//! bz = −1 − rz ω_y² − rx G.
//!
//! With rims rounded with the radius r, (R, h) of the cylinder inside, the levers about u and e_θ are
//! R + s r and h + c r instead of R and h, and rz is r less. As rx' = (rz + r) ω_y, and the levers
//! change, r ω_y² is taken from −bz, and by gains r ω_y ω_z.
//!
//! On a slope along y the rim touches ξ ahead of its lowest point. What matters of that is that γx of the point
//! that touches is less than that of the lowest one by ω_z ξ, and that fx has the moment −ξ fx about the
//! vertical. γ is then the slip of the point that touches. (Its γx' has −ξω_z' besides, which is left out: K_xx grows by ξ²/kt, and
//! bx by ξ times what else turns ω_z, for a rolling coin ω_y Ω_a, a product of the slope and of the rate of leaning.)
//!
//! Sticking requires γ' = 0, slipping f = −μ N γ/|γ|. Drag adds −k v to the acceleration of the
//! centre and −k_ω ω to ω'. On a tilted table its pull (see `crate::pull`) adds to bx and by. Without gyroscopic torque Ω_a = ω_a. (Le Saux, Leine & Glocker, J.
//! Nonlinear Sci. 15 (2005) 27; contour and pivoting friction as in Leine, Arch. Appl. Mech. 79
//! (2009) 1063.)

use super::dynamics::Dynamics;
use super::held_friction::Load;
use super::integrator::Flow;
use crate::body::levers;
use crate::series::sin_cos_tilt;
use coinmc_lanes::Lane;

/// Components of the state, in the order of the integrator's vector.
pub(crate) const TILT: usize = 0;
pub(crate) const OMEGA_Y: usize = 1;
pub(crate) const OMEGA_A: usize = 2;
pub(crate) const OMEGA_T: usize = 3;
pub(crate) const SLIP_X: usize = 4;
pub(crate) const SLIP_Y: usize = 5;

/// (θ, ω_y, ω_a, ω_θ, γx, γy).
pub(crate) type RimState<L> = [L; 6];

/// Whether the contact point sticks or slips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Stick,
    Slip,
}

/// Forces and rates of change of a state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates<L> {
    /// d/dt of the state.
    pub(crate) state: RimState<L>,
    /// Normal force, m g.
    pub(crate) normal: L,
    /// Friction force, m g: the force needed to stick, or the force that acts in slip.
    pub(crate) friction: [L; 2],
    /// Acceleration at which the contact point would enter the surface if it were free: −bz.
    pub(crate) press: L,
    /// Kzz − μ Kxz nx. Where it is not positive, no normal force is consistent with slip
    /// (Painlevé): the contact jams.
    pub(crate) jam_margin: L,
}

/// The flow of a mode. It keeps the rates that it has returned last.
pub(super) struct RimFlow<'a, L> {
    pub(super) dynamics: &'a Dynamics,
    pub(super) mode: Mode,
    pub(super) last: &'a mut Rates<L>,
}

// not a closure, because a closure that is called six times is not inlined
impl<L: Lane> Flow<L, 6> for RimFlow<'_, L> {
    #[inline(always)]
    fn rates(&mut self, state: &RimState<L>) -> RimState<L> {
        *self.last = self.dynamics.rates(state, self.mode);
        self.last.state
    }
}

impl<L: Lane> Rates<L> {
    pub(super) fn none() -> Self {
        let zero = L::splat(0.0);
        Self {
            state: [zero; 6],
            normal: zero,
            friction: [zero; 2],
            press: zero,
            jam_margin: zero,
        }
    }
}

impl Dynamics {
    /// Whether contact in this mode loses no energy.
    pub(super) fn conserves(&self, mode: Mode) -> bool {
        let smooth = mode == Mode::Stick || self.friction.mu == 0.0;
        smooth && !self.friction.has_lengths() && !self.drag.acts() && self.pull.is_none()
    }

    /// Adds the pull of a tilted table to the accelerations of the free contact point.
    #[inline(always)]
    fn add_pull<L: Lane>(&self, bx: &mut L, by: &mut L) {
        if let Some([x, y]) = self.pull {
            *bx += L::splat(x);
            *by += L::splat(y);
        }
    }

    /// What drag takes from the rates of rotation.
    #[inline(always)]
    fn drag_on_rotation<L: Lane>(&self, [wy, wa, wt]: [L; 3]) -> [L; 3] {
        if self.drag.acts() {
            let angular = L::splat(self.drag.angular);
            [angular * wy, angular * wa, angular * wt]
        } else {
            [L::splat(0.0); 3]
        }
    }

    /// Adds drag to the accelerations of the free contact point, given the velocity of the centre, whose
    /// vertical part is ω_y rx, and minus that of the contact point along y relative to the centre.
    #[inline(always)]
    fn add_drag<L: Lane>(&self, [bx, by, bz]: [&mut L; 3], [vx, vy, wy, rx]: [L; 4], rolls: L) {
        if self.drag.acts() {
            let linear = L::splat(self.drag.linear);
            *bx -= linear * vx;
            *by -= linear * vy + L::splat(self.drag.angular) * rolls;
            *bz -= linear * wy * rx;
        }
    }

    /// Adds to the velocity along x what the lowest point slips more than the one that touches.
    #[inline(always)]
    fn add_drift<L: Lane>(&self, vx: &mut L, s: L, c: L, [wa, wt]: [L; 2]) {
        if self.ahead != 0.0 {
            *vx += self.drift(s, c, wa, wt);
        }
    }

    /// Adds the moment −ξ fx about the vertical to by and to what slows down ω_a and ω_θ; R and h are the
    /// levers about u and e_θ.
    #[inline(always)]
    fn add_moment<L: Lane>(
        &self,
        fx: L,
        s: L,
        c: L,
        [radius, half]: [L; 2],
        [by, slows_a, slows_t]: [&mut L; 3],
    ) {
        if self.ahead != 0.0 {
            let about = L::splat(self.ahead) * fx;
            let turn_a = about * c * L::splat(self.inverse_ka);
            let turn_t = about * s * L::splat(self.inverse_kt);
            *by -= radius * turn_a - half * turn_t;
            *slows_a += turn_a;
            *slows_t -= turn_t;
        }
    }

    /// Rates and forces of `state` in a mode.
    #[inline(always)]
    pub(crate) fn rates<L: Lane>(&self, state: &RimState<L>, mode: Mode) -> Rates<L> {
        let k = L::splat;
        let [tilt, wy, wa, wt, gx, gy] = *state;
        let (s, c) = sin_cos_tilt(tilt);
        let (radius, half) = (k(self.body.radius), k(self.body.half));
        let (ikt, ika) = (k(self.inverse_kt), k(self.inverse_ka));
        let rx = radius * c - half * s;
        let (rim, height) = (k(self.body.rim), half * c + radius * s);
        let rz = -height - rim;
        let (radius, half) = levers(&self.body, s, c);
        let inverse = self.quotients(s, c);
        let azimuth = -(wt * inverse.sin);
        let excess = k(self.axial_factor) * wa - azimuth * c;
        let [slows_y, mut slows_a, mut slows_t] = self.drag_on_rotation([wy, wa, wt]);
        let gyro_y = wt * excess - slows_y;
        let (mut vx, vy) = (gx - wy * rz, gy - radius * wa - half * wt);
        self.add_drift(&mut vx, s, c, [wa, wt]);
        let kxx = k(1.0) + rz * rz * ikt;
        let kxz = -(rx * rz * ikt);
        let kzz = k(1.0) + rx * rx * ikt;
        let (kyy, inverse_kyy) = self.across(radius, half);
        let mut bx = azimuth * vy + rz * gyro_y - rx * wy * wy;
        let mut bz = -(k(1.0) - height * wy * wy + rx * gyro_y);
        let mut by = -(azimuth * vx) - half * wy * excess;
        if self.body.rim != 0.0 {
            by += rim * wy * (c * wa - s * wt);
        }
        let rolls = radius * wa + half * wt;
        self.add_drag([&mut bx, &mut by, &mut bz], [vx, vy, wy, rx], rolls);
        self.add_pull(&mut bx, &mut by);
        let mu = k(self.friction.mu);
        // in slip, both forces contain N/|γ| = −bz/(K_zz |γ| − μ K_xz γx): one quotient for all
        let slip = Slip::new(mode, gx, gy);
        let opposes = kzz * slip.speed - mu * kxz * slip.x;
        let (fx, normal, drive) = match mode {
            Mode::Stick => {
                let inverse = self.inverse_along(kxx, kzz);
                (
                    (kxz * bz - kzz * bx) * inverse,
                    (kxz * bx - kxx * bz) * inverse,
                    k(0.0),
                )
            }
            Mode::Slip => {
                let drive = bz / opposes;
                (mu * drive * slip.x, -(drive * slip.speed), drive)
            }
        };
        let (torque_a, torque_t) = if self.holds() {
            let (fy, follows) = match mode {
                Mode::Stick => (-(by * inverse_kyy), inverse_kyy),
                Mode::Slip => (mu * drive * slip.y, k(0.0)),
            };
            self.held_torques(&Load {
                s,
                c,
                inverse: &inverse,
                wy,
                wa,
                wt,
                excess,
                normal,
                fy,
                follows,
            })
        } else {
            self.friction_torques_at(s, c, &inverse, wa, wt)
        };
        by -= normal * (radius * torque_a * ika + half * torque_t * ikt);
        self.add_moment(
            fx,
            s,
            c,
            [radius, half],
            [&mut by, &mut slows_a, &mut slows_t],
        );
        let fy = match mode {
            Mode::Stick => -(by * inverse_kyy),
            Mode::Slip => mu * drive * slip.y,
        };
        let (slide_x, slide_y) = match mode {
            Mode::Stick => (k(0.0), k(0.0)),
            Mode::Slip => (kxx * fx + kxz * normal + bx, kyy * fy + by),
        };
        Rates {
            state: [
                wy,
                gyro_y + (rz * fx - rx * normal) * ikt,
                (radius * fy - normal * torque_a) * ika - slows_a,
                (half * fy - normal * torque_t) * ikt - wy * excess - slows_t,
                slide_x,
                slide_y,
            ],
            normal,
            friction: [fx, fy],
            press: -bz,
            jam_margin: match mode {
                Mode::Stick => k(1.0),
                Mode::Slip => opposes / slip.speed,
            },
        }
    }
}

/// A slip velocity and its size.
struct Slip<L> {
    x: L,
    y: L,
    speed: L,
}

impl<L: Lane> Slip<L> {
    /// The slip of a slipping point; unit speed along x for a point that sticks or does not move.
    #[inline(always)]
    fn new(mode: Mode, x: L, y: L) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        if mode == Mode::Stick {
            return Self {
                x: one,
                y: zero,
                speed: one,
            };
        }
        let speed = (x * x + y * y).sqrt();
        let at_rest = speed.le(zero);
        Self {
            x: L::select(at_rest, one, x),
            y: L::select(at_rest, zero, y),
            speed: L::select(at_rest, one, speed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Friction};
    use crate::drag::Drag;
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// A coin in the laboratory.
    struct Lab {
        axis: Vector3<f64>,
        spin: Vector3<f64>,
        /// From the centre to the lowest point.
        arm: Vector3<f64>,
        velocity: Vector3<f64>,
        /// Angular momentum about the centre.
        momentum: Vector3<f64>,
    }

    /// The coin whose axis leans towards this azimuth; the slip of the state is that of its lowest point.
    fn lab(body: &Body, state: &RimState<f64>, azimuth: f64) -> Lab {
        let [tilt, wy, wa, wt, gx, gy] = *state;
        let ((s, c), (sin, cos)) = (libm::sincos(tilt), libm::sincos(azimuth));
        let [x, y, z] = [
            Vector3::new(cos, sin, 0.0),
            Vector3::new(-sin, cos, 0.0),
            Vector3::z(),
        ];
        let (axis, across) = (x * s + z * c, x * c - z * s);
        let spin = axis * wa + across * wt + y * wy;
        let arm = across * body.radius - axis * body.half - z * body.rim;
        Lab {
            axis,
            spin,
            arm,
            velocity: x * gx + y * gy - spin.cross(&arm),
            momentum: axis * (body.ka * wa) + (across * wt + y * wy) * body.kt,
        }
    }

    /// The rate of change at t = 0.
    fn rate(of: impl Fn(f64) -> Vector3<f64>) -> Vector3<f64> {
        let h = 1e-4;
        ((of(h) - of(-h)) * 8.0 - (of(2.0 * h) - of(-2.0 * h))) / (12.0 * h)
    }

    fn scene(dice: &mut Dice, gyroscopic: bool) -> Dynamics {
        let body = Body {
            radius: dice.between(0.3, 1.2),
            half: dice.between(0.2, 1.2),
            rim: dice.between(-0.2, 0.2).max(0.0),
            kt: dice.between(0.1, 0.6),
            ka: dice.between(0.1, 0.6),
        };
        let friction = Friction {
            mu: dice.between(0.05, 0.5),
            contour: dice.between(-0.05, 0.1).max(0.0),
            pivoting: dice.between(-0.05, 0.1).max(0.0),
        };
        let drag = Drag {
            linear: dice.between(-0.5, 0.5).max(0.0),
            angular: dice.between(-0.5, 0.5).max(0.0),
        };
        let factor = if gyroscopic { body.ka / body.kt } else { 1.0 };
        let dynamics = Dynamics::new(body, friction, drag, factor, 1e-9).on_rim(0.0);
        let ahead = dice.between(-0.2, 0.2).max(0.0);
        let pull = [dice.between(-0.2, 0.2), dice.between(-0.2, 0.2)];
        if dice.chance() {
            dynamics.pulled_by(pull).touching_ahead(ahead)
        } else {
            dynamics.touching_ahead(ahead)
        }
    }

    /// Newton's and Euler's equations in the laboratory, differenced: whatever the rims, the moments, friction,
    /// drag, the pull of the table and how far ahead the rim touches, the rates are those of the forces and of
    /// their moments, and the forces those of the mode.
    #[test]
    fn rates_follow_from_the_forces_in_the_laboratory() {
        let mut checked = 0;
        for trial in 0..2_000 {
            let mut dice = Dice::new(840, trial);
            let gyroscopic = dice.chance();
            let dynamics = scene(&mut dice, gyroscopic);
            let (body, friction) = (&dynamics.body, &dynamics.friction);
            let mode = if dice.chance() {
                Mode::Stick
            } else {
                Mode::Slip
            };
            let slips = if mode == Mode::Slip { 1.0 } else { 0.0 };
            let mut part = || dice.between(-1.0, 1.0);
            let [wy, wa, wt] = [part(), part(), part()];
            let slip = Vector3::new(part(), part(), 0.0) * slips;
            let tilt = dice.between(0.4, 1.5);
            let state = [tilt, wy, wa, wt, slip.x, slip.y];
            let now = dynamics.rates(&state, mode);
            if now.jam_margin < 0.1 {
                continue;
            }
            checked += 1;

            let (s, c) = libm::sincos(tilt);
            let (along, about) = (s * wa + c * wt, c * wa - s * wt);
            let at = |t: f64| {
                let mut moved: RimState<f64> = std::array::from_fn(|i| state[i] + t * now.state[i]);
                moved[SLIP_X] += about * dynamics.ahead;
                lab(body, &moved, -wt / s * t)
            };
            let here = at(0.0);
            let force = Vector3::new(now.friction[0], now.friction[1], now.normal);
            let [px, py] = dynamics.pull.unwrap_or([0.0; 2]);
            let acceleration =
                force + Vector3::new(px, py, -1.0) - here.velocity * dynamics.drag.linear;
            let twist = Vector3::new(
                -now.normal * friction.contour / s * along.signum(),
                0.0,
                -now.normal * friction.pivoting * about.signum() - dynamics.ahead * force.x,
            );
            let mut torque = here.arm.cross(&force) + twist - here.momentum * dynamics.drag.angular;
            if !gyroscopic {
                torque += here.spin.cross(&here.momentum);
            }
            let size = 1e-9 * (1.0 + force.norm()) / body.ka.min(body.kt).powi(2);
            let off = [
                rate(|t| at(t).axis) - here.spin.cross(&here.axis),
                rate(|t| at(t).velocity) - acceleration,
                rate(|t| at(t).momentum) - torque,
            ];
            assert!(off.iter().all(|off| off.norm() < size), "{trial} {off:?}");

            // an impulse turns the coin, and that moves the lowest point
            let moves = |p: Vector3<f64>| {
                let turns = here.arm.cross(&p);
                let axial = here.axis * here.axis.dot(&turns);
                p + (axial / body.ka + (turns - axial) / body.kt).cross(&here.arm)
            };
            assert!((now.press - moves(force).z).abs() < size);
            let [slide_x, slide_y] = [now.state[SLIP_X], now.state[SLIP_Y]];
            if mode == Mode::Stick {
                assert!(slide_x == 0.0 && slide_y == 0.0 && now.jam_margin == 1.0);
            } else {
                let against = -slip.normalize() * friction.mu;
                let off = force - (against + Vector3::z()) * now.normal;
                assert!(off.norm() < size, "{off}");
                let margin = moves(against + Vector3::z()).z;
                assert!((now.jam_margin - margin).abs() < 1e-12 * (1.0 + margin));
            }
        }
        assert!(checked > 1_500, "{checked}");
    }

    /// A point that slips, but is at rest at the moment, slips along x.
    #[test]
    fn a_slip_that_begins_is_along_x() {
        for trial in 0..100 {
            let dynamics = scene(&mut Dice::new(841, trial), true);
            let mut state = [0.9, 0.3, -0.4, 0.6, 0.0, 0.0];
            let at_rest = dynamics.rates(&state, Mode::Slip);
            state[SLIP_X] = 1e-11;
            let slow = dynamics.rates(&state, Mode::Slip);
            let off = (0..6).map(|i| (at_rest.state[i] - slow.state[i]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-8 * (1.0 + slow.normal.abs()));
            assert!((at_rest.jam_margin - slow.jam_margin).abs() < 1e-9);
        }
    }

    /// Energy is kept where no friction slides or twists, no drag acts and no table pulls.
    #[test]
    fn contact_conserves_where_nothing_acts() {
        let at = |mu, contour, pivoting, linear, angular| {
            let friction = Friction {
                mu,
                contour,
                pivoting,
            };
            let body = Body {
                radius: 0.8,
                half: 0.6,
                rim: 0.0,
                kt: 0.3,
                ka: 0.4,
            };
            Dynamics::new(body, friction, Drag { linear, angular }, 1.0, 1e-2)
        };
        let both = |dynamics: &Dynamics| [Mode::Stick, Mode::Slip].map(|m| dynamics.conserves(m));
        assert_eq!(both(&at(0.0, 0.0, 0.0, 0.0, 0.0)), [true, true]);
        assert_eq!(both(&at(0.3, 0.0, 0.0, 0.0, 0.0)), [true, false]);
        for lossy in [
            at(0.0, 0.1, 0.0, 0.0, 0.0),
            at(0.0, 0.0, 0.1, 0.0, 0.0),
            at(0.0, 0.0, 0.0, 0.1, 0.0),
            at(0.0, 0.0, 0.0, 0.0, 0.1),
            at(0.0, 0.0, 0.0, 0.0, 0.0).pulled_by([0.1, 0.0]),
        ] {
            assert_eq!(both(&lossy), [false, false]);
        }
    }
}
