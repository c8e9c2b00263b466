//! Filmed drops, as `coinmc film fit` reads them: restitution and friction with their errors.

use super::{Kind, Law, Reduced};
use crate::Parameter;
use coinmc_core::schema::{
    Absent, Fallback, Kind as KeyKind, ReadError, TableKind, Values, Whole, Word, field, fields,
};
use coinmc_core::{Scene, Surface};
use coinmc_film::text::{self, Choice};
use coinmc_film::{
    FilmedDrop, Fit, Law as FlatLaw, MAX_DROPS, Model, Options, Remark, Shared, fit,
};
use std::path::{Path, PathBuf};

/// Files of drops.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Drops {
    files: Vec<PathBuf>,
    /// `None`: that of the engine.
    law: Option<FlatLaw>,
    bounces: usize,
}

/// The law of impact.
const LAWS: [(&str, FlatLaw); 2] = [
    ("moreau", FlatLaw::Moreau),
    ("chatterjee-ruina", FlatLaw::ChatterjeeRuina),
];

fn law_of(name: &str) -> Option<FlatLaw> {
    let law = LAWS.iter().find(|(known, _)| *known == name);
    law.map(|(_, law)| *law)
}

/// What filmed drops say.
pub(crate) struct Filmed {
    pub(crate) reduced: Vec<Reduced>,
    /// What casts doubt on it.
    pub(crate) remarks: Vec<String>,
}

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
                "Law of impact that is fitted; absent: that of the engine, or else `chatterjee-ruina`.",
                KeyKind::Word(vec![
                    word(
                        "moreau",
                        "Newton's restitution, friction opposing the final slip",
                    ),
                    word("chatterjee-ruina", "the law of Chatterjee and Ruina"),
                ]),
                Absent::Omitted,
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
        let law = match values.get("law") {
            Some(_) => law_of(values.word("law")?),
            None => None,
        };
        Ok(Self {
            files: files.iter().map(PathBuf::from).collect(),
            law,
            bounces: values.integer("bounces")?,
        })
    }

    /// Reads and fits the drops; files are sought from the folder of the config, and the law is that of the engine if none is
    /// given: what is measured is the restitution of the law that tosses. `seen` are those of the tables before,
    /// to which these are added: a drop given twice would count as two.
    ///
    /// # Errors
    /// What is wrong with each file, or why there is no fit.
    pub(crate) fn fitted(
        &self,
        scene: &Scene,
        law: &str,
        folder: &Path,
        seen: &mut Vec<PathBuf>,
    ) -> Result<Filmed, Vec<String>> {
        let mut drops: Vec<FilmedDrop> = vec![];
        let mut problems: Vec<String> = vec![];
        for file in &self.files {
            match read(file, folder, seen) {
                Ok(drop) => drops.push(drop),
                Err(problem) => problems.push(problem),
            }
            seen.push(folder.join(file));
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let model = Model {
            law: self
                .law
                .or_else(|| law_of(law))
                .unwrap_or(FlatLaw::ChatterjeeRuina),
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
        Ok(Filmed {
            reduced: determined,
            remarks: remarks(&fitted),
        })
    }

    pub(crate) const KIND: Kind = Kind::Film;
}

/// What casts doubt on a fit. Remedies that only `coinmc film fit` has are put in its words.
fn remarks(fitted: &Fit) -> Vec<String> {
    let words = |remark: &Remark| match remark {
        Remark::Outliers { .. } => format!("{remark} of `coinmc film fit`"),
        _ => remark.to_string(),
    };
    fitted.remarks.iter().map(words).collect()
}

/// Reads a file from a folder, or says in a line what is wrong with it.
fn read(file: &Path, folder: &Path, seen: &[PathBuf]) -> Result<FilmedDrop, String> {
    if file.as_os_str().is_empty() {
        return Err("`files` has an empty name".to_owned());
    }
    let path = folder.join(file);
    let name = path.display().to_string();
    if let Some(other) = text::given_before(&path, seen) {
        let other = other.display();
        return Err(format!(
            "{name}: this is the same file as {other}: give each film once"
        ));
    }
    let bytes = text::bytes_of(&path).map_err(|error| format!("{name}: {error}"))?;
    match text::read(&name, &bytes, &Choice::default()) {
        Ok(footage) => Ok(footage.drop),
        Err(problems) => Err(in_a_line(problems.problems())),
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
