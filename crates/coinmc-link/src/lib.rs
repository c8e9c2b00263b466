//! The robot's serial link: frames, messages, device and host state machines. `no_std`, no
//! allocation, no I/O.
//!
//! The same code runs in the host program and in the robot's firmware. Nothing here reads a clock or
//! a port: bytes and milliseconds are put in, bytes and events come out, so every behaviour can be
//! tested, fuzzed and replayed. `docs/reference/robot-protocol.md` is the wire format for people who write
//! firmware in another language.
//!
//! * [`Wire`] and [`Decoder`]: one message a frame, COBS between zero bytes, CRC-32.
//! * [`Request`] and [`Reply`]: what host and robot say.
//! * [`Device`]: the robot's side, over a [`Hardware`] that turns motors and reads sensors.
//! * [`Host`]: the other side: retransmission, handshake, loss of the line.
//!
//! # Example
//! A host and a robot, joined without a wire:
//! ```
//! use coinmc_link::{Action, Device, Hardware, Host, Info, Motion, Record, Request, Sensors};
//!
//! #[derive(Default)]
//! struct Bench(Option<Record>);
//! impl Hardware for Bench {
//!     fn info(&self) -> Info { Info::default() }
//!     fn load(&mut self) -> Option<Record> { self.0 }
//!     fn store(&mut self, record: &Record) -> bool { self.0 = Some(*record); true }
//!     fn start(&mut self, _: Motion) {}
//!     fn motors_off(&mut self) {}
//!     fn light(&mut self, _: u16) {}
//!     fn sense(&mut self) -> Sensors { Sensors { settled: true, ..Sensors::default() } }
//! }
//!
//! let (mut device, mut host) = (Device::boot(Bench::default(), 0), Host::new());
//! host.open(0x1234, 0);
//! loop {
//!     match host.poll(0) {
//!         Action::Transmit(bytes) => {
//!             let bytes = bytes.to_vec();
//!             for byte in bytes {
//!                 if let Some(reply) = device.receive(byte, 0) {
//!                     host.receive(reply, 0);
//!                 }
//!             }
//!         }
//!         Action::Connected { greeting, .. } => {
//!             assert_eq!(greeting.throw_id, 0);
//!             host.request(&Request::Status, 0)?;
//!         }
//!         Action::Reply(status) => break println!("{status:?}"),
//!         other => unreachable!("{other:?}"),
//!     }
//! }
//! # Ok::<(), coinmc_link::RequestError>(())
//! ```
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
