//! Impact of a corner: from the contact velocity before to the impulse.
//!
//! Everything is per unit mass and in the xz plane. With r = (−sin δ, −cos δ) the corner seen
//! from the centre, an impulse p changes the contact velocity by K p,
//!
//! K_xx = 1 + r_z²/k,  K_zz = 1 + r_x²/k,  K_xz = −r_x r_z/k  (lengths in D, k = I/mD²).

use crate::motion::Motion;
use crate::settings::Law;
use crate::shape::Shape;
use coinmc_core::Breaks;
use coinmc_lanes::{Lane, Mask};

/// The contact's inverse mass matrix K.
#[derive(Debug, Clone, Copy)]
pub struct ContactMatrix<L = f64> {
    /// Horizontal velocity by horizontal impulse.
    pub xx: L,
    /// Horizontal velocity by normal impulse.
    pub xz: L,
    /// Normal velocity by normal impulse.
    pub zz: L,
}

impl<L: Lane> ContactMatrix<L> {
    /// K of a corner with the centre at angle δ beyond its balance, sin δ and cos δ given.
    #[inline(always)]
    pub fn new(sin: L, cos: L, k: f64) -> Self {
        let (one, k) = (L::splat(1.0), L::splat(k));
        Self {
            xx: one + cos * cos / k,
            xz: -sin * cos / k,
            zz: one + sin * sin / k,
        }
    }

    /// det K = 1 + 1/k: the corner is a distance 1 from the centre, whatever δ.
    #[inline(always)]
    fn determinant(self) -> L {
        self.xx * self.zz - self.xz * self.xz
    }

    /// The impulse that changes the contact velocity by (dx, dz).
    #[inline(always)]
    pub(crate) fn solve(self, dx: L, dz: L) -> (L, L) {
        let inverse = L::splat(1.0) / self.determinant();
        (
            (self.zz * dx - self.xz * dz) * inverse,
            (self.xx * dz - self.xz * dx) * inverse,
        )
    }
}

/// An impulse per unit mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse<L: Lane = f64> {
    /// Horizontal part.
    pub x: L,
    /// Normal part, not negative.
    pub z: L,
    /// The contact point does not slide afterwards.
    pub sticks: L::Mask,
}

impl<L: Lane> Impulse<L> {
    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            x: L::select(mask, yes.x, no.x),
            z: L::select(mask, yes.z, no.z),
            sticks: (mask & yes.sticks) | (!mask & no.sticks),
        }
    }
}

/// A law of impact at one corner.
///
/// A law is an own type with its citation and the argument why it never gains energy. To add
/// one: implement this trait, add a variant to [`Law`] and an arm where the engine is built.
pub trait ImpactLaw: Copy + Sync {
    /// Whether an impact is its impulse and no more, so that impacts go side by side.
    const SIDE_BY_SIDE: bool = true;

    /// The impulse for contact velocity (`ux`, `uz`) before the impact (uz < 0 approaches),
    /// restitution `e` and friction `mu`: of one impact, or of several side by side.
    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L>;

    /// Its name in configs and results.
    fn law(&self) -> Law;

    /// Carries the coin through an impact that is more than an impulse at one instant; a law that
    /// does so is not [`SIDE_BY_SIDE`](Self::SIDE_BY_SIDE). The default leaves it to
    /// [`impulse`](Self::impulse).
    #[inline]
    fn carry(&self, _: &mut Strike<'_>) -> Carried {
        Carried::ByImpulse
    }

    /// Carries the coin only so far into an impact that [`carry`](Self::carry) has found to last
    /// longer than `time`: for observers. The default is for laws without duration.
    fn look_into(&self, _: &mut Strike<'_>, _time: f64) {}

    /// The restitution by which the time of the bounces that remain is judged.
    #[inline]
    fn rebound(&self, e: f64) -> f64 {
        e
    }
}

/// An impact about to happen: the coin with its lowest corner on the surface, and what holds
/// there. Made and read by this crate's laws only.
pub struct Strike<'a> {
    pub(crate) motion: &'a mut Motion,
    pub(crate) shape: &'a Shape,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) tolerance: f64,
    pub(crate) breaks: &'a mut Breaks,
    /// Force and steps of the impact, for whoever looks at it alone.
    pub(crate) record: Record,
}

/// What an impact resolved in time was like, in units of m, D and sqrt(D/g).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Record {
    pub(crate) peak_force: f64,
    pub(crate) steps: u32,
    /// Energy before, less energy after, less what damping and friction took.
    pub(crate) imbalance: f64,
}

/// What a law made of an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carried {
    /// Nothing: its impulse describes the impact.
    ByImpulse,
    /// Carried to the end; the coin leaves the surface.
    Departs,
    /// Carried on until the corner stays on the surface.
    Presses,
}

/// Newton restitution u_z⁺ = −e u_z⁻ with Coulomb friction against the slip **after** the impact.
///
/// Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988): the
/// contact sticks if the impulse that stops it lies in the friction cone, else it slides and the
/// friction impulse is −μ p_z against the final slip. The work of the impulse is
/// ½p·(u⁻ + u⁺), of which the normal part −½(1 − e)|u_z⁻|p_z and the friction with u⁺ dissipate;
/// the friction with u⁻ need not. Where the sum would be positive, or no solution exists, the
/// impulse of [`ChatterjeeRuina`] is used.
#[derive(Debug, Clone, Copy)]
pub struct Moreau;

impl ImpactLaw for Moreau {
    #[inline(always)]
    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        let rebound = L::splat(-(1.0 + e)) * uz;
        if mu == 0.0 {
            return Impulse {
                x: L::splat(0.0),
                z: rebound / k.zz,
                sticks: L::Mask::splat(false),
            };
        }
        let (x, z) = k.solve(-ux, rebound);
        let sticks = x.abs().le(L::splat(mu) * z);
        let (mut p, mut found) = (Impulse { x, z, sticks }, sticks);
        if (!sticks).any() {
            // the friction that would be needed shows which way it fails to stop the slip
            let friction = L::splat(mu) * -L::splat(1.0).copysign(x);
            for friction in [friction, -friction] {
                let (slides, one) = slide(k, ux, rebound, friction);
                p = Impulse::select(!found & slides, one, p);
                found = found | slides;
                if !(!found).any() {
                    break;
                }
            }
        }
        let sound = found & work(k, ux, uz, p).le(L::splat(0.0));
        if (!sound).any() {
            let guard = ChatterjeeRuina.impulse(k, ux, uz, e, mu);
            p = Impulse::select(sound, p, guard);
        }
        p
    }

    fn law(&self) -> Law {
        Law::Moreau
    }
}

/// The impulse with friction −`friction`·p_z, and whether the contact then slides in `friction`'s
/// direction.
#[inline(always)]
fn slide<L: Lane>(k: ContactMatrix<L>, ux: L, rebound: L, friction: L) -> (L::Mask, Impulse<L>) {
    let zero = L::splat(0.0);
    let resistance = k.zz - friction * k.xz;
    let z = rebound / resistance;
    let slip = ux + (k.xz - friction * k.xx) * z;
    let slides = zero.lt(resistance) & zero.lt(slip * friction);
    let x = -friction * z;
    let sticks = L::Mask::splat(false);
    (slides, Impulse { x, z, sticks })
}

/// Energy that an impulse adds, ½p·(u⁻ + u⁺).
#[inline(always)]
fn work<L: Lane>(k: ContactMatrix<L>, ux: L, uz: L, p: Impulse<L>) -> L {
    let after_x = ux + k.xx * p.x + k.xz * p.z;
    let after_z = uz + k.xz * p.x + k.zz * p.z;
    L::splat(0.5) * (p.x * (ux + after_x) + p.z * (uz + after_z))
}

/// Chatterjee & Ruina, "A new algebraic rigid-body collision law", J. Appl. Mech. 65 (1998) 939,
/// with tangential restitution 0: p = (1 + e)p_I + κ(p_II − p_I).
///
/// p_I is the frictionless plastic impulse, p_II the one that stops the contact altogether, κ the
/// largest value up to 1 inside the friction cone. As K p_II − K p_I has no normal component,
/// p_I and p_II − p_I are orthogonal in the energy metric, and the energy changes by
/// −½(1 − e²)(u_z²/K_zz) − κ(1 − κ/2)·|p_II − p_I|²_K <= 0 for e and κ in [0, 1]; u_z⁺ = −e u_z⁻.
#[derive(Debug, Clone, Copy)]
pub struct ChatterjeeRuina;

impl ImpactLaw for ChatterjeeRuina {
    #[inline(always)]
    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        let friction = L::splat(mu);
        let smooth = -uz / k.zz;
        let (stop_x, stop_z) = k.solve(-ux, -uz);
        let (dx, dz) = (stop_x, stop_z - smooth);
        let base = L::splat(1.0 + e) * smooth;
        let inside = dx.abs().le(friction * (base + dz));
        // where it is not, |dx| > mu (base + dz) and 0 <= mu base: the denominator is positive
        let outside = friction * base / (dx.abs() - friction * dz);
        let kappa = L::select(inside, L::splat(1.0), outside);
        // with e = 0 and κ = 1 this is p_II: the contact stops
        Impulse {
            x: kappa * dx,
            z: base + kappa * dz,
            sticks: inside & L::Mask::splat(e == 0.0),
        }
    }

    fn law(&self) -> Law {
        Law::ChatterjeeRuina
    }
}
