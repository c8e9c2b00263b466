//! Sustained contact of one rim point: the equations of motion.
//!
//! # State
//! The tilt θ of u, ω in the triad (u, e_θ, y), and the slip γ of the contact point. The centre
//! follows: v = (γx − ω_y rz, γy − R ω_a − h ω_θ, ω_y rx), h = H/2, because the contact point
//! stays on the surface.
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
//! σ_c and σ_p being the signs of ψ' = ω_a + ω_θ c/s and ω_z = ω_a c − ω_θ s. With
//! rx' = rz ω_y and rz' = −rx ω_y, the accelerations of the contact point are
//!
//! γ' = K_h f + K_xz N + b,  0 = Kxz fx + Kzz N + bz,
//! bx = φ'vy + rz G − rx ω_y²,
//! by = −φ'vx + h ω_y(φ'c − Ω_a) − N(R t_a/ka + h t_θ/kt),
//! bz = −1 − rz ω_y² − rx G.
//!
//! Stick asks γ' = 0, slip f = −μ N γ/|γ|. Drag adds −k v to the centre's acceleration and −k_ω ω
//! to ω'. Without gyroscopic torque Ω_a = ω_a. (Le Saux, Leine & Glocker, J. Nonlinear Sci. 15
//! (2005) 27; contour and pivoting friction as in Leine, Arch. Appl. Mech. 79 (2009) 1063.)

use super::integrator::Flow;
use crate::body::{Body, Friction};
use crate::flight::Drag;
use crate::motion::{Motion, Spin};
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

/// The scene as contact sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Law {
    pub(crate) body: Body,
    pub(crate) friction: Friction,
    pub(crate) drag: Drag,
    /// Ω_a/ω_a: I_a/I_t with gyroscopic torque, 1 without.
    pub(crate) axial_factor: f64,
    /// 1/k_t and 1/k_a.
    inverse_kt: f64,
    inverse_ka: f64,
    /// K_yy and 1/K_yy, which no tilt changes.
    kyy: f64,
    inverse_kyy: f64,
    /// 1/(K_xx K_zz − K_xz²), which none changes either: the rim is as far as ever.
    inverse_det: f64,
    /// 1/(ρ_c smoothing_time) and 1/(ρ_p smoothing_time), see [`smoothed_sign`].
    contour_fade: f64,
    pivoting_fade: f64,
}

/// Whether the contact point is held or slides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Stick,
    Slip,
}

/// Forces and rates of a state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates<L> {
    /// d/dt of the state.
    pub(crate) state: RimState<L>,
    /// Normal force, m g.
    pub(crate) normal: L,
    /// Friction force needed (stick) or acting (slip), m g.
    pub(crate) friction: [L; 2],
    /// Acceleration with which the free contact point would press into the surface: −bz.
    pub(crate) press: L,
    /// Kzz − μ Kxz nx: where it is not positive no force lets the point go on sliding (Painlevé).
    pub(crate) yields: L,
}

/// The flow of a mode, which keeps the rates it gave last.
pub(super) struct RimFlow<'a, L> {
    pub(super) law: &'a Law,
    pub(super) mode: Mode,
    pub(super) last: &'a mut Rates<L>,
}

// not a closure: one that is called six times is not inlined
impl<L: Lane> Flow<L, 6> for RimFlow<'_, L> {
    #[inline(always)]
    fn rates(&mut self, state: &RimState<L>) -> RimState<L> {
        *self.last = self.law.rates(state, self.mode);
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
            yields: zero,
        }
    }
}

/// sign(rate) of dry friction that slows `rate` down by b (per normal force), fading linearly to 0
/// where it would stop within the time `smoothing_time`: the rate of the decay is 1/smoothing_time however light the
/// part that turns. `share` is rate/(b smoothing_time).
#[inline(always)]
fn smoothed_sign<L: Lane>(share: L) -> L {
    share.min(L::splat(1.0)).max(L::splat(-1.0))
}

/// Quotients that depend on the tilt alone.
#[derive(Debug, Clone, Copy)]
struct Quotients<L> {
    /// 1/s.
    sin: L,
    /// 1/A and 1/G, A = s²/ka + c²/kt and G = c²/ka + s²/kt: how heavy the coin turns about the
    /// horizontal x axis and the vertical.
    along: L,
    about: L,
}

impl Law {
    pub(crate) fn new(
        body: Body,
        friction: Friction,
        drag: Drag,
        axial_factor: f64,
        smoothing_time: f64,
    ) -> Self {
        let (inverse_kt, inverse_ka) = (1.0 / body.kt, 1.0 / body.ka);
        let kyy = 1.0 + body.half * body.half * inverse_kt + body.radius * body.radius * inverse_ka;
        // no length, no friction: then any finite quotient does
        let inverse_smoothing =
            |length: f64| 1.0 / (length * smoothing_time).max(f64::MIN_POSITIVE);
        Self {
            body,
            friction,
            drag,
            axial_factor,
            inverse_kt,
            inverse_ka,
            kyy,
            inverse_kyy: 1.0 / kyy,
            inverse_det: 1.0 / (1.0 + inverse_kt),
            contour_fade: inverse_smoothing(friction.contour),
            pivoting_fade: inverse_smoothing(friction.pivoting),
        }
    }

    /// The same with drag of which the compiler knows whether it acts.
    #[inline(always)]
    pub(crate) fn with_known_drag<const ACTS: bool>(&self) -> Self {
        Self {
            drag: self.drag.known::<ACTS>(),
            ..*self
        }
    }

    /// Whether contact in this mode loses nothing.
    pub(super) fn conserves(&self, mode: Mode) -> bool {
        let smooth = mode == Mode::Stick || self.friction.mu == 0.0;
        smooth && !self.friction.twists() && !self.drag.acts()
    }

    /// Rates and forces of `state`, in stick or slip.
    #[inline(always)]
    pub(crate) fn rates<L: Lane>(&self, state: &RimState<L>, mode: Mode) -> Rates<L> {
        let k = L::splat;
        let [tilt, wy, wa, wt, gx, gy] = *state;
        let (s, c) = sin_cos_tilt(tilt);
        let (radius, half) = (k(self.body.radius), k(self.body.half));
        let (ikt, ika) = (k(self.inverse_kt), k(self.inverse_ka));
        let rx = radius * c - half * s;
        let rz = -(half * c + radius * s);
        let inverse = self.quotients(s, c);
        let azimuth = -(wt * inverse.sin);
        let excess = k(self.axial_factor) * wa - azimuth * c;
        let mut gyro_y = wt * excess;
        let vx = gx - wy * rz;
        let vy = gy - radius * wa - half * wt;
        let kxx = k(1.0) + rz * rz * ikt;
        let kxz = -(rx * rz * ikt);
        let kzz = k(1.0) + rx * rx * ikt;
        let kyy = k(self.kyy);
        let angular = k(self.drag.angular);
        let (mut slows_a, mut slows_t) = (k(0.0), k(0.0));
        if self.drag.acts() {
            gyro_y -= angular * wy;
            (slows_a, slows_t) = (angular * wa, angular * wt);
        }
        let mut bx = azimuth * vy + rz * gyro_y - rx * wy * wy;
        let mut bz = -(k(1.0) + rz * wy * wy + rx * gyro_y);
        let mut by = -(azimuth * vx) - half * wy * excess;
        if self.drag.acts() {
            let linear = k(self.drag.linear);
            bx -= linear * vx;
            by -= linear * vy + angular * (radius * wa + half * wt);
            bz -= linear * wy * rx;
        }
        let mu = k(self.friction.mu);
        // sliding, both forces are of N/|γ| = −bz/(K_zz |γ| − μ K_xz γx): one quotient for all
        let slip = Slip::of(mode, gx, gy);
        let opposes = kzz * slip.speed - mu * kxz * slip.x;
        let (fx, normal, drive) = match mode {
            Mode::Stick => {
                let inverse = k(self.inverse_det);
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
        let (twist_a, twist_t) = self.twist_at(s, c, &inverse, wa, wt);
        by -= normal * (radius * twist_a * ika + half * twist_t * ikt);
        let fy = match mode {
            Mode::Stick => -(by * k(self.inverse_kyy)),
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
                (radius * fy - normal * twist_a) * ika - slows_a,
                (half * fy - normal * twist_t) * ikt - wy * excess - slows_t,
                slide_x,
                slide_y,
            ],
            normal,
            friction: [fx, fy],
            press: -bz,
            yields: match mode {
                Mode::Stick => k(1.0),
                Mode::Slip => opposes / slip.speed,
            },
        }
    }

    /// The quotients of a tilt: one division for all three.
    #[inline(always)]
    fn quotients<L: Lane>(&self, s: L, c: L) -> Quotients<L> {
        if !self.friction.twists() {
            let none = L::splat(0.0);
            return Quotients {
                sin: L::splat(1.0) / s,
                along: none,
                about: none,
            };
        }
        let (ikt, ika) = (L::splat(self.inverse_kt), L::splat(self.inverse_ka));
        let along = s * s * ika + c * c * ikt;
        let about = c * c * ika + s * s * ikt;
        let both = along * about;
        let inverse = L::splat(1.0) / (s * both);
        let inverse_both = s * inverse;
        Quotients {
            sin: both * inverse,
            along: about * inverse_both,
            about: along * inverse_both,
        }
    }

    /// (t_a, t_θ): torques of contour and pivoting friction per normal force.
    #[inline(always)]
    pub(crate) fn twist<L: Lane>(&self, s: L, c: L, wa: L, wt: L) -> (L, L) {
        self.twist_at(s, c, &self.quotients(s, c), wa, wt)
    }

    #[inline(always)]
    fn twist_at<L: Lane>(&self, s: L, c: L, inverse: &Quotients<L>, wa: L, wt: L) -> (L, L) {
        if !self.friction.twists() {
            return (L::splat(0.0), L::splat(0.0));
        }
        // ω_x = s ψ' and ω_z; friction takes ρ_c A/s and ρ_p G from them
        let (along, about) = (wa * s + wt * c, wa * c - wt * s);
        let along = along * s * inverse.along * L::splat(self.contour_fade);
        let about = about * inverse.about * L::splat(self.pivoting_fade);
        let contour = L::splat(self.friction.contour) * smoothed_sign(along);
        let pivoting = L::splat(self.friction.pivoting) * smoothed_sign(about);
        let cot = c * inverse.sin;
        (contour + pivoting * c, contour * cot - pivoting * s)
    }

    /// ω_θ(Ω_a − φ'c): the gyroscopic part of ω_y', without drag.
    #[inline(always)]
    fn gyroscopic<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        let azimuth = -(spin.turn / m.sin);
        spin.turn * (L::splat(self.axial_factor) * spin.axial - azimuth * m.cos)
    }

    /// The acceleration with which the contact point presses into the surface, were it free: −bz.
    #[inline(always)]
    pub(crate) fn press<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        let (radius, half) = (L::splat(self.body.radius), L::splat(self.body.half));
        let rx = radius * m.cos - half * m.sin;
        let rz = -(half * m.cos + radius * m.sin);
        L::splat(1.0) + rz * spin.tilt * spin.tilt + rx * self.gyroscopic(m, spin)
    }

    /// How much more than 1 the press may be, as far as the motion before the impact tells.
    #[inline(always)]
    pub(crate) fn uplift<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        self.gyroscopic(m, spin).abs()
    }
}

/// A slip, and how fast it is.
struct Slip<L> {
    x: L,
    y: L,
    speed: L,
}

impl<L: Lane> Slip<L> {
    /// Of a contact that slides; along x at unit speed of one that does not.
    #[inline(always)]
    fn of(mode: Mode, x: L, y: L) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        if mode == Mode::Stick {
            return Self {
                x: one,
                y: zero,
                speed: one,
            };
        }
        let speed = (x * x + y * y).sqrt();
        let none = speed.le(zero);
        Self {
            x: L::select(none, one, x),
            y: L::select(none, zero, y),
            speed: L::select(none, one, speed),
        }
    }
}

/// The fastest rate of a coin in contact: of rolling, tilting, precessing, toppling.
#[inline(always)]
pub(crate) fn fastest<L: Lane>(m: &Motion<L>, spin: &Spin<L>) -> L {
    let azimuth = spin.turn / m.sin;
    (L::splat(1.0) + spin.axial * spin.axial + spin.tilt * spin.tilt + azimuth * azimuth).sqrt()
}
