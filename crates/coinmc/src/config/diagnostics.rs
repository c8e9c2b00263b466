//! All problems of a config, reported at once.

use super::source::{Source, Sources, Span};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::fmt;

/// Largest number of problems kept; more would not help to repair a config.
const KEPT: usize = 100;

/// One problem of a config.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Problem {
    /// The file; `--set` for an override, or what it was [made of](super::Override::made_of).
    pub source: String,
    /// Line, from 1; 0 if the problem has no location in the text (such as a missing file).
    pub line: usize,
    /// Column in characters, from 1; 0 like `line`.
    pub column: usize,
    /// What was found and what is allowed.
    pub message: String,
    /// How to fix it.
    pub help: Option<String>,
    /// The lines to quote, the number of the first and the bytes to mark.
    quote: Option<Quote>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Quote {
    lines: String,
    first_line: usize,
    marked: std::ops::Range<usize>,
}

/// All problems of a config, sorted by location. [`Display`](fmt::Display) and
/// [`render`](Self::render) quote the lines with a caret under the token.
///
/// # Example
/// ```
/// let problems = coinmc::config::parse("toss.toml", "sede = 1", &[]).unwrap_err();
/// assert_eq!((problems.problems()[0].line, problems.problems()[0].column), (1, 1));
/// assert!(problems.render(false).contains("did you mean `seed`?"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostics {
    problems: Vec<Problem>,
    /// Number of problems found beyond those kept.
    dropped: usize,
}

impl Diagnostics {
    /// A problem of a file as a whole.
    pub(super) fn of_file(name: &str, message: String, help: Option<String>) -> Self {
        let problem = Problem {
            source: name.to_owned(),
            line: 0,
            column: 0,
            message,
            help,
            quote: None,
        };
        Self {
            problems: vec![problem],
            dropped: 0,
        }
    }

    /// The same with a location in text that cannot be quoted.
    pub(super) fn at(mut self, line: usize, column: usize) -> Self {
        for problem in &mut self.problems {
            (problem.line, problem.column) = (line, column);
        }
        self
    }

    /// These problems, and then more.
    #[must_use]
    pub fn and(mut self, more: Self) -> Self {
        self.dropped += more.dropped;
        for problem in more.problems {
            if self.problems.len() < KEPT {
                self.problems.push(problem);
            } else {
                self.dropped += 1;
            }
        }
        self
    }

    /// The problems, sorted by location: those of the file, then those of overrides. At most 100
    /// are kept.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// The messages in readable form, with or without colour (ANSI escapes).
    pub fn render(&self, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        }
        .decor_style(DecorStyle::Ascii);
        let mut text = self
            .problems
            .iter()
            .map(|problem| renderer.render(&[problem.group()]))
            .collect::<Vec<_>>()
            .join("\n\n");
        if self.dropped > 0 {
            text += "\n\nand ";
            text += &self.dropped.to_string();
            text += " more";
        }
        text
    }
}

impl Problem {
    fn group(&self) -> Group<'_> {
        let title = Level::ERROR.primary_title(self.message.as_str());
        let mut group = match &self.quote {
            Some(quote) => title.element(
                Snippet::source(quote.lines.as_str())
                    .path(self.source.as_str())
                    .line_start(quote.first_line)
                    .fold(false)
                    .annotation(AnnotationKind::Primary.span(quote.marked.clone())),
            ),
            None if self.line > 0 => title.element(
                Origin::path(self.source.as_str())
                    .line(self.line)
                    .char_column(self.column),
            ),
            None => title.element(Origin::path(self.source.as_str())),
        };
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        group
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

/// Collects problems while a config is read.
#[derive(Debug, Default)]
pub(super) struct Problems {
    found: Vec<(Span, String, Option<String>)>,
    dropped: usize,
}

impl Problems {
    pub(super) fn add(&mut self, span: Span, message: impl Into<String>) {
        self.push(span, message.into(), None);
    }

    pub(super) fn add_with_help(
        &mut self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push(span, message.into(), Some(help.into()));
    }

    pub(super) fn push(&mut self, span: Span, message: String, help: Option<String>) {
        if self.found.len() < KEPT {
            self.found.push((span, message, help));
        } else {
            self.dropped += 1;
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    pub(super) fn count(&self) -> usize {
        self.found.len() + self.dropped
    }

    /// The finished list, sorted by location; problems at one location keep their order.
    pub(super) fn finish(mut self, sources: &Sources) -> Diagnostics {
        self.found.sort_by_key(|(span, ..)| *span);
        let problems = self
            .found
            .into_iter()
            .map(|(span, message, help)| {
                let span = sources.shown(span);
                let Source { name, .. } = sources.get(span);
                let (line, column) = sources.place(span);
                let (lines, first_line, marked) = sources.excerpt(span);
                let quote = Quote {
                    lines: lines.to_owned(),
                    first_line,
                    marked,
                };
                Problem {
                    source: name.to_string(),
                    line,
                    column,
                    message,
                    help,
                    quote: Some(quote),
                }
            })
            .collect();
        Diagnostics {
            problems,
            dropped: self.dropped,
        }
    }
}

/// A file name without characters that control a terminal.
pub(super) fn printable(name: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\'' | '\\' => vec![c],
        _ => c.escape_debug().collect(),
    };
    name.chars().flat_map(escaped).collect()
}

/// User text for a message: on one line, printable, of bounded length, in backquotes.
pub(super) fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text
        .chars()
        .take(LONGEST)
        .flat_map(char::escape_debug)
        .collect();
    // escape_debug also escapes quotes, which need no escape here
    shown = shown.replace("\\\"", "\"").replace("\\'", "'");
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}
