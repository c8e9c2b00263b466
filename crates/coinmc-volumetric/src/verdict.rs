//! When the face of a toss is settled.
//!
//! # Energy
//! To pass from lying on a face to lying on the side, or back, the centre must rise to D at least
//! once: in contact the coin stands on its rim then, in flight it is higher still. So a coin whose
//! mechanical energy is below m g D stays in the well it is in: a face if its lowest point is
//! beyond the centre (c > h, tilt below the balance), else the side.
//!
//! # Tilting
//! Energy that cannot become tilt is left out:
//!
//! * *on the side*, the energy of straight rolling. A tangential impulse p at the contact changes
//!   v_y by p and ω_a by Rp/I_a, so Λ = v_y − (k_a/R) ω_a stays, and v_y and ω_a keep at least the
//!   energy Λ²/(2(1 + k_a/R²)) as long as the axis keeps its direction. Once the coin lies, its
//!   axis turns about the vertical at Ω_z, which neither weight nor a free rotation changes: v_y
//!   becomes v_x, and ω_a becomes ω_θ and tilt. In the time t that it takes to topple about
//!   Λ cos(Ω_z t) is left along the axis, so the share 1/(1 + Ω_z² t²) of the energy is left out,
//!   all of it for an axis that will not turn, and t² = `TOPPLING`. (The rate φ' at which the axis
//!   turns now will not do: a leaning coin that spins fast nods, and passes φ' = 0 while it is held
//!   up by Ω_z.) Nearly rigorous: `docs/validation/spatial.md` has the bias that is left.
//!   A coin that lies on both rims is settled, too, once the weight's moment is twice what could
//!   lift a rim (see `contact::line`);
//! * *flat on a face*, within `flat` of it, the energy of sliding and of spinning about u. Friction
//!   that slides under a coin tilted by θ has a moment of at most μN(h c + R s) about the centre,
//!   against N(R c − h s) of the weight's. What is left over has to be paid for by the rest of the
//!   energy, up to the tilt where nothing is, tan θ = (R − μh)/(h + μR):
//!   ∫ (R c − h s − μ(h c + R s)) dθ = sqrt(1 + μ²) − (h + μR), as R² + h² = 1. So the barrier for
//!   that rest, h already its potential, is not 1 but `brim` = sqrt(1 + μ²) − μR (1 without
//!   friction; h where μh = R, and beyond that friction tips the coin by itself).
//!
//! # Without friction
//! With μ = 0 the horizontal velocity never changes, and neither do the rules when its energy is
//! left out; nor can rolling tilt the coin, so on the side the energy of ω_a is left out instead.
//!
//! With no friction lengths the normal force has no moment about u or the vertical:
//! ω_a, L_z and the horizontal velocity never change. At the balance over a rim, u_z = c* = ±h,
//! the energy of turning about the vertical is then k_t(Ω_z − Ω_a c*)²/(2s*²), and the balance
//! cannot be passed with less than 1 plus that. This is exact for any e, in flight and in contact.

use crate::body::{Body, Friction};
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Lane, Mask};

/// What is known of a toss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    Open,
    /// The face that is up now.
    Face,
    Side,
}

/// The rules in force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Judge {
    body: Body,
    axial_factor: f64,
    tilting: bool,
    /// μ = 0.
    slides: bool,
    /// Nothing but normal forces act.
    smooth: bool,
    /// ½/(1 + k_a/R²) and k_a/R of straight rolling.
    rolling: f64,
    lever: f64,
    /// sin of the tilt below which a coin counts as flat; 0 where friction could tip it.
    flat: f64,
    /// What a flat coin has to exceed, beside sliding and spinning, to be tipped.
    brim: f64,
}

/// Square of the time, in sqrt(D/g), in which a rolling coin that turns topples: a choice. With 1
/// the bias of P(side) is .0018 where it is largest among the examples, with 2 it is .0004, for
/// 5 % of the rate where coins roll longest.
const TOPPLING: f64 = 2.0;

impl Judge {
    pub(crate) fn new(
        body: Body,
        friction: &Friction,
        axial_factor: f64,
        drags: bool,
        tilting: bool,
        flat: f64,
    ) -> Self {
        let r2 = body.radius * body.radius;
        Self {
            body,
            axial_factor,
            tilting,
            slides: friction.mu == 0.0,
            smooth: friction.mu == 0.0 && !friction.twists() && !drags,
            rolling: 0.5 / (1.0 + body.ka / r2),
            lever: body.ka / body.radius,
            flat: if friction.mu * body.half <= body.radius {
                flat
            } else {
                0.0
            },
            brim: (1.0 + friction.mu * friction.mu).sqrt() - friction.mu * body.radius,
        }
    }

    /// Whether energy that cannot tilt the coin is left out.
    pub(crate) fn tilts_only(&self) -> bool {
        self.tilting
    }

    /// Whether the coin leans towards its side.
    #[inline(always)]
    pub(crate) fn on_side<L: Lane>(&self, m: &Motion<L>) -> L::Mask {
        m.cos.lt(L::splat(self.body.half))
    }

    #[inline]
    pub(crate) fn verdict(&self, m: &Motion<f64>, spin: &Spin<f64>) -> Verdict {
        if !self.settles(m, spin) {
            Verdict::Open
        } else if self.on_side(m) {
            Verdict::Side
        } else {
            Verdict::Face
        }
    }

    /// Whether the face is settled.
    #[inline(always)]
    pub(crate) fn settles<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L::Mask {
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let mut energy = m.energy(&self.body, spin);
        let sliding = half * (m.vx * m.vx + m.vy * m.vy);
        if self.slides {
            energy -= sliding;
        }
        let mut settled = energy.lt(one);
        if !(!settled).any() {
            return settled;
        }
        let side = self.on_side(m);
        let spinning = L::splat(0.5 * self.body.ka) * spin.axial * spin.axial;
        if self.tilting {
            let lies = !side & m.sin.lt(L::splat(self.flat));
            let flat = if self.slides {
                spinning
            } else {
                spinning + sliding
            };
            let rolling = if self.slides {
                spinning
            } else {
                self.rolling_left_out(m, spin)
            };
            let idle = L::select(side, rolling, L::select(lies, flat, L::splat(0.0)));
            let barrier = L::select(lies, L::splat(self.brim), one);
            settled = settled | (energy - idle).lt(barrier);
        }
        if self.smooth {
            settled = settled | self.is_trapped(m, spin, energy - spinning, side);
        }
        settled
    }

    /// See the module's text, *Tilting*: the share of straight rolling that is left out.
    #[inline(always)]
    fn rolling_left_out<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        let invariant = m.vy - L::splat(self.lever) * spin.axial;
        let turns = L::splat(1.0) + L::splat(TOPPLING) * m.oz * m.oz;
        L::splat(self.rolling) * invariant * invariant / turns
    }

    /// See the module's text, *Without friction*.
    #[inline(always)]
    fn is_trapped<L: Lane>(
        &self,
        m: &Motion<L>,
        spin: &Spin<L>,
        free: L,
        side: L::Mask,
    ) -> L::Mask {
        let Body {
            radius, half, kt, ..
        } = self.body;
        let axial = L::splat(self.axial_factor) * spin.axial;
        let near = (m.oz - axial * L::splat(half)) / L::splat(radius);
        let far = (m.oz + axial * L::splat(half)) / L::splat(radius);
        let most = |turn: L| L::splat(1.0) + L::splat(0.5 * kt) * turn * turn;
        free.lt(most(near)) & (!side | free.lt(most(far)))
    }

    /// Whether nothing is ever lost: such a toss is settled at its launch or never.
    pub(crate) fn conserves(&self, restitution: f64) -> bool {
        self.smooth && restitution == 1.0
    }
}
