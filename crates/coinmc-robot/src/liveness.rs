//! Whether an experiment makes progress.

use crate::cycle::Halt;
use crate::words::{fault_text, state_name};
use coinmc_link::{State, Status};
use std::time::{Duration, Instant};

/// Notes when anything changed last: the journal, or what the robot does.
#[derive(Debug)]
pub(crate) struct Liveness {
    limit: Duration,
    seen: (u64, Option<(State, u32)>),
    since: Instant,
    last: Option<Status>,
}

impl Liveness {
    /// Nothing has happened yet.
    pub(crate) fn new(limit: Duration) -> Self {
        Self {
            limit,
            seen: (0, None),
            since: Instant::now(),
            last: None,
        }
    }

    /// Notes the number of entries in the journal and the robot's status; none if it is unknown.
    pub(crate) fn note(&mut self, entries: u64, status: Option<&Status>) {
        let state = status.map(|status| (status.state, status.throw_id));
        // an unknown status is no change: a robot that comes and goes makes no progress either
        let seen = (entries, state.or(self.seen.1));
        if seen != self.seen {
            self.seen = seen;
            self.since = Instant::now();
        }
        self.last = status.copied();
    }

    /// Whether nothing has changed for too long.
    pub(crate) fn is_stalled(&self) -> bool {
        self.since.elapsed() >= self.limit
    }

    /// Names it.
    pub(crate) fn halt(&self) -> Halt {
        let what = match &self.last {
            None => "the robot does not answer".to_owned(),
            Some(status) if status.state == State::Fault => fault_text(status.fault),
            Some(status) => format!(
                "the robot is at throw {}, {}",
                status.throw_id,
                state_name(status.state)
            ),
        };
        Halt::Stalled {
            minutes: self.limit.as_secs() / 60,
            what,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;

    #[test]
    fn only_a_change_is_progress() {
        let limit = Duration::from_millis(200);
        let mut liveness = Liveness::new(limit);
        let mut status = Status {
            throw_id: 7,
            ..Status::default()
        };
        liveness.note(3, Some(&status));
        sleep(limit);
        // the time goes on, the robot answers, and nothing happens
        status.t_ms += 200;
        liveness.note(3, Some(&status));
        assert!(liveness.is_stalled());
        assert!(liveness.halt().to_string().contains("at throw 7, starting"));
        // unplugged and plugged in again: nothing happens either
        liveness.note(3, None);
        assert!(liveness.is_stalled());
        assert!(liveness.halt().to_string().contains("does not answer"));
        liveness.note(4, None);
        assert!(!liveness.is_stalled());
        sleep(limit);
        status.state = State::Idle;
        liveness.note(4, Some(&status));
        assert!(!liveness.is_stalled());
    }
}
