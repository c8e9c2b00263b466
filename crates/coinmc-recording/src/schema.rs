//! Schemas of messages.

use std::borrow::Cow;

/// A named schema that describes the messages of a channel, for either encoding.
///
/// # Example
/// ```
/// use coinmc_recording::Schema;
/// let schema = Schema::new("my.Reading", r#"{"type": "object"}"#, b"");
/// assert_eq!(schema.name, "my.Reading");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schema {
    /// Name; viewers recognise Foxglove's schemas by it.
    pub name: Cow<'static, str>,
    /// Text of the JSON Schema.
    pub json: Cow<'static, str>,
    /// A serialised `FileDescriptorSet` that defines the message of this name and all it uses.
    pub protobuf: Cow<'static, [u8]>,
}

/// A schema from the files `schemas/NAME.json` and `schemas/NAME.bin`.
macro_rules! foxglove {
    ($name:literal) => {
        Self {
            name: Cow::Borrowed(concat!("foxglove.", $name)),
            json: Cow::Borrowed(include_str!(concat!("../schemas/", $name, ".json"))),
            protobuf: Cow::Borrowed(include_bytes!(concat!("../schemas/", $name, ".bin"))),
        }
    };
}

impl Schema {
    /// A custom schema.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        json: impl Into<Cow<'static, str>>,
        protobuf: &'static [u8],
    ) -> Self {
        Self {
            name: name.into(),
            json: json.into(),
            protobuf: Cow::Borrowed(protobuf),
        }
    }

    /// Schema of [`FrameTransform`](crate::foxglove::FrameTransform).
    pub const FRAME_TRANSFORM: Self = foxglove!("FrameTransform");

    /// Schema of [`PoseInFrame`](crate::foxglove::PoseInFrame).
    pub const POSE_IN_FRAME: Self = foxglove!("PoseInFrame");

    /// Schema of [`SceneUpdate`](crate::foxglove::SceneUpdate).
    pub const SCENE_UPDATE: Self = foxglove!("SceneUpdate");

    /// Schema of [`Log`](crate::foxglove::Log).
    pub const LOG: Self = foxglove!("Log");

    /// Schema of [`CompressedImage`](crate::foxglove::CompressedImage).
    pub const COMPRESSED_IMAGE: Self = foxglove!("CompressedImage");
}
