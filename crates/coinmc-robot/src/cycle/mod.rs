//! The next step of an experiment, from the journal and the latest messages of robot and camera.
//!
//! No I/O and no clock. The step depends only on the present state, not on its history, so a host
//! that restarts after a crash takes exactly the step that the crashed one would have taken:
//!
//! | journal | robot | step |
//! |---|---|---|
//! | no session | any | who is it? `S` |
//! | nothing open | Idle, does not know the experiment yet | tell it |
//! | nothing open | Idle | announce the next throw (`I`) |
//! | `I p` | counter < p, Idle | send the throw (again) |
//! | `I p` | counter = p, moving | wait |
//! | `I p` | counter = p, AtCoin | photograph; face read: `R`; no face in any photo: `V unread` |
//! | `I p` | counter = p, Fault | `V fault-N` |
//! | `I p` | counter = p, Idle | `V lost` |
//! | `I p` | counter = p, of another experiment or with another setting | `V mismatch` |
//! | `I p` | another robot, or without memory | ask the user, or `V foreign` after `--adopt` |
//! | `R p` | AtCoin | collect |
//! | `R p` | Idle or Fault | `D` |
//! | any | counter ahead | ask the user, or `A` after `--adopt` |
//! | nothing open | AtCoin, Fault | collect, clear the fault |

use crate::journal::{Digest, Entry, History, ImageName, Measured, Pending, Reading, VoidReason};
use crate::{Face, Setting};
use coinmc_link::{Greeting, Info, Nak, Reply, Request, State, Status, fault};

mod halt;
mod step;
mod whose;

pub use halt::{Halt, Stranger};
pub use step::{Photo, Rules, Shown, Step};
use whose::Whose;

/// Attempts to clear a fault before the user is asked.
const MAX_CLEARS: u32 = 20;

/// The state beyond the journal: the latest messages of robot and camera.
#[derive(Debug, Clone)]
pub struct Cycle {
    rules: Rules,
    /// Version of this program, for the journal.
    program: String,
    /// Who the robot is, since the last connection.
    info: Option<Info>,
    /// The journal names this robot and this program.
    named: bool,
    status: Option<Status>,
    /// The last throw released for this experiment; a reset clears it.
    release: Option<Release>,
    boot: u16,
    /// The robot rejected a request: wait before sending it again.
    rejected: bool,
    camera: Camera,
    camera_failures: u32,
    stopping: bool,
    clears: u32,
    voids: u32,
    halt: Option<Halt>,
}

/// A released throw.
#[derive(Debug, Clone, Copy)]
struct Release {
    id: u32,
    /// Spin and angle that the robot was asked for.
    asked: (u16, u16),
    measured: Measured,
    boot: u16,
}

/// State of the camera.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Camera {
    Idle,
    Busy {
        id: u32,
        attempt: u32,
        unread: u32,
    },
    /// No face yet, after this many attempts; in so many of them the camera looked and read none.
    Tried {
        id: u32,
        attempts: u32,
        unread: u32,
    },
    Read {
        id: u32,
        face: Face,
        image: ImageName,
        digest: Digest,
    },
}

impl Cycle {
    /// A cycle before the first message of robot or camera. `program` is the version of this program.
    pub fn new(rules: Rules, program: &str) -> Self {
        Self {
            rules,
            program: program.to_owned(),
            info: None,
            named: false,
            status: None,
            release: None,
            boot: 0,
            rejected: false,
            camera: Camera::Idle,
            camera_failures: 0,
            stopping: false,
            clears: 0,
            voids: 0,
            halt: None,
        }
    }

    /// Notes that a session with the robot was opened (again): earlier messages are stale, and it may
    /// be another robot.
    pub fn connected(&mut self, greeting: &Greeting) {
        self.boot = greeting.boot;
        self.info = None;
        self.status = None;
    }

    /// Notes a reply of the robot.
    pub fn replied(&mut self, request: &Request, reply: &Reply) {
        self.status = None;
        self.rejected = false;
        match reply {
            Reply::Status(status) => {
                if status.state == State::Idle {
                    self.clears = 0;
                }
                if status.state.in_cycle()
                    && status.released
                    && status.experiment == self.rules.experiment
                {
                    self.release = Some(Release {
                        id: status.throw_id,
                        asked: (status.spin_mrev_s, status.angle_cdeg),
                        measured: Measured {
                            spin_mrev_s: status.meas_spin_mrev_s,
                            angle_cdeg: status.meas_angle_cdeg,
                        },
                        boot: self.boot,
                    });
                }
                self.status = Some(*status);
            }
            Reply::Info(info) => self.introduced(info),
            Reply::Nak(nak) => self.note_rejection(request, *nak),
            Reply::Ok { .. } | Reply::Hello(_) => {}
        }
    }

    fn introduced(&mut self, info: &Info) {
        let (limits, planned) = (info.limits, self.rules.reach);
        if limits.spin_mrev_s < planned.spin_mrev_s() || limits.angle_cdeg < planned.angle_cdeg() {
            self.halt = Some(Halt::OutOfReach {
                planned,
                spin_mrev_s: limits.spin_mrev_s,
                angle_cdeg: limits.angle_cdeg,
            });
        }
        self.info = Some(*info);
    }

    fn note_rejection(&mut self, request: &Request, nak: Nak) {
        self.rejected = true;
        match (nak, request) {
            (
                Nak::BadRange,
                Request::Throw {
                    spin_mrev_s,
                    angle_cdeg,
                    ..
                },
            ) => {
                self.halt = Setting::new(*spin_mrev_s, *angle_cdeg)
                    .ok()
                    .map(|setting| Halt::OutOfRange { setting });
            }
            (Nak::BadMessage | Nak::BadRange, _) => self.halt = Some(Halt::Misunderstood),
            // the next status shows it
            (Nak::WrongState | Nak::WrongId | Nak::NoSession | Nak::Busy, _) => {}
        }
    }

    /// Notes that the polling interval is over: the status is stale.
    pub fn waited(&mut self) {
        self.status = None;
        self.rejected = false;
    }

    /// Notes that a photo was started.
    pub fn photographing(&mut self, id: u32, attempt: u32) {
        let unread = match self.camera {
            Camera::Tried { id: of, unread, .. } if of == id => unread,
            _ => 0,
        };
        self.camera = Camera::Busy {
            id,
            attempt,
            unread,
        };
    }

    /// Notes the result of a photo.
    pub fn photographed(&mut self, photo: Photo) {
        let Photo { id, attempt, shown } = photo;
        let unread = match self.camera {
            Camera::Busy {
                id: of,
                attempt: number,
                unread,
            } if (of, number) == (id, attempt) => unread,
            _ => return, // its throw is resolved already
        };
        let failures = std::mem::take(&mut self.camera_failures);
        self.camera = match shown {
            Shown::Face {
                face,
                image,
                digest,
            } => Camera::Read {
                id,
                face,
                image,
                digest,
            },
            Shown::Nothing => Camera::Tried {
                id,
                attempts: attempt,
                unread: unread + 1,
            },
            // a camera that failed has not looked at the coin
            Shown::Failure(last) => {
                let count = failures + 1;
                self.camera_failures = count;
                if count >= self.rules.max_camera_failures {
                    self.halt = Some(Halt::CameraFails { id, count, last });
                }
                Camera::Tried {
                    id,
                    attempts: attempt,
                    unread,
                }
            }
        };
    }

    /// Notes that an entry is on disk.
    pub fn written(&mut self, entry: &Entry) {
        match entry {
            Entry::Void { reason, .. } => {
                self.camera = Camera::Idle;
                self.voids += 1;
                // a person has adopted the robot in spite of the throw: it says nothing of the robot
                let adopted = matches!(reason, VoidReason::Foreign | VoidReason::Superseded);
                if self.voids >= self.rules.max_voids && !adopted {
                    self.halt = Some(Halt::TooManyVoids {
                        count: self.voids,
                        last: *reason,
                    });
                }
            }
            Entry::Read { .. } => {
                self.camera = Camera::Idle;
                self.voids = 0;
            }
            Entry::Session { .. } => self.named = true,
            Entry::Adopted { .. } => self.named = false,
            Entry::Announced { .. } | Entry::Done { .. } => {}
        }
    }

    /// Finishes the open throw and starts no other.
    pub fn stop(&mut self) {
        self.stopping = true;
    }

    /// The present status, unless it is stale.
    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// The next step. `now_ms` is the timestamp for entries.
    pub fn step(&mut self, history: &History, now_ms: u64) -> Step {
        if let Some(halt) = &self.halt {
            return Step::Halt(halt.clone());
        }
        if self.rejected {
            return Step::Wait;
        }
        let Some(info) = self.info else {
            return Step::Request(Request::Info);
        };
        let Some(status) = self.status else {
            return Step::Request(Request::Status);
        };
        let whose = self.whose(&status, &info, history);
        let (ours, pending) = (matches!(whose, Whose::Ours), history.pending());
        if let Pending::Read { id } = pending
            && (!ours
                || status.throw_id != id
                || !status.state.in_cycle() && status.state != State::Boot)
        {
            // a reading is valid whatever has happened to the robot since
            return Step::Write(Entry::Done { id });
        }
        if let Whose::Strange(how) = whose {
            return self.strange(how, &status, history);
        }
        if let Some(entry) = self.naming(&info, history, now_ms) {
            return Step::Write(entry);
        }
        if status.throw_id > history.last_id() {
            return self.ahead(status.throw_id, history, pending);
        }
        match pending {
            Pending::Nothing => self.nothing_open(&status, history, ours),
            // announced by a program that did not note the robot: nobody knows
            Pending::Announced { id, .. } if !ours => Step::Write(Entry::Void {
                id,
                reason: VoidReason::Foreign,
            }),
            Pending::Announced { id, setting } if status.throw_id < id => {
                self.not_thrown_yet(&status, id, setting)
            }
            Pending::Announced { id, setting } => self.thrown(&status, id, setting, now_ms),
            Pending::Read { .. } => self.bring_to_idle(&status),
        }
    }

    fn ahead(&self, robot: u32, history: &History, pending: Pending) -> Step {
        let journal = history.last_id();
        if !self.rules.adopt {
            return Step::Halt(Halt::Ahead { robot, journal });
        }
        match pending {
            Pending::Announced { id, .. } => Step::Write(Entry::Void {
                id,
                reason: VoidReason::Superseded,
            }),
            Pending::Nothing | Pending::Read { .. } => {
                Step::Write(Entry::Adopted { counter: robot })
            }
        }
    }

    fn nothing_open(&mut self, status: &Status, history: &History, ours: bool) -> Step {
        let throw = history.announced();
        if status.state != State::Idle {
            return self.bring_to_idle(status);
        }
        if self.stopping || throw >= self.rules.throws {
            return Step::Finished;
        }
        if !ours {
            return Step::Request(Request::SetCounter {
                throw_id: history.last_id(),
                experiment: self.rules.experiment,
            });
        }
        history
            .next_id()
            .map_or(Step::Halt(Halt::NoNumberLeft), |id| Step::Announce {
                throw,
                id,
            })
    }

    fn not_thrown_yet(&mut self, status: &Status, id: u32, setting: Setting) -> Step {
        if status.state != State::Idle {
            return self.bring_to_idle(status);
        }
        Step::Request(Request::Throw {
            throw_id: id,
            experiment: self.rules.experiment,
            spin_mrev_s: setting.spin_mrev_s(),
            angle_cdeg: setting.angle_cdeg(),
        })
    }

    /// The next step when the robot has accepted the open throw and the journal has no reading of
    /// it.
    fn thrown(&self, status: &Status, id: u32, setting: Setting, at_ms: u64) -> Step {
        let void = |reason| Step::Write(Entry::Void { id, reason });
        let wanted = (setting.spin_mrev_s(), setting.angle_cdeg());
        if status.state.in_cycle() && (status.spin_mrev_s, status.angle_cdeg) != wanted {
            return void(VoidReason::Mismatch);
        }
        if let (
            Camera::Read {
                id: of,
                face,
                image,
                digest,
            },
            Some(release),
        ) = (&self.camera, self.release)
            && (*of, release.id) == (id, id)
        {
            if release.asked != wanted {
                return void(VoidReason::Mismatch);
            }
            if !self.is_on_target(&release) {
                return void(VoidReason::OffTarget);
            }
            let reading = Reading {
                face: *face,
                measured: release.measured,
                boot: release.boot,
                image: image.clone(),
                digest: Some(*digest),
            };
            return Step::Write(Entry::Read { id, reading, at_ms });
        }
        match status.state {
            State::AtCoin => self.at_coin(id),
            State::Fault => void(VoidReason::Fault(status.fault)),
            State::Idle => void(VoidReason::Lost),
            State::Boot | State::Aiming | State::Flying | State::Driving | State::Returning => {
                Step::Wait
            }
        }
    }

    fn at_coin(&self, id: u32) -> Step {
        match self.camera {
            Camera::Busy { id: of, .. } if of == id => Step::Wait,
            Camera::Tried {
                id: of,
                attempts,
                unread,
            } if of == id => {
                if unread >= self.rules.max_photos {
                    let reason = VoidReason::Unread;
                    Step::Write(Entry::Void { id, reason })
                } else {
                    let attempt = attempts + 1;
                    Step::Photograph { id, attempt }
                }
            }
            _ => Step::Photograph { id, attempt: 1 },
        }
    }

    fn is_on_target(&self, release: &Release) -> bool {
        let (spin, angle) = release.asked;
        let measured = release.measured;
        measured.spin_mrev_s.abs_diff(spin) <= self.rules.spin_tolerance_mrev_s
            && measured.angle_cdeg.abs_diff(angle) <= self.rules.angle_tolerance_cdeg
    }

    /// The next step that brings the robot to Idle.
    fn bring_to_idle(&mut self, status: &Status) -> Step {
        match status.state {
            State::AtCoin => Step::Request(Request::Collect {
                throw_id: status.throw_id,
            }),
            State::Fault if status.fault == fault::EMERGENCY => Step::Halt(Halt::EmergencyStop),
            State::Fault => {
                self.clears += 1;
                if self.clears > MAX_CLEARS {
                    let code = status.fault;
                    return Step::Halt(Halt::FaultStays { code });
                }
                Step::Request(Request::ClearFault { code: status.fault })
            }
            _ => Step::Wait,
        }
    }
}
