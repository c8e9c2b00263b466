//! The camera beside the robot: photos are taken on a thread of their own, so that the robot is
//! watched meanwhile.

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

/// How the camera is used.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraOptions {
    /// A command of the shell.
    pub command: String,
    /// Where photos go; absolute.
    pub folder: PathBuf,
    /// Where the camera's standard error goes.
    pub log: Option<PathBuf>,
    /// How long a photo, and how long its classification, may take.
    pub timeout: Duration,
}

/// A photo that was asked for.
#[derive(Debug)]
pub struct Taken {
    /// The throw.
    pub id: u32,
    /// Which photo of it.
    pub attempt: u32,
    /// The face and the photo, which is on the disk; or why there is none.
    pub result: Result<(Face, ImageName), CameraError>,
}

/// A camera at work. Dropped, it is ended.
#[derive(Debug)]
pub struct Camera {
    jobs: Sender<(u32, u32)>,
    taken: Receiver<Taken>,
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
                let taken = Taken {
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

    /// Begins a photo.
    pub fn take(&self, id: u32, attempt: u32) {
        // the worker lives as long as this sender
        let _ = self.jobs.send((id, attempt));
    }

    /// A photo that is finished, if there is one within this time.
    pub fn taken(&self, within: Duration) -> Option<Taken> {
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

    /// Takes a photo and reads it. A camera that failed in any way but honestly is ended, and a
    /// fresh one is asked the next time.
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
        let image = child.ask(&take, timeout)?.image(&folder);
        let image = image.map_err(CameraError::Answer)?;
        let path = folder.join(image.as_str());
        sync(&path).map_err(|error| CameraError::Photo {
            name: image.as_str().to_owned(),
            error,
        })?;
        let shown = child.ask(&Request::Classify(path), timeout)?.shown();
        match shown.map_err(CameraError::Answer)? {
            Shown::Face(face) => Ok((face, image)),
            Shown::Nothing => Err(CameraError::NoFace),
        }
    }
}

/// Brings a photo and its name to the disk.
fn sync(path: &PathBuf) -> io::Result<()> {
    // a link could lead out of the folder, and its target is not what would be synced
    if !fs::symlink_metadata(path)?.is_file() {
        return Err(io::Error::other("not a file"));
    }
    File::open(path)?.sync_all()?;
    path.parent()
        .map_or(Ok(()), |folder| File::open(folder)?.sync_all())
}
