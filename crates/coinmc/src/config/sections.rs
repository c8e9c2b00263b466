//! Configs of questions that need more than a scene: further tables, each of which may be given several
//! times and may toss in a scene of its own.

use super::at::{At, Fault};
use super::checked::Checked;
use super::diagnostics::{Diagnostics, Problems, printable};
use super::source::{Sources, Span};
use super::sweep::Sweep;
use super::tree::{self, Node, Table, Value};
use super::{MAX_BYTES, Override, of_tree, schema, values, walk};
use crate::plan::Plan;
use coinmc_core::schema::{Absent, ReadError, TableKind, Values, field};
use coinmc_core::schema::{Kind, Value as Given};

/// Most entries of all sections of a config.
const MOST_ENTRIES: usize = 1000;

/// A table beside those of the scene.
#[derive(Debug, Clone)]
pub struct Section<T> {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its keys.
    pub kind: TableKind,
    /// Whether it may be given several times, as `[[name]]`.
    pub many: bool,
    /// Tables of the scene that it may replace by its own, as in `[name.coin]`.
    pub own: &'static [&'static str],
    /// Reads its values.
    pub read: fn(&Values) -> Result<T, ReadError>,
}

/// A table that was found.
#[derive(Debug, Clone)]
pub struct Entry<T> {
    /// What it says.
    pub content: T,
    /// The scene, with the tables that it replaces.
    pub plan: Plan,
    /// Where it stands.
    pub place: Place,
}

/// A place in a config, for problems that show later than while reading.
#[derive(Debug, Clone)]
pub struct Place {
    sources: Sources,
    span: Span,
}

impl Place {
    /// A problem here, quoted with a caret.
    pub fn problem(&self, message: impl Into<String>, help: Option<String>) -> Diagnostics {
        let mut problems = Problems::default();
        problems.push(self.span, message.into(), help);
        problems.finish(&self.sources)
    }

    /// Several problems here, each quoted with a caret.
    pub fn problems(&self, messages: impl IntoIterator<Item = String>) -> Diagnostics {
        let mut problems = Problems::default();
        for message in messages {
            problems.add(self.span, message);
        }
        problems.finish(&self.sources)
    }

    /// The line, from 1.
    pub fn line(&self) -> usize {
        self.sources.place(self.span).0
    }
}

/// Reads a config with these sections. Its `[stop]` may be absent, and all its entries are in the order
/// of the file. An entry with tables of its own is about one scene; if the config itself sweeps, such entries
/// are left out.
///
/// # Errors
/// Every problem found, of the scene and of all sections.
///
/// # Example
/// ```
/// use coinmc::config::{Section, parse_with};
/// use coinmc_core::schema::{Absent, Bounds, Kind, field, fields};
/// let tilt = Section {
///     name: "tilt",
///     doc: "A tilted surface.",
///     kind: fields(vec![field("angle_deg", "Angle.", Kind::Reals(Bounds::open(0.0, 90.0)), Absent::Required)]),
///     many: true,
///     own: &[],
///     read: |values| Ok(values.numbers("angle_deg")?.to_vec()),
/// };
/// let text = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
///             engine.volumetric = {}\n[[tilt]]\nangle_deg = [17, 17]\n";
/// let (plan, found) = parse_with("inline", text, &[], &[tilt]).unwrap();
/// assert_eq!((found[0].content.as_slice(), found[0].place.line()), (&[17.0, 17.0][..], 5));
/// assert_eq!(found[0].plan, plan);
/// ```
pub fn parse_with<T>(
    name: &str,
    text: &str,
    overrides: &[Override],
    sections: &[Section<T>],
) -> Result<(Plan, Vec<Entry<T>>), Diagnostics> {
    if text.len() > MAX_BYTES {
        let message = format!("a config has at most {MAX_BYTES} bytes");
        return Err(Diagnostics::of_file(name, message, None));
    }
    let mut sources = Sources::default();
    let mut problems = Problems::default();
    let read = read(
        &mut sources,
        (name, text),
        overrides,
        sections,
        &mut problems,
    );
    match read {
        Some(read) if problems.is_empty() => Ok(read),
        _ => Err(problems.finish(&sources)),
    }
}

fn read<T>(
    sources: &mut Sources,
    (name, text): (&str, &str),
    overrides: &[Override],
    sections: &[Section<T>],
    problems: &mut Problems,
) -> Option<(Plan, Vec<Entry<T>>)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let file = sources.add(&printable(name), text);
    let mut tree = tree::document(sources, file, text, problems)?;
    for set in overrides {
        set.apply(sources, &mut tree, problems);
    }
    let end = sources.end(file);
    allow_no_stop(&mut tree, end);
    let found = take(&mut tree, sections, problems);
    let mut contents = vec![];
    for (section, node, place) in &found {
        let own = own_tables(section, node);
        let content = content(sources, section, &without(node, &own), problems);
        contents.push((content, own, *place));
    }
    let root = with_sections(sections);
    let plan = of_tree(sources, &root, &tree, end, problems)?;
    let mut entries = vec![];
    let mut swept = !plan.axes.is_empty();
    for (content, own, span) in contents {
        let plan = if own.is_empty() {
            Some(plan.clone())
        } else if swept {
            None
        } else {
            let mut tree = tree.clone();
            for (key, node) in own {
                tree.set(&[(key, span)], node);
            }
            let plan = of_tree(sources, &root, &tree, end, problems);
            plan.filter(|plan| {
                swept = !plan.axes.is_empty();
                if swept {
                    let axes = plan.axes.join(", ");
                    let message = format!("this table is about one scene, but sweeps {axes}");
                    problems.push(span, message, None);
                }
                !swept
            })
        };
        if let (Some(content), Some(plan)) = (content, plan) {
            let sources = sources.clone();
            let place = Place { sources, span };
            entries.push(Entry {
                content,
                plan,
                place,
            });
        }
    }
    entries.sort_by_key(|entry| entry.place.span);
    Some((plan, entries))
}

/// What a run needs and a question does not.
fn allow_no_stop(tree: &mut Table, end: Span) {
    if tree.get("stop").is_none() {
        let once = Given::Table(Values::new(vec![("tosses", Given::Integer(1))]));
        tree.set(&[("stop".to_owned(), end)], Node::of_value(end, &once));
    }
}

/// The schema of the scene, in which messages also know the names of the sections.
fn with_sections<T>(sections: &[Section<T>]) -> TableKind {
    let mut root = schema::root();
    root.fields.extend(sections.iter().map(|section| {
        let kind = Kind::Table(section.kind.clone());
        field(section.name, section.doc, kind, Absent::Omitted)
    }));
    root
}

/// A section with one of its tables and where that stands.
type Found<'a, T> = (&'a Section<T>, Node, Span);

/// Takes the tables of the sections out of the tree.
fn take<'a, T>(
    tree: &mut Table,
    sections: &'a [Section<T>],
    problems: &mut Problems,
) -> Vec<Found<'a, T>> {
    let mut found = vec![];
    for section in sections {
        let Some(index) = tree.entries.iter().position(|e| e.key == section.name) else {
            continue;
        };
        let entry = tree.entries.remove(index);
        match entry.node.value {
            Value::List(nodes) if section.many => {
                found.extend(nodes.into_iter().map(|node| {
                    let span = node.span;
                    (section, node, span)
                }));
            }
            _ => found.push((section, entry.node, entry.key_span)),
        }
    }
    if let Some((_, _, span)) = found.get(MOST_ENTRIES) {
        let message = format!(
            "at most {MOST_ENTRIES} of these tables are allowed, found {}",
            found.len()
        );
        problems.push(*span, message, None);
        found.truncate(MOST_ENTRIES);
    }
    found
}

/// The tables of the scene that an entry replaces.
fn own_tables<T>(section: &Section<T>, node: &Node) -> Vec<(String, Node)> {
    let Value::Table(table) = &node.value else {
        return vec![];
    };
    let own = table.entries.iter();
    let own = own.filter(|entry| section.own.contains(&entry.key.as_str()));
    own.map(|entry| (entry.key.clone(), entry.node.clone()))
        .collect()
}

fn without(node: &Node, own: &[(String, Node)]) -> Node {
    let mut node = node.clone();
    if let Value::Table(table) = &mut node.value {
        table
            .entries
            .retain(|entry| !own.iter().any(|(key, _)| *key == entry.key));
    }
    node
}

/// Checks and reads an entry; `None` only after a problem.
fn content<T>(
    sources: &Sources,
    section: &Section<T>,
    node: &Node,
    problems: &mut Problems,
) -> Option<T> {
    let before = problems.count();
    let checked: Checked = walk::section(sources, problems, &section.kind, node, section.name);
    if problems.count() > before {
        return None;
    }
    let sweep = Sweep::none();
    match values::read(&checked, &At::new(&sweep, true), section.read) {
        Ok(content) => Some(content),
        Err(Fault::Reported) => None,
        Err(Fault::Problem {
            span,
            message,
            help,
        }) => {
            problems.push(span, message, help);
            None
        }
    }
}
