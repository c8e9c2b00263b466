//! "Did you mean …?"

/// The candidate that was most likely meant, if any is near: one that starts with the text
/// (`gravity` for `gravity_m_s2`), or the one with the fewest typing errors.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // longer words cannot be near; this also bounds the work
    if word.is_empty() || word.len() > 64 {
        return None;
    }
    let word = word.to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let begins = candidate
            .strip_prefix(&word)
            .is_some_and(|rest| rest.starts_with(['_', '-']));
        let distance = if begins {
            0
        } else {
            typing_errors(&word, candidate)
        };
        let longer = word.chars().count().max(candidate.len());
        // typing errors seldom are in the first letter: `marble` is not meant to be `table`
        let same_start = word.chars().next() == candidate.chars().next();
        let allowed = if same_start { (longer / 3).max(1) } else { 1 };
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Whether a word is a name with one typing error at most, in whatever case.
pub(super) fn is_same_but_one(word: &str, name: &str) -> bool {
    word.len() <= 64 && typing_errors(&word.to_lowercase(), name) <= 1
}

/// Optimal string alignment: insertions, deletions, replacements and swaps of neighbours.
fn typing_errors(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = [
            "ratio",
            "radius_m",
            "restitution",
            "friction",
            "gravity_m_s2",
        ];
        for (typed, meant) in [
            ("ratoi", Some("ratio")),
            ("radius", Some("radius_m")),
            ("gravity", Some("gravity_m_s2")),
            ("Friction", Some("friction")),
            ("frction", Some("friction")),
            ("riction", Some("friction")),
            ("eriction", Some("friction")),
            ("diction", None),
            ("bounce", None),
            ("", None),
        ] {
            assert_eq!(nearest(typed, names), meant, "{typed}");
        }
    }

    #[test]
    fn typing_errors_are_counted() {
        for (a, b, n) in [
            ("", "abc", 3),
            ("abc", "acb", 1),
            ("kitten", "sitting", 3),
            ("a", "a", 0),
        ] {
            assert_eq!(
                (typing_errors(a, b), typing_errors(b, a)),
                (n, n),
                "{a} {b}"
            );
        }
    }
}
