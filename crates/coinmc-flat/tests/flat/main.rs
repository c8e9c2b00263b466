//! Independent verification of the planar engine: each module checks one promise against a
//! reference that the engine does not contain. Every tolerance is derived beside it. Seeds are
//! fixed, so no test fails by chance; "false alarms" says how often one would with another seed.

mod batch;
mod common;
mod contact_phases;
mod convergence;
mod decision;
mod determinism;
mod energy;
mod engines;
mod flight;
mod hardest;
mod hostile;
mod impact_laws;
mod limits;
mod oracle_friction;
mod oracle_smooth;
mod regressions;
mod sampling;
mod symmetry;
