//! The algebraic law of Chatterjee and Ruina.

use crate::body::{Body, Friction};
use crate::impact::contact_point::Condensed;
use crate::impact::friction_moments::FrictionMoments;
use crate::impact::{ContactPoint, ImpactLaw, Impulse};
use coinmc_core::schema::Values;
use coinmc_core::{EngineError, LawSettings};
use coinmc_lanes::Lane;

/// Chatterjee & Ruina, "A new algebraic rigid-body collision law", J. Appl. Mech. 65 (1998) 939,
/// with tangential restitution 0: p = (1 + e)p_I + κ(p_II − p_I).
///
/// p_I is the frictionless plastic impulse, p_II = −K⁻¹u⁻ stops the contact point, and κ is the
/// largest value up to 1 that keeps p inside the friction cone. u_z⁺ = −e u_z⁻.
///
/// # Energy
/// d = p_II − p_I does not change the normal velocity, (K d)_z = 0, while p_I is normal. So p_I·K
/// d = 0: the two are orthogonal in the energy metric. With u⁻ = −K p_II the energy changes by
///
/// p·u⁻ + ½ p·K p = −½(1 − e²) u_z²/K_zz − κ(1 − κ/2) d·K d <= 0     (0 <= e <= 1, 0 <= κ <= 1).
///
/// The friction lengths act after p: within |J_c| <= ρ_c p_z and |J_p| <= ρ_p p_z, they leave the
/// least energy. As J = 0 is one of the choices, they dissipate too.
///
/// # Compared with the other laws
/// Friction opposes the slip at the middle of the impact, −d_t, and not the slip at its end. So
/// after a sliding impact the slip need not be antiparallel to the friction. With e > 0 an impact
/// that could stick leaves the contact point with e times the slip that p_I of a plastic impact
/// causes ([`Moreau`](super::Moreau) stops it). Friction and the friction lengths are not solved
/// jointly: J follows after p_y.
#[derive(Debug, Clone, Copy)]
pub struct ChatterjeeRuina;

impl LawSettings for ChatterjeeRuina {
    const NAME: &'static str = "chatterjee-ruina";
    const DOC: &'static str = "Chatterjee & Ruina (1998), tangential restitution 0";

    fn read(_: &Values) -> Result<Self, EngineError> {
        Ok(Self)
    }
}

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
            // the impulse at constant u_z that stops the slip left after p_I
            let x = -(point.slip_x + k.xz * smooth) / alpha;
            let y = -point.slip_y / k.yy;
            let z = -coupling * x;
            let mu = L::splat(friction.mu);
            let size = (x * x + y * y).sqrt();
            let excess = size - mu * z;
            let limit = mu * base;
            // inside the cone size <= μ (base + z); outside excess > μ base >= 0, and κ < 1
            let kappa = L::select(excess.le(limit), L::splat(1.0), limit / excess);
            p.x = kappa * x;
            p.y = kappa * y;
            // from the normal condition instead of base + κ z: this makes u_z⁺ = −e u_z⁻ most exact
            p.z = base - coupling * p.x;
        }
        if friction.has_lengths() {
            let (contour, pivoting) =
                FrictionMoments::new(body, friction, point, k.yy).held(p.y, p.z);
            p.contour = point.sin * contour;
            p.pivoting = pivoting;
        }
        p
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Rigid;
    use coinmc_testkit::Dice;
    use nalgebra::{Matrix3, Vector3};

    /// p = (1 + e)p_I + κ(p_II − p_I), where p_I ends the approach without friction, p_II stops the contact point, and κ is
    /// 1 or as large as friction allows: from what impulses do to the coin in vectors.
    #[test]
    fn the_impulse_goes_from_the_smooth_one_to_the_one_that_stops_as_far_as_friction_allows() {
        let (mut stops, mut slides) = (0, 0);
        for trial in 0..500 {
            let mut dice = Dice::new(328, trial);
            let body = Rigid::generic_body(dice.pick(&[0.0, 0.15]));
            let friction = Friction {
                mu: dice.between(0.05, 1.0),
                contour: 0.0,
                pivoting: 0.0,
            };
            let tilt = dice.between(0.2, 1.5);
            let mut coin = Rigid::new(&body, tilt, dice.vector(1.0), dice.vector(2.0));
            coin.velocity.z -= coin.at_contact().z + dice.between(0.3, 1.5);
            let e = dice.between(0.0, 1.0);
            let (motion, spin) = coin.folded(1.0, 1.0);
            let point = motion.contact_point(&body, &spin);
            let p = ChatterjeeRuina.impulse(&body, &friction, &point, e);

            let before = coin.at_contact();
            let moves = |impulse: Vector3<f64>| {
                coin.pushed(impulse, Vector3::zeros()).at_contact() - before
            };
            let k = Matrix3::from_columns(&[Vector3::x(), Vector3::y(), Vector3::z()].map(moves));
            let smooth = Vector3::z() * (-before.z / k.m33);
            let way = -(k.try_inverse().expect("positive masses") * before) - smooth;
            let rest = Vector3::new(p.x, p.y, p.z) - smooth * (1.0 + e);
            let kappa = rest.dot(&way) / way.norm_squared();
            assert!((rest - way * kappa).norm() < 1e-12, "{trial}");
            let (size, limit) = (libm::hypot(p.x, p.y), friction.mu * p.z);
            if (kappa - 1.0).abs() < 1e-9 {
                stops += 1;
                assert!(size < limit * (1.0 + 1e-9), "{trial}");
            } else {
                slides += 1;
                assert!(0.0 < kappa && kappa < 1.0, "{trial}: {kappa}");
                assert!((size / limit - 1.0).abs() < 1e-9, "{trial}");
            }
        }
        assert!(stops > 50 && slides > 50, "{stops} {slides}");
    }
}
