//! Configs: what good ones mean, what bad ones are told, and how they are written down.

mod bad;
mod files;
mod plan;
mod properties;
mod rapier;
mod render;
mod schema;
mod space;
mod support;
