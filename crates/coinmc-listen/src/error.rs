//! Why a recording says nothing.

use crate::files::MOST_FILES;
use crate::struck::StruckError;
use coinmc_calibrate::CalibrationError;
use coinmc_questions::QuestionError;
use std::io;
use thiserror::Error;

/// Why a file cannot be read as a recording.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    Io(io::Error),
    /// It is no WAV file.
    #[error(
        "this is not a WAV file ({0}): save the recording as WAV, or convert it with `ffmpeg -i FILE recording.wav`"
    )]
    NotWav(&'static str),
    /// Its samples are of a kind that is not read.
    #[error(
        "this kind of WAV file is not read: whole numbers of 8, 16, 24 or 32 bits, or floats of 32 or 64, without compression"
    )]
    Unsupported,
    /// It ends early.
    #[error("the file is cut off: it has {found} of the {promised} samples that it promises")]
    CutOff {
        /// Samples found.
        found: u64,
        /// Samples promised.
        promised: u64,
    },
    /// There is no sound in it.
    #[error("the file holds no samples")]
    Empty,
    /// Too long.
    #[error(
        "the recording has {found} samples in each channel, but at most {most} are read: cut out the part with the coin"
    )]
    TooLong {
        /// Samples of a channel.
        found: u64,
        /// The most.
        most: u64,
    },
    /// Too long, and not said how long.
    #[error(
        "the recording has more than the {most} samples in each channel that are read, and its header does not say how \
         many: cut out the part with the coin"
    )]
    Endless {
        /// The most.
        most: u64,
    },
    /// A rate at which a coin cannot be heard well enough.
    #[error("the recording has {0} samples a second, but from 8000 to 384000 are read")]
    Rate(u32),
    /// A float that is no number.
    #[error("sample {0} is not a finite number")]
    NotFinite(u64),
    /// A float far beyond the full scale.
    #[error(
        "sample {place} is {level:.1e}, but the full scale of floats in a WAV file is 1: scale the recording"
    )]
    BeyondScale {
        /// Which sample, from 0.
        place: u64,
        /// Its value.
        level: f64,
    },
    /// Shorter than any bounce.
    #[error("the recording is only {0:.3} s long: 0.1 s are the least")]
    TooShort(f64),
}

/// Why nothing is known of the surface.
#[derive(Debug, Error)]
pub enum ListenError {
    /// The scene makes no tosses that can be heard.
    #[error(transparent)]
    Struck(#[from] StruckError),
    /// The config has problems.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// Tosses cannot be made, or were stopped.
    #[error(transparent)]
    Question(#[from] QuestionError),
    /// More files than can be heard together.
    #[error("{0} recordings were given, but at most {MOST_FILES} can be heard together")]
    TooManyFiles(usize),
    /// What is wrong with each of some files.
    #[error("{}", .0.join("\n"))]
    Files(Vec<String>),
    /// The engine in use knows no friction lengths.
    #[error("drops are compared with tosses in space: use [engine.volumetric]")]
    NotSpatial,
}
