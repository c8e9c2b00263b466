//! The reader against every dialect and every kind of bad file; the fit against known truths.

mod bad_files;
mod fitting;
mod laws;
mod reading;
mod round_trip;
