//! The texts that make up a config, and locations in them.

use std::ops::Range;
use std::sync::Arc;

/// A range of one source, in bytes. Ordered by location: the file first, then the overrides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Span {
    source: usize,
    start: usize,
    end: usize,
}

/// One text with its name in messages.
#[derive(Debug, Clone)]
pub(super) struct Source {
    pub(super) name: Arc<str>,
    pub(super) text: Arc<str>,
}

/// The config file and, after it, every override.
#[derive(Debug, Clone, Default)]
pub(super) struct Sources(Vec<Source>);

impl Sources {
    /// Adds a text and returns its number.
    pub(super) fn add(&mut self, name: &str, text: &str) -> usize {
        self.0.push(Source {
            name: name.into(),
            text: text.into(),
        });
        self.0.len() - 1
    }

    pub(super) fn get(&self, span: Span) -> &Source {
        &self.0[span.source]
    }

    /// A range of a source, clipped to its length and to whole characters.
    pub(super) fn span(&self, source: usize, range: Range<usize>) -> Span {
        let text = &self.0[source].text;
        let start = text.floor_char_boundary(range.start);
        let end = text.ceil_char_boundary(range.end.max(start));
        Span { source, start, end }
    }

    /// Just after the last character that is not blank, where a missing table would go.
    pub(super) fn end(&self, source: usize) -> Span {
        let end = self.0[source].text.trim_end().len();
        Span {
            source,
            start: end,
            end,
        }
    }

    pub(super) fn text(&self, span: Span) -> &str {
        &self.get(span).text[span.start..span.end]
    }

    /// Line and column of the start, both from 1, the column in characters.
    pub(super) fn place(&self, span: Span) -> (usize, usize) {
        end_place(&self.get(span).text[..span.start])
    }

    /// The lines around a span, the number of the first, and the span within them: a message
    /// quotes these few, however long the source.
    pub(super) fn excerpt(&self, span: Span) -> (&str, usize, Range<usize>) {
        let text = &self.get(span).text;
        let line_start = text[..span.start]
            .rfind('\n')
            .map_or(0, |newline| newline + 1);
        let line_end = text[span.start..]
            .find('\n')
            .map_or(text.len(), |n| span.start + n);
        // the line before shows the context
        let before = text[..line_start.saturating_sub(1)].rfind('\n');
        let start = before.map_or(0, |newline| newline + 1);
        let first = text[..start].bytes().filter(|byte| *byte == b'\n').count() + 1;
        let end = span.end.min(line_end).max(span.start);
        (
            &text[start..line_end],
            first,
            span.start - start..end - start,
        )
    }
}

/// Line and column, both from 1, of what follows a text.
pub(super) fn end_place(before: &str) -> (usize, usize) {
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_and_lines_from_one() {
        let mut sources = Sources::default();
        let file = sources.add("a.toml", "µ = 1\nβγ = 2\n\n");
        let at = |range| sources.place(sources.span(file, range));
        assert_eq!(at(0..2), (1, 1));
        assert_eq!(at(5..6), (1, 5));
        assert_eq!(at(12..13), (2, 4));
        assert_eq!(sources.place(sources.end(file)), (2, 7));
        assert_eq!(
            sources.excerpt(sources.span(file, 12..13)),
            ("µ = 1\nβγ = 2", 1, 12..13)
        );
    }

    #[test]
    fn spans_outside_the_text_or_inside_a_character_are_cut() {
        let mut sources = Sources::default();
        let file = sources.add("a.toml", "µ");
        assert_eq!(sources.text(sources.span(file, 1..1)), "µ");
        assert_eq!(sources.text(sources.span(file, 7..9)), "");
    }
}
