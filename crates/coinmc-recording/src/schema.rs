//! Schemas of messages.

use std::borrow::Cow;

/// What the messages of a channel look like: a name and a JSON Schema.
///
/// # Example
/// ```
/// use coinmc_recording::Schema;
/// let schema = Schema::new("my.Reading", r#"{"type": "object"}"#);
/// assert_eq!(schema.name, "my.Reading");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schema {
    /// Its name; viewers know Foxglove's by theirs.
    pub name: Cow<'static, str>,
    /// The JSON Schema's text.
    pub text: Cow<'static, str>,
}

impl Schema {
    /// A schema of one's own.
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

    /// Of [`FrameTransform`](crate::foxglove::FrameTransform).
    pub const FRAME_TRANSFORM: Self = Self::foxglove(
        "foxglove.FrameTransform",
        include_str!("../schemas/FrameTransform.json"),
    );

    /// Of [`SceneUpdate`](crate::foxglove::SceneUpdate).
    pub const SCENE_UPDATE: Self = Self::foxglove(
        "foxglove.SceneUpdate",
        include_str!("../schemas/SceneUpdate.json"),
    );

    /// Of [`Log`](crate::foxglove::Log).
    pub const LOG: Self = Self::foxglove("foxglove.Log", include_str!("../schemas/Log.json"));

    /// Of [`CompressedImage`](crate::foxglove::CompressedImage).
    pub const COMPRESSED_IMAGE: Self = Self::foxglove(
        "foxglove.CompressedImage",
        include_str!("../schemas/CompressedImage.json"),
    );
}
