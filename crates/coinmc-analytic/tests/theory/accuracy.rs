//! Round-off, against 80-digit references over 24 decades.

use coinmc_analytic::Rule;
use coinmc_analytic::precession::{thick, thin};

fn rows(table: &str) -> impl Iterator<Item = Vec<f64>> {
    table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
}

/// Relative error in units of 2⁻⁵², about one unit in the last place.
fn error(found: f64, expected: f64) -> f64 {
    if found == expected {
        0.0
    } else {
        (found - expected).abs() / expected / f64::EPSILON
    }
}

#[test]
fn side_and_faces_of_every_rule_are_good_to_a_few_units_in_the_last_place() {
    let mut worst = [(0.0f64, 0.0f64); 6];
    for row in rows(include_str!("reference/rules.csv")) {
        for (i, rule) in Rule::ALL.into_iter().enumerate() {
            let p = rule.probabilities(row[0]);
            worst[i].0 = worst[i].0.max(error(p.side, row[1 + 2 * i]));
            worst[i].1 = worst[i].1.max(error(p.faces(), row[2 + 2 * i]));
        }
    }
    // Roundings on the way, half a unit each at most but one for libm's functions: 3 and 3 (arc), 2
    // and 5 (zone), 2 and 2 (both shares), up to 14 (wells, each weight twice in the quotient).
    let allowed = [
        (2.0, 2.0),
        (2.0, 3.0),
        (1.5, 1.5),
        (1.5, 1.5),
        (6.0, 6.0),
        (6.0, 6.0),
    ];
    for ((rule, found), bound) in Rule::ALL.into_iter().zip(worst).zip(allowed) {
        println!("{rule:16} side {:.2}, faces {:.2} units", found.0, found.1);
        assert!(
            found.0 <= bound.0 && found.1 <= bound.1,
            "{rule}: {found:?} units"
        );
    }
}

#[test]
fn precessing_coin_is_as_good_as_its_inputs_allow() {
    let mut worst = 0.0f64;
    for row in rows(include_str!("reference/thick.csv")) {
        let p = thick::probabilities(row[0], row[1]);
        for (i, found) in [p.heads, p.tails, p.side].into_iter().enumerate() {
            // Some ten roundings of its own; each of a few roundings of sin α and cos 2ψ acts like
            // one of an input, which the condition number of the result multiplies.
            let scaled = error(found, row[2 + i]) / (1.0 + row[5 + i]);
            worst = worst.max(scaled);
            assert!(scaled <= 3.0, "{:?}: {found}, {scaled:.1} units", &row[..5]);
        }
    }
    println!("precession       {worst:.2} units over the condition number");
}

#[test]
fn thin_coin_keeps_its_digits_near_a_quarter_turn() {
    let mut worst = 0.0f64;
    for row in rows(include_str!("reference/thick.csv")).filter(|row| row[0] == 0.0) {
        let (psi, same, other) = (row[1], row[2], row[3]);
        worst = worst.max(error(thin::p_same_side(psi), same));
        worst = worst.max(error(thin::p_other_side(psi), other));
    }
    println!("thin precession  {worst:.2} units");
    // 2ψ is exact, so there is nothing to condition: a cosine, a root, an arc and a product.
    assert!(worst <= 3.0, "{worst} units");
}
