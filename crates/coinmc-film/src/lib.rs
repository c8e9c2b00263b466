#![doc = include_str!("../README.md")]
//!
//! # How it works
//! A camera films a coin that falls, turns and bounces in a vertical plane, and its centre and angle
//! are marked frame by frame in Tracker (Open Source Physics). This crate reads Tracker's exports
//! ([`text`]) and fits the laws of the flat engine to them ([`fit`]): restitution and friction,
//! shared by all drops, with confidence intervals, and an initial state for each drop. Residuals and
//! information criteria show which law describes the drops best ([`compare`]).
//!
//! # Files
//! `text` Tracker's text · `drop` frames · `law` the model · `parameter` fitted parameters · `path`
//! prediction · `flight` the frames before the first impact · `fit` the fit · `compare` ranking of
//! laws · `plot` and `table` residuals · `synthetic` simulated films.

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
    GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, Settings, SettingsError,
};
pub use compare::{Ranked, compare};
pub use drop::{Coordinate, FilmedDrop, Frame, MAX_FRAMES};
pub use fit::{
    Estimated, Fit, FitError, FittedDrop, Loss, MAX_DROPS, Noise, Options, Remark, Residual, fit,
    fit_all,
};
pub use flight::MIN_FLIGHT;
pub use law::Model;
pub use parameter::{Parameter, Shared, parameters};
pub use plot::residuals_svg;
pub use synthetic::Synthetic;
pub use table::residuals_csv;
