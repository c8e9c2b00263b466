//! A simulated robot: the link's own device over a simulated plant, on a pseudo-terminal, with
//! faults on demand.
//!
//! Its coin falls as a coinmc engine says for the very spin and angle it was told, so a simulated
//! day can be analysed like a real one. Motions take as long as those of the real robot, divided by
//! the speed; the robot's own limits (phases, silence of the host) stay in real time, so that a busy
//! computer is not taken for a silent host.

mod dice;
mod line;
mod memory;
mod plant;
mod pty;
mod robot;
mod truth;

pub use dice::Dice;
pub use line::Noise;
pub use robot::{Command, Faults, SimError, SimOptions, UnknownCommand, simulate};
pub use truth::{Truth, last_truth, read_truths};
