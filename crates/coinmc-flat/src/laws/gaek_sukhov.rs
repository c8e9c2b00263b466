//! The law of impact of Gaek & Sukhov, arXiv 2401.03557, as published.
//!
//! Before the impact the coin has fallen from the height h₁ and has the angular velocity ω₁; after
//! it the coin rises to h₃ with ω₂:
//!
//! k m g h₁ + I ω₁²/2 = m g h₃ + I ω₂²/2,  Δω = ω₂ − ω₁ = η H cos θ/I,  η = 2 N_max τ/π,
//!
//! where θ is the tilt of the face and η the impulse of half a sine of height N_max and length τ, a
//! constant that does not depend on the speed. k is the share of the energy of fall that a bounce
//! leaves. A coin that lands without turning rebounds with restitution e = √k, so k is the square
//! of the surface's restitution here. Horizontal motion is unchanged.
//!
//! The heights stand for the energy of vertical motion, h = v_z²/2g. This is exact for a dropped
//! coin, and the only interpretation that works at every impact.
//!
//! # Where it breaks
//! The energy of rotation and the impulse η are independent of each other, so nothing keeps them
//! consistent:
//! * **h₃ < 0** where |ω₂| > sqrt(ω₁² + 2 k m g h₁/I). Counted (`negative_heights`), and as a gain
//!   of energy as well where rotation alone would have more than the coin had before
//!   (`energy_gains`).
//! * **The corner** would keep moving into the surface: v_z⁺ is less than the speed with which ω₂
//!   moves the corner down. Counted (`sinkings`).
//! * **The lever** H cos θ never changes sign; that of the corner, R cos θ − (H/2) sin θ, does
//!   where the centre passes over the corner. Counted (`wrong_levers`), and used as published.
//!
//! *Fallback* of the first two: the frictionless impact of the corner with e = √k, which loses
//! energy. Setting h₃ = 0 and keeping the energy balance instead would let coins rock from corner
//! to corner forever, because the law takes no energy from rotation.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::impact_law::{Impact, ImpactLaw, PlanarLaw, Resolution};
use crate::laws::moreau::Moreau;
use crate::settings_error::SettingsError;
use crate::shape::{Quadrant, Shape};
use coinmc_core::schema::{Absent, Bounds, TableKind, Values, choice, fields, number};
use coinmc_core::{EngineError, LawSettings, Scene, Unmodelled};
use coinmc_lanes::{Lane, sin_cos};

/// Least restitution in the estimate of the time of the remaining bounces: the rotation that the
/// law adds lets a coin rebound even with k = 0.
const MIN_EFFECTIVE_RESTITUTION: f64 = 0.5;

/// Gaek & Sukhov's law: its constant beside k, and the interpretation of its lever.
///
/// # Example
/// ```
/// use coinmc_flat::{Law, Lever, GaekSukhov, Settings};
/// let law = Law::GaekSukhov(GaekSukhov { eta_n_s: 0.01, lever: Lever::Height });
/// assert!(Settings { law, ..Settings::default() }.validate().is_ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaekSukhov {
    /// η = 2 N_max τ/π, N s.
    pub eta_n_s: f64,
    /// The lever of the impulse η.
    pub lever: Lever,
}

/// Lever of the impulse about the centre, θ the tilt of the face from the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lever {
    /// H cos θ, towards the face, as in the published formula.
    #[default]
    Height,
    /// L cos θ with L = 2R, towards the face: one published formula has this letter instead of H.
    Diameter,
    /// R cos θ − (H/2) sin θ, the lever of the touching corner.
    Corner,
}

impl Lever {
    /// All levers.
    pub const ALL: [Self; 3] = [Self::Height, Self::Diameter, Self::Corner];

    /// The name used in configs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Diameter => "diameter",
            Self::Corner => "corner",
        }
    }

    fn doc(self) -> &'static str {
        match self {
            Self::Height => "H cos θ, as published",
            Self::Diameter => "2R cos θ, the letter L of one of its formulas",
            Self::Corner => "R cos θ − (H/2) sin θ, that of the corner that touches",
        }
    }
}

const ETA_N_S: Bounds = Bounds::closed(0.0, 1e12);

impl LawSettings for GaekSukhov {
    const NAME: &'static str = "gaek-sukhov";
    const DOC: &'static str =
        "Gaek & Sukhov's law as published: surface.restitution is the square root of its k.";
    const UNMODELLED: &'static [Unmodelled] = &[Unmodelled {
        table: "surface",
        key: "friction",
        message: "Gaek & Sukhov's law has no friction: `surface.friction` must be 0",
        help: "set `friction = 0`, or take another `engine.flat.law`",
    }];

    fn parameters() -> TableKind {
        fields(vec![
            number(
                "eta_n_s",
                "Its constant η = 2·N_max·τ/π, the impulse that turns the coin, N s.",
                ETA_N_S,
                Absent::Required,
            ),
            choice(
                "lever",
                "Lever of that impulse, θ the tilt of the face.",
                Lever::ALL.map(|lever| (lever.name(), lever.doc())),
                Lever::default().name(),
            ),
        ])
    }

    fn read(parameters: &Values) -> Result<Self, EngineError> {
        Ok(Self {
            eta_n_s: parameters.number("eta_n_s")?,
            lever: parameters.one_of("lever", Lever::ALL, Lever::name)?,
        })
    }
}

impl PlanarLaw for GaekSukhov {
    type Impact = GaekSukhovImpact;

    fn validate(&self) -> Result<(), SettingsError> {
        Ok(ETA_N_S.check("eta_n_s", self.eta_n_s)?)
    }

    fn impact(self, scene: &Scene) -> Result<GaekSukhovImpact, SettingsError> {
        GaekSukhovImpact::new(scene, self)
    }
}

/// [`GaekSukhov`] in one scene, in dimensionless units.
#[derive(Debug, Clone, Copy)]
pub struct GaekSukhovImpact {
    gaek_sukhov: GaekSukhov,
    /// η in units of m sqrt(g D).
    eta: f64,
}

impl GaekSukhovImpact {
    /// The law in this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if η is out of range or the surface has friction.
    pub fn new(scene: &Scene, gaek_sukhov: GaekSukhov) -> Result<Self, SettingsError> {
        gaek_sukhov.validate()?;
        let friction = scene.surface.friction();
        if friction != 0.0 {
            return Err(SettingsError::Friction(friction));
        }
        let speed = scene.coin.rim_distance_m() / scene.time_scale_s();
        Ok(Self {
            gaek_sukhov,
            eta: gaek_sukhov.eta_n_s / (scene.coin.mass_kg() * speed),
        })
    }

    /// Lever in D, positive where it turns the coin towards growing θ.
    fn lever(&self, shape: &Shape, quadrant: Quadrant, delta: f64) -> f64 {
        let (side, tilt) = shape.face_tilt(quadrant, delta);
        let (half_height, radius) = shape.base(0, false);
        match self.gaek_sukhov.lever {
            Lever::Height => side * 2.0 * half_height * sin_cos(tilt).1,
            Lever::Diameter => side * 2.0 * radius * sin_cos(tilt).1,
            Lever::Corner => sin_cos(delta).0,
        }
    }
}

impl ImpactLaw for GaekSukhovImpact {
    const BATCHED: bool = false;

    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        Moreau.impulse(k, ux, uz, e, mu)
    }

    fn effective_restitution(&self, e: f64) -> f64 {
        e.max(MIN_EFFECTIVE_RESTITUTION)
    }

    fn resolve(&self, impact: &mut Impact<'_>) -> Resolution {
        let (shape, breaks) = (impact.shape, &mut *impact.breaks);
        let motion = &mut *impact.motion;
        let inertia = shape.k;
        let sin = sin_cos(motion.delta).0;
        let lever = self.lever(shape, motion.quadrant, motion.delta);
        breaks.wrong_levers += u32::from(lever * sin < 0.0);
        let fall = 0.5 * motion.vz * motion.vz;
        let kept = impact.restitution * impact.restitution * fall;
        let omega = motion.omega + self.eta * lever / inertia;
        let turned = 0.5 * inertia * (motion.omega * motion.omega - omega * omega);
        let rise = kept + turned;
        if rise < 0.0 {
            breaks.negative_heights += 1;
            breaks.energy_gains += u32::from(fall + turned < 0.0);
            return Resolution::UseImpulse;
        }
        let speed = (2.0 * rise).sqrt();
        if speed + omega * sin < 0.0 {
            breaks.sinkings += 1;
            return Resolution::UseImpulse;
        }
        (motion.vz, motion.omega) = (speed, omega);
        Resolution::Separates
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::scene;

    /// What each lever is said to be is what it is: its description begins with its formula.
    #[test]
    fn levers_are_what_their_descriptions_say() {
        let scene = scene(1.5, 0.5, 0.0);
        let shape = Shape::new(&scene.coin);
        let (half_height, radius) = shape.base(0, false);
        let delta = 0.2;
        // the first quadrant begins flat on a face
        let (sin, cos) = libm::sincos(delta + shape.first_span(0));
        for lever in Lever::ALL {
            let settings = GaekSukhov {
                eta_n_s: 0.0,
                lever,
            };
            let law = settings.impact(&scene).expect("valid");
            let (formula, value) = match lever {
                Lever::Height => ("H cos θ", 2.0 * half_height * cos),
                Lever::Diameter => ("2R cos θ", 2.0 * radius * cos),
                Lever::Corner => ("R cos θ − (H/2) sin θ", radius * cos - half_height * sin),
            };
            assert!(lever.doc().starts_with(formula));
            let found = law.lever(&shape, 0, delta);
            assert!((found.abs() - value.abs()).abs() < 1e-14, "{formula}");
        }
    }
}
