//! Empty: what counts is this package's Cargo.toml.
//!
//! Cargo compiles a dependency once for every set of features that a build asks of it, and then
//! everything that depends on it. The program, the Python wheel and the tests ask for different sets.
//! Built together with this package they ask for the same, so they share what they compile: without
//! it the tests take minutes longer. No published package depends on it.
