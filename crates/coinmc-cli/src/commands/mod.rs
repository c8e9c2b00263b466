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
mod names;
mod new_file;
mod other_size;
mod page;
pub(crate) mod quantity;
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
use std::str::FromStr;

/// A whole number, in which digits may be grouped by `_`; `1e9` is one, too, as in a config.
fn count(text: &str) -> Result<u64, String> {
    let digits = text.replace('_', "");
    digits
        .parse()
        .ok()
        .or_else(|| digits.parse().ok().and_then(whole))
        .ok_or_else(|| "expected a whole number, as 20_000 or 1e6".to_owned())
}

/// The whole number that is `x`, unless neighbours of it have no `f64` of their own.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and in the range
fn whole(x: f64) -> Option<u64> {
    const EXACT: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;
    ((0.0..=EXACT).contains(&x) && libm::trunc(x) == x).then_some(x as u64)
}

/// A value of a list, in which blanks may follow the commas.
fn trimmed<T: FromStr>(text: &str) -> Result<T, T::Err> {
    text.trim().parse()
}

/// The face of a name, for arguments.
fn face(name: &str) -> Result<Face, String> {
    Face::named(name).ok_or_else(|| "expected heads, tails or side".to_owned())
}

#[cfg(test)]
mod tests {
    use super::count;

    #[test]
    fn counts_are_whole_numbers_however_they_are_written() {
        for (text, number) in [
            ("20_000", Some(20_000)),
            ("1e12", Some(1_000_000_000_000)),
            ("2.5e3", Some(2_500)),
            ("18446744073709551615", Some(u64::MAX)),
            ("9007199254740992.0", Some(1 << 53)),
            ("9.1e15", None),
            ("1e-3", None),
            ("-1", None),
            ("-1e3", None),
            ("NaN", None),
            ("inf", None),
            ("", None),
        ] {
            assert_eq!(count(text).ok(), number, "{text}");
        }
    }
}
