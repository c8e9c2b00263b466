//! Chatterjee & Ruina's law of impact.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::impact_law::{ImpactLaw, PlanarLaw};
use crate::settings_error::SettingsError;
use coinmc_core::schema::Values;
use coinmc_core::{EngineError, LawSettings, Scene};
use coinmc_lanes::{Lane, Mask};

/// Chatterjee & Ruina, "A new algebraic rigid-body collision law", J. Appl. Mech. 65 (1998) 939,
/// with tangential restitution 0: p = (1 + e)p_I + κ(p_II − p_I).
///
/// p_I is the frictionless plastic impulse, p_II the impulse that stops the contact altogether, κ
/// the largest value up to 1 inside the friction cone. As K p_II − K p_I has no normal component,
/// p_I and p_II − p_I are orthogonal in the energy metric, and the energy changes by −½(1 −
/// e²)(u_z²/K_zz) − κ(1 − κ/2)·|p_II − p_I|²_K <= 0 for e and κ in [0, 1]; u_z⁺ = −e u_z⁻.
#[derive(Debug, Clone, Copy)]
pub struct ChatterjeeRuina;

impl LawSettings for ChatterjeeRuina {
    const NAME: &'static str = "chatterjee-ruina";
    const DOC: &'static str = "Chatterjee & Ruina (1998), tangential restitution 0";

    fn read(_: &Values) -> Result<Self, EngineError> {
        Ok(Self)
    }
}

impl PlanarLaw for ChatterjeeRuina {
    type Impact = Self;

    fn impact(self, _: &Scene) -> Result<Self, SettingsError> {
        Ok(self)
    }
}

impl ImpactLaw for ChatterjeeRuina {
    #[inline(always)]
    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        let friction = L::splat(mu);
        let smooth = -uz / k.zz;
        let (stop_x, stop_z) = k.solve(-ux, -uz);
        let (dx, dz) = (stop_x, stop_z - smooth);
        let base = L::splat(1.0 + e) * smooth;
        let inside = dx.abs().le(friction * (base + dz));
        // outside, |dx| > mu (base + dz) and 0 <= mu base: the denominator is positive
        let outside = friction * base / (dx.abs() - friction * dz);
        let kappa = L::select(inside, L::splat(1.0), outside);
        // with e = 0 and κ = 1 this is p_II: the contact stops
        Impulse {
            x: kappa * dx,
            z: base + kappa * dz,
            sticks: inside & L::Mask::splat(e == 0.0),
        }
    }
}
