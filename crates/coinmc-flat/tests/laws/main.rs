//! The laws of impact that are more than an impulse: against their formulas worked out by hand,
//! their limits, the conservation of energy, and the conformance every law owes the engine. Seeds
//! are fixed and every tolerance is derived where it stands.

mod common;
mod conformance;
mod gaek_sukhov;
mod half_sine;
mod hostile;
mod line_contact;
mod sampling;
