//! Independent verification of the engine in space: each module checks one promise against
//! something the engine does not contain. Every tolerance is derived where it stands. Seeds are
//! fixed, so no test fails by chance; "false alarms" says how often one would under another seed.

mod common;
mod decision;
mod flight;
mod hardest;
mod hostile;
mod impacts;
mod limits;
mod planar;
mod sampling;
mod symmetry;
mod textbook;
