//! What is wrong with a text that is no TOML, in the words of who wrote it.

use super::source::{Sources, Span};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Most errors that are told of a text.
const MOST: usize = 10;

/// A mistake, and how to mend it if it is a usual one.
pub(super) struct Mistake {
    pub(super) span: Span,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

/// An error of the parser: where, and what.
pub(super) type ParseError = (Range<usize>, String);

/// The errors in a text, of which a parser found these, some of them twice: it does not read values behind a line
/// without a value, so the text is read again without such lines.
pub(super) fn all_errors(text: &str, mut errors: Vec<ParseError>) -> Vec<ParseError> {
    let mut rest = text.to_owned();
    let mut read = 0;
    for _ in 0..MOST {
        let unfinished = errors[read..].iter();
        let unfinished = unfinished.filter(|(_, message)| is_unfinished_line(message));
        let lines: Vec<_> = unfinished
            .map(|(range, _)| line_at(text, range.start))
            .collect();
        if lines.is_empty() {
            break;
        }
        for line in lines {
            rest.replace_range(line.clone(), &" ".repeat(line.len()));
        }
        read = errors.len();
        let (_, more) = DeTable::parse_recoverable(&rest);
        errors.extend(
            more.iter()
                .filter_map(|error| Some((error.span()?, error.message().to_owned()))),
        );
    }
    errors
}

/// The bytes of the line that holds this one, without its end.
fn line_at(text: &str, index: usize) -> Range<usize> {
    let index = text.floor_char_boundary(index);
    let start = text[..index].rfind('\n').map_or(0, |end| end + 1);
    let end = text[index..].find('\n').map_or(text.len(), |n| index + n);
    start..end
}

/// The mistakes in a text of which a parser found these errors: the first of each line, as what follows it in the line
/// follows from it; and none after a bracket or a quote that is not closed.
pub(super) fn mistakes(sources: &Sources, mut errors: Vec<(Span, &str)>) -> Vec<Mistake> {
    errors.sort_by_key(|(span, _)| *span);
    errors.dedup_by_key(|(span, _)| sources.place(*span).0);
    let open = errors.iter().position(|(_, message)| is_left_open(message));
    let told = errors
        .into_iter()
        .take(open.map_or(MOST, |open| open + 1).min(MOST));
    told.map(|(span, message)| {
        let (lines, first, marked) = sources.excerpt(span);
        let row = sources.place(span).0 - first;
        let line = lines.lines().nth(row);
        let start = line_at(lines, marked.start).start;
        Mistake {
            span,
            message: format!("this is no TOML: {message}"),
            help: line.and_then(|line| help_in(line, marked.start - start)),
        }
    })
    .collect()
}

/// Whether the parser leaves off at this error, which is of one line: a key without a value, or a header without its
/// bracket.
fn is_unfinished_line(message: &str) -> bool {
    let of_line = [
        "key with no value",
        "unclosed table",
        "unclosed array table",
    ];
    of_line.iter().any(|begin| message.starts_with(begin))
}

/// Whether the parser takes the lines after this error for a part of what is before it.
fn is_left_open(message: &str) -> bool {
    let of_more = ["array", "inline table", "between key-value pairs"];
    !is_unfinished_line(message) && of_more.iter().any(|word| message.contains(word))
}

/// How to write a line with an error at this byte.
fn help_in(line: &str, error: usize) -> Option<String> {
    match line.split_once('=') {
        Some((key, value)) if error > key.len() && !value.starts_with('=') => help(value),
        _ => help_to_join(line),
    }
}

/// How to join a key and its value.
fn help_to_join(line: &str) -> Option<String> {
    let line = line.split('#').next().unwrap_or(line).trim();
    let is_key = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let rest = line.trim_start_matches(is_key);
    let key = &line[..line.len() - rest.len()];
    if key.is_empty() {
        return None;
    }
    if rest == "]" {
        return Some(format!("the name of a table stands in brackets: `[{key}]`"));
    }
    let rest = rest.trim_start();
    let joins = ["->", ":=", "==", "=>", ":", "="];
    let value = joins.iter().find_map(|join| rest.strip_prefix(join));
    let value = value.unwrap_or(rest).trim();
    if DeValue::parse(value).is_ok() {
        Some(format!(
            "a key and its value are joined by `=`: `{key} = {value}`"
        ))
    } else {
        let example = "a key and its value are joined by `=`, as in `ratio = 1`";
        (!line.contains('=')).then(|| example.to_owned())
    }
}

/// How to write a value that is no TOML.
pub(super) fn help(value: &str) -> Option<String> {
    let value = value.split('#').next().unwrap_or(value).trim();
    let number = value.trim_start_matches(['-', '+']);
    let sign = &value[..value.len() - number.len()];
    let is_whole = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if let Some((whole, rest)) = number.split_once(',')
        && is_whole(whole)
        && is_whole(rest)
    {
        return Some(format!(
            "numbers have a decimal point: `{sign}{whole}.{rest}`"
        ));
    }
    if let Some((above, below)) = number.split_once('/')
        && is_whole(above.trim())
        && is_whole(below.trim())
    {
        return Some("a fraction is written as a decimal number, such as `0.5`".to_owned());
    }
    if let Some(rest) = number.strip_prefix('.')
        && is_whole(rest)
    {
        return Some(format!("a number begins with a digit: `{sign}0.{rest}`"));
    }
    if let Some(whole) = number.strip_suffix('.')
        && is_whole(whole)
    {
        return Some(format!("a digit follows the point: `{sign}{whole}.0`"));
    }
    if let Some(rest) = number.strip_prefix('0')
        && rest.starts_with(|c: char| c.is_ascii_digit() || c == '_')
        && rest.bytes().all(|byte| b"0123456789_.".contains(&byte))
    {
        let rest = rest.trim_start_matches(['0', '_']);
        let zero = if rest.starts_with(|c: char| c.is_ascii_digit()) {
            ""
        } else {
            "0"
        };
        return Some(format!(
            "a number has no zeros in front: `{sign}{zero}{rest}`"
        ));
    }
    if let Some(percent) = number.strip_suffix('%')
        && percent.trim().parse::<f64>().is_ok()
    {
        return Some("a percentage is written as a share, 50 % as `0.5`".to_owned());
    }
    let unit = number.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let has_digits = unit.len() < number.len();
    let is_word = |text: &str| {
        text.starts_with(char::is_alphabetic)
            && text
                .chars()
                .all(|c| c.is_alphanumeric() || "-_".contains(c))
    };
    if has_digits && unit.trim_start().starts_with(char::is_alphabetic) {
        return Some(
            "a number stands alone: its unit is in the name of the key, as in `radius_mm = 10`"
                .to_owned(),
        );
    }
    is_word(value).then(|| format!("text stands in quotes: `\"{value}\"`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_mistakes_are_mended() {
        for (value, mended) in [
            (" 0,5", "`0.5`"),
            ("-1,25 # a comma", "`-1.25`"),
            (".5", "`0.5`"),
            ("+.5", "`+0.5`"),
            ("1.", "`1.0`"),
            ("1/2", "fraction"),
            ("10 mm", "unit"),
            ("1.5cm", "unit"),
            ("robot", "`\"robot\"`"),
            ("clean-flat", "`\"clean-flat\"`"),
            ("010", "`10`"),
            ("-007.5", "`-7.5`"),
            ("00", "`0`"),
            ("00.5", "`0.5`"),
            ("50%", "`0.5`"),
        ] {
            let told = help(value).unwrap_or_default();
            assert!(told.contains(mended), "{value}: {told}");
        }
        for value in [
            "", "[1, 2", "\"robot", "{ a = 1", "1,2,3", "a b", "2_", "-_",
        ] {
            assert_eq!(help(value), None, "{value}");
        }
    }

    #[test]
    fn a_key_and_its_value_are_joined() {
        for (line, error, mended) in [
            ("ratio 1", 6, "`ratio = 1`"),
            ("ratio: 1 # a colon", 5, "`ratio = 1`"),
            ("ratio := -1", 6, "`ratio = -1`"),
            ("ratio == 1", 7, "`ratio = 1`"),
            ("ratio -> 1", 6, "`ratio = 1`"),
            ("ratio", 5, "as in"),
            ("coin]", 4, "`[coin]`"),
            ("ratio = 010", 8, "`10`"),
        ] {
            let told = help_in(line, error).unwrap_or_default();
            assert!(told.contains(mended), "{line}: {told}");
        }
        for (line, error) in [("a b = 1", 2), ("= 1", 0), ("", 0)] {
            assert_eq!(help_in(line, error), None, "{line}");
        }
    }

    #[test]
    fn reading_goes_on_behind_an_unfinished_line() {
        let text = "[coin\nratio 1\n'a' : 2\nx = 3mm\ny";
        let (_, errors) = DeTable::parse_recoverable(text);
        let first = errors.iter().map(|error| {
            let range = error.span().expect("a place");
            (range, error.message().to_owned())
        });
        let errors = all_errors(text, first.collect());
        let lines = errors
            .iter()
            .map(|(range, _)| text[..range.start].matches('\n').count());
        let mut lines: Vec<usize> = lines.collect();
        lines.sort_unstable();
        lines.dedup();
        assert_eq!(lines, [0, 1, 2, 3, 4]);
    }
}
