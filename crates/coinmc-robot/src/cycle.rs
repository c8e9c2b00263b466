//! The next step of an experiment, from the journal and the latest messages of robot and camera.
//!
//! No I/O and no clock. The step depends only on the present state, not on its history, so a host
//! that restarts after a crash takes exactly the step that the crashed one would have taken:
//!
//! | journal | robot | step |
//! |---|---|---|
//! | nothing open | Idle | announce the next throw (`I`) |
//! | `I p` | counter < p, Idle | send the throw (again) |
//! | `I p` | counter = p, moving | wait |
//! | `I p` | counter = p, AtCoin | photograph; face read: `R`; no face in any photo: `V unread` |
//! | `I p` | counter = p, Fault | `V fault-N` |
//! | `I p` | counter = p, Idle | `V lost` |
//! | `R p` | AtCoin | collect |
//! | `R p` | Idle or Fault | `D` |
//! | any | counter ahead | ask the user, or `A` after `--adopt` |
//! | nothing open | AtCoin, Fault | collect, clear the fault |

use crate::journal::{Entry, History, ImageName, Measured, Pending, Reading, VoidReason};
use crate::{Face, Setting};
use coinmc_link::{Greeting, Nak, Reply, Request, State, Status};
use thiserror::Error;

/// Attempts to clear a fault before the user is asked.
const MAX_CLEARS: u32 = 20;

/// Settings that do not change during a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rules {
    /// Throws planned.
    pub throws: u32,
    /// Photos of one throw without a face before the throw is void.
    pub max_photos: u32,
    /// Consecutive void throws before the user is asked.
    pub max_voids: u32,
    /// If the robot's counter is ahead of the journal, continue from the counter.
    pub adopt: bool,
}

/// What to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Send this request to the robot now.
    Request(Request),
    /// Nothing to do: request the status after the polling interval.
    Wait,
    /// Announce throw number `throw` of the plan under this id: `I`.
    Announce {
        /// Number in the plan, from 0.
        throw: u32,
        /// Number on the link.
        id: u32,
    },
    /// Write this entry.
    Write(Entry),
    /// Photograph the coin of this throw; the attempts count from 1.
    Photograph {
        /// The throw.
        id: u32,
        /// Number of the photo of this throw.
        attempt: u32,
    },
    /// All throws are resolved, or the cycle was stopped and no throw is open.
    Finished,
    /// The user must decide.
    Halt(Halt),
}

/// Why the user must decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
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

/// The result of one photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// The throw.
    pub id: u32,
    /// Number of the photo of this throw.
    pub attempt: u32,
    /// The face and the photo, which is synced to disk; `None` if no face could be read.
    pub read: Option<(Face, ImageName)>,
}

/// The state beyond the journal: the latest messages of robot and camera.
#[derive(Debug, Clone)]
pub struct Cycle {
    rules: Rules,
    status: Option<Status>,
    /// Id, measurements and boot number of the last released throw; a reset clears it.
    release: Option<(u32, Measured, u16)>,
    boot: u16,
    /// The robot rejected a request: wait before sending it again.
    rejected: bool,
    camera: Camera,
    stopping: bool,
    clears: u32,
    voids: u32,
    halt: Option<Halt>,
}

/// State of the camera.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Camera {
    Idle,
    Busy {
        id: u32,
        attempt: u32,
    },
    Failed {
        id: u32,
        attempt: u32,
    },
    Read {
        id: u32,
        face: Face,
        image: ImageName,
    },
}

impl Cycle {
    /// A cycle before the first message of robot or camera.
    pub fn new(rules: Rules) -> Self {
        Self {
            rules,
            status: None,
            release: None,
            boot: 0,
            rejected: false,
            camera: Camera::Idle,
            stopping: false,
            clears: 0,
            voids: 0,
            halt: None,
        }
    }

    /// Notes that a session with the robot was opened (again): earlier messages are stale.
    pub fn connected(&mut self, greeting: &Greeting) {
        self.boot = greeting.boot;
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
                if status.state.in_cycle() && status.released {
                    let measured = Measured {
                        spin_mrev_s: status.meas_spin_mrev_s,
                        angle_cdeg: status.meas_angle_cdeg,
                    };
                    self.release = Some((status.throw_id, measured, self.boot));
                }
                self.status = Some(*status);
            }
            Reply::Nak(nak) => self.note_rejection(request, *nak),
            Reply::Ok { .. } | Reply::Hello(_) | Reply::Info(_) => {}
        }
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
        self.camera = Camera::Busy { id, attempt };
    }

    /// Notes the result of a photo.
    pub fn photographed(&mut self, photo: Photo) {
        let Photo { id, attempt, read } = photo;
        if self.camera != (Camera::Busy { id, attempt }) {
            return; // its throw is resolved already
        }
        self.camera = match read {
            Some((face, image)) => Camera::Read { id, face, image },
            None => Camera::Failed { id, attempt },
        };
    }

    /// Notes that an entry is on disk.
    pub fn written(&mut self, entry: &Entry) {
        match entry {
            Entry::Void { reason, .. } => {
                self.camera = Camera::Idle;
                self.voids += 1;
                if self.voids >= self.rules.max_voids {
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
            Entry::Adopted { .. } | Entry::Announced { .. } | Entry::Done { .. } => {}
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
        if let Some(halt) = self.halt {
            return Step::Halt(halt);
        }
        if self.rejected {
            return Step::Wait;
        }
        let Some(status) = self.status else {
            return Step::Request(Request::Status);
        };
        let pending = history.pending();
        if let Pending::Read { id } = pending
            && (status.throw_id != id || !status.state.in_cycle() && status.state != State::Boot)
        {
            // a reading is valid whatever has happened to the robot since
            return Step::Write(Entry::Done { id });
        }
        if status.throw_id > history.last_id() {
            return self.ahead(status.throw_id, history, pending);
        }
        match pending {
            Pending::Nothing => self.nothing_open(&status, history),
            Pending::Announced { id, setting } if status.throw_id < id => {
                self.not_thrown_yet(&status, id, setting)
            }
            Pending::Announced { id, .. } => self.thrown(&status, id, now_ms),
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

    fn nothing_open(&mut self, status: &Status, history: &History) -> Step {
        let throw = history.announced();
        if status.state != State::Idle {
            return self.bring_to_idle(status);
        }
        if self.stopping || throw >= self.rules.throws {
            return Step::Finished;
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
            spin_mrev_s: setting.spin_mrev_s(),
            angle_cdeg: setting.angle_cdeg(),
        })
    }

    /// The next step when the robot has accepted the open throw and the journal has no reading of
    /// it.
    fn thrown(&self, status: &Status, id: u32, at_ms: u64) -> Step {
        let void = |reason| Step::Write(Entry::Void { id, reason });
        if let (
            Camera::Read {
                id: of,
                face,
                image,
            },
            Some((released, measured, boot)),
        ) = (&self.camera, self.release)
            && (*of, released) == (id, id)
        {
            let reading = Reading {
                face: *face,
                measured,
                boot,
                image: image.clone(),
            };
            return Step::Write(Entry::Read { id, reading, at_ms });
        }
        match status.state {
            State::AtCoin => match self.camera {
                Camera::Busy { id: of, .. } if of == id => Step::Wait,
                Camera::Failed { id: of, attempt } if of == id => {
                    if attempt >= self.rules.max_photos {
                        void(VoidReason::Unread)
                    } else {
                        let attempt = attempt + 1;
                        Step::Photograph { id, attempt }
                    }
                }
                _ => Step::Photograph { id, attempt: 1 },
            },
            State::Fault => void(VoidReason::Fault(status.fault)),
            State::Idle => void(VoidReason::Lost),
            State::Boot | State::Aiming | State::Flying | State::Driving | State::Returning => {
                Step::Wait
            }
        }
    }

    /// The next step that brings the robot to Idle.
    fn bring_to_idle(&mut self, status: &Status) -> Step {
        match status.state {
            State::AtCoin => Step::Request(Request::Collect {
                throw_id: status.throw_id,
            }),
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
