#![doc = include_str!("../README.md")]
//!
//! # Contents
//! The same code runs in the host program and in the robot's firmware. It never reads a clock or a
//! port: its input is bytes and milliseconds, its output bytes and events, so that every behaviour
//! can be tested, fuzzed and replayed. `docs/reference/robot-protocol.md` describes the wire format
//! for authors of firmware in other languages.
//!
//! * [`Wire`] and [`Decoder`]: frames of one message each, with COBS, zero bytes between and a CRC.
//! * [`Request`] and [`Reply`]: the messages of host and robot.
//! * [`Device`]: the robot's side, generic over a [`Hardware`] that drives motors and reads
//!   sensors.
//! * [`FlashLog`]: the robot's journal as a log in flash memory.
//! * [`Host`]: the host's side, with handshake, retransmission and detection of a lost connection.
#![no_std]
// Nobody is there to restart a robot: nothing in this crate may panic, whatever arrives.
#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects,
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod device;
mod flash;
mod frame;
mod host;
mod message;

pub use device::{
    AT_COIN_LIMIT_MS, BOOT_LIMIT_MS, Device, HOME_LIMIT_MS, Hardware, MOVE_LIMIT_MS, Motion,
    Record, SILENCE_LIMIT_MS, Sensors, fault,
};
pub use flash::{Flash, FlashLog};
pub use frame::{Decoder, Frame, Header, MAX_BODY, MAX_PLAIN, MAX_WIRE, Reject, TooLong, Wire};
pub use host::{Action, Counters, Host, LOST_AFTER_MS, REPLY_TIMEOUT_MS, RequestError, Seen};
pub use message::{
    BadMessage, Greeting, Info, Limits, Nak, PROTOCOL, Reply, Request, State, Status, Version,
    axis, capability,
};
