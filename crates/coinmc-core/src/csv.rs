//! Cells of CSV files.

use std::borrow::Cow;

/// A cell of a CSV file, in quotes where it must be (RFC 4180).
///
/// # Example
/// ```
/// use coinmc_core::csv_cell;
/// assert_eq!(csv_cell("P(side)"), "P(side)");
/// assert_eq!(csv_cell("hand, on \"wood\""), "\"hand, on \"\"wood\"\"\"");
/// ```
pub fn csv_cell(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_would_end_a_cell_is_quoted() {
        for text in ["", "x", "two words", "1.5 ± 0.1"] {
            assert_eq!(csv_cell(text), text);
        }
        for text in ["a,b", "a\nb", "a\rb"] {
            assert_eq!(csv_cell(text), format!("\"{text}\""));
        }
        assert_eq!(csv_cell("\""), "\"\"\"\"");
    }
}
