//! What a plan computes and what it skips, in words.

mod omission;
mod without_tosses;

use super::{EngineChoice, Plan};
use coinmc_core::Landing;
use coinmc_flat as flat;
use coinmc_quadrature::Method;
use coinmc_rapier as rapier;
use coinmc_volumetric as volumetric;
use omission::{Omission, omissions};

/// What is done for some of the points, and what is not and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// How many points are treated so.
    pub points: usize,
    /// What is computed.
    pub computed: String,
    /// What is skipped, with the reason.
    pub skipped: Vec<String>,
}

impl Plan {
    /// What will be computed and what is skipped and why, points of one treatment together, in
    /// the order in which treatments first appear.
    ///
    /// # Example
    /// ```
    /// let plan = coinmc::config::parse(
    ///     "inline", "coin.ratio = [1.0, 2.0]\nengine.analytic.rule = 'arc'", &[],
    /// ).unwrap();
    /// let [all] = &plan.explain()[..] else { panic!() };
    /// assert_eq!(all.points, 2);
    /// assert!(all.computed.contains("(2/π)·atan(x/2)"));
    /// ```
    pub fn explain(&self) -> Vec<Explanation> {
        let mut treatments: Vec<(Treatment, Explanation)> = Vec::new();
        for index in 0..self.points.len() {
            let treatment = Treatment::of(self, index);
            let known = treatments.iter_mut().find(|(known, _)| *known == treatment);
            if let Some((_, explanation)) = known {
                explanation.points += 1;
            } else {
                let explanation = treatment.explain(&self.points[index].engine);
                treatments.push((treatment, explanation));
            }
        }
        treatments
            .into_iter()
            .map(|(_, explanation)| explanation)
            .collect()
    }
}

/// All that decides how a point is treated. A swept setting of the engine does not.
#[derive(PartialEq)]
struct Treatment {
    engine: std::mem::Discriminant<EngineChoice>,
    /// Slow contacts do not bounce. Unlike the rest this is something computed.
    threshold: bool,
    /// The first contact decides.
    adhesive: bool,
    /// How it is integrated, and how many random numbers are left to that.
    integrated: Option<(Method, usize)>,
    omissions: Vec<Omission>,
}

impl Treatment {
    fn of(plan: &Plan, index: usize) -> Self {
        let point = &plan.points[index];
        let surface = &point.scene.surface;
        let adhesive = surface.landing() == Landing::Adhesive;
        let impacts = point.engine.makes_tosses() && !adhesive;
        let method = plan.method(index);
        Self {
            engine: std::mem::discriminant(&point.engine),
            threshold: impacts && surface.restitution_threshold_m_s() > 0.0,
            adhesive,
            integrated: method.map(|method| (method, method.dimensions_left(&point.launches))),
            omissions: omissions(point, method),
        }
    }

    fn explain(&self, engine: &EngineChoice) -> Explanation {
        let computed = match (self.integrated, engine) {
            (Some((method, left)), _) => without_tosses::computed(method, left),
            (None, EngineChoice::Analytic(rule)) => format!(
                "closed form {rule}: P(side) = {}, x = H/R ({})",
                rule.formula(),
                rule.assumption()
            ),
            (None, _) if self.adhesive => {
                "flight in closed form to the first contact; the coin sticks there and falls to the \
                 side its centre hangs over"
                    .to_owned()
            }
            (None, EngineChoice::Flat(settings)) => in_the_plane(settings),
            (None, EngineChoice::Volumetric(settings)) => in_space(settings, self.threshold),
            (None, EngineChoice::Rapier(settings)) => in_steps(settings, self.threshold),
        };
        Explanation {
            points: 1,
            computed,
            skipped: self
                .omissions
                .iter()
                .map(|omission| omission.reason().to_owned())
                .collect(),
        }
    }
}

fn in_the_plane(settings: &flat::Settings) -> String {
    let decided = match settings.decision {
        flat::Decision::Energy => "until energy alone makes the face certain",
        flat::Decision::EnergyFraction(_) => {
            "until the energy has fallen to the chosen fraction, and on to the certain face to \
             count disagreements"
        }
    };
    format!(
        "flight in closed form, impacts by the law {}, sustained contact, {decided}",
        settings.law.name()
    )
}

fn in_space(settings: &volumetric::Settings, threshold: bool) -> String {
    let decided = match settings.decision {
        volumetric::Decision::Tilting => {
            "until the energy that can still tilt the coin is too small to carry it over its rim"
        }
        volumetric::Decision::Energy => "until energy alone makes the face certain",
    };
    let threshold = if threshold {
        " (restitution 0 below its threshold)"
    } else {
        ""
    };
    format!(
        "flight in closed form, impacts by the law {}{threshold}, sustained contact on the rim and \
         on the side, {decided}",
        settings.law.name()
    )
}

fn in_steps(settings: &rapier::Settings, threshold: bool) -> String {
    let flight = match settings.flight {
        rapier::Flight::Contact => {
            "flight in closed form to every contact that ends more than a step of it, "
        }
        rapier::Flight::Steps => "flight in closed form by whole steps, ",
        rapier::Flight::Off => "",
    };
    let decided = match settings.decision {
        rapier::Decision::Tilting => {
            "until the energy that can still tilt the coin is too small to carry it over its rim"
        }
        rapier::Decision::Energy => "until energy alone makes the face certain",
        rapier::Decision::Rest => "until the coin has come to rest",
    };
    let threshold = if threshold {
        " (restitution 0 below its threshold)"
    } else {
        ""
    };
    format!(
        "{flight}steps of Rapier, {} substeps each, friction {}{threshold}, {decided}",
        settings.substeps,
        settings.friction_model.name()
    )
}
