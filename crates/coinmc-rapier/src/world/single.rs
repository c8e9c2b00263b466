//! In single precision.

use rapier3d as rapier;

#[path = "stage.rs"]
mod stage;
pub(crate) use stage::Stage;
