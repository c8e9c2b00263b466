//! The files of a design: created before the work begins, they appear only when complete.

use crate::exit::Failure;
use coinmc_questions::{DesignFile, Designed};
use coinmc_recording::{Error, NewFile};
use std::path::{Path, PathBuf};

/// The new files.
pub(super) struct Files([(DesignFile, PathBuf, NewFile); 4]);

impl Files {
    /// Begins `name` with each ending.
    pub(super) fn begin(name: &Path) -> Result<Self, Failure> {
        let begin = |kind: DesignFile| {
            let mut path = name.as_os_str().to_owned();
            path.push(kind.ending());
            let path = PathBuf::from(path);
            let file = NewFile::begin(&path)?;
            Ok::<_, Failure>((kind, path, file))
        };
        let [stl, package, openscad, sheet] = DesignFile::ALL.map(begin);
        Ok(Self([stl?, package?, openscad?, sheet?]))
    }

    /// Writes them all; returns their paths.
    pub(super) fn write(self, designed: &Designed) -> Result<Vec<PathBuf>, Failure> {
        let mut paths = vec![];
        for (kind, path, mut file) in self.0 {
            let written = designed.write(kind, &mut file);
            written.map_err(|error| Error::Stream(error).with_path(&path))?;
            file.finish()?;
            paths.push(path);
        }
        Ok(paths)
    }
}
