//! Coins as solids: meshes against closed forms, the files as other readers see them, and what is refused.

mod common;
mod files;
mod infill;
mod limits;
mod marks;
mod mesh;
mod moments;
mod properties;
