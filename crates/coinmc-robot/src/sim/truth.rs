//! The truth file: a log of every release by the simulated robot, hidden from the host. The
//! simulated camera reads it instead of a coin, and tests compare it with the journal.

use crate::Face;
use crate::files::{open_to_append, open_to_read};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// One release of the coin: a line of the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Truth {
    /// The throw.
    pub throw_id: u32,
    /// Spin, 1/1000 rev/s.
    pub spin_mrev_s: u16,
    /// Start angle, 1/100 degree.
    pub angle_cdeg: u16,
    /// Face on which it landed; `None` if undecided.
    pub face: Option<String>,
}

/// Longest line read.
const LONGEST: u64 = 512;

impl Truth {
    /// The face, if its name is valid.
    pub fn face(&self) -> Option<Face> {
        self.face.as_deref().and_then(Face::named)
    }
}

/// Appends to the file.
#[derive(Debug)]
pub(super) struct TruthFile(Option<File>);

impl TruthFile {
    pub(super) fn open(path: Option<&Path>) -> io::Result<Self> {
        let open = |path| open_to_append(path);
        path.map(open).transpose().map(Self)
    }

    pub(super) fn add(&mut self, truth: &Truth) -> io::Result<()> {
        let Some(file) = &mut self.0 else {
            return Ok(());
        };
        let mut line = serde_json::to_string(truth)?;
        line.push('\n');
        file.write_all(line.as_bytes())
    }
}

/// The last release in the file; `None` before the first.
///
/// # Errors
/// System errors, and an invalid last line.
pub fn last_truth(path: &Path) -> io::Result<Option<Truth>> {
    let mut file = match open_to_read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        file => file?,
    };
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(LONGEST)))?;
    let mut text = String::new();
    file.take(LONGEST).read_to_string(&mut text)?;
    // a line without its end is still being written
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let last = whole.lines().next_back();
    Ok(last.map(serde_json::from_str).transpose()?)
}

/// All releases in the file.
///
/// # Errors
/// System errors, and any invalid line.
pub fn read_truths(path: &Path) -> io::Result<Vec<Truth>> {
    let lines = BufReader::new(open_to_read(path)?).lines();
    lines
        .map(|line| Ok(serde_json::from_str(&line?)?))
        .collect()
}
