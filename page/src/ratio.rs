//! How thick is a fair coin?

use crate::Answer;
use coinmc_questions::{Question, Template, Workers, document, fair as search};
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// The answer of `coinmc fair --half-width W --max-tosses N --numerical 0`.
pub(crate) fn fair(config: &str, half_width: f64, max_tosses: u64) -> Answer {
    let question = Question {
        half_width,
        max_tosses,
        numerical_tosses: 0,
        ..Question::default()
    };
    // the page stops a worker by ending it
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: Some(NonZeroUsize::MIN),
        cancel: &cancel,
        made: &|_| (),
    };
    let template = Template::new("config", config, &[]);
    let answer = search(&template, &question, &workers).map_err(|error| error.to_string())?;
    Ok(document(&answer, (None, &[]), &[]))
}
