//! Messages: what the host asks and what the robot answers.
//!
//! Encoded with postcard (its wire format is stable and documented): the number of the variant,
//! then the fields in order; integers wider than a byte as little-endian base-128 varints, signed
//! ones zigzag-encoded first. Within a major version variants are only added, at the end, and no
//! field ever changes; a robot sends nothing that the minor version of the host's Hello did not
//! have. Frame, Hello and its reply stay for ever, so that two versions can always refuse each other.
//!
//! A body is accepted only if it is, byte for byte, what encoding its value gives.

use crate::frame::{Header, MAX_BODY, TooLong, Wire};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use thiserror::Error;

/// A version of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Version {
    /// Differs: the two do not understand each other.
    pub major: u8,
    /// Greater: knows more messages.
    pub minor: u8,
}

/// The version that this crate speaks.
pub const PROTOCOL: Version = Version { major: 1, minor: 0 };

/// Axes of [`Request::Home`], one bit each.
pub mod axis {
    /// The carriage, along x.
    pub const X: u8 = 1;
    /// The carriage, along y.
    pub const Y: u8 = 2;
    /// The lift that carries the coin back up.
    pub const LIFT: u8 = 4;
    /// The spindle that gives the coin its spin.
    pub const SPINDLE: u8 = 8;
    /// All of them.
    pub const ALL: u8 = X | Y | LIFT | SPINDLE;
}

/// What a robot can do beyond throwing: bits of [`Info::capabilities`].
pub mod capability {
    /// It has a lamp: Light works.
    pub const LIGHT: u32 = 1;
    /// The carriage can be moved by hand: MoveCarriage works.
    pub const CARRIAGE: u32 = 2;
}

/// What the host asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Request {
    /// Opens a session. Allowed at any time; never answered from the reply cache.
    Hello {
        /// Version of the host.
        version: Version,
        /// The new session: not 0, and the same as in the frame's header.
        session: u16,
    },
    /// Asks for [`Reply::Info`].
    Info,
    /// Asks for [`Reply::Status`].
    Status,
    /// Motors off, at once. In the middle of a throw the robot goes to Fault.
    Stop,
    /// Finds the end stops of these axes. Idle only.
    Home {
        /// Bits of [`axis`], at least one.
        axes: u8,
    },
    /// Throws the coin. An id that the robot already had is answered and not thrown again.
    Throw {
        /// From 1 up; greater than any before, except to repeat the last.
        throw_id: u32,
        /// Spin at release, 1/1000 rev/s, 0 to 5000.
        spin_mrev_s: u16,
        /// Angle at release, 1/100 degree, 0 to 18000.
        angle_cdeg: u16,
    },
    /// Moves the carriage, from the home position. Idle only.
    MoveCarriage {
        /// Along x, µm, within ±2 m and the robot's own limit.
        x_um: i32,
        /// Along y, µm, within ±2 m and the robot's own limit.
        y_um: i32,
    },
    /// Sets the lamp.
    Light {
        /// Brightness, 1/1000 of full, 0 to 1000.
        permille: u16,
    },
    /// The result of this throw is safe: lift the coin and return.
    Collect {
        /// The throw.
        throw_id: u32,
    },
    /// Leaves Fault for Idle, if this is the fault.
    ClearFault {
        /// The fault that the host saw.
        code: u16,
    },
    /// Sets the number of the last throw. Idle only.
    SetCounter {
        /// The new last throw.
        throw_id: u32,
    },
}

/// What the robot answers: exactly one to every request that arrives whole.
// Copied a few times a second; a box would need an allocator.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reply {
    /// To Hello. If the versions' majors differ, no session was opened.
    Hello(Greeting),
    /// To Info.
    Info(Info),
    /// Done, or begun.
    Ok {
        /// The last throw accepted.
        throw_id: u32,
        /// State after the request.
        state: State,
    },
    /// Not done.
    Nak(Nak),
    /// To Status.
    Status(Status),
}

/// The robot's side of the handshake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Greeting {
    /// Version of the robot.
    pub version: Version,
    /// Counts the robot's starts: another number means that it was reset.
    pub boot: u16,
    /// The last throw accepted; 0: none ever.
    pub throw_id: u32,
    /// Where it is.
    pub state: State,
}

/// What the robot is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Info {
    /// Unique number of this robot.
    pub uid: [u8; 8],
    /// Version of its firmware: major, minor, patch.
    pub firmware: [u8; 3],
    /// Bits of [`capability`].
    pub capabilities: u32,
    /// What it can reach.
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

/// Why the robot did not do it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Error)]
pub enum Nak {
    /// It arrived whole, but means nothing to this robot.
    #[error("the robot does not know this message")]
    BadMessage,
    /// A number is out of range.
    #[error("a number is outside the robot's range")]
    BadRange,
    /// Not in this state.
    #[error("not possible in the robot's present state")]
    WrongState,
    /// Not this throw.
    #[error("the robot is at another throw")]
    WrongId,
    /// The session is not open: the robot was reset, or another host came.
    #[error("the robot has no session with this host")]
    NoSession,
    /// Not yet: it starts, or an axis is moving.
    #[error("the robot is busy; ask again")]
    Busy,
}

/// Where the robot is in its cycle: Boot → Idle → Aiming → Flying → Driving → `AtCoin` → Returning →
/// Idle; from any to Fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[repr(u8)]
pub enum State {
    /// Starting.
    #[default]
    Boot = 0,
    /// Ready for a throw.
    Idle = 1,
    /// Bringing the coin to its spin and angle.
    Aiming = 2,
    /// The coin is released and not yet at rest.
    Flying = 3,
    /// The carriage drives to the coin.
    Driving = 4,
    /// The camera is above the coin: photograph, then Collect.
    AtCoin = 5,
    /// The coin is carried back.
    Returning = 6,
    /// Motors off, until ClearFault.
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

/// Everything the robot knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Status {
    /// Where it is.
    pub state: State,
    /// The last throw accepted.
    pub throw_id: u32,
    /// The coin of this throw was released (after a reset: may have been).
    pub released: bool,
    /// Measured spin: at release once released, before it now. 1/1000 rev/s.
    pub meas_spin_mrev_s: u16,
    /// Measured angle, likewise. 1/100 degree.
    pub meas_angle_cdeg: u16,
    /// Carriage along x, µm.
    pub x_um: i32,
    /// Carriage along y, µm.
    pub y_um: i32,
    /// Time since the start, ms; wraps.
    pub t_ms: u32,
    /// When the coin was released, likewise; 0 if it was not since the start.
    pub t_release_ms: u32,
    /// The fault, a code of [`fault`](crate::fault); 0: none.
    pub fault: u16,
    /// Frames that did not arrive whole since the start.
    pub rx_bad: u16,
}

/// Why a body is no message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum BadMessage {
    /// No message of this version is encoded so.
    #[error("not a message of this version of the protocol")]
    Malformed,
    /// It is one, but a number is out of range.
    #[error("a number is out of the protocol's range")]
    OutOfRange,
}

impl Request {
    /// Reads a frame's body.
    ///
    /// # Errors
    /// [`BadMessage`] if it is no request, or one with a number out of range.
    pub fn decode(body: &[u8]) -> Result<Self, BadMessage> {
        let request: Self = decode(body)?;
        request.check()?;
        Ok(request)
    }

    /// The frame that carries it.
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
    /// let throw = |spin_mrev_s| Request::Throw { throw_id: 1, spin_mrev_s, angle_cdeg: 9000 };
    /// assert!(throw(5000).check().is_ok() && throw(5001).check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), BadMessage> {
        const REACH_UM: i32 = 2_000_000;
        let fine = match *self {
            Self::Hello { session, .. } => session != 0,
            Self::Home { axes } => axes != 0 && axes & !axis::ALL == 0,
            Self::Throw {
                throw_id,
                spin_mrev_s,
                angle_cdeg,
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
        if fine {
            Ok(())
        } else {
            Err(BadMessage::OutOfRange)
        }
    }
}

impl Reply {
    /// Reads a frame's body.
    ///
    /// # Errors
    /// [`BadMessage::Malformed`] if it is no reply.
    pub fn decode(body: &[u8]) -> Result<Self, BadMessage> {
        decode(body)
    }

    /// The frame that carries it.
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
