//! What the tests of several packages share. Only development dependencies name this package, by
//! path and without a version, so it is absent from everything published.

pub mod study;
