//! The words that started the command, to be repeated in advice.

use std::ffi::OsString;
use std::sync::OnceLock;

static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Keeps the words for [`this_command`].
pub(crate) fn remember(words: &[OsString]) {
    // a second command in one process is only ever one of a test
    let _ = WORDS.set(words.to_vec());
}

/// The command line that started this process, for a shell.
pub(crate) fn this_command() -> String {
    let words = WORDS.get().into_iter().flatten();
    let words = words.map(|word| quoted(&word.to_string_lossy()));
    words.collect::<Vec<_>>().join(" ")
}

/// A word as a shell reads it back.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_only_where_a_shell_needs_it() {
        assert_eq!(quoted("--set=coin.ratio=1.2"), "--set=coin.ratio=1.2");
        assert_eq!(quoted("a b"), "'a b'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("[1, 2]"), "'[1, 2]'");
    }
}
