//! Everything that is wrong with a file, said at once.

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use std::fmt::{self, Write as _};
use std::ops::Range;

/// Problems kept; a file with more is not repaired by reading on.
const KEPT: usize = 50;
/// Longest line quoted, in characters; of longer ones the surroundings of the mark are shown.
const QUOTED: usize = 160;

/// One problem of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Problem {
    /// The file.
    pub file: String,
    /// Line, from 1; 0 if the problem has no place in the text.
    pub line: usize,
    /// Column in characters, from 1; 0 like `line`.
    pub column: usize,
    /// What was found and what is allowed.
    pub message: String,
    /// How to mend it.
    pub help: Option<String>,
    /// The line, and the bytes of it to mark.
    quote: Option<(String, Range<usize>)>,
}

/// All problems of a file, in the order of their places.
///
/// # Example
/// ```
/// use coinmc_film::text::{Choice, read};
/// let problems = read("a.txt", b"t\ty\ttheta\n0\t0.2\t1,5,0\n", &Choice::default()).unwrap_err();
/// assert_eq!((problems.problems()[0].line, problems.problems()[0].column), (2, 7));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostics {
    problems: Vec<Problem>,
    dropped: usize,
}

impl Diagnostics {
    /// A problem of a file as a whole.
    pub fn of_file(file: &str, message: impl Into<String>, help: Option<String>) -> Self {
        let problem = Problem {
            file: printable(file),
            line: 0,
            column: 0,
            message: message.into(),
            help,
            quote: None,
        };
        Self {
            problems: vec![problem],
            dropped: 0,
        }
    }

    /// The problems; at most 50 are kept.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Adds the problems of another file.
    pub fn append(&mut self, other: Self) {
        self.problems.extend(other.problems);
        self.dropped += other.dropped;
    }

    /// The messages as a person reads them, with or without colour (ANSI escapes).
    pub fn render(&self, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        }
        .decor_style(DecorStyle::Ascii);
        let rendered = self
            .problems
            .iter()
            .map(|problem| problem.render(&renderer));
        let mut text = rendered.collect::<Vec<_>>().join("\n\n");
        if self.dropped > 0 {
            let _ = write!(text, "\n\nand {} more", self.dropped);
        }
        text
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

impl Problem {
    fn render(&self, renderer: &Renderer) -> String {
        let title = Level::ERROR.primary_title(self.message.as_str());
        let mut group = match &self.quote {
            Some((line, marked)) => title.element(
                Snippet::source(line.as_str())
                    .path(self.file.as_str())
                    .line_start(self.line)
                    .fold(false)
                    .annotation(AnnotationKind::Primary.span(marked.clone())),
            ),
            None => title.element(Origin::path(self.file.as_str())),
        };
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        renderer.render(&[group])
    }
}

/// Gathers the problems of one file.
#[derive(Debug)]
pub(super) struct Problems<'a> {
    file: String,
    lines: &'a [&'a str],
    found: Vec<Problem>,
    dropped: usize,
}

impl<'a> Problems<'a> {
    pub(super) fn new(file: &str, lines: &'a [&'a str]) -> Self {
        Self {
            file: printable(file),
            lines,
            found: Vec::new(),
            dropped: 0,
        }
    }

    /// A problem of some bytes of a line, counted from 0.
    pub(super) fn add(
        &mut self,
        line: usize,
        bytes: Range<usize>,
        message: String,
        help: Option<String>,
    ) {
        if self.found.len() == KEPT {
            self.dropped += 1;
            return;
        }
        let text = self.lines.get(line).copied().unwrap_or("");
        let start = text.floor_char_boundary(bytes.start);
        let end = text
            .ceil_char_boundary(bytes.end.max(start))
            .min(text.len());
        let column = text[..start].chars().count() + 1;
        self.found.push(Problem {
            file: self.file.clone(),
            line: line + 1,
            column,
            message,
            help,
            quote: Some(excerpt(text, start, end)),
        });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    pub(super) fn finish(mut self) -> Diagnostics {
        self.found
            .sort_by_key(|problem| (problem.line, problem.column));
        Diagnostics {
            problems: self.found,
            dropped: self.dropped,
        }
    }
}

/// A line made printable, and where the mark is in it; a long line is cut around the mark.
fn excerpt(text: &str, start: usize, end: usize) -> (String, Range<usize>) {
    let mut from = 0;
    if text[..start].chars().count() > QUOTED / 2 {
        from = text[..start]
            .char_indices()
            .nth_back(QUOTED / 2)
            .map_or(0, |(i, _)| i);
    }
    let to = text[start..]
        .char_indices()
        .nth(QUOTED / 2)
        .map_or(text.len(), |(i, _)| start + i);
    let clean = |part: &str| part.replace(|c: char| c.is_control(), " ");
    let (before, marked, after) = (
        clean(&text[from..start]),
        clean(&text[start..end.clamp(start, to)]),
        clean(&text[end.clamp(start, to)..to]),
    );
    let range = before.len()..before.len() + marked.len();
    (before + &marked + &after, range)
}

/// A file name without what would steer a terminal.
fn printable(name: &str) -> String {
    name.chars()
        .flat_map(|c| match c {
            '"' | '\'' | '\\' => vec![c],
            _ => c.escape_debug().collect(),
        })
        .collect()
}

/// Foreign text for a message: printable, of bounded length, in backquotes.
pub(super) fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let shown: String = text
        .chars()
        .take(LONGEST)
        .flat_map(char::escape_debug)
        .collect();
    let more = if text.chars().nth(LONGEST).is_some() {
        "…"
    } else {
        ""
    };
    let shown = shown.replace("\\\"", "\"").replace("\\'", "'");
    format!("`{shown}{more}`")
}
