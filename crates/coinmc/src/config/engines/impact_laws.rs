//! The flat engine's law of impact at a point.

use super::super::build::{At, Fault, get};
use super::super::diagnostics::Problems;
use super::super::form::{Form, What};
use super::{is_somewhere_not_zero, named};
use coinmc_flat::{GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime};

/// The law in force.
pub(super) fn law(form: &Form, at: &At<'_>) -> Result<Law, Fault> {
    match &get(form, "law")?.what {
        What::Tagged("gaek-sukhov", inner) => Ok(Law::GaekSukhov(GaekSukhov {
            eta_n_s: at.required(inner, "eta_n_s")?,
            lever: named(inner, "lever", Lever::ALL, Lever::name)?,
        })),
        What::Tagged("half-sine", inner) => Ok(Law::HalfSine(HalfSine {
            time: match inner.get("contact") {
                Some(contact) => PulseTime::Contact(materials(contact, at)?),
                None => PulseTime::Given(at.required(inner, "time_s")?),
            },
            peak_n: at.optional(inner, "peak_n")?,
        })),
        What::Tagged(_, inner) => {
            let materials = materials(inner, at)?;
            let tangential = at
                .optional(inner, "tangential")?
                .unwrap_or_else(|| LineContact::mindlin(materials.coin_poisson));
            Ok(Law::LineContact(LineContact {
                materials,
                tangential,
            }))
        }
        _ => named(form, "law", Law::RIGID, Law::name),
    }
}

fn materials(form: &Form, at: &At<'_>) -> Result<Materials, Fault> {
    Ok(Materials {
        coin_young_pa: at.required(form, "coin_young_pa")?,
        coin_poisson: at.required(form, "coin_poisson")?,
        surface_young_pa: at.required(form, "surface_young_pa")?,
        surface_poisson: at.required(form, "surface_poisson")?,
        length_m: at.required(form, "length_m")?,
    })
}

/// Gaek & Sukhov's law has no friction: whatever the surface says would be ignored.
pub(super) fn refuse_friction(root: &Form, problems: &mut Problems) {
    let law = root.get("engine").and_then(|engine| match &engine.what {
        What::Tagged(_, inner) => inner.get("law"),
        _ => None,
    });
    let friction = root
        .get("surface")
        .and_then(|surface| surface.get("friction"));
    if law.and_then(Form::tag) == Some("gaek-sukhov")
        && let Some(friction) = friction.filter(|form| is_somewhere_not_zero(form))
    {
        problems.add_with_help(
            friction.span,
            "Gaek & Sukhov's law knows no friction: `surface.friction` must be 0",
            "set `friction = 0`, or take another `engine.flat.law`",
        );
    }
}
