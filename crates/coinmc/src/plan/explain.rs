//! What a plan computes and what it skips, in words.

use super::{EngineChoice, Plan, Point};
use coinmc_core::Landing;
use coinmc_flat::{Decision, Settings};

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
        for point in &self.points {
            let treatment = Treatment::of(point);
            match treatments.iter_mut().find(|(known, _)| *known == treatment) {
                Some((_, explanation)) => explanation.points += 1,
                None => treatments.push((treatment, explain(point))),
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
    adhesive: bool,
    frictionless: bool,
    no_bounce: bool,
}

impl Treatment {
    fn of(point: &Point) -> Self {
        let surface = &point.scene.surface;
        let engine = std::mem::discriminant(&point.engine);
        let adhesive = surface.landing() == Landing::Adhesive;
        // these only matter where impacts are computed
        let impacts = matches!(point.engine, EngineChoice::Flat(_)) && !adhesive;
        Self {
            engine,
            adhesive: adhesive && matches!(point.engine, EngineChoice::Flat(_)),
            frictionless: impacts && surface.friction() == 0.0,
            no_bounce: impacts && surface.restitution() == 0.0,
        }
    }
}

fn explain(point: &Point) -> Explanation {
    let (computed, skipped) = match &point.engine {
        EngineChoice::Analytic(rule) => (
            format!(
                "closed form {rule}: P(side) = {}, x = H/R ({})",
                rule.formula(),
                rule.assumption()
            ),
            vec!["tosses: the probability is known without them".to_owned()],
        ),
        EngineChoice::Flat(settings) => flat(settings, &Treatment::of(point)),
    };
    Explanation {
        points: 1,
        computed,
        skipped,
    }
}

fn flat(settings: &Settings, treatment: &Treatment) -> (String, Vec<String>) {
    let mut skipped =
        vec!["motion out of the xz plane: no launch of this config leaves it".to_owned()];
    if treatment.adhesive {
        skipped.push("impacts, sliding and rocking: the first contact decides".to_owned());
        return (
            "flight in closed form to the first contact; the coin sticks there and falls to the \
             side its centre hangs over"
                .to_owned(),
            skipped,
        );
    }
    if treatment.frictionless {
        skipped.push("the tangential half of impacts and contacts: friction is 0".to_owned());
    }
    if treatment.no_bounce {
        skipped.push("sequences of bounces: restitution is 0".to_owned());
    }
    let decided = match settings.decision {
        Decision::Certain => "until energy alone makes the face certain",
        Decision::EnergyFraction(_) => {
            "until the energy has fallen to the chosen fraction, and on to the certain face to \
             count disagreements"
        }
    };
    let computed = format!(
        "flight in closed form, impacts by the law {}, sustained contact, {decided}",
        settings.law.name()
    );
    (computed, skipped)
}
