//! One file a verb.

mod analytic;
mod check;
mod completions;
mod merge;
mod run;
mod schema;

pub(crate) use analytic::Analytic;
pub(crate) use check::Check;
pub(crate) use completions::Completions;
pub(crate) use merge::Merge;
pub(crate) use run::Run;
pub(crate) use schema::Schema;
