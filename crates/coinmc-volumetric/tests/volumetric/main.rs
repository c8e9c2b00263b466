//! Independent verification of the volumetric engine: each module checks one claim against
//! something that the engine does not contain. Every tolerance is derived where it is used. Seeds
//! are fixed, so no test fails by chance; "false alarms" says how often it would with another seed.

mod common;
mod conical;
mod decision;
mod determinism;
mod flight;
mod hardest;
mod hostile;
mod impacts;
mod limits;
mod loaded;
mod planar;
mod remarks;
mod rough;
mod sampling;
mod side_ending;
mod symmetry;
mod table;
mod textbook;
mod tilted;
