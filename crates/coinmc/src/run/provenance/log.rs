//! Adds to `provenance.jsonl`.

use super::maker::Maker;
use super::record::{Entry, FILE, introduction, lines};
use crate::run::RunError;
use crate::run::append::{append, ends_within_a_line};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file of a run directory whose lock this process holds.
#[derive(Debug)]
pub(crate) struct Log {
    path: PathBuf,
    /// Makers that this process has introduced.
    introduced: Mutex<BTreeSet<String>>,
}

impl Log {
    pub(crate) fn of(dir: &Path) -> Self {
        Self {
            path: dir.join(FILE),
            introduced: Mutex::default(),
        }
    }

    /// Records who made chunks. It is not waited for the disk: what a loss of power takes is no count.
    pub(crate) fn add(&self, maker: &Maker, entries: &[Entry]) -> Result<(), RunError> {
        if entries.is_empty() {
            return Ok(());
        }
        let id = maker.id();
        let introduced = self.introduced.lock();
        let mut introduced = introduced.unwrap_or_else(PoisonError::into_inner);
        let mut text = String::new();
        if introduced.is_empty() && ends_within_a_line(&self.path)? {
            // a killed run did not finish it
            text.push('\n');
        }
        if !introduced.contains(&id) {
            text += &introduction(maker);
        }
        text += &lines(&id, entries);
        append(&self.path, text.as_bytes(), false)?;
        introduced.insert(id);
        Ok(())
    }
}
