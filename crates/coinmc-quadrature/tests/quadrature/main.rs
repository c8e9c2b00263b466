//! Sobol points, closed forms and intervals, compared with published values and with sampling.

mod common;
mod coverage;
mod faces;
mod order;
mod sobol;
