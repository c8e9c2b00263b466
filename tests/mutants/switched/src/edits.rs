//! Changes of a text that leave the rest as it is.

use proc_macro2::LineColumn;
use std::collections::BTreeMap;

/// A source and what is to be written into it. Expressions nest, so what several of them write at one place is in order:
/// what ends there, from inside out, before what begins there, from outside in.
pub(crate) struct Edits {
    source: String,
    /// Where each line begins.
    lines: Vec<usize>,
    endings: BTreeMap<usize, String>,
    beginnings: BTreeMap<usize, String>,
    /// Where a replaced stretch begins, where it ends, and what stands there instead.
    replaced: BTreeMap<usize, (usize, String)>,
}

impl Edits {
    pub(crate) fn of(source: &str) -> Self {
        let breaks = source.match_indices('\n').map(|(at, _)| at + 1);
        Self {
            source: source.to_owned(),
            lines: std::iter::once(0).chain(breaks).collect(),
            endings: BTreeMap::new(),
            beginnings: BTreeMap::new(),
            replaced: BTreeMap::new(),
        }
    }

    /// The byte at a place of the parser's, which counts lines from 1 and characters from 0.
    pub(crate) fn at(&self, place: LineColumn) -> usize {
        let start = self.lines[place.line - 1];
        let line = &self.source[start..];
        let within = line.char_indices().nth(place.column);
        start + within.map_or(line.len(), |(at, _)| at)
    }

    pub(crate) fn text(&self, from: usize, to: usize) -> &str {
        &self.source[from..to]
    }

    pub(crate) fn begin(&mut self, at: usize, text: &str) {
        self.beginnings.entry(at).or_default().push_str(text);
    }

    pub(crate) fn end(&mut self, at: usize, text: &str) {
        self.endings.entry(at).or_default().push_str(text);
    }

    pub(crate) fn replace(&mut self, from: usize, to: usize, text: String) {
        self.replaced.insert(from, (to, text));
    }

    /// The text with all changes.
    pub(crate) fn finish(mut self) -> String {
        let (mut text, mut at) = (String::new(), 0);
        loop {
            for inserted in [&self.endings, &self.beginnings] {
                text.push_str(inserted.get(&at).map_or("", String::as_str));
            }
            if let Some((to, instead)) = self.replaced.remove(&at) {
                text.push_str(&instead);
                at = to;
            } else if let Some(next) = self.source[at..].chars().next() {
                text.push(next);
                at += next.len_utf8();
            } else {
                return text;
            }
        }
    }
}
