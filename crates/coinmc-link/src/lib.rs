#![doc = include_str!("../README.md")]
//!
//! # Contents
//! The same code runs in the host program and in the robot's firmware. Nothing here reads a clock or
//! a port: bytes and milliseconds are put in, bytes and events come out, so every behaviour can be
//! tested, fuzzed and replayed. `docs/reference/robot-protocol.md` is the wire format for people who write
//! firmware in another language.
//!
//! * [`Wire`] and [`Decoder`]: one message a frame, COBS between zero bytes, CRC-32.
//! * [`Request`] and [`Reply`]: what host and robot say.
//! * [`Device`]: the robot's side, over a [`Hardware`] that turns motors and reads sensors.
//! * [`Host`]: the other side: retransmission, handshake, loss of the line.
#![no_std]
// A robot has nobody to restart it: nothing in this crate may panic, whatever arrives.
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
mod frame;
mod host;
mod message;

pub use device::{
    AT_COIN_LIMIT_MS, Device, Hardware, Motion, Record, SILENCE_LIMIT_MS, Sensors, fault,
};
pub use frame::{Decoder, Frame, Header, MAX_BODY, MAX_PLAIN, MAX_WIRE, Reject, TooLong, Wire};
pub use host::{Action, Counters, Host, LOST_AFTER_MS, REPLY_TIMEOUT_MS, RequestError, Seen};
pub use message::{
    BadMessage, Greeting, Info, Limits, Nak, PROTOCOL, Reply, Request, State, Status, Version,
    axis, capability,
};
