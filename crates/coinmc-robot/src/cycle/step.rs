//! What the cycle is told, and what it asks for.

use super::Halt;
use crate::journal::{Digest, Entry, ImageName};
use crate::{Face, Setting};
use coinmc_link::Request;

/// Settings that do not change during a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rules {
    /// Throws planned.
    pub throws: u32,
    /// Number by which the robot knows this experiment, not 0.
    pub experiment: u32,
    /// Greatest spin and greatest angle that are planned.
    pub reach: Setting,
    /// Greatest difference of the measured spin from the one asked for, 1/1000 rev/s.
    pub spin_tolerance_mrev_s: u16,
    /// Greatest difference of the measured angle from the one asked for, 1/100 degree.
    pub angle_tolerance_cdeg: u16,
    /// Photos of one throw without a face before the throw is void.
    pub max_photos: u32,
    /// Consecutive failures of the camera before the user is asked.
    pub max_camera_failures: u32,
    /// Consecutive void throws before the user is asked.
    pub max_voids: u32,
    /// If the robot's counter is ahead of the journal, or the robot does not know the experiment, take
    /// the robot over as it is.
    pub adopt: bool,
}

/// What to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Send this request to the robot now.
    Request(Request),
    /// Nothing to do: request the status after the polling interval.
    Wait,
    /// Announce throw number `throw` of the plan under this id: `I`.
    Announce {
        /// Number in the plan, from 0.
        throw: u32,
        /// Number on the link.
        id: u32,
    },
    /// Write this entry.
    Write(Entry),
    /// Photograph the coin of this throw; the attempts count from 1.
    Photograph {
        /// The throw.
        id: u32,
        /// Number of the photo of this throw.
        attempt: u32,
    },
    /// All throws are resolved, or the cycle was stopped and no throw is open.
    Finished,
    /// The user must decide.
    Halt(Halt),
}

/// The result of one photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// The throw.
    pub id: u32,
    /// Number of the photo of this throw.
    pub attempt: u32,
    /// What it shows.
    pub shown: Shown,
}

/// What came of a photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Shown {
    /// A face; the photo is synced to disk.
    Face {
        /// The face.
        face: Face,
        /// Name of the photo.
        image: ImageName,
        /// What tells the photo from others.
        digest: Digest,
    },
    /// No face that could be read.
    Nothing,
    /// The camera failed.
    Failure(String),
}
