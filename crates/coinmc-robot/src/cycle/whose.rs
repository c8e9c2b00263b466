//! Whose robot it is: the one that the journal's throws were announced to, or another one, or one that
//! has forgotten.
//!
//! Before its first throw the robot is told the experiment's number. From then on it must know it: if
//! it does not, nobody can say whether it has made the open throw.

use super::{Cycle, Halt, Step, Stranger};
use crate::journal::{Entry, History, Pending, RobotName, VoidReason};
use coinmc_link::{Info, Status};

/// Whose robot it is.
pub(super) enum Whose {
    Ours,
    /// Nothing was announced to it yet.
    Nobodys,
    Strange(Stranger),
}

impl Cycle {
    /// Whether the robot is the one that the open throw was, or the next throw will be, announced to.
    pub(super) fn whose(&self, status: &Status, info: &Info, history: &History) -> Whose {
        let known = status.experiment == self.rules.experiment;
        let uid = RobotName::of(info).uid;
        if !history.is_claimed() {
            let told = known && status.throw_id == history.last_id();
            return if told { Whose::Ours } else { Whose::Nobodys };
        }
        let (throw_id, least) = (status.throw_id, history.least_id());
        Whose::Strange(match history.robot() {
            Some(robot) if robot.uid != uid => Stranger::OtherRobot {
                found: uid,
                expected: robot.uid,
            },
            _ if !known => Stranger::OtherExperiment {
                throw_id,
                experiment: status.experiment,
            },
            _ if throw_id < least => Stranger::Behind { throw_id, least },
            _ => return Whose::Ours,
        })
    }

    pub(super) fn strange(&self, how: Stranger, status: &Status, history: &History) -> Step {
        match (history.pending(), how) {
            // the robot has made another throw under this number, so never this one
            (Pending::Announced { id, .. }, Stranger::OtherExperiment { throw_id, .. })
                if throw_id == id =>
            {
                Step::Write(Entry::Void {
                    id,
                    reason: VoidReason::Mismatch,
                })
            }
            _ if !self.rules.adopt => Step::Halt(Halt::Foreign { how }),
            (Pending::Announced { id, .. }, _) => Step::Write(Entry::Void {
                id,
                reason: VoidReason::Foreign,
            }),
            _ => Step::Write(Entry::Adopted {
                counter: status.throw_id,
            }),
        }
    }

    /// The entry that names robot and program, unless the journal has it.
    pub(super) fn naming(&self, info: &Info, history: &History, at_ms: u64) -> Option<Entry> {
        let robot = RobotName::of(info);
        let wanted = !self.named || history.robot() != Some(robot);
        wanted.then(|| Entry::Session {
            robot,
            boot: self.boot,
            program: self.program.clone(),
            at_ms,
        })
    }
}
