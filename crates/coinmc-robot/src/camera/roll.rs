//! The photos of an experiment: which names are free, and which pictures were seen before.

use crate::files::open_to_read;
use crate::journal::{Digest, ImageName};
use sha2::{Digest as _, Sha256};
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Largest photo, bytes.
const MAX_BYTES: u64 = 256 << 20;

/// Photos of earlier sessions that are in no reading: this many of the last are looked at again.
const LOOKED_AT: usize = 64;

/// The folder of the photos.
#[derive(Debug)]
pub(super) struct Roll {
    folder: PathBuf,
    /// Names in use, without their extensions.
    names: HashSet<String>,
    seen: HashSet<Digest>,
}

impl Roll {
    /// The photos in a folder; `seen` are those of the journal.
    ///
    /// # Errors
    /// System errors.
    pub(super) fn open(folder: &Path, seen: HashSet<Digest>) -> io::Result<Self> {
        let mut paths = Vec::new();
        for entry in fs::read_dir(folder)? {
            paths.push(entry?.path());
        }
        paths.sort();
        let stem = |path: &PathBuf| Some(path.file_stem()?.to_string_lossy().into_owned());
        let mut roll = Self {
            folder: folder.to_owned(),
            names: paths.iter().filter_map(stem).collect(),
            seen,
        };
        for path in paths.iter().rev().take(LOOKED_AT) {
            // whatever cannot be read is no photo
            if let Ok(digest) = open_to_read(path).and_then(digest) {
                roll.seen.insert(digest);
            }
        }
        Ok(roll)
    }

    /// The first free name of a throw's photo: `STEM-N` with N at least `attempt`.
    pub(super) fn name(&mut self, stem: &str, attempt: u32) -> String {
        let names = (attempt..).map(|number| format!("{stem}-{number}"));
        let free = names.into_iter().find(|name| !self.names.contains(name));
        let name = free.unwrap_or_default();
        self.names.insert(name.clone());
        name
    }

    /// Syncs a photo and its directory entry to disk, unless it was seen before.
    pub(super) fn add(&mut self, image: &ImageName) -> io::Result<Digest> {
        let path = self.folder.join(image.as_str());
        // a symbolic link could lead out of the folder, and its target would not be synced
        if !fs::symlink_metadata(&path)?.is_file() {
            return Err(io::Error::other("not a file"));
        }
        let file = open_to_read(&path)?;
        file.sync_all()?;
        File::open(&self.folder)?.sync_all()?;
        let digest = digest(file)?;
        if self.seen.insert(digest) {
            Ok(digest)
        } else {
            Err(io::Error::other(
                "the same picture as one before: an old frame, or the camera stands still",
            ))
        }
    }
}

fn digest(file: File) -> io::Result<Digest> {
    let length = file.metadata()?.len();
    if length == 0 || length > MAX_BYTES {
        return Err(io::Error::other("an empty or huge file"));
    }
    let mut hasher = Sha256::new();
    let mut file = file.take(MAX_BYTES);
    let mut bytes = vec![0; 1 << 16];
    loop {
        match file.read(&mut bytes)? {
            0 => break,
            count => hasher.update(&bytes[..count]),
        }
    }
    let hash = hasher.finalize();
    let mut first = [0; 8];
    first.copy_from_slice(&hash[..8]);
    Ok(Digest(u64::from_be_bytes(first)))
}
