//! What can go wrong.

use coinmc_questions::QuestionError;
use thiserror::Error;

/// Why there is no answer.
#[derive(Debug, Error)]
pub enum AtlasError {
    /// No such launch.
    #[error("the atlas has no launch `{name}`: it has {known}")]
    NoLaunch {
        /// What was asked for.
        name: String,
        /// Those it has.
        known: String,
    },
    /// Numbers beyond the atlas.
    #[error("{}", .0.join("\n"))]
    Outside(
        /// A sentence for each.
        Vec<String>,
    ),
    /// A key that it does not vary.
    #[error(
        "the atlas has no `{0}`: it knows restitution, friction, rolling_friction_m, pivoting_friction_m (or \
         either as …_over_radius), contact_patch_m, roughness_slope and roughness_wavelength_m"
    )]
    Key(String),
    /// The material is none.
    #[error(transparent)]
    Material(#[from] coinmc_core::EngineError),
    /// Tosses failed.
    #[error(transparent)]
    Tosses(#[from] QuestionError),
}

/// Why networks cannot be fitted to results.
#[derive(Debug, Error)]
pub enum FitError {
    /// A config that has no Sobol' points.
    #[error("the config must have a sweep of mode \"sobol\" over ranges: {0}")]
    NotADesign(String),
    /// Too few points.
    #[error("{0} points with tosses that showed a face are too few: at least 1000 are needed")]
    TooFew(usize),
}

/// Why a file of networks is none.
#[derive(Debug, Error)]
pub enum FileError {
    /// The first line is not what it should be.
    #[error("the first line does not describe networks: {0}")]
    Header(#[from] serde_json::Error),
    /// A version that this program does not know.
    #[error("version {0} of the format is not known")]
    Version(u32),
    /// Sizes that no network has.
    #[error("networks of these sizes cannot be")]
    Sizes,
    /// Axes that are not the numbers of a place, in their order.
    #[error("its axes are not ratio, restitution and so on, as the atlas has them")]
    Axes,
    /// The file ends too early.
    #[error("the file ends too early")]
    Short,
    /// Something follows the numbers.
    #[error("something follows the last number")]
    Long,
    /// A number is infinite or NaN.
    #[error("a number is not finite")]
    NotFinite,
}
