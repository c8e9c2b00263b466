//! In double precision.

use rapier3d_f64 as rapier;

#[path = "stage.rs"]
mod stage;
pub(crate) use stage::Stage;
