//! Input and output files: meaning of columns, bounded reading, new files only.

use crate::exit::Failure;
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use coinmc_film::text::{self, AngleOf, Choice, Diagnostics, Footage};
use coinmc_recording::NewFile;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Meaning and units of the columns.
#[derive(Debug, Args)]
#[command(next_help_heading = "Columns")]
pub(super) struct Columns {
    /// Column of x, as COLUMN or TRACK.COLUMN [default: x]
    #[arg(long, value_name = "NAME")]
    x: Option<String>,

    /// Column of the height [default: y]
    #[arg(long, value_name = "NAME")]
    y: Option<String>,

    /// Column of the angle [default: θ, theta, angle, rotation or phi]
    #[arg(long, value_name = "NAME")]
    angle: Option<String>,

    /// Two tracks instead, points of the coin at equal distances on either side of its centre:
    /// FIRST,SECOND
    #[arg(long, value_name = "TRACK,TRACK", value_parser = two_tracks)]
    #[arg(conflicts_with_all = ["x", "y", "angle"])]
    ends: Option<(String, String)>,

    /// The direction that the angle measures
    #[arg(long, value_enum, default_value_t = Direction::Face)]
    angle_of: Direction,

    /// Unit of lengths [default: as in the file's header, else m]
    #[arg(long, value_enum, value_name = "UNIT")]
    length_unit: Option<LengthUnit>,

    /// Unit of angles [default: as in the file's header, else deg]
    #[arg(long, value_enum, value_name = "UNIT")]
    angle_unit: Option<AngleUnit>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Direction {
    /// That of a line along the heads face, anticlockwise from the right: 0 lies heads up
    Face,
    /// That of the axis outwards from the heads face, anticlockwise from the right
    Axis,
    /// That of the axis, clockwise from the vertical: coinmc's θ
    Tilt,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LengthUnit {
    M,
    Cm,
    Mm,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum AngleUnit {
    Deg,
    Rad,
}

impl From<Direction> for AngleOf {
    fn from(direction: Direction) -> Self {
        match direction {
            Direction::Face => Self::Face,
            Direction::Axis => Self::Axis,
            Direction::Tilt => Self::Tilt,
        }
    }
}

impl Columns {
    fn choice(&self) -> Choice {
        Choice {
            x: self.x.clone(),
            y: self.y.clone(),
            angle: self.angle.clone(),
            ends: self.ends.clone(),
            length_m: self.length_unit.map(|unit| match unit {
                LengthUnit::M => 1.0,
                LengthUnit::Cm => 1e-2,
                LengthUnit::Mm => 1e-3,
            }),
            angle_rad: self.angle_unit.map(|unit| match unit {
                AngleUnit::Deg => 1.0_f64.to_radians(),
                AngleUnit::Rad => 1.0,
            }),
            angle_of: self.angle_of.into(),
        }
    }

    /// Reads all files, or reports the problems of all of them.
    pub(super) fn read(&self, paths: &[PathBuf]) -> Result<Vec<Footage>, Failure> {
        let choice = self.choice();
        gathered(paths.iter().map(|path| read(path, &choice)))
    }

    /// The same of different drops: a file that is given twice is a problem, too.
    pub(super) fn read_once_each(&self, paths: &[PathBuf]) -> Result<Vec<Footage>, Failure> {
        let choice = self.choice();
        let each = paths.iter().enumerate().map(|(place, path)| {
            match text::given_before(path, &paths[..place]) {
                Some(other) => Err(given_twice(path, other)),
                None => read(path, &choice),
            }
        });
        gathered(each)
    }
}

fn given_twice(path: &Path, other: &Path) -> Diagnostics {
    let message = format!(
        "this is the same file as {}: give each film once",
        other.display()
    );
    Diagnostics::of_file(&path.display().to_string(), message, None)
}

/// What was read, or all problems.
fn gathered(
    all: impl Iterator<Item = Result<Footage, Diagnostics>>,
) -> Result<Vec<Footage>, Failure> {
    let mut footage = Vec::new();
    let mut problems: Option<Diagnostics> = None;
    for read in all {
        match read {
            Ok(read) => footage.push(read),
            Err(found) => match &mut problems {
                Some(problems) => problems.append(found),
                None => problems = Some(found),
            },
        }
    }
    match problems {
        Some(problems) => Err(Failure::Film(problems)),
        None => Ok(footage),
    }
}

fn read(path: &Path, choice: &Choice) -> Result<Footage, Diagnostics> {
    let name = path.display().to_string();
    let bytes = text::bytes_of(path).map_err(|error| {
        let message = match error.kind() {
            ErrorKind::NotFound => "there is no such file".to_owned(),
            ErrorKind::IsADirectory => "this is a directory, not a file".to_owned(),
            _ => format!("the file cannot be read: {error}"),
        };
        Diagnostics::of_file(&name, message, None)
    })?;
    text::read(&name, &bytes, choice)
}

/// Begins new files, which appear only when complete.
pub(super) fn begin_new<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<Vec<NewFile>, Failure> {
    let mut begun: Vec<(&PathBuf, NewFile)> = Vec::new();
    for path in paths {
        if begun.iter().any(|(other, _)| *other == path) {
            return Err(Failure::Input(anyhow!("{} is given twice", path.display())));
        }
        begun.push((path, NewFile::begin(path)?));
    }
    Ok(begun.into_iter().map(|(_, file)| file).collect())
}

fn two_tracks(text: &str) -> Result<(String, String), String> {
    match text.split_once(',') {
        Some((first, second)) if !first.trim().is_empty() && !second.trim().is_empty() => {
            Ok((first.trim().to_owned(), second.trim().to_owned()))
        }
        _ => Err("give two tracks separated by a comma: A,B".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::question::write_file;

    #[test]
    fn a_file_appears_when_it_is_complete_and_replaces_none() {
        let dir = tempfile::tempdir().expect("a directory");
        let path = dir.path().join("fit.json");
        let mut begun = begin_new([&path]).expect("a new file");
        // a process that is killed now leaves nothing that has the name
        assert!(!path.exists());
        write_file(begun.remove(0), b"{}").expect("written");
        assert_eq!(std::fs::read(&path).expect("the file"), b"{}");
        assert!(begin_new([&path]).is_err());
        let other = dir.path().join("other.csv");
        let twice = begin_new([&other, &other]).expect_err("the same name twice");
        assert!(twice.message().ends_with("is given twice"));
    }
}
