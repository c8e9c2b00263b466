//! Points, closed forms and intervals, against published ones and against sampling.

mod common;
mod coverage;
mod faces;
mod order;
mod sobol;
