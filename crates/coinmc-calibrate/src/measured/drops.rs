//! Filmed drops, as `coinmc film fit` reads them: restitution and friction with their errors.

use super::{Kind, Law, Reduced};
use crate::Parameter;
use coinmc_core::schema::{
    Absent, Fallback, Kind as KeyKind, ReadError, TableKind, Values, Whole, Word, field, fields,
};
use coinmc_core::{Scene, Surface};
use coinmc_film::text::{self, Choice};
use coinmc_film::{FilmedDrop, Law as FlatLaw, MAX_DROPS, Model, Options, Shared, fit};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Files of drops.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Drops {
    files: Vec<PathBuf>,
    law: FlatLaw,
    bounces: usize,
}

/// The law of impact.
const LAWS: [(&str, FlatLaw); 2] = [
    ("moreau", FlatLaw::Moreau),
    ("chatterjee-ruina", FlatLaw::ChatterjeeRuina),
];

impl Drops {
    pub(crate) fn schema() -> TableKind {
        let word = |name, doc| Word { name, doc };
        fields(vec![
            field(
                "files",
                "Text files exported by Tracker, one drop each; beside the config.",
                KeyKind::Texts,
                Absent::Required,
            ),
            field(
                "law",
                "Law of impact that is fitted.",
                KeyKind::Word(vec![
                    word(
                        "moreau",
                        "Newton's restitution, friction opposing the final slip",
                    ),
                    word("chatterjee-ruina", "the law of Chatterjee and Ruina"),
                ]),
                Absent::Is(Fallback::Word("chatterjee-ruina")),
            ),
            field(
                "bounces",
                "Number of bounces to fit.",
                KeyKind::Integer(Whole { low: 1, high: 20 }),
                Absent::Is(Fallback::Integer(2)),
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let files = values.texts("files")?;
        if files.len() > MAX_DROPS {
            let message = format!(
                "at most {MAX_DROPS} drops are allowed, found {}",
                files.len()
            );
            return Err(ReadError::new(message).at("files"));
        }
        let name = values.word("law")?;
        let law = LAWS.iter().find(|(known, _)| *known == name);
        Ok(Self {
            files: files.iter().map(PathBuf::from).collect(),
            law: law.map_or(FlatLaw::ChatterjeeRuina, |(_, law)| *law),
            bounces: values.integer("bounces")?,
        })
    }

    /// Reads and fits the drops; files are sought from the folder of the config.
    ///
    /// # Errors
    /// What is wrong with each file, or why there is no fit.
    pub(crate) fn fitted(&self, scene: &Scene, folder: &Path) -> Result<Vec<Reduced>, Vec<String>> {
        let mut drops: Vec<FilmedDrop> = vec![];
        let mut problems: Vec<String> = vec![];
        for file in &self.files {
            match read(file, folder) {
                Ok(drop) => drops.push(drop),
                Err(problem) => problems.push(problem),
            }
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let model = Model {
            law: self.law,
            coin: scene.coin,
            gravity_m_s2: scene.gravity_m_s2(),
        };
        let surface: &Surface = &scene.surface;
        let options = Options {
            bounces: self.bounces,
            shared: Shared {
                restitution: surface.restitution(),
                friction: surface.friction(),
                ..Shared::default()
            },
            ..Options::default()
        };
        let fitted = fit(&model, &drops, &options).map_err(|error| vec![error.to_string()])?;
        let pairs = [
            (coinmc_film::Parameter::Restitution, Parameter::Restitution),
            (coinmc_film::Parameter::Friction, Parameter::Friction),
        ];
        let determined = pairs.iter().filter_map(|(filmed, ours)| {
            let estimate = fitted.estimate(*filmed)?;
            // what the film leaves open it does not measure
            let error = estimate.std_error.filter(|_| estimate.is_determined())?;
            Some(Reduced {
                law: Law::Times(*ours, 1.0),
                value: estimate.value,
                absolute: error,
                relative: 0.0,
            })
        });
        let determined: Vec<_> = determined.collect();
        if determined.is_empty() {
            let nothing = "these drops determine neither restitution nor friction";
            return Err(vec![nothing.to_owned()]);
        }
        Ok(determined)
    }

    pub(crate) const KIND: Kind = Kind::Film;
}

/// Reads a file from a folder, or says in a line what is wrong with it.
fn read(file: &Path, folder: &Path) -> Result<FilmedDrop, String> {
    if file.as_os_str().is_empty() {
        return Err("`files` has an empty name".to_owned());
    }
    let path = folder.join(file);
    let name = path.display().to_string();
    let bytes = bytes_of(&path).map_err(|error| format!("{name}: {error}"))?;
    match text::read(&name, &bytes, &Choice::default()) {
        Ok(footage) => Ok(footage.drop),
        Err(problems) => Err(in_a_line(problems.problems())),
    }
}

/// The bytes of a file. A config names no pipe, which would wait for somebody to write, and no device, which need not
/// end.
fn bytes_of(path: &Path) -> io::Result<Vec<u8>> {
    let kind = fs::metadata(path)?;
    if kind.is_file() || kind.is_dir() {
        text::bytes_of(path)
    } else {
        Err(io::Error::other("it is not a plain file"))
    }
}

/// The first problem of a file, and how many more there are.
fn in_a_line(problems: &[text::Problem]) -> String {
    let Some((first, more)) = problems.split_first() else {
        return String::new();
    };
    let text::Problem {
        file,
        line,
        column,
        message,
        ..
    } = first;
    let place = match line {
        0 => file.clone(),
        _ => format!("{file}:{line}:{column}"),
    };
    match more.len() {
        0 => format!("{place}: {message}"),
        more => format!("{place}: {message}, and {more} more: see `coinmc film read {file}`"),
    }
}
