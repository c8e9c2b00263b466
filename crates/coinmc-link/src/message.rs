//! Messages: requests of the host and replies of the robot.
//!
//! Encoded with postcard, whose wire format is stable and documented: the number of the variant,
//! then the fields in order; integers wider than a byte as little-endian base-128 varints, signed
//! ones zigzag-encoded first. Within a major version, variants are only added at the end, and
//! fields never change; a robot sends only messages known to the minor version in the host's Hello.
//! The frame format, Hello and its reply never change, so that any two versions can reject each
//! other.
//!
//! A body is accepted only if encoding its value gives exactly the same bytes.

use crate::frame::{Header, MAX_BODY, TooLong, Wire};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use thiserror::Error;

/// A version of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Version {
    /// Versions with different majors are incompatible.
    pub major: u8,
    /// A version with a greater minor has more messages.
    pub minor: u8,
}

/// The version implemented by this crate.
pub const PROTOCOL: Version = Version { major: 2, minor: 0 };

/// Axes of [`Request::Home`], one bit each.
pub mod axis {
    /// The carriage, along x.
    pub const X: u8 = 1;
    /// The carriage, along y.
    pub const Y: u8 = 2;
    /// The lift that raises the coin again.
    pub const LIFT: u8 = 4;
    /// The spindle that gives the coin its spin.
    pub const SPINDLE: u8 = 8;
    /// All of them.
    pub const ALL: u8 = X | Y | LIFT | SPINDLE;
}

/// Optional capabilities of a robot: bits of [`Info::capabilities`].
pub mod capability {
    /// It has a lamp and supports Light.
    pub const LIGHT: u32 = 1;
    /// The host can move its carriage with MoveCarriage.
    pub const CARRIAGE: u32 = 2;
}

/// Requests of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Request {
    /// Opens a session. Allowed at any time; never answered from the reply cache.
    Hello {
        /// Version of the host.
        version: Version,
        /// The new session: not 0 and the same as in the frame's header.
        session: u16,
    },
    /// Asks for [`Reply::Info`].
    Info,
    /// Asks for [`Reply::Status`].
    Status,
    /// Switches the motors off at once. During a throw the robot goes to Fault.
    Stop,
    /// Moves these axes to their end stops. Idle only.
    Home {
        /// Bits of [`axis`], at least one.
        axes: u8,
    },
    /// Throws the coin. An id that was accepted before is answered but not thrown again.
    Throw {
        /// At least 1 and greater than any before, except to repeat the last.
        throw_id: u32,
        /// The experiment that the throw belongs to; 0 for none.
        experiment: u32,
        /// Spin at release, 1/1000 rev/s, 0 to 5000.
        spin_mrev_s: u16,
        /// Angle at release, 1/100 degree, 0 to 18000.
        angle_cdeg: u16,
    },
    /// Moves the carriage to a position relative to home. Idle only.
    MoveCarriage {
        /// x coordinate, µm, within ±2 m and the robot's own limit.
        x_um: i32,
        /// y coordinate, µm, within ±2 m and the robot's own limit.
        y_um: i32,
    },
    /// Sets the lamp.
    Light {
        /// Brightness, 1/1000 of full, 0 to 1000.
        permille: u16,
    },
    /// The result of this throw has been saved: lift the coin and return.
    Collect {
        /// The throw.
        throw_id: u32,
    },
    /// Leaves Fault for Idle if the code is that of the present fault.
    ClearFault {
        /// The fault that the host saw.
        code: u16,
    },
    /// Sets the number of the last throw and the experiment that it belongs to: from then on the
    /// robot is known to be that of the experiment. Idle only.
    SetCounter {
        /// The new last throw.
        throw_id: u32,
        /// The experiment; 0 for none.
        experiment: u32,
    },
}

/// Replies of the robot: exactly one to every request that arrives intact.
// Copied a few times per second; a box would need an allocator.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reply {
    /// Reply to Hello. If the major versions differ, no session was opened.
    Hello(Greeting),
    /// Reply to Info.
    Info(Info),
    /// The request was executed or has begun.
    Ok {
        /// The last throw accepted.
        throw_id: u32,
        /// State after the request.
        state: State,
    },
    /// The request was rejected.
    Nak(Nak),
    /// Reply to Status.
    Status(Status),
}

/// The robot's side of the handshake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Greeting {
    /// Version of the robot.
    pub version: Version,
    /// Number of the robot's starts: a different number means that it was reset.
    pub boot: u16,
    /// The last throw accepted; 0 if there was none.
    pub throw_id: u32,
    /// State.
    pub state: State,
}

/// Description of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Info {
    /// Unique number of this robot.
    pub uid: [u8; 8],
    /// Version of its firmware: major, minor, patch.
    pub firmware: [u8; 3],
    /// Bits of [`capability`].
    pub capabilities: u32,
    /// Greatest values it accepts.
    pub limits: Limits,
}

/// Greatest values that a robot accepts, within those of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Limits {
    /// Spin, 1/1000 rev/s.
    pub spin_mrev_s: u16,
    /// Angle, 1/100 degree.
    pub angle_cdeg: u16,
    /// Distance of the carriage from home along x, µm.
    pub x_um: i32,
    /// Distance of the carriage from home along y, µm.
    pub y_um: i32,
}

/// Why the robot rejected a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Error)]
pub enum Nak {
    /// It arrived intact, but this robot does not know the message.
    #[error("the robot does not know this message")]
    BadMessage,
    /// A number is out of range.
    #[error("a number is outside the robot's range")]
    BadRange,
    /// Not possible in the present state.
    #[error("not possible in the robot's present state")]
    WrongState,
    /// The id is not that of the present throw.
    #[error("the robot is at another throw")]
    WrongId,
    /// The session is not open: the robot was reset, or another host has opened one.
    #[error("the robot has no session with this host")]
    NoSession,
    /// Not yet possible: the robot is starting, or an axis is moving.
    #[error("the robot is busy: try again")]
    Busy,
}

/// State of the robot in its cycle: Boot → Idle → Aiming → Flying → Driving → `AtCoin` → Returning
/// → Idle; from any of them to Fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[repr(u8)]
pub enum State {
    /// Starting.
    #[default]
    Boot = 0,
    /// Ready to throw.
    Idle = 1,
    /// Bringing the coin to its spin and angle.
    Aiming = 2,
    /// The coin is released and not yet at rest.
    Flying = 3,
    /// The carriage drives to the coin.
    Driving = 4,
    /// The camera is above the coin: the host photographs it, then sends Collect.
    AtCoin = 5,
    /// The coin is carried back.
    Returning = 6,
    /// Motors off until ClearFault.
    Fault = 7,
}

impl State {
    /// All states, by number.
    pub const ALL: [Self; 8] = [
        Self::Boot,
        Self::Idle,
        Self::Aiming,
        Self::Flying,
        Self::Driving,
        Self::AtCoin,
        Self::Returning,
        Self::Fault,
    ];

    /// The state's number, as in messages, fault codes and journals.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// The state of this number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Whether a throw is under way.
    pub fn in_cycle(self) -> bool {
        matches!(
            self,
            Self::Aiming | Self::Flying | Self::Driving | Self::AtCoin | Self::Returning
        )
    }
}

/// Complete status of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Status {
    /// State.
    pub state: State,
    /// The last throw accepted.
    pub throw_id: u32,
    /// The experiment that it belongs to; 0 for none.
    pub experiment: u32,
    /// Spin asked for, 1/1000 rev/s; 0 if this throw was accepted before the last start.
    pub spin_mrev_s: u16,
    /// Angle asked for, 1/100 degree, likewise.
    pub angle_cdeg: u16,
    /// Whether the coin of this throw was released (after a reset: may have been released).
    pub released: bool,
    /// Measured spin, 1/1000 rev/s: present value before the release, then the value at release.
    pub meas_spin_mrev_s: u16,
    /// Measured angle, 1/100 degree, likewise.
    pub meas_angle_cdeg: u16,
    /// x coordinate of the carriage, µm.
    pub x_um: i32,
    /// y coordinate of the carriage, µm.
    pub y_um: i32,
    /// Time since the start, ms; wraps.
    pub t_ms: u32,
    /// Time of release since the start, ms; 0 if no coin was released since the start.
    pub t_release_ms: u32,
    /// The fault, a code of [`fault`](crate::fault); 0 if there is none.
    pub fault: u16,
    /// Number of damaged frames received since the start.
    pub rx_bad: u16,
}

/// Why a body is not a valid message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum BadMessage {
    /// It does not encode a message of this version.
    #[error("not a message of this version of the protocol")]
    Malformed,
    /// It encodes a message with a number out of range.
    #[error("a number is out of the protocol's range")]
    OutOfRange,
}

impl Request {
    /// Decodes a frame's body.
    ///
    /// # Errors
    /// [`BadMessage`] if it is not a request or has a number out of range.
    pub fn decode(body: &[u8]) -> Result<Self, BadMessage> {
        let request: Self = decode(body)?;
        request.check()?;
        Ok(request)
    }

    /// The frame that carries this message.
    ///
    /// # Errors
    /// Never for a message of this version: all fit.
    pub fn to_wire(&self, header: Header) -> Result<Wire, TooLong> {
        to_wire(self, header)
    }

    /// Whether all numbers are within the protocol's ranges.
    ///
    /// # Errors
    /// [`BadMessage::OutOfRange`] if not.
    ///
    /// # Example
    /// ```
    /// use coinmc_link::Request;
    /// let throw = |spin_mrev_s| {
    ///     Request::Throw { throw_id: 1, experiment: 7, spin_mrev_s, angle_cdeg: 9000 }
    /// };
    /// assert!(throw(5000).check().is_ok() && throw(5001).check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), BadMessage> {
        const REACH_UM: i32 = 2_000_000;
        let in_range = match *self {
            Self::Hello { session, .. } => session != 0,
            Self::Home { axes } => axes != 0 && axes & !axis::ALL == 0,
            Self::Throw {
                throw_id,
                spin_mrev_s,
                angle_cdeg,
                ..
            } => throw_id != 0 && spin_mrev_s <= 5000 && angle_cdeg <= 18_000,
            Self::MoveCarriage { x_um, y_um } => {
                let reach = -REACH_UM..=REACH_UM;
                reach.contains(&x_um) && reach.contains(&y_um)
            }
            Self::Light { permille } => permille <= 1000,
            Self::Info
            | Self::Status
            | Self::Stop
            | Self::Collect { .. }
            | Self::ClearFault { .. }
            | Self::SetCounter { .. } => true,
        };
        if in_range {
            Ok(())
        } else {
            Err(BadMessage::OutOfRange)
        }
    }
}

impl Reply {
    /// Decodes a frame's body.
    ///
    /// # Errors
    /// [`BadMessage::Malformed`] if it is not a reply.
    pub fn decode(body: &[u8]) -> Result<Self, BadMessage> {
        decode(body)
    }

    /// The frame that carries this message.
    ///
    /// # Errors
    /// Never for a message of this version: all fit.
    pub fn to_wire(&self, header: Header) -> Result<Wire, TooLong> {
        to_wire(self, header)
    }
}

fn to_wire(message: &impl Serialize, header: Header) -> Result<Wire, TooLong> {
    let mut space = [0; MAX_BODY];
    let body = postcard::to_slice(message, &mut space).map_err(|_| TooLong(MAX_BODY))?;
    Wire::new(header, body)
}

fn decode<T: Serialize + DeserializeOwned>(body: &[u8]) -> Result<T, BadMessage> {
    let value: T = postcard::from_bytes(body).map_err(|_| BadMessage::Malformed)?;
    let mut space = [0; MAX_BODY];
    match postcard::to_slice(&value, &mut space) {
        Ok(again) if again == body => Ok(value),
        _ => Err(BadMessage::Malformed),
    }
}
