//! Why a shape cannot be made, meshed or weighed.

use thiserror::Error;

/// A measure of a coin lies outside what can be made.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// The diameter or the thickness is outside 0.1 mm to 1 m.
    #[error("{what} must be from {least} m to {most} m, not {found} m")]
    Size {
        /// Diameter or thickness.
        what: &'static str,
        /// What was asked for, m.
        found: f64,
        /// The smallest, m.
        least: f64,
        /// The greatest, m.
        most: f64,
    },
    /// The rounding or chamfer is too small to be made, or leaves no side or no faces.
    #[error("the edge must take from {least} m to {most} m of this coin, not {found} m")]
    Edge {
        /// Radius of the rounding or size of the chamfer, m.
        found: f64,
        /// The smallest, m.
        least: f64,
        /// The greatest for this diameter and thickness, m.
        most: f64,
    },
    /// The angle of a conical edge takes too little to be made, or leaves no narrower face.
    #[error(
        "the draft of this coin must be from {least:.3}° to {most:.3}° to either side, or 0, not {found}°"
    )]
    Draft {
        /// What was asked for, degrees.
        found: f64,
        /// The smallest, degrees.
        least: f64,
        /// The greatest for this diameter and thickness, degrees.
        most: f64,
    },
    /// A conical edge with rounded or chamfered rims.
    #[error("a coin with a conical edge has sharp rims, neither rounded nor chamfered ones")]
    DraftedEdge,
    /// Marks on a coin with a conical edge.
    #[error(
        "a coin with a conical edge has no marks: its faces differ in width, and marks would move its \
         centre of mass"
    )]
    DraftedMarks,
    /// The marks are too shallow to be made, or too deep for the coin.
    #[error("marks must be from {least} m deep to less than {limit} m, not {found} m")]
    MarkDepth {
        /// What was asked for, m.
        found: f64,
        /// The smallest depth, m.
        least: f64,
        /// A quarter of the thickness, m.
        limit: f64,
    },
    /// The marks' radii are out of order, too near each other, or off the flat face.
    #[error(
        "marks between the radii {inner} m and {outer} m do not fit a flat face of radius {face} m: \
         each step outwards must be at least {least} m"
    )]
    MarkRadii {
        /// Inner radius, m.
        inner: f64,
        /// Outer radius, m.
        outer: f64,
        /// Radius of the flat part of the face, m.
        face: f64,
        /// The smallest step from the axis to the inner radius, the outer one, and the face's, m.
        least: f64,
    },
}

/// A mesh of the wanted fineness cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The chord error is not a length that a mesh can have.
    #[error("the chord error must be finite and at least {least} m, not {found} m")]
    ChordError {
        /// What was asked for, m.
        found: f64,
        /// The smallest, m.
        least: f64,
    },
    /// The mesh would have too many triangles.
    #[error(
        "a mesh this fine has {triangles} triangles, more than {most}: allow a greater chord error"
    )]
    TooFine {
        /// How many it would have.
        triangles: u64,
        /// How many it may have.
        most: u64,
    },
}

/// The mass of a print cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum MassError {
    /// The density is not positive and finite.
    #[error("density must be positive and finite, not {0} kg/m³")]
    Density(f64),
    /// The fraction is not from 0 to 1.
    #[error("the infill's fraction must be from 0 to 1, not {0}")]
    Fraction(f64),
    /// Infill inside a conical edge.
    #[error(
        "a coin with a conical edge is printed full: infill would move its centre of mass, which is to be \
         that of the uniform solid"
    )]
    DraftedInfill,
    /// The core inside these walls would stick out at the edges or into the marks.
    #[error(
        "walls must be at least {least} m around the edges and marks of this coin, not {found} m"
    )]
    Walls {
        /// What was asked for, m.
        found: f64,
        /// The thinnest walls that hold the core, m.
        least: f64,
    },
}
