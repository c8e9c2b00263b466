//! One file a verb.

mod analytic;
mod check;
mod completions;
mod film;
mod merge;
mod robot;
mod run;
mod schema;
mod trace;

pub(crate) use analytic::Analytic;
pub(crate) use check::Check;
pub(crate) use completions::Completions;
pub(crate) use film::Film;
pub(crate) use merge::Merge;
pub(crate) use robot::Robot;
pub(crate) use run::Run;
pub(crate) use schema::Schema;
pub(crate) use trace::Trace;
