//! Files of recordings of the same coin and launch.

use crate::error::ListenError;
use crate::listened::{Heard, Kind};
use crate::recording::Recording;
use coinmc_core::Scene;
use std::fs;
use std::path::Path;

/// Most recordings that can be heard together.
pub const MOST_FILES: usize = 100;

impl Heard {
    /// Listens to files, each of another toss, in which a coin must be heard. See [`Heard::of`].
    ///
    /// # Errors
    /// [`ListenError::TooManyFiles`], or [`ListenError::Files`] with what is wrong with each file, also that it is given
    /// twice.
    ///
    /// # Example
    /// ```
    /// use coinmc_listen::Heard;
    /// let error = Heard::of_files(&["no.wav", "such.wav"], None, None).unwrap_err();
    /// assert_eq!(error.to_string().lines().count(), 2);
    /// ```
    pub fn of_files(
        files: &[impl AsRef<Path>],
        scene: Option<&Scene>,
        kind: Option<Kind>,
    ) -> Result<Vec<Self>, ListenError> {
        if files.len() > MOST_FILES {
            return Err(ListenError::TooManyFiles(files.len()));
        }
        let (mut all, mut problems) = (vec![], vec![]);
        for (place, path) in files.iter().enumerate() {
            let path = path.as_ref();
            let found = match same(path, &files[..place]) {
                Some(other) => Err(format!(
                    "this is the same file as {}: give each recording once",
                    other.display()
                )),
                None => heard(path, scene, kind),
            };
            match found {
                Ok(heard) => all.push(heard),
                Err(why) => problems.push(format!("{}: {why}", path.display())),
            }
        }
        if problems.is_empty() {
            Ok(all)
        } else {
            Err(ListenError::Files(problems))
        }
    }
}

/// The one of some files that is this one, maybe by another name: heard twice, a drop would count as two.
fn same<'a>(path: &Path, files: &'a [impl AsRef<Path>]) -> Option<&'a Path> {
    // what is not there is told when it is read
    let real = fs::canonicalize(path).ok()?;
    let mut others = files.iter().map(AsRef::as_ref);
    others.find(|other| fs::canonicalize(other).is_ok_and(|other| other == real))
}

/// A recording in which a coin is heard, or why none is.
fn heard(path: &Path, scene: Option<&Scene>, kind: Option<Kind>) -> Result<Heard, String> {
    let recording = Recording::read(path).map_err(|error| error.to_string())?;
    let heard = Heard::of(&recording, scene, kind);
    match heard.silence() {
        Some(why) => Err(format!("no coin heard: {why}")),
        None => Ok(heard),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file is known by another path and by a link to it; a copy is another file.
    #[test]
    fn a_recording_is_given_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("drop.wav");
        fs::write(&path, "no sound").unwrap();
        let copy = folder.path().join("copy.wav");
        fs::copy(&path, &copy).unwrap();
        let round = folder.path().join(".").join("drop.wav");
        let said = |files: &[&Path]| {
            let error = Heard::of_files(files, None, None).unwrap_err().to_string();
            error.lines().map(str::to_owned).collect::<Vec<_>>()
        };
        let twice = said(&[&path, &copy, &round]);
        assert_eq!(twice.len(), 3);
        let expected = format!(
            "{}: this is the same file as {}: give each recording once",
            round.display(),
            path.display()
        );
        assert_eq!(twice[2], expected);
        let others = said(&[&path, &copy]);
        assert!(others.iter().all(|line| line.contains("not a WAV file")));
        let absent = said(&["no.wav".as_ref(), "no.wav".as_ref()]);
        assert!(absent.iter().all(|line| line.contains("cannot be read")));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_the_same_recording() {
        let folder = tempfile::tempdir().unwrap();
        let [path, link] = ["drop.wav", "link.wav"].map(|name| folder.path().join(name));
        fs::write(&path, "no sound").unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        let error = Heard::of_files(&[path, link], None, None).unwrap_err();
        assert!(error.to_string().contains("same file"), "{error}");
    }
}
