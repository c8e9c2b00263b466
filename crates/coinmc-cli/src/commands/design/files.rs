//! The files of a design: created before the work begins, they appear only when complete.

use super::{Designed, sheet};
use crate::exit::Failure;
use anyhow::anyhow;
use coinmc_recording::{Error, NewFile};
use coinmc_solid::{write_3mf, write_openscad, write_stl};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The new files.
pub(super) struct Files {
    stl: (PathBuf, NewFile),
    package: (PathBuf, NewFile),
    openscad: (PathBuf, NewFile),
    sheet: (PathBuf, NewFile),
}

/// What was written.
pub(super) struct Written {
    pub(super) paths: [PathBuf; 4],
    pub(super) triangles: usize,
}

impl Files {
    /// Begins `name` with each ending.
    pub(super) fn begin(name: &Path) -> Result<Self, Failure> {
        let begin = |ending: &str| {
            let mut path = name.as_os_str().to_owned();
            path.push(ending);
            let path = PathBuf::from(path);
            let file = NewFile::begin(&path)?;
            Ok::<_, Failure>((path, file))
        };
        Ok(Self {
            stl: begin(".stl")?,
            package: begin(".3mf")?,
            openscad: begin(".scad")?,
            sheet: begin(".svg")?,
        })
    }

    /// Writes them all.
    pub(super) fn write(self, designed: &Designed) -> Result<Written, Failure> {
        let shape = &designed.shape;
        let mesh = shape
            .mesh(shape.chord_error_m())
            .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        let title = "A fair coin with three sides, by coinmc";
        let paths = [
            write(self.stl, |out| write_stl(&mesh, out))?,
            write(self.package, |out| write_3mf(&mesh, title, out))?,
            write(self.openscad, |out| write_openscad(shape, out))?,
            write(self.sheet, |out| {
                out.write_all(sheet::svg(designed).as_bytes())
            })?,
        ];
        Ok(Written {
            paths,
            triangles: mesh.triangles().len(),
        })
    }
}

fn write(
    (path, mut file): (PathBuf, NewFile),
    content: impl FnOnce(&mut NewFile) -> std::io::Result<()>,
) -> Result<PathBuf, Failure> {
    content(&mut file).map_err(|error| Error::Stream(error).with_path(&path))?;
    file.finish()?;
    Ok(path)
}
