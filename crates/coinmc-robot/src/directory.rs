//! The directory of an experiment.
//!
//! ```text
//! DIR/
//!   experiment.toml     the config as understood
//!   setup.json          port and camera, for `resume`
//!   journal.txt         the source of truth; see `journal`
//!   photos/             one file per photo
//!   sessions/           recordings (MCAP), one or more per session
//!   camera.log          standard error of the camera program
//! ```

use crate::Experiment;
use crate::journal::{Header, History, Journal, JournalError};
use coinmc::config;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const CONFIG: &str = "experiment.toml";
const SETUP: &str = "setup.json";
const JOURNAL: &str = "journal.txt";
const PHOTOS: &str = "photos";
const SESSIONS: &str = "sessions";
const CAMERA_LOG: &str = "camera.log";

/// Greatest length of the setup file, bytes.
const SETUP_BYTES: u64 = 1 << 16;

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

    /// The first line of an experiment's journal.
    pub fn header(experiment: &Experiment) -> Header {
        Header {
            plan_hash: experiment.plan().hash(),
            throws: experiment.throws(),
        }
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
            let opened = Journal::open(&journal, &header)?;
            self.save_setup(setup)?;
            return Ok(opened);
        }
        self.check_free()?;
        for folder in [self.path.clone(), self.photos(), self.sessions()] {
            fs::create_dir_all(&folder).map_err(|e| io_error("create", &folder, e))?;
        }
        self.write(CONFIG, experiment.plan().resolved_toml.as_bytes())?;
        // before the journal, so that every directory with a journal can be resumed
        self.save_setup(setup)?;
        Ok((Journal::create(&journal, &header)?, 0))
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
        if theirs != ours {
            return Err(JournalError::OtherExperiment { path, theirs, ours }.into());
        }
        Ok((experiment, history))
    }

    /// Port and camera of the last session, if they can be read.
    pub fn setup(&self) -> Option<Setup> {
        let mut text = String::new();
        let file = File::open(self.path.join(SETUP)).ok()?;
        file.take(SETUP_BYTES).read_to_string(&mut text).ok()?;
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
            let is_ours = |name: &str| ours.contains(&name.strip_suffix(".tmp").unwrap_or(name));
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
        let (place, next) = (self.path.join(name), self.path.join(format!("{name}.tmp")));
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(true);
        let written = options.open(&next).and_then(|mut file| {
            file.write_all(content)?;
            file.sync_all()
        });
        written
            .and_then(|()| fs::rename(&next, &place))
            .map_err(|e| io_error("write", &place, e))
    }
}

fn io_error(action: &'static str, path: &Path, error: io::Error) -> DirectoryError {
    DirectoryError::Io {
        action,
        path: path.to_owned(),
        error,
    }
}
