//! The laws of impact that are more than an impulse: their formulas computed independently, their
//! limits, conservation of energy, and the conformance that the engine requires of every law. Seeds
//! are fixed and every tolerance is derived beside it.

mod common;
mod conformance;
mod gaek_sukhov;
mod half_sine;
mod hostile;
mod line_contact;
mod sampling;
