//! Files of recordings of the same coin and launch.

use crate::error::ListenError;
use crate::listened::{Heard, Kind};
use crate::recording::Recording;
use coinmc_core::Scene;
use std::path::Path;

/// Most recordings that can be heard together.
pub const MOST_FILES: usize = 100;

impl Heard {
    /// Listens to files, in each of which a coin must be heard. See [`Heard::of`].
    ///
    /// # Errors
    /// [`ListenError::TooManyFiles`], or [`ListenError::Files`] with what is wrong with each file.
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
        for path in files {
            match heard(path.as_ref(), scene, kind) {
                Ok(heard) => all.push(heard),
                Err(why) => problems.push(format!("{}: {why}", path.as_ref().display())),
            }
        }
        if problems.is_empty() {
            Ok(all)
        } else {
            Err(ListenError::Files(problems))
        }
    }
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
