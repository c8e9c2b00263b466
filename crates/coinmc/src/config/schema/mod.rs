//! What a config may say, described once, in the words of [`coinmc_core::schema`]: the walker, its messages, the canonical text and the
//! JSON Schema are all made from this description.

mod fields;
mod json;

pub(super) use coinmc_core::schema::{
    Absent, Bounds, Condition, Fallback, Field, Kind, Rule, TableKind, Whole, Word,
};
pub(super) use fields::{TARGETS, range, root};
pub(super) use json::json_schema;
