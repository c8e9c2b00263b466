//! How messages are encoded.

use std::fmt;
use std::str::FromStr;

/// How the messages of a recording are encoded.
///
/// # Example
/// ```
/// use coinmc_recording::Encoding;
/// assert_eq!("json".parse(), Ok(Encoding::Json));
/// assert_eq!(Encoding::default().to_string(), "protobuf");
/// assert!("xml".parse::<Encoding>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Encoding {
    /// Protocol Buffers: less than half the size, and what most viewers draw.
    #[default]
    Protobuf,
    /// JSON: readable without its schema.
    Json,
}

/// An unknown name of an encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("encoding is `protobuf` or `json`")]
pub struct UnknownEncoding;

impl Encoding {
    /// The name of encoded messages in MCAP files.
    pub(crate) fn of_messages(self) -> &'static str {
        match self {
            Self::Protobuf => "protobuf",
            Self::Json => "json",
        }
    }

    /// The name of encoded schemas in MCAP files.
    pub(crate) fn of_schemas(self) -> &'static str {
        match self {
            Self::Protobuf => "protobuf",
            Self::Json => "jsonschema",
        }
    }
}

impl FromStr for Encoding {
    type Err = UnknownEncoding;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "protobuf" => Ok(Self::Protobuf),
            "json" => Ok(Self::Json),
            _ => Err(UnknownEncoding),
        }
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.of_messages())
    }
}
