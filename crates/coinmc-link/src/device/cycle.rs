//! The cycle of a throw: its phases, their time limits, the journal, and silence of the host.

use super::hardware::{Hardware, Motion, Record, Sensors};
use crate::message::{Nak, Request, State, Status};

/// Time the robot waits at the coin for Collect before it goes to Fault, ms.
pub const AT_COIN_LIMIT_MS: u32 = 60_000;
/// Time without a valid frame after which all motors are switched off, ms.
pub const SILENCE_LIMIT_MS: u32 = 5_000;
/// Time limit of the start, ms.
pub const BOOT_LIMIT_MS: u32 = 10_000;
/// Time limit of Home, ms.
pub const HOME_LIMIT_MS: u32 = 10_000;
/// Time limit of `MoveCarriage`, ms.
pub const MOVE_LIMIT_MS: u32 = 5_000;

/// Fault codes.
pub mod fault {
    /// The host sent Stop during a throw.
    pub const STOPPED: u16 = 1;
    /// The host fell silent during a motion of a throw.
    pub const SILENCE: u16 = 2;
    /// The journal cannot be written.
    pub const JOURNAL: u16 = 3;
    /// The emergency stop was pressed. It must be released before this fault can be cleared.
    pub const EMERGENCY: u16 = 4;
    /// Plus the number of the phase during which the robot was reset.
    pub const RESET: u16 = 100;
    /// Plus the number of the state that exceeded its time limit: Idle for a motion on request.
    pub const LIMIT: u16 = 200;
    /// Plus the firmware's own number of a hardware failure.
    pub const HARDWARE: u16 = 300;
}

/// The robot's state, and since when it is in it.
#[derive(Debug)]
pub(super) struct Cycle {
    pub(super) state: State,
    pub(super) throw_id: u32,
    experiment: u32,
    /// Spin and angle asked for; 0 after a start.
    asked: (u16, u16),
    pub(super) boot: u16,
    fault: u16,
    since_ms: u32,
    heard_ms: u32,
    /// The host has been silent for too long, or has never sent a valid frame.
    silent: bool,
    /// Start and time limit of a motion on request.
    moving: Option<(u32, u32)>,
    release: Option<Release>,
    /// The coin may have been released: set at release, or after a reset from the journal.
    released: bool,
}

/// Measurements at release.
#[derive(Debug)]
struct Release {
    at_ms: u32,
    spin_mrev_s: u16,
    angle_cdeg: u16,
}

impl Cycle {
    pub(super) fn boot(hardware: &mut impl Hardware, now_ms: u32) -> Self {
        hardware.motors_off();
        let last = hardware.load().unwrap_or(Record {
            throw_id: 0,
            experiment: 0,
            boot: 0,
            phase: State::Idle,
        });
        let stopped = last.phase == State::Fault;
        let mut cycle = Self {
            state: State::Boot,
            throw_id: last.throw_id,
            experiment: last.experiment,
            asked: (0, 0),
            boot: last.boot.wrapping_add(1),
            fault: 0,
            since_ms: now_ms,
            heard_ms: now_ms,
            silent: true,
            moving: None,
            release: None,
            // an emergency stop leaves no record of the phase
            released: stopped || last.phase.in_cycle() && last.phase != State::Aiming,
        };
        // The phase stays in the journal, so that a second reset finds it again.
        let stored = cycle.journal(hardware, last.phase);
        if stopped {
            cycle.fail(hardware, fault::EMERGENCY);
        } else if last.phase.in_cycle() {
            let phase = u16::from(last.phase.number());
            cycle.fail(hardware, fault::RESET.saturating_add(phase));
        } else if !stored {
            cycle.fail(hardware, fault::JOURNAL);
        }
        cycle
    }

    /// Notes that a valid frame arrived.
    pub(super) fn heard(&mut self, now_ms: u32) {
        self.heard_ms = now_ms;
        self.silent = false;
    }

    pub(super) fn execute(
        &mut self,
        hardware: &mut impl Hardware,
        request: Request,
        now_ms: u32,
    ) -> Result<(), Nak> {
        match request {
            Request::Stop => self.stop(hardware),
            Request::Home { axes } => {
                self.move_on_request(hardware, Motion::Home { axes }, (now_ms, HOME_LIMIT_MS))?;
            }
            Request::MoveCarriage { x_um, y_um } => {
                let motion = Motion::MoveCarriage { x_um, y_um };
                self.move_on_request(hardware, motion, (now_ms, MOVE_LIMIT_MS))?;
            }
            Request::Throw {
                throw_id,
                experiment,
                spin_mrev_s,
                angle_cdeg,
            } => {
                let asked = (spin_mrev_s, angle_cdeg);
                self.throw(hardware, (throw_id, experiment), asked, now_ms)?;
            }
            Request::Collect { throw_id } => self.collect(hardware, throw_id, now_ms)?,
            Request::ClearFault { code } => self.clear(hardware, code)?,
            Request::SetCounter {
                throw_id,
                experiment,
            } => {
                self.require_idle()?;
                self.forget_throw((throw_id, experiment));
                self.journal_or_fail(hardware, State::Idle);
            }
            _ => return Err(Nak::BadMessage),
        }
        Ok(())
    }

    /// Advances to the next phase if the sensors allow it, and checks the time limits.
    pub(super) fn tick(&mut self, hardware: &mut impl Hardware, now_ms: u32) {
        self.check_silence(hardware, now_ms);
        let sensors = hardware.sense();
        if sensors.stopped {
            self.stop_in_emergency(hardware);
        } else if self.state == State::Fault {
            // only ClearFault leads out
        } else if sensors.failure != 0 {
            let code = fault::HARDWARE.saturating_add(u16::from(sensors.failure));
            self.fail(hardware, code);
        } else if sensors.settled && self.advance(hardware, &sensors, now_ms) {
            // at most one phase per tick
        } else if let Some((since_ms, limit_ms)) = self.limit()
            && now_ms.wrapping_sub(since_ms) >= limit_ms
        {
            let phase = u16::from(self.state.number());
            self.fail(hardware, fault::LIMIT.saturating_add(phase));
        }
    }

    pub(super) fn status(
        &self,
        sensors: &Sensors,
        started_ms: u32,
        t_ms: u32,
        rx_bad: u16,
    ) -> Status {
        let release = self.release.as_ref();
        Status {
            state: self.state,
            throw_id: self.throw_id,
            experiment: self.experiment,
            spin_mrev_s: self.asked.0,
            angle_cdeg: self.asked.1,
            released: self.released,
            meas_spin_mrev_s: release.map_or(sensors.spin_mrev_s, |at| at.spin_mrev_s),
            meas_angle_cdeg: release.map_or(sensors.angle_cdeg, |at| at.angle_cdeg),
            x_um: sensors.x_um,
            y_um: sensors.y_um,
            t_ms,
            t_release_ms: release.map_or(0, |at| at.at_ms.wrapping_sub(started_ms)),
            fault: self.fault,
            rx_bad,
        }
    }

    fn require_idle(&self) -> Result<(), Nak> {
        match self.state {
            State::Idle => Ok(()),
            State::Boot => Err(Nak::Busy),
            _ => Err(Nak::WrongState),
        }
    }

    /// Starts a motion with its time limit. A second one has to wait: it would begin the limit anew.
    fn move_on_request(
        &mut self,
        hardware: &mut impl Hardware,
        motion: Motion,
        limit: (u32, u32),
    ) -> Result<(), Nak> {
        self.require_idle()?;
        if self.moving.is_some() {
            return Err(Nak::Busy);
        }
        self.moving = Some(limit);
        hardware.start(motion);
        Ok(())
    }

    fn throw(
        &mut self,
        hardware: &mut impl Hardware,
        (throw_id, experiment): (u32, u32),
        asked: (u16, u16),
        now_ms: u32,
    ) -> Result<(), Nak> {
        if throw_id == self.throw_id && experiment == self.experiment {
            return Ok(());
        }
        if throw_id <= self.throw_id {
            return Err(Nak::WrongId);
        }
        self.require_idle()?;
        if self.moving.is_some() || !hardware.sense().settled {
            return Err(Nak::Busy);
        }
        self.forget_throw((throw_id, experiment));
        self.asked = asked;
        let aim = Motion::Aim {
            spin_mrev_s: asked.0,
            angle_cdeg: asked.1,
        };
        self.enter(hardware, State::Aiming, Some(aim), now_ms);
        Ok(())
    }

    fn collect(
        &mut self,
        hardware: &mut impl Hardware,
        throw_id: u32,
        now_ms: u32,
    ) -> Result<(), Nak> {
        if throw_id != self.throw_id {
            return Err(Nak::WrongId);
        }
        match self.state {
            State::AtCoin => {
                self.enter(hardware, State::Returning, Some(Motion::Return), now_ms);
                Ok(())
            }
            // requested again, because the first reply was lost with its session
            State::Returning | State::Idle => Ok(()),
            _ => Err(Nak::WrongState),
        }
    }

    fn clear(&mut self, hardware: &mut impl Hardware, code: u16) -> Result<(), Nak> {
        if self.state != State::Fault || self.fault != code {
            return Err(Nak::WrongState);
        }
        if hardware.sense().stopped {
            return Err(Nak::Busy);
        }
        self.switch_off(hardware);
        if self.journal(hardware, State::Idle) {
            self.state = State::Idle;
            self.fault = 0;
        } else {
            self.fault = fault::JOURNAL;
        }
        Ok(())
    }

    fn stop(&mut self, hardware: &mut impl Hardware) {
        if self.state.in_cycle() {
            self.fail(hardware, fault::STOPPED);
        } else {
            self.switch_off(hardware);
        }
    }

    /// Latches the emergency stop: the motors first, then the journal, which outlasts a reset.
    fn stop_in_emergency(&mut self, hardware: &mut impl Hardware) {
        let latched = self.state == State::Fault && self.fault == fault::EMERGENCY;
        self.fail(hardware, fault::EMERGENCY);
        if !latched {
            // the motors are off, whether this succeeds or not
            self.journal(hardware, State::Fault);
        }
    }

    fn check_silence(&mut self, hardware: &mut impl Hardware, now_ms: u32) {
        if !self.silent && now_ms.wrapping_sub(self.heard_ms) >= SILENCE_LIMIT_MS {
            self.silent = true;
            // At the coin nothing moves: the host may still come back and photograph it.
            if self.state.in_cycle() && self.state != State::AtCoin {
                self.fail(hardware, fault::SILENCE);
            }
        }
        if self.silent || self.state == State::Fault {
            self.switch_off(hardware);
        }
    }

    /// Enters the next phase if the present one ends without a request; whether it did.
    fn advance(&mut self, hardware: &mut impl Hardware, sensors: &Sensors, now_ms: u32) -> bool {
        match self.state {
            State::Boot => self.state = State::Idle,
            State::Aiming => {
                self.enter(hardware, State::Flying, Some(Motion::Release), now_ms);
                if self.state == State::Flying {
                    self.released = true;
                    self.release = Some(Release {
                        at_ms: now_ms,
                        spin_mrev_s: sensors.spin_mrev_s,
                        angle_cdeg: sensors.angle_cdeg,
                    });
                }
            }
            State::Flying => {
                self.enter(hardware, State::Driving, Some(Motion::DriveToCoin), now_ms);
            }
            State::Driving => self.enter(hardware, State::AtCoin, None, now_ms),
            State::Returning => self.enter(hardware, State::Idle, None, now_ms),
            // what does not move has no current, for however long the host asks for nothing
            State::Idle => self.switch_off(hardware),
            State::AtCoin | State::Fault => return false,
        }
        true
    }

    /// Enters a state: writes the journal first, then starts the motion.
    fn enter(
        &mut self,
        hardware: &mut impl Hardware,
        state: State,
        motion: Option<Motion>,
        now_ms: u32,
    ) {
        self.state = state;
        self.since_ms = now_ms;
        if self.journal_or_fail(hardware, state)
            && let Some(motion) = motion
        {
            hardware.start(motion);
        }
    }

    fn journal_or_fail(&mut self, hardware: &mut impl Hardware, phase: State) -> bool {
        let stored = self.journal(hardware, phase);
        if !stored {
            self.fail(hardware, fault::JOURNAL);
        }
        stored
    }

    fn journal(&self, hardware: &mut impl Hardware, phase: State) -> bool {
        hardware.store(&Record {
            throw_id: self.throw_id,
            experiment: self.experiment,
            boot: self.boot,
            phase,
        })
    }

    fn fail(&mut self, hardware: &mut impl Hardware, code: u16) {
        self.switch_off(hardware);
        self.state = State::Fault;
        self.fault = code;
    }

    fn switch_off(&mut self, hardware: &mut impl Hardware) {
        hardware.motors_off();
        self.moving = None;
    }

    /// Start and time limit of what the robot does now.
    fn limit(&self) -> Option<(u32, u32)> {
        match self.state {
            State::Idle => self.moving,
            state => limit_ms(state).map(|limit_ms| (self.since_ms, limit_ms)),
        }
    }

    /// The last throw is this one, and nothing else is known of it.
    fn forget_throw(&mut self, (throw_id, experiment): (u32, u32)) {
        self.throw_id = throw_id;
        self.experiment = experiment;
        self.asked = (0, 0);
        self.release = None;
        self.released = false;
    }
}

/// Time limit of a phase, ms.
fn limit_ms(state: State) -> Option<u32> {
    match state {
        State::Boot => Some(BOOT_LIMIT_MS),
        State::Aiming | State::Flying => Some(3_000),
        State::Driving => Some(4_000),
        State::AtCoin => Some(AT_COIN_LIMIT_MS),
        State::Returning => Some(5_000),
        State::Idle | State::Fault => None,
    }
}
