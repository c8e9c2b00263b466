#![doc = include_str!("../README.md")]
//!
//! # Where the commit comes from
//! The first of these that is there:
//! 1. The environment variable `COINMC_COMMIT` at build time, for those who build from an archive.
//! 2. `.cargo_vcs_info.json`, which cargo puts into published packages.
//! 3. Git, if these sources are under its control. `-dirty` after the commit means that the
//!    workspace's sources, manifests or `Cargo.lock` differed from it.
//!
//! Without any of them the build is the version alone.

/// This build: `0.1.0 (6487d3b 2026-11-20)`, `0.1.0 (6487d3b-dirty 2026-11-20)` or `0.1.0`.
pub const BUILD: &str = env!("COINMC_BUILD");
