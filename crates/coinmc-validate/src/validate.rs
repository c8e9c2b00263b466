//! A whole validation.

use crate::claims::{CLAIMS, Checked};
use crate::prior::{draws, tables};
use crate::sets::{Draws, Predicted, SETS, predict};
use crate::tosser::Tosser;
use crate::trend::LEVEL;
use crate::{Size, ValidateError};
use coinmc_questions::Workers;
use std::fs;
use std::path::Path;

/// Directories in that of a validation: for the tosses of its claims and of its data sets.
const PLACES: [&str; 2] = ["claims", "sets"];

/// What to validate, and how.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// How much work to do.
    pub size: Size,
    /// Names of claims and data sets; all of them if empty.
    pub only: &'a [String],
    /// Key of all random numbers.
    pub seed: u64,
    /// A directory for run directories, so that a later call goes on where this one stopped; without one all
    /// counts stay in memory.
    pub out: Option<&'a Path>,
    /// How run directories name this build of the program.
    pub build: &'a str,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Validation {
    /// How much work was done.
    pub size: Size,
    /// Key of all random numbers.
    pub seed: u64,
    /// Draws from the prior.
    pub draws: u64,
    /// Tosses of each draw and ratio.
    pub tosses_of_draw: u64,
    /// The claims, in their order.
    pub claims: Vec<Checked>,
    /// The data sets, in their order.
    pub sets: Vec<Predicted>,
}

impl Validation {
    /// Share of false alarms of each test.
    pub const LEVEL: f64 = LEVEL;

    /// The prior, in words.
    pub fn prior() -> String {
        let names: Vec<_> = tables().map(|scene| scene.name).collect();
        format!(
            "a toss by hand at one of the everyday scenes {}, each as likely; every number of table, hand and coin \
             anywhere in the range that `coinmc fair --scene NAME` states for it; what a source states is taken \
             from it, and nothing is fitted",
            names.join(", ")
        )
    }

    /// The data sets that were predicted.
    pub fn predicted(&self) -> impl Iterator<Item = &Predicted> {
        self.sets.iter().filter(|set| set.p_value.is_some())
    }

    /// How many of them the data do not contradict, by a test with [`LEVEL`](Self::LEVEL).
    pub fn not_rejected(&self) -> usize {
        self.predicted()
            .filter(|set| set.is_rejected(Self::LEVEL) == Some(false))
            .count()
    }
}

/// The names of all claims and data sets, in their order.
pub fn names() -> impl Iterator<Item = &'static str> {
    let claims = CLAIMS.iter().map(|claim| claim.name);
    claims.chain(SETS.iter().map(|set| set.name))
}

/// Validates. The result does not depend on the number of threads, nor on how often it was stopped and went on.
///
/// # Errors
/// [`ValidateError::Unknown`] name, before the first toss; [`ValidateError::Stopped`]; [`ValidateError::Run`] if a
/// run directory cannot be written or belongs to another validation.
///
/// # Example
/// ```
/// use coinmc_questions::Workers;
/// use coinmc_validate::{Options, Size, Verdict, validate};
/// use std::sync::atomic::AtomicBool;
/// let only = ["contact-time".to_owned(), "kerrich".to_owned()];
/// let options = Options { size: Size::Quick, only: &only, seed: 1, out: None, build: "doc" };
/// let cancel = AtomicBool::new(false);
/// let found = validate(&options, &Workers { threads: None, cancel: &cancel, made: &|_| () })?;
/// assert!(matches!(found.claims[0].finding.verdict, Verdict::HoldsWhere(_)));
/// // 5,067 heads of 10,000: two-sided and exact
/// assert!((found.sets[0].p_value.unwrap() - 0.1835).abs() < 1e-3);
/// # Ok::<(), coinmc_validate::ValidateError>(())
/// ```
pub fn validate(options: &Options<'_>, workers: &Workers<'_>) -> Result<Validation, ValidateError> {
    let Options { size, seed, .. } = *options;
    check(options.only)?;
    if let Some(out) = options.out {
        check_directory(out)?;
    }
    let wanted = |name: &str| options.only.is_empty() || options.only.iter().any(|n| n == name);
    let tosser = Tosser {
        seed,
        size,
        out: options.out,
        build: options.build,
        workers: *workers,
    };
    let mut claims = vec![];
    for claim in CLAIMS.iter().filter(|claim| wanted(claim.name)) {
        let finding = (claim.check)(&tosser)?;
        claims.push(Checked { claim, finding });
    }
    let number = size.of(256, 512);
    let tosses = size.of(96, 1024);
    let stated = size.of(4000, 100_000);
    let mut of_prior = Draws::new(tosser, draws(seed, number), [tosses, stated]);
    let mut sets = vec![];
    for set in SETS.iter().filter(|set| wanted(set.name)) {
        sets.push(predict(set, &mut of_prior)?);
    }
    Ok(Validation {
        size,
        seed,
        draws: number,
        tosses_of_draw: tosses,
        claims,
        sets,
    })
}

/// That a directory is absent, empty or that of a validation.
fn check_directory(dir: &Path) -> Result<(), ValidateError> {
    // what is absent can be made, and of what cannot be read the first run says why
    let Ok(entries) = fs::read_dir(dir) else {
        return Ok(());
    };
    let names = entries.flatten().map(|entry| entry.file_name());
    let foreign = names
        .filter(|name| !PLACES.iter().any(|place| name == place))
        .min();
    match foreign {
        None => Ok(()),
        Some(name) => Err(ValidateError::OtherDirectory {
            dir: dir.to_owned(),
            found: name.display().to_string(),
        }),
    }
}

/// That everything has these names, with the nearest name of each that nothing has.
fn check(only: &[String]) -> Result<(), ValidateError> {
    let unknown = only
        .iter()
        .filter(|name| !names().any(|known| known == *name));
    let told: Vec<String> = unknown
        .map(|name| {
            let shown: String = name.chars().take(60).collect();
            match coinmc::config::nearest(name, names()) {
                Some(near) => format!("`{shown}` (did you mean `{near}`?)"),
                None => format!("`{shown}`"),
            }
        })
        .collect();
    if told.is_empty() {
        return Ok(());
    }
    Err(ValidateError::Unknown {
        names: told,
        known: names().collect::<Vec<_>>().join(", "),
    })
}
