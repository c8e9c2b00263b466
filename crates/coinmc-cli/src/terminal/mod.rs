//! Output for people: tables, plots, progress, and the summary of a run.

mod ascii;
pub(crate) mod events;
mod harmless;
mod number;
pub(crate) mod plot;
pub(crate) mod progress;
mod style;
pub(crate) mod summary;
pub(crate) mod table;
mod wrap;

pub(crate) use ascii::in_ascii;
pub(crate) use coinmc_questions::number::{compact, grouped};
pub(crate) use harmless::{harmless, harmless_json};
pub(crate) use number::{
    count, decimals_for, decimals_that_show, duration, four_decimals_for, signed, tosses,
    with_interval,
};
pub(crate) use style::{Colors, Style};
pub(crate) use wrap::wrapped;
