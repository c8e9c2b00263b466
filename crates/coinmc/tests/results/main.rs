//! Results: their intervals, the fair ratio, their table.

mod fair;
mod half_width;
#[path = "../run/support.rs"]
mod support;
mod table;
