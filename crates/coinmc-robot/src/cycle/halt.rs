//! Why an experiment stops so that a person can look.

use crate::Setting;
use crate::journal::VoidReason;
use std::path::PathBuf;
use thiserror::Error;

/// Why the user must decide.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Halt {
    /// The robot was used for something else.
    #[error(
        "the robot has counted {robot} throws and this journal {journal}: the robot was used with \
         another journal. If that is intended, continue from its counter with --adopt; if not, \
         use the journal that it was used with"
    )]
    Ahead {
        /// The robot's counter.
        robot: u32,
        /// The last number in the journal.
        journal: u32,
    },
    /// Another robot, or one that has forgotten.
    #[error(
        "{how}. A throw that was announced may or may not have been made. If this is the robot's own \
         journal, put back what was there and resume; otherwise --adopt takes the robot over as it is \
         and counts an open throw as void"
    )]
    Foreign {
        /// How it was noticed.
        how: Stranger,
    },
    /// The robot's range is smaller than the plan.
    #[error(
        "the plan has spins up to {} rev/s and angles up to {} degrees, but this robot only reaches \
         {} rev/s and {} degrees. Narrow the config's launch and start another experiment",
        planned.spin_rev_s(), planned.angle_deg(),
        f64::from(*spin_mrev_s) / 1e3, f64::from(*angle_cdeg) / 1e2
    )]
    OutOfReach {
        /// Greatest spin and angle planned.
        planned: Setting,
        /// The robot's greatest spin.
        spin_mrev_s: u16,
        /// The robot's greatest angle.
        angle_cdeg: u16,
    },
    /// Nothing has changed for too long.
    #[error("no progress for {minutes} minutes: {what}. Check the robot, then resume")]
    Stalled {
        /// How long.
        minutes: u64,
        /// What is there instead.
        what: String,
    },
    /// A photo and its line would no longer fit.
    #[error(
        "no space left for another throw: {free_mib} MiB are free in {}, and --min-free asks for \
         {least_mib}. Nothing is lost; free some space and resume", directory.display()
    )]
    DiskFull {
        /// Where.
        directory: PathBuf,
        /// Free now.
        free_mib: u64,
        /// The least that must be free.
        least_mib: u64,
    },
    /// Somebody pressed the button.
    #[error(
        "the robot's emergency stop was pressed. Release it, check the robot, then `coinmc robot \
         clear` and resume"
    )]
    EmergencyStop,
    /// The camera fails again and again.
    #[error(
        "the camera has failed {count} times in a row; the last time: {last}. Check it, then resume"
    )]
    CameraFails {
        /// The throw that could not be photographed.
        id: u32,
        /// Number of failures.
        count: u32,
        /// Why the last photo failed.
        last: String,
    },
    /// The robot's own limits are narrower than the protocol's.
    #[error(
        "the robot rejects {} rev/s from {} degrees: its own range is narrower (`coinmc robot \
         info` shows it). Narrow the config's launch and start another experiment",
        setting.spin_rev_s(), setting.angle_deg()
    )]
    OutOfRange {
        /// The rejected setting.
        setting: Setting,
    },
    /// The robot does not know a required message.
    #[error("the robot does not understand this program: update its firmware")]
    Misunderstood,
    /// A fault that cannot be cleared.
    #[error("the robot stays in fault {code}: check it, then resume")]
    FaultStays {
        /// The fault.
        code: u16,
    },
    /// Probably something is wrong with robot or camera.
    #[error(
        "{count} consecutive throws have no result (the last: {last}): check robot and camera, then \
         resume"
    )]
    TooManyVoids {
        /// Number of void throws.
        count: u32,
        /// Why the last one has no result.
        last: VoidReason,
    },
    /// No id is left on the link.
    #[error(
        "the ids of the link are used up: clear the robot's memory and start another experiment"
    )]
    NoNumberLeft,
}

/// How a robot was found not to be the one that the journal's throws were announced to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Stranger {
    /// Another unique number.
    #[error(
        "this is robot {found:016x}, but the last throws were announced to robot {expected:016x}"
    )]
    OtherRobot {
        /// Its number.
        found: u64,
        /// The number in the journal.
        expected: u64,
    },
    /// It does not know the experiment.
    #[error(
        "the robot is at throw {throw_id} of {}: its memory was erased, or it was used for something \
         else", if *experiment == 0 { "no experiment".to_owned() } else { format!("experiment {experiment}") }
    )]
    OtherExperiment {
        /// Its counter.
        throw_id: u32,
        /// Its experiment.
        experiment: u32,
    },
    /// It knows the experiment but not its last throws.
    #[error(
        "the robot is at throw {throw_id}, but it has made throw {least}: its memory was changed"
    )]
    Behind {
        /// Its counter.
        throw_id: u32,
        /// The least that it can be.
        least: u32,
    },
}
