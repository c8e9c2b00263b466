//! Messages that MCAP viewers draw, after Foxglove's schemas (in this crate's `schemas/`).
//!
//! Lengths are in metres, angles in radians, colours from 0 to 1.

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::Serialize;

/// A point in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize)]
pub struct Time {
    /// Whole seconds.
    pub sec: u64,
    /// Nanoseconds after the whole second.
    pub nsec: u32,
}

impl Time {
    /// From nanoseconds since the epoch.
    ///
    /// # Example
    /// ```
    /// use coinmc_recording::foxglove::Time;
    /// assert_eq!(Time::from_ns(1_500_000_000), Time { sec: 1, nsec: 500_000_000 });
    /// ```
    pub fn from_ns(ns: u64) -> Self {
        // the remainder is below 2^30
        #[allow(clippy::cast_possible_truncation)]
        let nsec = (ns % 1_000_000_000) as u32;
        Self {
            sec: ns / 1_000_000_000,
            nsec,
        }
    }
}

/// A vector or a point.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[allow(missing_docs)] // components
pub struct Vector3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

impl Vector3 {
    /// From its components.
    pub fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }
}

/// A rotation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(missing_docs)] // components
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self {
        x: 0.0,
        y: 0.0,
        z: 0.0,
        w: 1.0,
    };
}

/// A position and an orientation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pose {
    /// Position.
    pub position: Vector3,
    /// Orientation.
    pub orientation: Quaternion,
}

impl Pose {
    /// At a position, without rotation.
    pub fn at(position: Vector3) -> Self {
        Self {
            position,
            orientation: Quaternion::IDENTITY,
        }
    }
}

/// A colour.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(missing_docs)] // red, green, blue, opacity
pub struct Color {
    pub r: f64,
    pub g: f64,
    pub b: f64,
    pub a: f64,
}

impl Color {
    /// From red, green, blue and opacity, each from 0 to 1.
    pub fn new([r, g, b, a]: [f64; 4]) -> Self {
        Self { r, g, b, a }
    }
}

/// Position and orientation of a frame of reference in another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameTransform {
    /// Time.
    pub timestamp: Time,
    /// The parent frame.
    pub parent_frame_id: String,
    /// The child frame.
    pub child_frame_id: String,
    /// Origin of the child frame in the parent frame.
    pub translation: Vector3,
    /// Orientation of the child frame in the parent frame.
    pub rotation: Quaternion,
}

/// Position and orientation of a body in a frame of reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PoseInFrame {
    /// Time.
    pub timestamp: Time,
    /// The frame of reference.
    pub frame_id: String,
    /// Position and orientation in it.
    pub pose: Pose,
}

/// Entities to add to or remove from the drawn scene.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SceneUpdate {
    /// Entities to remove.
    pub deletions: Vec<SceneEntityDeletion>,
    /// Entities to add or replace.
    pub entities: Vec<SceneEntity>,
}

/// Which entities to remove.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneEntityDeletion {
    /// Time; only older entities are removed.
    pub timestamp: Time,
    /// 0: the entity with this id; 1: all.
    pub r#type: u8,
    /// Id of the entity.
    pub id: String,
}

/// An object made of shapes in one frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneEntity {
    /// Time it appears.
    pub timestamp: Time,
    /// Frame of reference.
    pub frame_id: String,
    /// Id: an entity with the same id is replaced.
    pub id: String,
    /// How long it is shown; zero forever.
    pub lifetime: Time,
    /// Whether it moves with its frame.
    pub frame_locked: bool,
    /// Named values.
    pub metadata: Vec<KeyValuePair>,
    /// Cuboids.
    pub cubes: Vec<CubePrimitive>,
    /// Ellipsoids.
    pub spheres: Vec<SpherePrimitive>,
    /// Cylinders and cones.
    pub cylinders: Vec<CylinderPrimitive>,
    /// Text labels.
    pub texts: Vec<TextPrimitive>,
    arrows: [(); 0],
    lines: [(); 0],
    triangles: [(); 0],
    models: [(); 0],
}

impl SceneEntity {
    /// An entity without shapes.
    pub fn new(timestamp: Time, frame_id: &str, id: impl Into<String>) -> Self {
        Self {
            timestamp,
            frame_id: frame_id.to_owned(),
            id: id.into(),
            lifetime: Time::default(),
            frame_locked: true,
            metadata: Vec::new(),
            cubes: Vec::new(),
            spheres: Vec::new(),
            cylinders: Vec::new(),
            texts: Vec::new(),
            arrows: [],
            lines: [],
            triangles: [],
            models: [],
        }
    }
}

/// A named value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct KeyValuePair {
    /// Name.
    pub key: String,
    /// Value.
    pub value: String,
}

/// A cuboid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CubePrimitive {
    /// Its centre.
    pub pose: Pose,
    /// Its edges.
    pub size: Vector3,
    /// Its colour.
    pub color: Color,
}

/// An ellipsoid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpherePrimitive {
    /// Its centre.
    pub pose: Pose,
    /// Its diameters.
    pub size: Vector3,
    /// Its colour.
    pub color: Color,
}

/// A cylinder about its z axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CylinderPrimitive {
    /// Its centre.
    pub pose: Pose,
    /// Diameters along x and y, height along z.
    pub size: Vector3,
    /// Diameter of the lower face as a fraction of that in `size`, 0 to 1.
    pub bottom_scale: f64,
    /// The same for the upper face.
    pub top_scale: f64,
    /// Its colour.
    pub color: Color,
}

/// A text label.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TextPrimitive {
    /// Its centre; +x is along the text.
    pub pose: Pose,
    /// Whether it always faces the viewer.
    pub billboard: bool,
    /// Height of its letters, m.
    pub font_size: f64,
    /// Whether the height is fixed on the screen.
    pub scale_invariant: bool,
    /// Its colour.
    pub color: Color,
    /// The text.
    pub text: String,
}

/// Severity of a [`Log`] message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // the usual levels
pub enum LogLevel {
    Debug,
    Info,
    Warning,
    Error,
    Fatal,
}

impl Serialize for LogLevel {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(match self {
            Self::Debug => 1,
            Self::Info => 2,
            Self::Warning => 3,
            Self::Error => 4,
            Self::Fatal => 5,
        })
    }
}

/// A log message.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Log {
    /// Time.
    pub timestamp: Time,
    /// Severity.
    pub level: LogLevel,
    /// Text.
    pub message: String,
    /// Name of the program or part of it that logs.
    pub name: String,
    /// Source file; may be empty.
    pub file: String,
    /// Line of the source file; may be 0.
    pub line: u32,
}

/// An image in a compressed file format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CompressedImage {
    /// Time it was taken.
    pub timestamp: Time,
    /// The camera's frame of reference.
    pub frame_id: String,
    /// Bytes of the image file.
    pub data: Vec<u8>,
    /// `jpeg`, `png`, `webp` or `avif`.
    pub format: String,
}

impl Serialize for CompressedImage {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut fields = serializer.serialize_struct("CompressedImage", 4)?;
        fields.serialize_field("timestamp", &self.timestamp)?;
        fields.serialize_field("frame_id", &self.frame_id)?;
        fields.serialize_field("data", &BASE64.encode(&self.data))?;
        fields.serialize_field("format", &self.format)?;
        fields.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entity_has_every_list_the_schema_requires() {
        let entity = SceneEntity::new(Time::default(), "world", "a");
        let json = serde_json::to_value(&entity).unwrap();
        for list in ["arrows", "lines", "triangles", "models", "cubes"] {
            assert_eq!(json[list], serde_json::json!([]), "{list}");
        }
    }
}
