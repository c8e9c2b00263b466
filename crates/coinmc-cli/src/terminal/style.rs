//! Width, colours and characters of terminal output.

use anstyle::{AnsiColor, Style as Ansi};
use clap::ColorChoice;
use console::Term;
use std::env;
use std::io::IsTerminal;

/// Columns where the width is unknown.
const DEFAULT_WIDTH: usize = 100;
/// Least width of a layout; a narrower terminal wraps lines.
const MIN_WIDTH: usize = 60;
const MAX_WIDTH: usize = 500;

/// One colour per curve, distinct also on a terminal of 16 colours.
const CURVES: [AnsiColor; 6] = [
    AnsiColor::Cyan,
    AnsiColor::Yellow,
    AnsiColor::Green,
    AnsiColor::Magenta,
    AnsiColor::Red,
    AnsiColor::Blue,
];

/// What the terminal (or the file) behind a stream can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Style {
    /// Whether to use escape sequences.
    pub(crate) color: bool,
    /// Whether to use characters beyond ASCII.
    pub(crate) unicode: bool,
    /// Columns.
    pub(crate) width: usize,
    /// Whether tables are written whole, however wide and long: for programs and files.
    pub(crate) whole: bool,
}

/// What a colour marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Colors {
    /// Titles.
    Strong,
    /// Secondary text.
    Faint,
    /// Warnings.
    Warning,
    /// The n-th curve of a plot.
    Curve(usize),
}

impl Style {
    /// The style of standard output.
    pub(crate) fn stdout(choice: ColorChoice) -> Self {
        Self::of(choice, std::io::stdout().is_terminal(), &Term::stdout())
    }

    /// The style of standard error.
    pub(crate) fn stderr(choice: ColorChoice) -> Self {
        Self::of(choice, std::io::stderr().is_terminal(), &Term::stderr())
    }

    fn of(choice: ColorChoice, is_terminal: bool, term: &Term) -> Self {
        let variable = |name: &str| env::var(name).ok().filter(|value| !value.is_empty());
        let terminal_width = || term.size_checked().map(|(_, columns)| usize::from(columns));
        Self {
            color: wants_color(
                choice,
                is_terminal,
                variable("NO_COLOR").is_some(),
                variable("TERM").as_deref(),
            ),
            unicode: speaks_unicode(
                ["LC_ALL", "LC_CTYPE", "LANG"]
                    .into_iter()
                    .find_map(variable)
                    .as_deref(),
            ),
            width: variable("COLUMNS")
                .and_then(|columns| columns.parse().ok())
                .or_else(|| is_terminal.then(terminal_width).flatten())
                .unwrap_or(DEFAULT_WIDTH)
                .clamp(MIN_WIDTH, MAX_WIDTH),
            whole: !is_terminal && variable("COLUMNS").is_none(),
        }
    }

    /// `text` in a colour, if there are colours.
    pub(crate) fn paint(&self, role: Colors, text: &str) -> String {
        if !self.color || text.is_empty() {
            return text.to_owned();
        }
        let ansi = match role {
            Colors::Strong => Ansi::new().bold(),
            Colors::Faint => Ansi::new().dimmed(),
            Colors::Warning => AnsiColor::Yellow.on_default().bold(),
            Colors::Curve(n) => CURVES[n % CURVES.len()].on_default(),
        };
        format!("{ansi}{text}{ansi:#}")
    }

    /// "± ", the sign before half the width of an interval.
    pub(crate) fn plus_minus(&self) -> &'static str {
        if self.unicode { "±" } else { "+-" }
    }

    /// The mark of something left out.
    pub(crate) fn ellipsis(&self) -> &'static str {
        if self.unicode { "…" } else { "..." }
    }
}

fn wants_color(choice: ColorChoice, is_terminal: bool, no_color: bool, term: Option<&str>) -> bool {
    match choice {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => is_terminal && !no_color && term != Some("dumb"),
    }
}

/// A locale that names another character set, or the bare C locale, gets ASCII; no locale at all
/// (containers) gets Unicode, which today's terminals show.
fn speaks_unicode(locale: Option<&str>) -> bool {
    locale.is_none_or(|locale| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    })
}

#[cfg(test)]
impl Style {
    /// A style for tests: no colour, Unicode.
    pub(crate) fn plain(width: usize) -> Self {
        Self {
            color: false,
            unicode: true,
            width,
            whole: false,
        }
    }

    /// The same in ASCII.
    pub(crate) fn ascii(width: usize) -> Self {
        Self {
            unicode: false,
            ..Self::plain(width)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_is_for_terminals_that_did_not_decline_it() {
        use ColorChoice::{Always, Auto, Never};
        assert!(wants_color(Auto, true, false, Some("xterm")));
        assert!(!wants_color(Auto, false, false, None));
        assert!(!wants_color(Auto, true, true, None));
        assert!(!wants_color(Auto, true, false, Some("dumb")));
        assert!(wants_color(Always, false, true, Some("dumb")));
        assert!(!wants_color(Never, true, false, None));
    }

    #[test]
    fn only_a_locale_that_cannot_spell_gets_ascii() {
        assert!(speaks_unicode(None) && speaks_unicode(Some("de_AT.UTF-8")));
        assert!(speaks_unicode(Some("C.utf8")));
        assert!(!speaks_unicode(Some("C")) && !speaks_unicode(Some("en_US.ISO-8859-1")));
    }

    #[test]
    fn paint_leaves_text_alone_without_colour() {
        assert_eq!(Style::plain(80).paint(Colors::Warning, "x"), "x");
        let painted = Style {
            color: true,
            ..Style::plain(80)
        }
        .paint(Colors::Strong, "x");
        assert_eq!(painted, "\u{1b}[1mx\u{1b}[0m");
    }
}
