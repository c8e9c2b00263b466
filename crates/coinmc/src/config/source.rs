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
    /// Where to show what is wrong with it, if not in the text itself.
    made_of: Option<MadeOf>,
}

/// The words of a user of which a program made the text of a source, `key=value`.
#[derive(Debug, Clone)]
struct MadeOf {
    /// The source of those words.
    words: usize,
    /// The key in the text.
    key: Range<usize>,
    /// Where those words have the key, if they do, and what else they say.
    key_in_words: Option<usize>,
    value_in_words: Range<usize>,
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
            made_of: None,
        });
        self.0.len() - 1
    }

    /// Adds a text `key=value` with its `=` here, that was made of these words: messages show those. They may say
    /// the key, its value behind an `=`, both or something else.
    pub(super) fn add_made(
        &mut self,
        (text, equals): (&str, usize),
        (name, words): (&str, &str),
    ) -> usize {
        let key = text[..equals].trim();
        let start = text.len() - text.trim_start().len();
        let value = words.find('=').map_or(0, |equals| equals + 1);
        let made_of = MadeOf {
            words: self.add(name, words),
            key: start..start + key.len(),
            key_in_words: words.find(key),
            value_in_words: value..words.len(),
        };
        let source = self.add(name, text);
        self.0[source].made_of = Some(made_of);
        source
    }

    /// Where to show what is wrong at this place: in the words of the user.
    pub(super) fn shown(&self, span: Span) -> Span {
        let Some(made_of) = &self.get(span).made_of else {
            return span;
        };
        let range = match made_of.key_in_words {
            Some(start) if span.end <= made_of.key.end => {
                let shift = |index: usize| start + index.saturating_sub(made_of.key.start);
                shift(span.start)..shift(span.end)
            }
            _ => made_of.value_in_words.clone(),
        };
        self.span(made_of.words, range)
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
    fn a_place_in_a_made_text_is_shown_in_the_words_of_the_user() {
        let shown = |words: &str, range: Range<usize>| {
            let mut sources = Sources::default();
            let made = sources.add_made(("a.bc=1.5", 4), ("--over", words));
            let span = sources.shown(sources.span(made, range));
            assert_eq!(&*sources.get(span).name, "--over");
            sources.text(span).to_owned()
        };
        assert_eq!(shown("a.bc=0..2", 2..4), "bc");
        assert_eq!(shown(" a.bc = 0..2", 0..1), "a");
        assert_eq!(shown("a.bc=0..2", 5..8), "0..2");
        assert_eq!(shown("a.bc", 2..4), "bc");
        assert_eq!(shown("a.bc", 5..8), "a.bc");
        assert_eq!(shown("robot", 2..4), "robot");
    }

    #[test]
    fn spans_outside_the_text_or_inside_a_character_are_cut() {
        let mut sources = Sources::default();
        let file = sources.add("a.toml", "µ");
        assert_eq!(sources.text(sources.span(file, 1..1)), "µ");
        assert_eq!(sources.text(sources.span(file, 7..9)), "");
    }
}
