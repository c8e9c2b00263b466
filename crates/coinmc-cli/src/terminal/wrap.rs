//! Word wrap.

/// Wraps words to lines of `width` characters, with all lines but the first indented; ends in a line
/// feed. A word longer than a line has its own line.
pub(crate) fn wrapped(text: &str, width: usize, indent: usize) -> String {
    let (mut lines, mut used) = (String::new(), 0);
    for word in text.split(' ') {
        let length = word.chars().count();
        if used > 0 && used + 1 + length > width {
            lines += &format!("\n{:indent$}", "");
            used = 0;
        } else if used > 0 {
            lines.push(' ');
            used += 1;
        }
        lines += word;
        used += length;
    }
    lines + "\n"
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn long_texts_are_wrapped_under_their_first_line() {
        assert_eq!(wrapped("one two three", 20, 10), "one two three\n");
        assert_eq!(
            wrapped("one two three", 8, 10),
            "one two\n          three\n"
        );
        assert_eq!(wrapped("one two three", 8, 0), "one two\nthree\n");
        assert_eq!(wrapped("unbreakable", 3, 10), "unbreakable\n");
    }
}
