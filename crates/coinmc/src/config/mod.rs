//! Reads a config: TOML in, a [`Plan`] or all [`Problem`]s out.
//!
//! ```text
//! text ─▶ tree ─▶ walk (against the schema) ─▶ form ─▶ sweep, build ─▶ Plan
//!           ▲                                    └────▶ resolved TOML
//!       overrides
//! ```
//!
//! * Every key is described once, in the schema; messages and [`json_schema`] come from there.
//! * Any number of `[coin]`, `[surface]`, `[environment]`, `[launch]` and any real setting of an
//!   engine may be a number, a list of numbers or a range `{ from, to, steps }` (both ends
//!   included; `scale = "log"` for even ratios): an axis of the sweep. A list of one is a number.
//!   Values of a range are rounded to 15 digits.
//! * Axes are ordered as in the reference, not as in the file, and the first varies slowest. The
//!   plan depends on no comment, order of keys, or file name.
//! * A whole number may be written `1e6`; an integer will do for a real number.
//! * With `[engine.analytic]`, `[surface]`, `[launch]` and `[stop]` may be left out. If they are
//!   there they are checked, axes in them make points, and they change no result.

mod at;
mod build;
mod checked;
mod coin;
mod columns;
mod diagnostics;
mod engines;
mod launch;
mod nearest;
mod notes;
mod overrides;
mod quantity;
mod resolved;
mod schema;
mod sections;
mod source;
mod surface;
mod sweep;
mod syntax;
mod tree;
mod values;
mod walk;

pub use diagnostics::{Diagnostics, Problem};
pub use nearest::nearest;
pub use overrides::{Override, OverrideError};
pub use sections::{Entry, Place, Section, parse_with};

use crate::plan::Plan;
use checked::{Checked, CheckedValue};
use coinmc_core::schema::TableKind;
use diagnostics::{Problems, printable};
use source::{Sources, Span};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use sweep::Sweep;
use tree::Table;

/// Largest config, as written and as resolved, bytes.
pub const MAX_BYTES: usize = 1 << 20;

/// Reads a config file.
///
/// # Errors
/// Every problem found, or that the file cannot be read.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Plan, Diagnostics> {
    parse(&path.display().to_string(), &read_text(path)?, overrides)
}

/// The text of a config file, for [`parse`].
///
/// # Errors
/// One problem, that the file cannot be read or is no text.
pub fn read_text(path: &Path) -> Result<String, Diagnostics> {
    let name = path.display().to_string();
    let bytes = read(path).map_err(|error| {
        let (message, help) = match error.kind() {
            std::io::ErrorKind::NotFound => ("there is no such file".to_owned(), None),
            std::io::ErrorKind::IsADirectory => (
                "this is a directory, not a config file".to_owned(),
                Some(instead_of(path)),
            ),
            _ => (format!("the file cannot be read: {error}"), None),
        };
        Diagnostics::of_file(&name, message, help)
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let (line, column) = source::end_place(&String::from_utf8_lossy(good));
        let message = "this is no UTF-8 text".to_owned();
        let help = Some("save the file as UTF-8".to_owned());
        Diagnostics::of_file(&name, message, help).at(line, column)
    })
}

/// What to give instead of a directory.
fn instead_of(directory: &Path) -> String {
    let of_run = directory.join("config.toml");
    if of_run.is_file() {
        format!("the config of this run is {}", of_run.display())
    } else {
        "give the path of a .toml file".to_owned()
    }
}

/// Reads at most one byte more than allowed, to detect larger files without loading them.
fn read(path: &Path) -> std::io::Result<Vec<u8>> {
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(std::io::ErrorKind::IsADirectory.into());
    }
    let mut bytes = Vec::new();
    file.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a config from a text; `name` is its name in messages.
///
/// # Errors
/// Every problem found.
///
/// # Example
/// ```
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = { from = 0.5, to = 2.0, steps = 4 }\nengine.analytic.rule = 'arc'",
///     &[],
/// ).unwrap();
/// assert_eq!(plan.axes, ["ratio"]);
/// assert_eq!(plan.points[1].scene.coin.ratio(), 1.0);
/// ```
pub fn parse(name: &str, text: &str, overrides: &[Override]) -> Result<Plan, Diagnostics> {
    if text.len() > MAX_BYTES {
        let message = format!("a config has at most {MAX_BYTES} bytes");
        return Err(Diagnostics::of_file(name, message, None));
    }
    let mut sources = Sources::default();
    let mut problems = Problems::default();
    let plan = plan(&mut sources, name, text, overrides, &mut problems);
    match plan {
        Some(plan) if problems.is_empty() => Ok(plan),
        _ => Err(problems.finish(&sources)),
    }
}

/// The JSON Schema (2020-12) of the config, for editors and other programs.
pub fn json_schema() -> String {
    schema::json_schema()
}

/// Converts text to a plan; `None` only after a problem.
fn plan(
    sources: &mut Sources,
    name: &str,
    text: &str,
    overrides: &[Override],
    problems: &mut Problems,
) -> Option<Plan> {
    // a byte order mark is not part of the text
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let file = sources.add(&printable(name), text);
    let mut tree = tree::document(sources, file, text, problems)?;
    for set in overrides {
        set.apply(sources, &mut tree, problems);
    }
    of_tree(sources, &schema::root(), &tree, sources.end(file), problems)
}

/// Checks a tree against a schema and makes the plan; `end` is where a missing table would go.
fn of_tree(
    sources: &Sources,
    schema: &TableKind,
    tree: &Table,
    end: Span,
    problems: &mut Problems,
) -> Option<Plan> {
    let mut root = walk::document(sources, problems, schema, tree, end);
    let taken = spell_out(&mut root, problems);
    engines::refuse_unmodelled(&root, problems);
    let sweep = Sweep::find(&mut root, problems)?;
    let points = build::points(&root, sweep, problems);
    build::refuse_small_total(&root, points.sweep.points, problems);
    if !problems.is_empty() {
        return None;
    }
    if points.sweep.axes.len() < 2 {
        single_axis(&mut root, points.sweep.axes.len());
    }
    let resolved_toml = resolved(&root, end, problems)?;
    let (confidence, interval) = build::estimate(&root)?;
    Some(Plan {
        seed: build::integer(&root, "seed")?,
        paired: build::boolean(&root, "paired")?,
        stop: build::stop(&root)?,
        sampling: build::sampling(&root)?,
        confidence,
        interval,
        axes: points.axes(),
        notes: taken.into_iter().chain(points.notes.texts(&root)).collect(),
        points: points.list,
        resolved_toml,
    })
}

/// Expands the lengths of the coin, the preset of the launch and the material of the surface; remarks
/// on what was taken.
fn spell_out(root: &mut Checked, problems: &mut Problems) -> Vec<String> {
    let engine = engines::descriptor(root);
    let unmodelled = engines::unmodelled(root);
    let mut notes = Vec::new();
    if let CheckedValue::Table(entries) = &mut root.value {
        for (key, checked) in entries {
            match *key {
                "coin" => *checked = coin::spelled_out(checked, problems),
                "launch" => *checked = launch::spelled_out(checked),
                "surface" => {
                    let spelled = surface::spelled_out(checked, engine, &unmodelled);
                    *checked = spelled.surface;
                    notes = spelled.notes;
                }
                _ => {}
            }
        }
    }
    notes
}

/// A grid and a zip of fewer than two axes are the same sweep, as all sweeps without axes are: write
/// them as a grid.
fn single_axis(root: &mut Checked, axes: usize) {
    let CheckedValue::Table(entries) = &mut root.value else {
        return;
    };
    for (_, sweep) in entries.iter_mut().filter(|(key, _)| *key == "sweep") {
        if let CheckedValue::Table(fields) = &mut sweep.value {
            for (_, mode) in fields {
                if axes == 1 && mode.word() == Some("sobol") {
                    continue;
                }
                mode.value = CheckedValue::Word("grid");
            }
        }
    }
}

/// The resolved TOML, unless it is too long to be read back.
fn resolved(root: &Checked, end: Span, problems: &mut Problems) -> Option<String> {
    let text = resolved::document(root);
    if text.len() > MAX_BYTES {
        let message = format!(
            "this config, spelled out, has more than {MAX_BYTES} bytes: its lists are too long"
        );
        problems.add_with_help(end, message, "use ranges, or several configs");
        return None;
    }
    Some(text)
}
