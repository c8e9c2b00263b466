//! The laws of impact, each in a file of its own, and the elastic line contact that two of them use.

pub(crate) mod chatterjee_ruina;
pub(crate) mod gaek_sukhov;
pub(crate) mod half_sine;
pub(crate) mod line_contact;
pub(crate) mod moreau;
pub(crate) mod palmgren;
