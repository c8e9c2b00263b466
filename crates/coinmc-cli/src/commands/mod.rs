//! One file per verb.

mod analytic;
mod check;
mod completions;
mod design;
mod fair;
#[cfg(feature = "film")]
mod film;
mod merge;
mod quantity;
#[cfg(feature = "robot")]
mod robot;
mod run;
mod schema;
mod trace;

pub(crate) use analytic::Analytic;
pub(crate) use check::Check;
pub(crate) use completions::Completions;
pub(crate) use design::Design;
pub(crate) use fair::Fair;
#[cfg(feature = "film")]
pub(crate) use film::Film;
pub(crate) use merge::Merge;
#[cfg(feature = "robot")]
pub(crate) use robot::Robot;
pub(crate) use run::Run;
pub(crate) use schema::Schema;
pub(crate) use trace::Trace;
