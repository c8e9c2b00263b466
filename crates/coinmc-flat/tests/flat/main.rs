//! Independent verification of the flat engine: each module checks one promise against something
//! the engine does not contain. Every tolerance is derived where it stands. Seeds are fixed, so
//! no test fails by chance; "false alarms" says how often one would under another seed.

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
mod side_by_side;
mod symmetry;
