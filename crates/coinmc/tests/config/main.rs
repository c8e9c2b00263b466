//! Configs: the meaning of valid ones, the errors of invalid ones, and the resolved text.

mod bad;
mod files;
mod lengths;
mod plan;
mod properties;
mod rapier;
mod render;
mod schema;
mod space;
mod support;
mod surface;
