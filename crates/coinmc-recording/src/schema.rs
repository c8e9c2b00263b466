//! JSON schemas of messages.

use std::borrow::Cow;

/// A named JSON Schema that describes the messages of a channel.
///
/// # Example
/// ```
/// use coinmc_recording::Schema;
/// let schema = Schema::new("my.Reading", r#"{"type": "object"}"#);
/// assert_eq!(schema.name, "my.Reading");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schema {
    /// Name; viewers recognise Foxglove's schemas by it.
    pub name: Cow<'static, str>,
    /// Text of the JSON Schema.
    pub text: Cow<'static, str>,
}

impl Schema {
    /// A custom schema.
    pub fn new(name: impl Into<Cow<'static, str>>, text: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            text: text.into(),
        }
    }

    const fn foxglove(name: &'static str, text: &'static str) -> Self {
        Self {
            name: Cow::Borrowed(name),
            text: Cow::Borrowed(text),
        }
    }

    /// Schema of [`FrameTransform`](crate::foxglove::FrameTransform).
    pub const FRAME_TRANSFORM: Self = Self::foxglove(
        "foxglove.FrameTransform",
        include_str!("../schemas/FrameTransform.json"),
    );

    /// Schema of [`SceneUpdate`](crate::foxglove::SceneUpdate).
    pub const SCENE_UPDATE: Self = Self::foxglove(
        "foxglove.SceneUpdate",
        include_str!("../schemas/SceneUpdate.json"),
    );

    /// Schema of [`Log`](crate::foxglove::Log).
    pub const LOG: Self = Self::foxglove("foxglove.Log", include_str!("../schemas/Log.json"));

    /// Schema of [`CompressedImage`](crate::foxglove::CompressedImage).
    pub const COMPRESSED_IMAGE: Self = Self::foxglove(
        "foxglove.CompressedImage",
        include_str!("../schemas/CompressedImage.json"),
    );
}
