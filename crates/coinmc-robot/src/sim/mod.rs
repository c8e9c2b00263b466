//! A simulated robot: the link's device state machine with simulated hardware, on a
//! pseudo-terminal, with faults on demand.
//!
//! A coinmc engine simulates its coin with the given spin and angle, so a simulated day can be
//! analysed like a real one. Motions take as long as those of the real robot, divided by the speed;
//! the robot's own limits (phases, silence of the host) stay in real time, so that a busy computer
//! does not look like a silent host.

mod dice;
mod forgery;
mod line;
mod memory;
mod nemesis;
mod plant;
mod pty;
mod robot;
mod truth;

pub use dice::Dice;
pub use forgery::{reframed, with_another_identity, with_old_content};
pub use line::Noise;
pub use nemesis::Nemesis;
pub use robot::{Command, Faults, SimError, SimOptions, UnknownCommand, simulate};
pub use truth::{Truth, last_truth, read_truths};
