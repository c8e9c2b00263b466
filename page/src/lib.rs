//! The part of the page to play with that tosses: a WebAssembly module that answers questions in
//! JSON. `scripts/web-page` builds it and puts it beside the files of `site/`; docs/guide/page.md shows
//! the page.
//!
//! ```text
//! page ──question──▶ worker ──question──▶ answer() ──▶ coinmc, coinmc-questions, coinmc-trace
//! ```
//!
//! The module is the program's own code: a config, a seed and a range of tosses give the same counts
//! here and there. It has one thread and keeps nothing between two questions, so the page asks several
//! of them at a time, each for another range of tosses, and adds up the counts.
//!
//! # Questions
//! Each is a JSON object whose `ask` names it; [`Question`] lists them with their fields. An answer is
//! an object, too: `{"error": "…"}` where there is none.

mod about;
mod check;
mod motion;
mod question;
mod ratio;
mod tosses;

#[cfg(target_arch = "wasm32")]
mod module;

pub use question::Question;

use serde_json::{Value, json};

/// Answers a question, both JSON.
///
/// # Example
/// ```
/// let answer = coinmc_page::answer(r#"{"ask": "toss", "config": "", "from": 0, "to": 10}"#);
/// assert!(answer.starts_with(r#"{"error":"#));
/// ```
pub fn answer(question: &str) -> String {
    let answer = serde_json::from_str(question)
        .map_err(|error| format!("no question: {error}"))
        .and_then(|question: Question| question.answer());
    answer
        .unwrap_or_else(|error| json!({ "error": error }))
        .to_string()
}

/// An answer, or why there is none.
type Answer = Result<Value, String>;
