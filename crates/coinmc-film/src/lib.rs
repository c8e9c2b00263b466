#![doc = include_str!("../README.md")]
//!
//! # How it works
//! A camera sees a coin fall, turn and bounce in a vertical plane; somebody marks its centre and its
//! angle frame by frame in Tracker (Open Source Physics). This crate reads what Tracker exports
//! ([`text`]), and fits the laws of the flat engine to it ([`fit`]): restitution and friction, which
//! all drops share, with intervals that cover, and each drop's own first state; with residuals, and
//! criteria that say which law describes the drops best ([`compare`]).
//!
//! # Files
//! `text` Tracker's text · `drop` frames · `law` the model · `parameter` what is fitted · `path`
//! prediction · `flight`
//! the film before the first impact · `fit` the fit · `compare` several laws · `plot` and `table`
//! residuals · `synthetic` drops filmed in the computer.

mod compare;
mod drop;
mod fit;
mod flight;
mod law;
mod parameter;
mod path;
mod plot;
mod synthetic;
mod table;
pub mod text;

pub use coinmc_flat::{
    GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, SettingsError,
};
pub use compare::{Ranked, compare};
pub use drop::{Coordinate, FilmedDrop, Frame, MAX_FRAMES};
pub use fit::{
    Estimated, Fit, FitError, FittedDrop, Loss, MAX_DROPS, Noise, Options, Remark, Residual, fit,
    fit_all,
};
pub use flight::LEAST_FLIGHT;
pub use law::Model;
pub use parameter::{Parameter, Shared, parameters};
pub use plot::residuals_svg;
pub use synthetic::Synthetic;
pub use table::residuals_csv;
