//! Every problem of a question, found before the first toss.

use super::launch::Launch;
use super::plane::Plane;
use super::{Aim, MOST_FACTORS, MOST_PLACES, MOST_TOSSES, Parameter};
use crate::{QuestionError, Template, Workers};
use coinmc::config::Diagnostics;
use coinmc::plan::Plan;
use std::sync::atomic::Ordering;

/// What is tossed.
pub(super) struct Plans {
    pub(super) plane: Plane,
    /// One for each place.
    pub(super) places: Vec<Plan>,
    pub(super) own: Plan,
    /// The parameters of the config's own launch.
    pub(super) own_values: Vec<f64>,
    template: Template,
    launch: Launch,
}

/// The plans of all places, once the question and all of them have been checked.
pub(super) fn checked(
    template: &Template,
    question: &Aim,
    workers: &Workers<'_>,
) -> Result<Plans, QuestionError> {
    check_numbers(question)?;
    let (own, spelled_out) = template.spelled_out()?;
    if own.points.len() > 1 {
        return Err(QuestionError::Swept(own.axes.join(", ")));
    }
    if !own.points[0].engine.makes_tosses() {
        return Err(QuestionError::NoLaunch);
    }
    own.points[0]
        .build_engine()
        .map_err(QuestionError::Engine)?;
    let mut launch = Launch::of(&own.resolved_toml).ok_or(QuestionError::NoLaunch)?;
    let mut plans = Plans {
        plane: Plane::new(&question.parameters),
        places: vec![],
        own_values: own_values(question, &mut launch)?,
        own,
        template: spelled_out,
        launch,
    };
    for place in 0..plans.plane.len() {
        // 10,000 plans take seconds
        if workers.cancel.load(Ordering::Relaxed) {
            return Err(QuestionError::Stopped);
        }
        let plan = plans.plan(&plans.launch_at(question, place));
        let plan = plan.map_err(|error| plans.told(question, place).unwrap_or(error))?;
        plans.places.push(plan);
    }
    check_clumsiness(&plans, question)?;
    Ok(plans)
}

/// The numbers of the question itself.
pub(super) fn check_numbers(question: &Aim) -> Result<(), QuestionError> {
    let parameters = &question.parameters;
    let twice = parameters.len() == 2 && parameters[0].key == parameters[1].key;
    if !(1..=2).contains(&parameters.len()) || twice {
        let different = if twice { 1 } else { parameters.len() };
        return Err(QuestionError::Parameters(different));
    }
    for parameter in parameters {
        check_parameter(parameter)?;
    }
    let values = parameters.iter().map(|parameter| parameter.values as u64);
    at_most(values.fold(1, u64::saturating_mul), MOST_PLACES, "places")?;
    for tosses in [question.tosses, question.final_tosses] {
        if tosses == 0 {
            return Err(QuestionError::TooFewTosses { least: 1, given: 0 });
        }
        at_most(tosses, MOST_TOSSES, "tosses of a place")?;
    }
    let factors = &question.clumsiness;
    at_most(factors.len() as u64, MOST_FACTORS, "factors for the spread")?;
    let sound = |factor: f64| factor >= 0.0 && factor.is_finite();
    match factors.iter().find(|&&factor| !sound(factor)) {
        Some(&factor) => Err(QuestionError::Factor(factor)),
        None => Ok(()),
    }
}

fn check_parameter(parameter: &Parameter) -> Result<(), QuestionError> {
    if parameter.values < 2 {
        return Err(QuestionError::TooFewValues {
            key: parameter.key.clone(),
            given: parameter.values,
        });
    }
    parameter.span().check()
}

fn at_most(given: u64, most: u64, what: &'static str) -> Result<(), QuestionError> {
    if given <= most {
        Ok(())
    } else {
        Err(QuestionError::TooMany { what, most, given })
    }
}

fn own_values(question: &Aim, launch: &mut Launch) -> Result<Vec<f64>, QuestionError> {
    let keys = question.parameters.iter().map(|parameter| &parameter.key);
    let number = |key: &String| match launch.number(key) {
        Some(number) => Ok(*number),
        None => Err(QuestionError::NotOfLaunch {
            key: key.chars().take(120).collect(),
            known: launch.keys().join(", "),
        }),
    };
    keys.map(number).collect()
}

/// Whether the config allows every hand at every place. The ends of a stretched distribution are
/// linear in each parameter and what a config allows of them is an interval, so that the corners of
/// the plane tell.
fn check_clumsiness(plans: &Plans, question: &Aim) -> Result<(), QuestionError> {
    for place in plans.plane.corners() {
        for &factor in &question.clumsiness {
            plans.clumsy(question, place, factor)?;
        }
    }
    Ok(())
}

impl Plans {
    /// The best place, or another, in a hand whose spread is multiplied.
    pub(super) fn clumsy(
        &self,
        question: &Aim,
        place: usize,
        factor: f64,
    ) -> Result<Plan, QuestionError> {
        let mut launch = self.launch_at(question, place);
        if !launch.spread(factor) {
            return Err(QuestionError::NoSpread);
        }
        self.plan(&launch).map_err(|error| match error {
            QuestionError::Config(problems) => QuestionError::Clumsy { factor, problems },
            other => other,
        })
    }

    fn plan(&self, launch: &Launch) -> Result<Plan, QuestionError> {
        self.template.plan(&[("launch", launch.to_string())])
    }

    /// Why there is no such place, told of the parameters that are at fault; `None` if each of them by itself is sound.
    fn told(&self, question: &Aim, place: usize) -> Option<QuestionError> {
        let values = self.plane.at(place);
        let values = question.parameters.iter().zip(values);
        let refused = values.filter_map(|(parameter, value)| {
            let mut launch = self.launch.clone();
            *launch.number(&parameter.key)? = value;
            let told = self.template.clone().told_as("launch", &parameter.key);
            match told.plan(&[("launch", launch.to_string())]) {
                Err(QuestionError::Config(problems)) => Some(problems),
                _ => None,
            }
        });
        refused.reduce(Diagnostics::and).map(QuestionError::Config)
    }

    fn launch_at(&self, question: &Aim, place: usize) -> Launch {
        let mut launch = self.launch.clone();
        for (parameter, value) in question.parameters.iter().zip(self.plane.at(place)) {
            *launch.number(&parameter.key).expect("the key was checked") = value;
        }
        launch
    }
}
