//! Pictures as SVG: elements, and axes with their labels.

mod canvas;
mod scale;

pub(crate) use canvas::{Anchor, Canvas, LINE, escaped};
pub(crate) use scale::Scale;
