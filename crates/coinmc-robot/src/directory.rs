//! The directory of an experiment.
//!
//! ```text
//! DIR/
//!   experiment.toml     the config as understood
//!   setup.json          port and camera, for `resume`
//!   journal.txt         the source of truth; see `journal`
//!   photos/             one file per photo
//!   sessions/           recordings (MCAP), one or more per session
//!   camera.log          standard error of the camera program, at most 1 MiB; before that: camera.log.1
//!   host.pid            process of the last session, for `stop`
//! ```

use crate::Experiment;
use crate::clock::unix_ms;
use crate::files::{make_folder, read_text, replace_file};
use crate::journal::{Header, History, Journal, JournalError};
use coinmc::config;
use rustix::process::{Pid, Signal, kill_process};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

const CONFIG: &str = "experiment.toml";
const SETUP: &str = "setup.json";
const JOURNAL: &str = "journal.txt";
const PHOTOS: &str = "photos";
const SESSIONS: &str = "sessions";
const CAMERA_LOG: &str = "camera.log";
const HOST: &str = "host.pid";

/// Greatest length of the setup file, bytes.
const SETUP_BYTES: u64 = 1 << 16;
/// Greatest length of the file with the process, bytes.
const HOST_BYTES: u64 = 32;

/// Robot and camera of an experiment, which `resume` needs in addition to the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// The serial port, by its stable name.
    pub port: PathBuf,
    /// The camera: a shell command.
    pub camera: String,
    /// Speed of a simulated robot relative to real time; 1 for a real robot.
    pub speed: f64,
}

/// An experiment's directory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Directory {
    path: PathBuf,
}

/// Why a directory cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DirectoryError {
    /// It contains something else.
    #[error("{} contains {found} but no {JOURNAL}: it is not an experiment. Give a new directory", path.display())]
    NotAnExperiment {
        /// The directory.
        path: PathBuf,
        /// The first unexpected file.
        found: String,
    },
    /// There is no experiment.
    #[error("{} contains no experiment: `coinmc robot run CONFIG --out DIR` starts one", .0.display())]
    Missing(PathBuf),
    /// Its saved config cannot be read.
    #[error("{} is damaged: {problem}. Give the config again: `coinmc robot run CONFIG --out DIR`", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// The journal.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A system error.
    #[error("cannot {action} {}: {error}", path.display())]
    Io {
        /// The failed action.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
}

impl Directory {
    /// The directory at a path; nothing is read yet.
    pub fn at(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Folder of the photos.
    pub fn photos(&self) -> PathBuf {
        self.path.join(PHOTOS)
    }

    /// Folder of the recordings.
    pub fn sessions(&self) -> PathBuf {
        self.path.join(SESSIONS)
    }

    /// File for the camera's standard error.
    pub fn camera_log(&self) -> PathBuf {
        self.path.join(CAMERA_LOG)
    }

    /// Path of the journal.
    pub fn journal(&self) -> PathBuf {
        self.path.join(JOURNAL)
    }

    /// The first line of a new journal of this experiment.
    pub fn header(experiment: &Experiment) -> Header {
        let plan_hash = experiment.plan().hash();
        // two journals of one plan must not be taken for each other by a robot
        let unique = format!("{plan_hash} {} {}", unix_ms(), std::process::id());
        Header {
            plan_hash,
            throws: experiment.throws(),
            experiment: crc32fast::hash(unique.as_bytes()).max(1),
        }
    }

    /// Notes this process as the one that runs the experiment.
    ///
    /// # Errors
    /// System errors.
    pub fn note_host(&self) -> Result<(), DirectoryError> {
        self.write(HOST, format!("{}\n", std::process::id()).as_bytes())
    }

    /// Interrupts the process that runs the experiment, like Ctrl-C.
    ///
    /// # Errors
    /// System errors; [`io::ErrorKind::NotFound`] if the process that is named is none of this program.
    pub fn interrupt_host(&self, process: u32) -> io::Result<()> {
        let name = fs::read_to_string(format!("/proc/{process}/comm"));
        let other = name.is_ok_and(|name| !name.starts_with("coinmc"));
        let pid = i32::try_from(process).ok().and_then(Pid::from_raw);
        let pid = pid.filter(|_| !other).ok_or(io::ErrorKind::NotFound)?;
        Ok(kill_process(pid, Signal::INT)?)
    }

    /// The process that runs the experiment, if one does.
    pub fn host(&self) -> Option<u32> {
        let process = read_text(&self.path.join(HOST), HOST_BYTES).ok()?;
        let process = process.trim().parse().ok()?;
        Journal::is_in_use(&self.journal()).then_some(process)
    }

    /// Starts an experiment here or continues it, and saves port and camera for the next session.
    /// Also returns the number of bytes of an incomplete last line that were removed from the
    /// journal.
    ///
    /// # Errors
    /// [`DirectoryError`] if the directory contains something else or is in use.
    pub fn open(
        &self,
        experiment: &Experiment,
        setup: &Setup,
    ) -> Result<(Journal, usize), DirectoryError> {
        let header = Self::header(experiment);
        let journal = self.journal();
        if journal.exists() {
            self.make_folders()?;
            let opened = Journal::open(&journal, &header)?;
            self.save_setup(setup)?;
            return Ok(opened);
        }
        self.check_free()?;
        self.make_folders()?;
        self.write(CONFIG, experiment.plan().resolved_toml.as_bytes())?;
        // before the journal, so that every directory with a journal can be resumed
        self.save_setup(setup)?;
        Ok((Journal::create(&journal, &header)?, 0))
    }

    fn make_folders(&self) -> Result<(), DirectoryError> {
        fs::create_dir_all(&self.path).map_err(|e| io_error("create", &self.path, e))?;
        for folder in [self.photos(), self.sessions()] {
            make_folder(&folder).map_err(|e| io_error("use", &folder, e))?;
        }
        Ok(())
    }

    /// The experiment in this directory.
    ///
    /// # Errors
    /// [`DirectoryError`] if there is none or its saved config cannot be read.
    pub fn experiment(&self) -> Result<Experiment, DirectoryError> {
        let path = self.path.join(CONFIG);
        if !path.exists() {
            return Err(DirectoryError::Missing(self.path.clone()));
        }
        // anything else, such as a named pipe, is not opened
        if !path.is_file() {
            return Err(io_error(
                "read",
                &path,
                io::Error::other("it is not a regular file"),
            ));
        }
        let damaged = |problem: String| DirectoryError::Damaged {
            path: path.clone(),
            problem,
        };
        let plan = config::load(&path, &[]).map_err(|problems| damaged(problems.to_string()))?;
        Experiment::new(plan).map_err(|problems| damaged(problems.to_string()))
    }

    /// The experiment in this directory and its journal, which is only read: the experiment can
    /// continue meanwhile.
    ///
    /// # Errors
    /// [`DirectoryError`] if there is none, a file is damaged, or the journal is another's.
    pub fn read(&self) -> Result<(Experiment, History), DirectoryError> {
        let experiment = self.experiment()?;
        let path = self.journal();
        let (theirs, history) = Journal::read(&path)?;
        let ours = Self::header(&experiment);
        if !theirs.is_same_plan(&ours) {
            return Err(JournalError::OtherExperiment { path, theirs, ours }.into());
        }
        Ok((experiment, history))
    }

    /// Port and camera of the last session, if they can be read.
    pub fn setup(&self) -> Option<Setup> {
        let text = read_text(&self.path.join(SETUP), SETUP_BYTES).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Saves port and camera.
    fn save_setup(&self, setup: &Setup) -> Result<(), DirectoryError> {
        let mut text = serde_json::to_string_pretty(setup)
            .map_err(|e| io_error("write", &self.path.join(SETUP), e.into()))?;
        text.push('\n');
        self.write(SETUP, text.as_bytes())
    }

    /// Checks that the directory is absent, empty, or contains only what a crash at the start
    /// leaves.
    fn check_free(&self) -> Result<(), DirectoryError> {
        let entries = match fs::read_dir(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(|e| io_error("list", &self.path, e))?,
        };
        for entry in entries {
            let name = entry
                .map_err(|e| io_error("list", &self.path, e))?
                .file_name();
            let ours = [CONFIG, SETUP, PHOTOS, SESSIONS];
            let left = |name: &str, our: &str| {
                name.strip_prefix(our).is_some_and(|rest| {
                    rest.starts_with('.') && rest.strip_suffix(".tmp").is_some()
                })
            };
            let is_ours = |name: &str| ours.iter().any(|our| name == *our || left(name, our));
            if !name.to_str().is_some_and(is_ours) {
                return Err(DirectoryError::NotAnExperiment {
                    path: self.path.clone(),
                    found: name.display().to_string(),
                });
            }
        }
        Ok(())
    }

    /// Writes a file atomically.
    fn write(&self, name: &str, content: &[u8]) -> Result<(), DirectoryError> {
        let place = self.path.join(name);
        replace_file(&place, |to| to.write_all(content)).map_err(|e| io_error("write", &place, e))
    }
}

fn io_error(action: &'static str, path: &Path, error: io::Error) -> DirectoryError {
    DirectoryError::Io {
        action,
        path: path.to_owned(),
        error,
    }
}
