//! Formulas for terminals that show ASCII only.

/// Characters beyond ASCII in our texts, and their spelling in ASCII.
const SPELLINGS: [(char, &str); 14] = [
    ('·', "*"),
    ('×', "x"),
    ('±', "+-"),
    ('−', "-"),
    ('²', "^2"),
    ('³', "^3"),
    ('½', "1/2"),
    ('°', " deg"),
    ('…', "..."),
    ('π', "pi"),
    ('α', "alpha"),
    ('μ', "mu"),
    ('ψ', "psi"),
    ('ω', "omega"),
];

/// The text in ASCII; characters without a spelling become question marks.
pub(crate) fn in_ascii(text: &str) -> String {
    let mut ascii = String::with_capacity(text.len());
    for c in text.chars() {
        match SPELLINGS.iter().find(|(symbol, _)| *symbol == c) {
            Some((_, spelling)) => ascii.push_str(spelling),
            None => ascii.push(if c.is_ascii() { c } else { '?' }),
        }
    }
    ascii
}

#[cfg(test)]
mod tests {
    use super::in_ascii;
    use coinmc_analytic::Rule;

    #[test]
    fn every_rule_can_be_spelled() {
        assert_eq!(in_ascii("(2/π)·atan(x/2) − ½"), "(2/pi)*atan(x/2) - 1/2");
        for rule in Rule::ALL {
            let texts = [rule.formula(), rule.assumption(), rule.source()];
            assert!(
                !texts.iter().any(|text| in_ascii(text).contains('?')),
                "{rule}"
            );
        }
    }

    #[test]
    fn the_rest_is_a_question_mark() {
        assert_eq!(in_ascii("naïve"), "na?ve");
    }
}
