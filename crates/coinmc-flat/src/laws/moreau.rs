//! Moreau's law of impact.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::impact_law::{ImpactLaw, PlanarLaw};
use crate::laws::chatterjee_ruina::ChatterjeeRuina;
use crate::settings_error::SettingsError;
use coinmc_core::schema::Values;
use coinmc_core::{EngineError, LawSettings, Scene};
use coinmc_lanes::{Lane, Mask};

/// Newton restitution u_z⁺ = −e u_z⁻ with Coulomb friction against the slip **after** the impact.
///
/// Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988): the
/// contact sticks if the impulse that stops it lies in the friction cone; otherwise it slides and
/// the friction impulse is −μ p_z against the final slip.
///
/// The work of the impulse is ½p·(u⁻ + u⁺). Its normal part −½(1 − e)|u_z⁻|p_z and the friction
/// with u⁺ dissipate energy; the friction with u⁻ may not. Where the sum would be positive, or no
/// solution exists, the impulse of [`ChatterjeeRuina`] is used.
#[derive(Debug, Clone, Copy)]
pub struct Moreau;

impl LawSettings for Moreau {
    const NAME: &'static str = "moreau";
    const DOC: &'static str = "Newton restitution, Coulomb friction against the final slip";

    fn read(_: &Values) -> Result<Self, EngineError> {
        Ok(Self)
    }
}

impl PlanarLaw for Moreau {
    type Impact = Self;

    fn impact(self, _: &Scene) -> Result<Self, SettingsError> {
        Ok(self)
    }
}

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
            // Of all impulses that give the normal rebound, a greater p_x leaves a greater slip, and p_x = x
            // none. Sliding with friction −μ p_z in the direction d is one whose slip has the sign of d: so
            // d x < −μ p_z < 0, and only the direction against x can be it.
            let friction = L::splat(mu) * -L::splat(1.0).copysign(x);
            let (slides, sliding) = slide(k, ux, rebound, friction);
            p = Impulse::select(!found & slides, sliding, p);
            found = found | slides;
        }
        let dissipates = found & work(k, ux, uz, p).le(L::splat(0.0));
        if (!dissipates).any() {
            let fallback = ChatterjeeRuina.impulse(k, ux, uz, e, mu);
            p = Impulse::select(dissipates, p, fallback);
        }
        p
    }
}

/// The impulse with friction −`friction`·p_z, and whether the contact then slides in the direction
/// of `friction`.
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

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::Dice;

    /// A sliding impulse gives the normal rebound with friction at the edge of its cone, and it is one if the slip
    /// after it has the direction that friction is against. Its work is the change of the kinetic energy, the
    /// quadratic form of the contact's mass matrix.
    #[test]
    fn sliding_impulses_rebound_and_do_the_work_of_their_change() {
        let (mut slides, mut others) = (0, 0);
        for trial in 0..1000 {
            let mut dice = Dice::new(63, trial);
            let (sin, cos) = libm::sincos(dice.between(-1.5, 1.5));
            let k = ContactMatrix::new(sin, cos, dice.between(0.1, 1.0));
            let (ux, uz) = (dice.between(-2.0, 2.0), -dice.between(0.1, 2.0));
            let friction = dice.pick(&[-1.0, 1.0]) * dice.between(0.05, 2.0);
            let rebound = -1.5 * uz;
            let (is_slide, p) = slide(k, ux, rebound, friction);
            let after = (ux + k.xx * p.x + k.xz * p.z, uz + k.xz * p.x + k.zz * p.z);
            // the resistance to it may be small
            let scale = 1.0 + p.z.abs();
            assert!((after.1 - (uz + rebound)).abs() < 1e-13 * scale);
            assert!((p.x + friction * p.z).abs() < 1e-13 * scale);
            if after.0.abs() > 1e-9 {
                assert_eq!(is_slide, p.z > 0.0 && after.0 * friction > 0.0);
            }
            *(if is_slide { &mut slides } else { &mut others }) += 1;
            // the energy of the contact point's velocity, to which the rest of the motion adds a constant
            let energy = |(x, z): (f64, f64)| {
                let (px, pz) = k.solve(x, z);
                0.5 * (x * px + z * pz)
            };
            let change = energy(after) - energy((ux, uz));
            assert!((work(k, ux, uz, p) - change).abs() < 1e-12 * scale * scale);
        }
        assert!(slides > 100 && others > 200, "{slides} {others}");
    }
}
