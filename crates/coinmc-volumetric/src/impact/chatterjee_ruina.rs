//! The algebraic law of Chatterjee and Ruina.

use super::contact_point::Condensed;
use super::{ContactPoint, ImpactLaw, Impulse, friction_moments::FrictionMoments};
use crate::body::{Body, Friction};
use coinmc_lanes::Lane;

/// Chatterjee & Ruina, "A new algebraic rigid-body collision law", J. Appl. Mech. 65 (1998) 939,
/// with tangential restitution 0: p = (1 + e)p_I + κ(p_II − p_I).
///
/// p_I is the frictionless plastic impulse, p_II = −K⁻¹u⁻ stops the contact point altogether, κ is
/// the largest value up to 1 that keeps p inside the friction cone; u_z⁺ = −e u_z⁻.
///
/// # Energy
/// d = p_II − p_I leaves the normal velocity alone, (K d)_z = 0, while p_I is normal: p_I·K d = 0,
/// they are orthogonal in the energy metric. With u⁻ = −K p_II the energy changes by
///
/// p·u⁻ + ½ p·K p = −½(1 − e²) u_z²/K_zz − κ(1 − κ/2) d·K d <= 0     (0 <= e <= 1, 0 <= κ <= 1).
///
/// The friction lengths act after p, within |J_c| <= ρ_c p_z and |J_p| <= ρ_p p_z, so as to leave
/// the least energy: J = 0 is among the choices, so they dissipate too.
///
/// # Against the other laws
/// Friction opposes the slip of the middle of the impact, −d_t, not that of its end: after a
/// sliding impact the slip need not be antiparallel to the friction, and with e > 0 an impact that
/// could stick leaves the contact point with a slip of e times what a plastic impact's p_I causes
/// ([`Moreau`](super::Moreau) stops it). Friction and the friction lengths do not share in the
/// sideways slip: J comes after p_y, not jointly with it.
#[derive(Debug, Clone, Copy)]
pub struct ChatterjeeRuina;

impl ImpactLaw for ChatterjeeRuina {
    #[inline(always)]
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        point: &ContactPoint<L>,
        e: L,
    ) -> Impulse<L> {
        let k = point.matrix(body);
        let zero = L::splat(0.0);
        let Condensed {
            mass_z,
            coupling,
            alpha,
        } = k.condensed();
        let smooth = (-point.approach).max(zero) * mass_z;
        let base = (L::splat(1.0) + e) * smooth;
        let mut p = Impulse::none();
        p.z = base;
        if friction.mu > 0.0 {
            // what is left of the slip after p_I, and the impulse at constant u_z that stops it
            let x = -(point.slip_x + k.xz * smooth) / alpha;
            let y = -point.slip_y / k.yy;
            let z = -coupling * x;
            let mu = L::splat(friction.mu);
            let size = (x * x + y * y).sqrt();
            let excess = size - mu * z;
            let limit = mu * base;
            // inside: size <= μ (base + z); else excess > μ base >= 0 and the quotient is below 1
            let kappa = L::select(excess.le(limit), L::splat(1.0), limit / excess);
            p.x = kappa * x;
            p.y = kappa * y;
            // from the normal condition, not base + κ z: u_z⁺ = −e u_z⁻ to the last bits
            p.z = base - coupling * p.x;
        }
        if friction.twists() {
            let (contour, pivoting) =
                FrictionMoments::new(body, friction, point, k.yy).held(p.y, p.z);
            p.contour = point.sin * contour;
            p.pivoting = pivoting;
        }
        p
    }
}
