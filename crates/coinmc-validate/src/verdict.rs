//! What was found of a claim, and the numbers that it rests on.

use coinmc::results::Row;
use coinmc_core::Estimate;

/// What was found of a claim.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// It holds wherever it was tested.
    Holds,
    /// It holds only there, in words.
    HoldsWhere(String),
    /// It is contradicted.
    Rejected,
    /// It was not tested, and why.
    NotValidated(String),
}

impl Verdict {
    /// The verdict in words, without the condition.
    ///
    /// # Example
    /// ```
    /// use coinmc_validate::Verdict;
    /// assert_eq!(Verdict::HoldsWhere("e = 0.3".to_owned()).name(), "holds only where");
    /// ```
    pub fn name(&self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsWhere(_) => "holds only where",
            Self::Rejected => "rejected",
            Self::NotValidated(_) => "not validated",
        }
    }

    /// Where it holds, or why it was not tested.
    pub fn condition(&self) -> Option<&str> {
        match self {
            Self::HoldsWhere(text) | Self::NotValidated(text) => Some(text),
            Self::Holds | Self::Rejected => None,
        }
    }

    /// It holds if `all` cases agree, only in those of `agreeing` if some do, else it is rejected.
    pub(crate) fn of_cases(agreeing: &[String], all: usize) -> Self {
        match agreeing.len() {
            0 => Self::Rejected,
            some if some == all => Self::Holds,
            _ => Self::HoldsWhere(agreeing.join("; ")),
        }
    }
}

/// A number that a verdict rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// What it is, with its unit.
    pub what: String,
    /// The number.
    pub value: f64,
    /// Its interval of 95 %; `None` where it has no error.
    pub interval: Option<[f64; 2]>,
    /// Tosses that it rests on; 0 where it needs none.
    pub tosses: u64,
}

impl Evidence {
    /// A number without error.
    pub(crate) fn exact(what: impl Into<String>, value: f64) -> Self {
        Self {
            what: what.into(),
            value,
            interval: None,
            tosses: 0,
        }
    }

    /// An estimated probability.
    pub(crate) fn estimate(what: impl Into<String>, estimate: &Estimate, tosses: u64) -> Self {
        Self {
            what: what.into(),
            value: estimate.p,
            interval: Some([estimate.lo, estimate.hi]),
            tosses,
        }
    }

    /// P(side) of a point.
    pub(crate) fn p_side(what: impl AsRef<str>, row: &Row) -> Self {
        let what = format!("P(side), {}", what.as_ref());
        Self::estimate(what, &row.side, row.tally.tosses())
    }
}

/// What was found, and on what grounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What was found.
    pub verdict: Verdict,
    /// The grounds.
    pub evidence: Vec<Evidence>,
}

impl Finding {
    /// A claim that was not tested.
    pub(crate) fn not_validated(why: impl Into<String>) -> Self {
        Self {
            verdict: Verdict::NotValidated(why.into()),
            evidence: vec![],
        }
    }

    /// All tosses that the evidence rests on.
    pub fn tosses(&self) -> u64 {
        self.evidence.iter().map(|number| number.tosses).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_holds_in_the_cases_that_agree() {
        let cases = |n: usize| (0..n).map(|i| format!("case {i}")).collect::<Vec<_>>();
        assert_eq!(Verdict::of_cases(&cases(3), 3), Verdict::Holds);
        assert_eq!(Verdict::of_cases(&[], 3), Verdict::Rejected);
        let some = Verdict::of_cases(&cases(2), 3);
        assert_eq!(some.condition(), Some("case 0; case 1"));
    }
}
