//! The laws of impact: their conditions, their energy, their limits, and independent solvers.

mod common;
mod conditions;
mod independent;
mod lanes;
mod limits;
mod oracle;
mod planar;
mod stronge;
