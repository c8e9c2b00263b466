//! Explanation of what a plan computes and what it skips.

mod omission;
mod without_tosses;

use super::{Plan, Point};
use coinmc_core::Landing;
use coinmc_quadrature::Method;
use omission::{Omission, omissions};

/// What is computed and what is skipped, and why, for some of the points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// Number of points.
    pub points: usize,
    /// What is computed.
    pub computed: String,
    /// What is skipped, with the reason.
    pub skipped: Vec<String>,
}

impl Plan {
    /// What will be computed, what is skipped and why, for each group of points with the same
    /// treatment, in the order in which the treatments first appear.
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
                let explanation = treatment.explain(&self.points.at(index));
                treatments.push((treatment, explanation));
            }
        }
        treatments
            .into_iter()
            .map(|(_, explanation)| explanation)
            .collect()
    }
}

/// Everything that determines the treatment of a point; swept settings of the engine do not.
#[derive(PartialEq)]
struct Treatment {
    engine: &'static str,
    /// Slow contacts do not bounce. Unlike the other fields this is part of what is computed.
    threshold: bool,
    /// The first contact decides.
    adhesive: bool,
    /// The method of integration, and the number of random numbers left to integrate over.
    integrated: Option<(Method, usize)>,
    omissions: Vec<Omission>,
}

impl Treatment {
    fn of(plan: &Plan, index: usize) -> Self {
        let point = &*plan.points.at(index);
        let surface = &point.scene.surface;
        let adhesive = surface.landing() == Landing::Adhesive;
        let impacts = point.engine.makes_tosses() && !adhesive;
        let method = plan.method(index);
        Self {
            engine: point.engine.name(),
            threshold: impacts && surface.restitution_threshold_m_s() > 0.0,
            adhesive,
            integrated: method.map(|method| (method, method.dimensions_left(&point.launches))),
            omissions: omissions(point, method),
        }
    }

    fn explain(&self, point: &Point) -> Explanation {
        let computed = match self.integrated {
            Some((method, left)) => without_tosses::computed(method, left),
            None if self.adhesive && point.engine.makes_tosses() => {
                "flight in closed form to the first contact; the coin sticks there and falls to the \
                 side its centre hangs over"
                    .to_owned()
            }
            None => point.engine.explain(&point.scene),
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
