//! Which launch forces a face?
//!
//! Gaek & Sukhov close their study of the thick coin (arXiv 2401.03557) with the thought that who
//! controls the launch could choose the face. How far that goes depends on the spread of the hand,
//! which the config's own distributions say.
//!
//! # Method
//! One or two numbers of the launch span a line or a plane of places. Every place is tossed equally
//! often with the same random numbers, which gives the `map`. Successive halving (`search`) then
//! finds the places where the face is most and least likely. How likely it is there, at the config's
//! own launch, and at the best place in clumsier hands is told by final tosses that took no part in
//! the choice, so that none of these estimates has the winner's bias. Everything is tossed, also
//! where an integral would give the probability.
//!
//! Modules, each above those it uses: `document`, `picture` · `answer` · `check` · `search`,
//! `launch`, `plane`.

mod answer;
mod check;
mod document;
mod launch;
mod picture;
mod plane;
mod search;

pub use document::document_of_aim;
pub use picture::picture;

use crate::span::{Span, rounded};
use crate::{QuestionError, Template, Workers};
use coinmc_core::{Estimate, Face};

/// Most places of a question.
pub const MOST_PLACES: u64 = 10_000;
/// Most tosses of a place.
pub const MOST_TOSSES: u64 = 1_000_000_000;
/// Most factors of clumsiness.
pub const MOST_FACTORS: u64 = 100;

/// A question: with which launch is this face most likely?
///
/// # Example
/// A coin is dropped without spin onto a surface to which it sticks, tilted by an angle that the
/// hand holds within about 5°: level is best, and a clumsy hand spoils it.
/// ```
/// use coinmc_core::Face;
/// use coinmc_questions::{Aim, Parameter, Template, Workers, aim, picture};
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 1.0\nengine.flat = {}\n\
///             surface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
///             [launch]\nheight_m = 0.5\n\
///             orientation.tilt_deg.normal = { mean = 70.0, sd = 5.0 }\n\
///             spin.about = { axis = [0, 1, 0], rate_rad_s = 0.0 }";
/// let question = Aim {
///     face: Face::Heads,
///     parameters: vec![Parameter {
///         key: "launch.orientation.tilt_deg.normal.mean".to_owned(),
///         from: 0.0,
///         to: 180.0,
///         values: 7,
///     }],
///     tosses: 64,
///     final_tosses: 1000,
///     clumsiness: vec![1.0, 10.0],
/// };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let answer = aim(&Template::new("inline", text, &[]), &question, &workers)?;
/// assert_eq!(answer.best.values, [0.0]);
/// assert!(answer.best.estimate.p == 1.0 && answer.baseline.estimate.hi < 0.2);
/// assert!(answer.clumsy[1].estimate.hi < 0.9);
/// assert!(picture(&answer).starts_with("<svg"));
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Aim {
    /// The face.
    pub face: Face,
    /// One or two numbers of the launch.
    pub parameters: Vec<Parameter>,
    /// Tosses of every place of the map.
    pub tosses: u64,
    /// Tosses of each estimate in the answer.
    pub final_tosses: u64,
    /// Factors by which the spread of the hand is multiplied at the best place: that of every
    /// standard deviation of the launch, and of every width of a uniform distribution about its
    /// middle. An isotropic orientation and Euler angles have no width, and stay.
    pub clumsiness: Vec<f64>,
}

/// A number of the launch, and where to search it.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its key in configs, such as `launch.height_m` or
    /// `launch.spin.precessing.rate_rad_s.normal.mean`; of a list of three its component, as
    /// `launch.velocity_m_s.z`. The number may be one that the config's preset gives.
    pub key: String,
    /// First value.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// How many values, both ends included: evenly spaced in the logarithm where
    /// to > 10 · from > 0, else evenly spaced.
    pub values: usize,
}

impl Parameter {
    /// Whether the values are evenly spaced in the logarithm.
    pub fn is_logarithmic(&self) -> bool {
        self.span().is_logarithmic()
    }

    /// The values, in order.
    ///
    /// # Example
    /// ```
    /// use coinmc_questions::Parameter;
    /// let key = "launch.height_m".to_owned();
    /// let height = Parameter { key, from: 0.01, to: 1.0, values: 3 };
    /// assert_eq!(height.steps(), [0.01, 0.1, 1.0]);
    /// ```
    pub fn steps(&self) -> Vec<f64> {
        let last = self.values.saturating_sub(1);
        let value = |i: usize| match i {
            0 => self.from,
            i if i == last => self.to,
            i => rounded(self.span().at(i as f64 / last as f64)),
        };
        (0..self.values).map(value).collect()
    }

    fn span(&self) -> Span {
        Span {
            from: self.from,
            to: self.to,
        }
    }
}

impl Aim {
    /// Tosses that the answer will take, for a display of progress.
    ///
    /// # Errors
    /// [`QuestionError`] if the question itself has problems, whatever the config.
    pub fn tosses_planned(&self) -> Result<u64, QuestionError> {
        check::check_numbers(self)?;
        Ok(answer::planned(self))
    }
}

/// The answer to an [`Aim`].
#[derive(Debug, Clone, PartialEq)]
pub struct Aimed {
    /// The question.
    pub question: Aim,
    /// All places, the first parameter varying slowest.
    pub map: Vec<Place>,
    /// Where the face is most likely (of equally good places the first), estimated by final tosses.
    pub best: Place,
    /// Where it is least likely, estimated by final tosses.
    pub worst: Place,
    /// The config's own launch, estimated by final tosses.
    pub baseline: Place,
    /// The best place in other hands, estimated by final tosses.
    pub clumsy: Vec<Clumsy>,
    /// Confidence of all intervals.
    pub confidence: f64,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of its law of impact.
    pub law: &'static str,
    /// All tosses that were made.
    pub tosses: u64,
}

/// A launch.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The values of the parameters.
    pub values: Vec<f64>,
    /// The face's probability.
    pub estimate: Estimate,
}

/// The best place in another hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clumsy {
    /// By how much the hand's spread is multiplied.
    pub factor: f64,
    /// The face's probability.
    pub estimate: Estimate,
}

/// Answers an [`Aim`]. The answer does not depend on the number of threads.
///
/// # Errors
/// [`QuestionError`] if the question, or the config at a place, has problems (no toss has been made
/// then), or it was stopped.
pub fn aim(
    template: &Template,
    question: &Aim,
    workers: &Workers<'_>,
) -> Result<Aimed, QuestionError> {
    let plans = check::checked(template, question, workers)?;
    answer::answer(question, &plans, workers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_even_in_the_logarithm_beyond_a_factor_of_ten() {
        let steps = |from, to, values| {
            let key = String::new();
            Parameter {
                key,
                from,
                to,
                values,
            }
            .steps()
        };
        assert_eq!(steps(0.0, 0.5, 6), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(steps(1.0, 10.0, 4), [1.0, 4.0, 7.0, 10.0]);
        assert_eq!(steps(1.0, 16.0, 5), [1.0, 2.0, 4.0, 8.0, 16.0]);
        assert_eq!(steps(-1.0, 100.0, 2), [-1.0, 100.0]);
    }
}
