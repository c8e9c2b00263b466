//! All problems of a file, reported together.

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use std::fmt::{self, Write as _};
use std::ops::Range;

/// Greatest number of problems kept.
const MAX_PROBLEMS: usize = 50;
/// Greatest length of a quoted line, in characters; of longer lines, the part around the mark is
/// shown.
const MAX_QUOTE: usize = 160;

/// One problem of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Problem {
    /// The file.
    pub file: String,
    /// Line, from 1; 0 if the problem concerns the whole file.
    pub line: usize,
    /// Column in characters, from 1; 0 if the problem concerns the whole file.
    pub column: usize,
    /// The problem.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// The line and its bytes to mark.
    quote: Option<(String, Range<usize>)>,
}

/// All problems of a file in the order of their positions.
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
    /// A problem with a file as a whole.
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

    /// The messages as text, with or without colour (ANSI escapes).
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

/// Collects the problems of one file.
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

    /// Adds a problem with some bytes of a line, counted from 0.
    pub(super) fn add(
        &mut self,
        line: usize,
        bytes: Range<usize>,
        message: String,
        help: Option<String>,
    ) {
        if self.found.len() == MAX_PROBLEMS {
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

/// A printable excerpt of a line around the mark, and the position of the mark in it.
fn excerpt(text: &str, start: usize, end: usize) -> (String, Range<usize>) {
    let mut from = 0;
    if text[..start].chars().count() > MAX_QUOTE / 2 {
        from = text[..start]
            .char_indices()
            .nth_back(MAX_QUOTE / 2)
            .map_or(0, |(i, _)| i);
    }
    let to = text[start..]
        .char_indices()
        .nth(MAX_QUOTE / 2)
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

/// A file name without control characters.
fn printable(name: &str) -> String {
    name.chars()
        .flat_map(|c| match c {
            '"' | '\'' | '\\' => vec![c],
            _ => c.escape_debug().collect(),
        })
        .collect()
}

/// Untrusted text for a message: printable, of bounded length, in backquotes.
pub(super) fn quoted(text: &str) -> String {
    const MAX_CHARS: usize = 40;
    let shown: String = text
        .chars()
        .take(MAX_CHARS)
        .flat_map(char::escape_debug)
        .collect();
    let more = if text.chars().nth(MAX_CHARS).is_some() {
        "…"
    } else {
        ""
    };
    let shown = shown.replace("\\\"", "\"").replace("\\'", "'");
    format!("`{shown}{more}`")
}
