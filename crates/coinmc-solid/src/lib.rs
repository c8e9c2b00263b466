#![doc = include_str!("../README.md")]

mod error;
mod infill;
mod marks;
mod mesh;
mod moments;
mod openscad;
mod package;
mod shape;
mod stl;

pub use error::{MassError, MeshError, ShapeError};
pub use infill::{Infill, Mass};
pub use marks::Marks;
pub use mesh::{MAX_TRIANGLES, MIN_CHORD_ERROR_M, Mesh};
pub use moments::Moments;
pub use openscad::write_openscad;
pub use package::write_3mf;
pub use shape::{Edge, MAX_SIZE_M, MIN_PART_M, MIN_SIZE_M, Shape};
pub use stl::write_stl;
