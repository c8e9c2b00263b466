//! The camera's thread: photos are taken in the background, while the host keeps polling the robot.

use super::child::{CameraChild, CameraError};
use super::log::Log;
use super::protocol::{Classify, Request, Shown, Take};
use super::roll::Roll;
use crate::Face;
use crate::clock::unix_ms;
use crate::journal::{Digest, ImageName};
use std::collections::HashSet;
use std::fmt;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::Duration;

/// First and longest pause before a camera that failed is started again; each doubles the last.
const FIRST_PAUSE: Duration = Duration::from_millis(100);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// Options of the camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraOptions {
    /// A shell command.
    pub command: String,
    /// Folder for photos; absolute.
    pub folder: PathBuf,
    /// File for the camera's standard error.
    pub log: Option<PathBuf>,
    /// Time limit of a photo and of its classification.
    pub timeout: Duration,
    /// Pictures seen before this session.
    pub seen: HashSet<Digest>,
}

/// Why a photo failed, and what the camera last said on its standard error.
#[derive(Debug)]
pub struct CameraFailure {
    /// The error.
    pub error: CameraError,
    /// The end of its log; empty if it said nothing.
    pub said: String,
}

impl fmt::Display for CameraFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.error)?;
        if self.said.is_empty() {
            return Ok(());
        }
        write!(f, "; it last said: {}", self.said)
    }
}

impl std::error::Error for CameraFailure {}

/// The result of a requested photo.
#[derive(Debug)]
pub struct PhotoResult {
    /// The throw.
    pub id: u32,
    /// Number of the photo of this throw.
    pub attempt: u32,
    /// The face and the photo, which is on disk; or why there is none.
    pub result: Result<(Face, ImageName, Digest), CameraFailure>,
}

/// A running camera, which ends when dropped.
#[derive(Debug)]
pub struct Camera {
    jobs: Sender<(u32, u32)>,
    taken: Receiver<PhotoResult>,
}

impl Camera {
    /// Starts the camera program and takes a test photo, so that a camera that does not work costs no
    /// throw.
    ///
    /// # Errors
    /// [`CameraFailure`]
    pub fn start(options: CameraOptions) -> Result<Self, CameraFailure> {
        let early = |error| CameraFailure {
            error: CameraError::Start(error),
            said: String::new(),
        };
        let log = Log::open(options.log.clone()).map_err(early)?;
        let roll = Roll::open(&options.folder, options.seen.clone()).map_err(early)?;
        let mut worker = Worker {
            options,
            log,
            roll,
            child: None,
            request: 0,
            pause: Duration::ZERO,
        };
        worker.test()?;
        let (jobs, wanted) = mpsc::channel::<(u32, u32)>();
        let (done, taken) = mpsc::channel();
        thread::spawn(move || {
            for (id, attempt) in wanted {
                let result = worker.photo(id, attempt);
                let taken = PhotoResult {
                    id,
                    attempt,
                    result,
                };
                if done.send(taken).is_err() {
                    return;
                }
            }
        });
        Ok(Self { jobs, taken })
    }

    /// Starts taking a photo.
    pub fn take(&self, id: u32, attempt: u32) {
        // the worker lives as long as this sender
        let _ = self.jobs.send((id, attempt));
    }

    /// A finished photo, if there is one within this time.
    pub fn finished_photo(&self, within: Duration) -> Option<PhotoResult> {
        self.taken.recv_timeout(within).ok()
    }
}

struct Worker {
    options: CameraOptions,
    log: Log,
    roll: Roll,
    child: Option<CameraChild>,
    /// Number of the last request.
    request: u32,
    /// Before the camera is started again.
    pause: Duration,
}

impl Worker {
    /// A photo before the first throw, whatever it shows.
    fn test(&mut self) -> Result<(), CameraFailure> {
        let name = self.roll.name("test", 1);
        match self.try_photo(0, 1, &name) {
            Ok(_) | Err(CameraError::NoFace) => Ok(()),
            Err(error) => Err(self.failure(error)),
        }
    }

    /// Takes and classifies a photo. After any failure other than a photo without a face, the camera is
    /// ended and started again for the next photo.
    fn photo(&mut self, id: u32, attempt: u32) -> Result<(Face, ImageName, Digest), CameraFailure> {
        let name = self.roll.name(&format!("{id:06}"), attempt);
        let result = self.try_photo(id, attempt, &name);
        self.pause = match result {
            Ok(_) | Err(CameraError::NoFace) => Duration::ZERO,
            Err(_) => (self.pause * 2).clamp(FIRST_PAUSE, LONGEST_PAUSE),
        };
        result.map_err(|error| self.failure(error))
    }

    fn failure(&mut self, error: CameraError) -> CameraFailure {
        if !matches!(error, CameraError::NoFace) && self.child.take().is_some() {
            // what it said last may still be on its way
            thread::sleep(Duration::from_millis(20));
        }
        let said = match error {
            CameraError::NoFace => String::new(),
            _ => self.log.last_words(),
        };
        CameraFailure { error, said }
    }

    fn try_photo(
        &mut self,
        throw_id: u32,
        attempt: u32,
        name: &str,
    ) -> Result<(Face, ImageName, Digest), CameraError> {
        let (folder, timeout) = (self.options.folder.clone(), self.options.timeout);
        if self.child.is_none() {
            thread::sleep(self.pause);
            self.child = Some(CameraChild::start(&self.options.command, &self.log)?);
        }
        let child = self.child.as_mut().ok_or(CameraError::Ended)?;
        self.request = self.request.wrapping_add(2);
        let (first, second) = (self.request.wrapping_sub(1), self.request);
        let asked_ms = unix_ms();
        let take = Take {
            throw_id,
            attempt,
            request: first,
            folder: folder.clone(),
            name: name.to_owned(),
        };
        let reply = child.request(&Request::Take { take }, timeout)?;
        let image = reply
            .check_time(asked_ms, unix_ms())
            .and_then(|()| reply.image(&folder, name))
            .map_err(CameraError::CameraReply)?;
        let digest = self.roll.add(&image).map_err(|error| CameraError::Photo {
            name: image.as_str().to_owned(),
            error,
        })?;
        let classify = Request::Classify(Classify {
            classify: folder.join(image.as_str()),
            throw_id,
            attempt,
            request: second,
        });
        let shown = child.request(&classify, timeout)?.shown();
        match shown.map_err(CameraError::CameraReply)? {
            Shown::Face(face) => Ok((face, image, digest)),
            Shown::Nothing => Err(CameraError::NoFace),
        }
    }
}
