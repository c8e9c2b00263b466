//! Tests of the reader with every dialect and bad files, and of the fit with known parameters.

mod bad_files;
mod fitting;
mod laws;
mod reading;
mod round_trip;
