//! One file per verb.

mod aim;
mod analytic;
mod ask;
#[cfg(feature = "film")]
mod calibrate;
mod check;
mod compare;
mod completions;
mod converge;
mod design;
mod fair;
#[cfg(feature = "film")]
mod film;
#[cfg(feature = "film")]
mod listen;
mod merge;
mod quantity;
mod question;
mod rare;
mod report;
#[cfg(feature = "robot")]
mod robot;
mod run;
mod schema;
mod sensitivity;
mod show;
mod status;
mod trace;
mod validate;

pub(crate) use aim::AimAt;
pub(crate) use analytic::Analytic;
pub(crate) use ask::Ask;
#[cfg(feature = "film")]
pub(crate) use calibrate::Calibrate;
pub(crate) use check::Check;
pub(crate) use compare::Compare;
pub(crate) use completions::Completions;
pub(crate) use converge::Converge;
pub(crate) use design::DesignArgs;
pub(crate) use fair::Fair;
#[cfg(feature = "film")]
pub(crate) use film::Film;
#[cfg(feature = "film")]
pub(crate) use listen::Listen;
pub(crate) use merge::Merge;
pub(crate) use rare::Rare;
pub(crate) use report::ReportOf;
#[cfg(feature = "robot")]
pub(crate) use robot::Robot;
pub(crate) use run::Run;
pub(crate) use schema::Schema;
pub(crate) use sensitivity::SensitivityOf;
pub(crate) use show::Show;
pub(crate) use status::Status;
pub(crate) use trace::Trace;
pub(crate) use validate::Validate;

use coinmc_core::Face;

/// A whole number, in which digits may be grouped by `_`.
fn count(text: &str) -> Result<u64, String> {
    text.replace('_', "")
        .parse()
        .map_err(|_| "expected a whole number".to_owned())
}

/// The face of a name, for arguments.
fn face(name: &str) -> Result<Face, String> {
    Face::named(name).ok_or_else(|| "expected heads, tails or side".to_owned())
}
