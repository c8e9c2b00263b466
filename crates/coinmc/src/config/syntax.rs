//! What is wrong with a text that is no TOML, in the words of who wrote it.

use super::source::{Sources, Span};

/// Most errors that are told of a text.
const MOST: usize = 10;

/// A mistake, and how to mend it if it is a usual one.
pub(super) struct Mistake {
    pub(super) span: Span,
    pub(super) message: String,
    pub(super) help: Option<String>,
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
        let (lines, first, _) = sources.excerpt(span);
        let line = lines.lines().nth(sources.place(span).0 - first);
        Mistake {
            span,
            message: format!("this is no TOML: {message}"),
            help: line.and_then(|line| help(line.split_once('=')?.1)),
        }
    })
    .collect()
}

/// Whether the parser takes the lines after this error for a part of what is before it.
fn is_left_open(message: &str) -> bool {
    ["array", "table", "unclosed", "missing"]
        .iter()
        .any(|word| message.contains(word))
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
    let unit = number.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let has_digits = unit.len() < number.len();
    let is_word = |text: &str| {
        text.chars()
            .all(|c| c.is_alphanumeric() || "-_".contains(c))
    };
    if has_digits && unit.trim_start().starts_with(char::is_alphabetic) {
        return Some(
            "a number stands alone: its unit is in the name of the key, as in `radius_mm = 10`"
                .to_owned(),
        );
    }
    (!value.is_empty() && is_word(value)).then(|| format!("text stands in quotes: `\"{value}\"`"))
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
        ] {
            let told = help(value).unwrap_or_default();
            assert!(told.contains(mended), "{value}: {told}");
        }
        for value in ["", "[1, 2", "\"robot", "{ a = 1", "1,2,3", "a b"] {
            assert_eq!(help(value), None, "{value}");
        }
    }
}
