//! A law of impact: how one impact changes the motion of the coin.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::motion::Motion;
use crate::settings_error::SettingsError;
use crate::shape::Shape;
use coinmc_core::{Breaks, LawSettings, Scene};
use coinmc_lanes::Lane;

/// A law of impact at one corner.
///
/// Each law is a type of its own, documented with its citation and the argument why it never gains
/// energy. Most laws are an [`impulse`](Self::impulse) at one instant; a law with a duration
/// [`resolve`](Self::resolve)s the impact itself.
pub trait ImpactLaw: Copy + Sync {
    /// Whether an impact is its impulse and nothing more, so that a batch can compute eight at a
    /// time.
    const BATCHED: bool = true;

    /// The impulse for the velocity (`ux`, `uz`) of the corner before the impact (uz < 0
    /// approaches), restitution `e` and friction `mu`: of one impact, or of one per lane.
    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L>;

    /// Moves the coin through an impact that is more than an impulse at one instant. A law that
    /// does so is not [`BATCHED`](Self::BATCHED). By default [`impulse`](Self::impulse) is used.
    #[inline]
    fn resolve(&self, _: &mut Impact<'_>) -> Resolution {
        Resolution::UseImpulse
    }

    /// Moves the coin to `time` after the touch, for observers. [`resolve`](Self::resolve) has
    /// found the impact to last longer than that. The default is for laws without duration.
    fn resolve_until(&self, _: &mut Impact<'_>, _time: f64) {}

    /// The restitution from which the duration of the remaining bounces is estimated.
    #[inline]
    fn effective_restitution(&self, e: f64) -> f64 {
        e
    }
}

/// A law of impact with the parameters that a user gives, before it is applied to a scene.
pub trait PlanarLaw: LawSettings {
    /// The law in a scene.
    type Impact: ImpactLaw;

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`SettingsError`] if one is out of range.
    fn validate(&self) -> Result<(), SettingsError> {
        Ok(())
    }

    /// The law in this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if a parameter is out of range, or the law does not go with the scene.
    fn impact(self, scene: &Scene) -> Result<Self::Impact, SettingsError>;
}

/// An impact about to happen: the coin with its lowest corner on the surface, and the parameters of
/// the contact. Only the laws of this crate create and read it.
pub struct Impact<'a> {
    pub(crate) motion: &'a mut Motion,
    pub(crate) shape: &'a Shape,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) tolerance: f64,
    pub(crate) breaks: &'a mut Breaks,
    /// Force and steps of the impact, for the study of single impacts.
    pub(crate) record: ImpactRecord,
}

/// Measurements of an impact resolved in time, in units of m, D and sqrt(D/g).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ImpactRecord {
    pub(crate) peak_force: f64,
    pub(crate) steps: u32,
    /// Energy before, minus energy after, minus what damping and friction took.
    pub(crate) imbalance: f64,
}

/// How a law has resolved an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// Not resolved: the law's impulse describes the impact.
    UseImpulse,
    /// Resolved to the end: the coin leaves the surface.
    Separates,
    /// Resolved to an instant after which the corner stays on the surface.
    StaysInContact,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// An impact of this coin with e = 1/2 and μ = .3.
    pub(crate) fn impact<'a>(
        motion: &'a mut Motion,
        shape: &'a Shape,
        breaks: &'a mut Breaks,
    ) -> Impact<'a> {
        Impact {
            motion,
            shape,
            restitution: 0.5,
            friction: 0.3,
            tolerance: 1e-6,
            breaks,
            record: ImpactRecord::default(),
        }
    }
}
