//! The next step of an experiment, from the journal, the robot's last word and the camera's.
//!
//! No input, no output, no clock. The step depends on the state alone and not on how it came to be,
//! so a host that begins anew after a crash takes the very step that the crashed one would have:
//!
//! | journal | robot | step |
//! |---|---|---|
//! | nothing open | Idle | announce the next throw (`I`) |
//! | `I p` | counter < p, Idle | send the throw, the same again |
//! | `I p` | counter = p, moving | wait |
//! | `I p` | counter = p, AtCoin | photograph; face read: `R`; no face after all tries: `V unread` |
//! | `I p` | counter = p, Fault | `V fault-N` |
//! | `I p` | counter = p, Idle | `V lost` |
//! | `R p` | AtCoin | collect |
//! | `R p` | Idle or Fault | `D` |
//! | any | counter ahead | ask the person, or `A` after `--adopt` |
//! | nothing open | AtCoin, Fault | collect, clear the fault |

use crate::journal::{Entry, History, ImageName, Measured, Pending, Reading, VoidReason};
use crate::{Face, Setting};
use coinmc_link::{Greeting, Nak, Reply, Request, State, Status};
use thiserror::Error;

/// Attempts to clear a fault before a person is asked.
const MOST_CLEARS: u32 = 20;

/// What does not change during a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rules {
    /// Throws planned.
    pub throws: u32,
    /// Photos of one throw before it is void.
    pub most_photos: u32,
    /// Void throws in a row before a person is asked.
    pub most_voids: u32,
    /// Go on behind the robot's counter where it is ahead.
    pub adopt: bool,
}

/// What to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Ask the robot this, now.
    Ask(Request),
    /// Nothing to do: ask for the status after the polling interval.
    Wait,
    /// Announce throw number `throw` of the plan under this id: `I`.
    Announce {
        /// Number in the plan, from 0.
        throw: u32,
        /// Number on the link.
        id: u32,
    },
    /// Write this.
    Write(Entry),
    /// Photograph the coin of this throw; the attempts count from 1.
    Photograph {
        /// The throw.
        id: u32,
        /// Which photo of it.
        attempt: u32,
    },
    /// All throws are resolved, or it was told to stop and none is open.
    Finished,
    /// A person must decide.
    Halt(Halt),
}

/// Why a person must decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Halt {
    /// The robot was used for something else.
    #[error(
        "the robot has counted {robot} throws, this journal {journal}: the robot was used with \
         another journal. If that is right, go on behind its counter with --adopt; if it is not, \
         find the journal that it was used with"
    )]
    Ahead {
        /// The robot's counter.
        robot: u32,
        /// The last number in the journal.
        journal: u32,
    },
    /// The robot's own limits are narrower than the protocol's.
    #[error(
        "the robot refuses {} rev/s from {} degrees: its own range is narrower (`coinmc robot \
         info` shows it). Narrow the config's launch and begin another experiment",
        setting.spin_rev_s(), setting.angle_deg()
    )]
    OutOfRange {
        /// What it was told.
        setting: Setting,
    },
    /// The robot does not know a message it must know.
    #[error("the robot does not understand this program: bring its firmware up to date")]
    Misunderstood,
    /// A fault that cannot be cleared.
    #[error("the robot stays in fault {code}: look after it, then resume")]
    FaultStays {
        /// The fault.
        code: u16,
    },
    /// Something is wrong with robot or camera.
    #[error(
        "{count} throws in a row have no result (the last: {last}): look after robot and camera, \
         then resume"
    )]
    TooManyVoids {
        /// How many.
        count: u32,
        /// Why the last one has none.
        last: VoidReason,
    },
    /// The link has no number left.
    #[error(
        "the numbers of the link are used up: clear the robot's memory and begin another experiment"
    )]
    NoNumberLeft,
}

/// What the camera said about one photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// The throw.
    pub id: u32,
    /// Which photo of it.
    pub attempt: u32,
    /// The face and the photo, synced to the disk; `None` if no face could be read.
    pub read: Option<(Face, ImageName)>,
}

/// What is known beyond the journal.
#[derive(Debug, Clone)]
pub struct Cycle {
    rules: Rules,
    status: Option<Status>,
    /// What was measured of the throw last seen in mid-cycle, and in which boot: a reset forgets it.
    release: Option<(u32, Measured, u16)>,
    boot: u16,
    /// The robot said no; let it come to itself before it is asked again.
    refused: bool,
    camera: Camera,
    stopping: bool,
    clears: u32,
    voids: u32,
    halt: Option<Halt>,
}

/// What the camera does.
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
    /// A session that knows nothing yet of its robot.
    pub fn new(rules: Rules) -> Self {
        Self {
            rules,
            status: None,
            release: None,
            boot: 0,
            refused: false,
            camera: Camera::Idle,
            stopping: false,
            clears: 0,
            voids: 0,
            halt: None,
        }
    }

    /// A session with the robot was opened, or opened again: what it said before is stale.
    pub fn connected(&mut self, greeting: &Greeting) {
        self.boot = greeting.boot;
        self.status = None;
    }

    /// The robot answered.
    pub fn replied(&mut self, request: &Request, reply: &Reply) {
        self.status = None;
        self.refused = false;
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
            Reply::Nak(nak) => self.refused_with(request, *nak),
            Reply::Ok { .. } | Reply::Hello(_) | Reply::Info(_) => {}
        }
    }

    fn refused_with(&mut self, request: &Request, nak: Nak) {
        self.refused = true;
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
            // the next status tells
            (Nak::WrongState | Nak::WrongId | Nak::NoSession | Nak::Busy, _) => {}
        }
    }

    /// The polling interval is over: the status is stale.
    pub fn waited(&mut self) {
        self.status = None;
        self.refused = false;
    }

    /// A photo was begun.
    pub fn photographing(&mut self, id: u32, attempt: u32) {
        self.camera = Camera::Busy { id, attempt };
    }

    /// A photo came back.
    pub fn photographed(&mut self, photo: Photo) {
        let Photo { id, attempt, read } = photo;
        if self.camera != (Camera::Busy { id, attempt }) {
            return; // of a throw that is resolved
        }
        self.camera = match read {
            Some((face, image)) => Camera::Read { id, face, image },
            None => Camera::Failed { id, attempt },
        };
    }

    /// An entry is on the disk.
    pub fn written(&mut self, entry: &Entry) {
        match entry {
            Entry::Void { reason, .. } => {
                self.camera = Camera::Idle;
                self.voids += 1;
                if self.voids >= self.rules.most_voids {
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

    /// Finish the open throw, and begin no other.
    pub fn stop(&mut self) {
        self.stopping = true;
    }

    /// The status that the next step is decided on, if it is fresh.
    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// The next step. `now_ms` is the time that entries get.
    pub fn step(&mut self, history: &History, now_ms: u64) -> Step {
        if let Some(halt) = self.halt {
            return Step::Halt(halt);
        }
        if self.refused {
            return Step::Wait;
        }
        let Some(status) = self.status else {
            return Step::Ask(Request::Status);
        };
        let pending = history.pending();
        if let Pending::Read { id } = pending
            && (status.throw_id != id || !status.state.in_cycle() && status.state != State::Boot)
        {
            // a reading stands, whatever became of the robot since
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
            Pending::Read { .. } => self.put_away(&status),
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
            return self.put_away(status);
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
            return self.put_away(status);
        }
        Step::Ask(Request::Throw {
            throw_id: id,
            spin_mrev_s: setting.spin_mrev_s(),
            angle_cdeg: setting.angle_cdeg(),
        })
    }

    /// The robot has the open throw, and the journal no reading of it.
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
                    if attempt >= self.rules.most_photos {
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

    /// Brings the robot towards Idle.
    fn put_away(&mut self, status: &Status) -> Step {
        match status.state {
            State::AtCoin => Step::Ask(Request::Collect {
                throw_id: status.throw_id,
            }),
            State::Fault => {
                self.clears += 1;
                if self.clears > MOST_CLEARS {
                    let code = status.fault;
                    return Step::Halt(Halt::FaultStays { code });
                }
                Step::Ask(Request::ClearFault { code: status.fault })
            }
            _ => Step::Wait,
        }
    }
}
