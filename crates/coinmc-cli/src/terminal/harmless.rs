//! Text from outside (configs, journals, names of files, what a camera says) without the characters
//! that a terminal obeys: everything printed passes through here.

use std::borrow::Cow;
use std::fmt::Write;

/// The text with its control characters shown instead of sent: `\u{1b}` for an escape. Line ends, tabs
/// and colours (escape sequences that end in `m`) stay; the program's own sequences are only these.
pub(crate) fn harmless(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = if c == '\u{1b}' { color(rest) } else { None };
        let (piece, after) = rest.split_at(length.unwrap_or(c.len_utf8()));
        if length.is_none() && is_obeyed(c) {
            shown.extend(c.escape_unicode());
        } else {
            shown.push_str(piece);
        }
        rest = after;
    }
    Cow::Owned(shown)
}

/// A JSON document in which these characters, that only its strings may hold, are escaped as JSON has it.
pub(crate) fn harmless_json(document: &str) -> Cow<'_, str> {
    if !document.chars().any(is_obeyed) {
        return Cow::Borrowed(document);
    }
    let mut shown = String::with_capacity(document.len() + 16);
    for c in document.chars() {
        if is_obeyed(c) {
            // all are below 2^16
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Control characters, and those that reorder text.
fn is_obeyed(c: char) -> bool {
    let reorders =
        matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    (c.is_control() && c != '\n' && c != '\t') || reorders
}

/// Length of the colour that the text begins with: at most three short numbers, none of which hides
/// text.
fn color(text: &str) -> Option<usize> {
    let body = text.strip_prefix("\u{1b}[")?;
    let end = body.find(|c: char| !c.is_ascii_digit() && c != ';')?;
    let numbers: Vec<&str> = body[..end].split(';').collect();
    let known = |number: &&str| {
        matches!(
            number.parse(),
            Ok(0_u8..=2 | 4 | 22 | 24 | 30..=39 | 90..=97)
        ) || number.is_empty()
    };
    let fits = body[end..].starts_with('m') && numbers.len() <= 3 && numbers.iter().all(known);
    fits.then_some(2 + end + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a terminal would obey is escaped, and the document says the same.
    #[test]
    fn a_document_stays_json() {
        for name in [
            "plain ± text",
            "gnp.\u{202e}exe",
            "\u{7f}\u{9b}2J",
            "\u{1b}[33m",
            "a\nb\t\u{200f}",
        ] {
            let document = serde_json::json!({ "out": name });
            let text = format!("{document:#}");
            let shown = harmless_json(&text);
            assert!(!shown.chars().any(is_obeyed), "{shown}");
            let read: serde_json::Value = serde_json::from_str(&shown).expect("JSON");
            assert_eq!(read, document);
        }
    }

    #[test]
    fn what_a_terminal_would_obey_is_shown() {
        for same in [
            "plain ± text\n\tmore",
            "\u{1b}[33m\u{1b}[1mwarning:\u{1b}[0m",
            "",
        ] {
            assert_eq!(harmless(same), same);
        }
        for (bad, shown) in [
            ("\u{1b}]0;title\u{7}", "\\u{1b}]0;title\\u{7}"),
            ("\u{1b}[2J", "\\u{1b}[2J"),
            ("\u{1b}[8mhidden", "\\u{1b}[8mhidden"),
            ("a\rb\u{8}", "a\\u{d}b\\u{8}"),
            ("\u{9b}2J\u{7f}", "\\u{9b}2J\\u{7f}"),
            ("gnp.\u{202e}exe", "gnp.\\u{202e}exe"),
            ("\u{1b}", "\\u{1b}"),
        ] {
            assert_eq!(harmless(bad), shown);
        }
    }
}
