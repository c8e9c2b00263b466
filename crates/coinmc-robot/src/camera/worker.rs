//! The camera's thread: photos are taken in the background, while the host keeps polling the robot.

use super::child::{CameraChild, CameraError};
use super::protocol::{Request, Shown, Take};
use crate::Face;
use crate::journal::ImageName;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::Duration;

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
}

/// The result of a requested photo.
#[derive(Debug)]
pub struct PhotoResult {
    /// The throw.
    pub id: u32,
    /// Number of the photo of this throw.
    pub attempt: u32,
    /// The face and the photo, which is on disk; or why there is none.
    pub result: Result<(Face, ImageName), CameraError>,
}

/// A running camera, which ends when dropped.
#[derive(Debug)]
pub struct Camera {
    jobs: Sender<(u32, u32)>,
    taken: Receiver<PhotoResult>,
}

impl Camera {
    /// Starts the camera program.
    ///
    /// # Errors
    /// [`CameraError::Start`] if there is no shell.
    pub fn start(options: CameraOptions) -> Result<Self, CameraError> {
        let mut worker = Worker {
            options,
            child: None,
        };
        worker.start()?;
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
    child: Option<CameraChild>,
}

impl Worker {
    fn start(&mut self) -> Result<&mut CameraChild, CameraError> {
        let log = self.options.log.as_ref();
        let log = log
            .map(|path| OpenOptions::new().create(true).append(true).open(path))
            .transpose()
            .map_err(CameraError::Start)?;
        let child = CameraChild::start(&self.options.command, log)?;
        Ok(self.child.insert(child))
    }

    /// Takes and classifies a photo. After any failure other than one that the camera reports
    /// itself, the camera is ended and started again for the next photo.
    fn photo(&mut self, id: u32, attempt: u32) -> Result<(Face, ImageName), CameraError> {
        let result = self.try_photo(id, attempt);
        if !matches!(result, Ok(_) | Err(CameraError::NoFace)) {
            self.child = None;
        }
        result
    }

    fn try_photo(&mut self, id: u32, attempt: u32) -> Result<(Face, ImageName), CameraError> {
        let (folder, timeout) = (self.options.folder.clone(), self.options.timeout);
        let child = match &mut self.child {
            Some(child) => child,
            None => self.start()?,
        };
        let take = Request::Take(Take {
            throw_id: id,
            attempt,
            folder: folder.clone(),
            name: format!("{id:06}-{attempt}"),
        });
        let image = child.request(&take, timeout)?.image(&folder);
        let image = image.map_err(CameraError::CameraReply)?;
        let path = folder.join(image.as_str());
        sync(&path).map_err(|error| CameraError::Photo {
            name: image.as_str().to_owned(),
            error,
        })?;
        let shown = child.request(&Request::Classify(path), timeout)?.shown();
        match shown.map_err(CameraError::CameraReply)? {
            Shown::Face(face) => Ok((face, image)),
            Shown::Nothing => Err(CameraError::NoFace),
        }
    }
}

/// Syncs a photo and its directory entry to disk.
fn sync(path: &PathBuf) -> io::Result<()> {
    // a symbolic link could lead out of the folder, and its target would not be synced
    if !fs::symlink_metadata(path)?.is_file() {
        return Err(io::Error::other("not a file"));
    }
    File::open(path)?.sync_all()?;
    path.parent()
        .map_or(Ok(()), |folder| File::open(folder)?.sync_all())
}
