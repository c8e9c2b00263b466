//! The part of a run that one of several machines computes.

use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Part `index` of `of`, counted from 1: the chunks whose turn is `index - 1` modulo `of`, the full
/// ones of all points first, then the shorter last ones.
///
/// # Example
/// ```
/// use coinmc::run::Part;
/// let part: Part = "2/4".parse()?;
/// assert_eq!((part.index(), part.of()), (2, 4));
/// assert_eq!("1/1".parse(), Ok(Part::WHOLE));
/// assert_eq!("5/4".parse::<Part>().unwrap_err().to_string(), "part 5/4: 1 <= i <= n is required");
/// # Ok::<(), coinmc::run::PartError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Part {
    index: u32,
    of: u32,
}

/// Why a text is not a valid part.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PartError {
    /// Not two whole numbers separated by a slash.
    #[error("a part is written i/n, as in 2/4, not `{0}`")]
    Form(String),
    /// The index is not between 1 and the number of parts.
    #[error("part {index}/{of}: 1 <= i <= n is required")]
    Range {
        /// The index found.
        index: u32,
        /// The number of parts found.
        of: u32,
    },
}

impl Part {
    /// The whole run.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Part `index` of `of`, counted from 1.
    ///
    /// # Errors
    /// [`PartError::Range`] unless 1 <= `index` <= `of`.
    pub fn new(index: u32, of: u32) -> Result<Self, PartError> {
        if (1..=of).contains(&index) {
            Ok(Self { index, of })
        } else {
            Err(PartError::Range { index, of })
        }
    }

    /// The number of the part, from 1.
    pub fn index(self) -> u32 {
        self.index
    }

    /// The number of parts.
    pub fn of(self) -> u32 {
        self.of
    }

    /// Whether the chunk with this turn belongs to this part.
    pub(super) fn owns(self, turn: u64) -> bool {
        turn % u64::from(self.of) == u64::from(self.index - 1)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Part {
    type Err = PartError;

    fn from_str(text: &str) -> Result<Self, PartError> {
        let number = |digits: &str| {
            // `parse` alone would accept a sign
            digits
                .bytes()
                .all(|b| b.is_ascii_digit())
                .then(|| digits.parse().ok())
                .flatten()
        };
        text.split_once('/')
            .and_then(|(index, of)| Some((number(index)?, number(of)?)))
            .ok_or_else(|| PartError::Form(text.chars().take(40).collect()))
            .and_then(|(index, of)| Self::new(index, of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_read_back_and_nonsense_is_refused() {
        for text in ["1/1", "3/7", "4294967295/4294967295"] {
            assert_eq!(text.parse::<Part>().unwrap().to_string(), text);
        }
        for bad in [
            "",
            "1",
            "/",
            "1/",
            "/1",
            "+1/2",
            "1/2/3",
            " 1/2",
            "1/4294967296",
            "a/b",
        ] {
            assert!(
                matches!(bad.parse::<Part>(), Err(PartError::Form(_))),
                "{bad}"
            );
        }
        for bad in ["0/1", "0/0", "1/0", "3/2"] {
            assert!(
                matches!(bad.parse::<Part>(), Err(PartError::Range { .. })),
                "{bad}"
            );
        }
    }

    #[test]
    fn every_chunk_belongs_to_exactly_one_part() {
        for chunk in 0..20 {
            let owners = (1..=3)
                .filter(|&i| Part::new(i, 3).unwrap().owns(chunk))
                .count();
            assert_eq!(owners, 1);
        }
    }
}
