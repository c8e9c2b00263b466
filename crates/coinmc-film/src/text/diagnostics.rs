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
    let from = text[..start]
        .char_indices()
        .nth_back(MAX_QUOTE / 2)
        .map_or(0, |(i, _)| i);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Short lines are quoted whole, and the mark lies where it was.
    #[test]
    fn a_short_line_is_quoted_whole() {
        let text = "0.1\tO.19\t2";
        assert_eq!(excerpt(text, 4, 8), ("0.1 O.19 2".to_owned(), 4..8));
        let (line, mark) = excerpt("θθ x", 5, 6);
        assert_eq!((line.as_str(), &line[mark]), ("θθ x", "x"));
    }

    /// Of a long one 80 characters before the mark and 80 from there on, however many bytes they take.
    #[test]
    fn a_long_line_is_quoted_around_the_mark() {
        for (letter, bytes) in [("a", 1), ("é", 2)] {
            let text = [&letter.repeat(500), "mark", &letter.repeat(500)].concat();
            let (line, mark) = excerpt(&text, 500 * bytes, 500 * bytes + 4);
            assert_eq!(&line[mark.clone()], "mark");
            assert_eq!(line[..mark.start].chars().count(), 81);
            assert_eq!(line[mark.start..].chars().count(), 80);
            // a line of just so many is not cut
            let text = [&letter.repeat(80), "mark", &letter.repeat(76)].concat();
            assert_eq!(excerpt(&text, 80 * bytes, 80 * bytes + 4).0, text);
            let wide = "m".repeat(300);
            let (line, mark) = excerpt(&wide, 0, 300);
            assert_eq!((line.len(), mark), (80, 0..80));
        }
    }

    /// Fifty are kept, in order of their places, and the rest counted; those of other files follow.
    #[test]
    fn problems_beyond_fifty_are_counted() {
        let lines = ["a b"; 60];
        let mut problems = Problems::new("a.txt", &lines);
        assert!(problems.is_empty());
        for line in (0..60).rev() {
            problems.add(line, 2..3, "wrong".to_owned(), None);
        }
        assert!(!problems.is_empty());
        let mut all = problems.finish();
        assert_eq!((all.problems().len(), all.problems()[0].line), (50, 11));
        assert_eq!(all.problems()[0].column, 3);
        let text = all.to_string();
        assert_eq!(text.matches("wrong").count(), 50);
        assert!(
            text.contains("a.txt:11:3") && text.ends_with("\n\nand 10 more"),
            "{text}"
        );
        let other = Diagnostics::of_file("b.txt", "empty", None);
        assert!(!other.to_string().contains("more"));
        all.append(other);
        assert_eq!(all.problems().len(), 51);
        assert!(all.to_string().contains("b.txt"));
        all.append(all.clone());
        assert!(all.to_string().ends_with("and 20 more"));
    }

    /// Names of files may hold anything; quotes and backslashes are printed as they are.
    #[test]
    fn control_characters_of_names_are_escaped() {
        assert_eq!(
            printable("C:\\it's \"a\"\u{7}\n"),
            "C:\\it's \"a\"\\u{7}\\n"
        );
        assert_eq!(quoted("it's \u{1b}\"a\""), "`it's \\u{1b}\"a\"`");
        assert_eq!(quoted(&"x".repeat(40)), format!("`{}`", "x".repeat(40)));
        assert_eq!(quoted(&"x".repeat(41)), format!("`{}…`", "x".repeat(40)));
    }
}
