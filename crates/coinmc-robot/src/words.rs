//! States, faults and reasons in words.

use crate::journal::VoidReason;
use coinmc_link::State;

/// Describes the reason of a void throw.
pub(crate) fn void_text(reason: VoidReason) -> String {
    match reason {
        VoidReason::Unread => "no photo showed a face".to_owned(),
        VoidReason::Fault(code) => format!("the robot stopped with {}", fault_text(code)),
        VoidReason::Lost => "the coin was collected before its face was read".to_owned(),
        VoidReason::Superseded => "the robot's counter is ahead of it".to_owned(),
        VoidReason::Mismatch => "the robot made another throw under its number".to_owned(),
        VoidReason::Foreign => "nobody knows whether the robot made it".to_owned(),
        VoidReason::OffTarget => {
            "spin or angle at release were too far from those asked for".to_owned()
        }
    }
}

/// Describes a state.
pub fn state_name(state: State) -> &'static str {
    match state {
        State::Boot => "starting",
        State::Idle => "ready",
        State::Aiming => "aiming",
        State::Flying => "flying",
        State::Driving => "driving",
        State::AtCoin => "at the coin",
        State::Returning => "returning",
        State::Fault => "fault",
    }
}

/// Describes a fault.
pub fn fault_text(code: u16) -> String {
    use coinmc_link::fault::{EMERGENCY, HARDWARE, JOURNAL, LIMIT, RESET, SILENCE, STOPPED};
    let phase = |base: u16| {
        u8::try_from(code - base)
            .ok()
            .and_then(State::from_number)
            .map_or("an unknown phase", state_name)
    };
    let text = match code {
        STOPPED => "stopped".to_owned(),
        SILENCE => "the host was silent".to_owned(),
        EMERGENCY => "emergency stop".to_owned(),
        JOURNAL => "its memory cannot be written".to_owned(),
        _ if code >= HARDWARE => format!("hardware failure {}", code - HARDWARE),
        _ if code == LIMIT + u16::from(State::Idle.number()) => {
            "a motion on request took too long".to_owned()
        }
        _ if code >= LIMIT => format!("{} took too long", phase(LIMIT)),
        _ if code >= RESET => format!("reset while {}", phase(RESET)),
        _ => "unknown".to_owned(),
    };
    format!("fault {code} ({text})")
}
