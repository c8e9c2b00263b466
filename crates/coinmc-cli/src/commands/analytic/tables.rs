//! The listings: which closed form fills which column.

use super::listing::{Field, Listing};
use coinmc_analytic::keller::{self, HeadsBand};
use coinmc_analytic::precession::{thick, thin};
use coinmc_analytic::{FaceProbabilities, Rule};

const NONE_EXISTS: &str = "none: no ratio has this P(side)";

/// Every rule with its formula, fair ratio, assumption and source.
pub(super) fn rules(rules: &[Rule]) -> Listing {
    let fields = vec![
        Field::text("rule", "rule"),
        Field::number("fair_ratio", "fair H/R"),
        Field::text("p_side", "P(side), x = H/R").droppable(1),
        Field::text("assumption", "assumes").droppable(2),
        Field::text("source", "source").droppable(3),
    ];
    let note = "fair H/R: the ratio at which P(side) is 1/3";
    let mut listing = Listing::new("rules", fields, note);
    for rule in rules {
        listing.push(vec![
            rule.name().into(),
            rule.fair_ratio(1.0 / 3.0).into(),
            rule.formula().into(),
            rule.assumption().into(),
            rule.source().into(),
        ]);
    }
    listing
}

/// Probabilities of each rule at each ratio.
pub(super) fn probabilities(rules: &[Rule], ratios: &[f64]) -> Listing {
    let fields = with_probabilities(vec![Field::text("rule", "rule")]);
    let mut listing = Listing::new("probabilities", fields, "");
    for &ratio in ratios {
        for rule in rules {
            let p = rule.probabilities(ratio);
            listing.push(vec![
                rule.name().into(),
                ratio.into(),
                p.heads.into(),
                p.tails.into(),
                p.side.into(),
            ]);
        }
    }
    listing
}

/// The ratio of each rule at which P(side) is the target.
pub(super) fn fair_ratios(rules: &[Rule], target: f64) -> Listing {
    let fields = vec![
        Field::text("rule", "rule"),
        Field::given("target", "P(side)"),
        Field::number("ratio", "H/R"),
        Field::text("assumption", "assumes").droppable(1),
    ];
    let mut listing = Listing::new("fair_ratios", fields, "");
    for rule in rules {
        // A rod without end has no ratio to print.
        let ratio = Some(rule.fair_ratio(target)).filter(|ratio| ratio.is_finite());
        listing.push(vec![
            rule.name().into(),
            target.into(),
            ratio.into(),
            rule.assumption().into(),
        ]);
    }
    listing
}

/// Probabilities of the thick precessing coin.
pub(super) fn precession_probabilities(psi_deg: &[f64], ratios: &[f64]) -> Listing {
    let fields = with_probabilities(vec![Field::given("psi_deg", "ψ, deg")]);
    let note = "thick coin, started heads up, landing without a bounce";
    let mut listing = Listing::new("precession_probabilities", fields, note);
    for &ratio in ratios {
        for &psi in psi_deg {
            let FaceProbabilities { heads, tails, side } =
                thick::probabilities(ratio, psi.to_radians());
            listing.push(vec![
                psi.into(),
                ratio.into(),
                heads.into(),
                tails.into(),
                side.into(),
            ]);
        }
    }
    listing
}

/// Ratios at which the thick precessing coin's P(side) is the target.
pub(super) fn precession_fair_ratios(psi_deg: &[f64], target: f64) -> Listing {
    let fields = vec![
        Field::given("psi_deg", "ψ, deg"),
        Field::given("target", "P(side)"),
        Field::number("ratio", "H/R"),
    ];
    let ratio_at = |psi: f64| {
        Some(thick::fair_ratio(target, psi.to_radians())).filter(|ratio| ratio.is_finite())
    };
    let all_exist = psi_deg.iter().all(|&psi| ratio_at(psi).is_some());
    let note = if all_exist { "" } else { NONE_EXISTS };
    let mut listing = Listing::new("precession_fair_ratios", fields, note);
    for &psi in psi_deg {
        listing.push(vec![psi.into(), target.into(), ratio_at(psi).into()]);
    }
    listing
}

/// The thin precessing coin, caught by hand.
pub(super) fn precession_thin(psi_deg: &[f64]) -> Listing {
    let fields = vec![
        Field::given("psi_deg", "ψ, deg"),
        Field::number("p_same_side", "P(same face)"),
        Field::number("p_other_side", "P(other face)"),
    ];
    let note = "thin coin, caught: how likely it shows the face it started with";
    let mut listing = Listing::new("precession_thin", fields, note);
    for &psi in psi_deg {
        let radians = psi.to_radians();
        listing.push(vec![
            psi.into(),
            thin::p_same_side(radians).into(),
            thin::p_other_side(radians).into(),
        ]);
    }
    listing
}

/// Where one toss falls among Keller's bands.
pub(super) fn keller(speed_m_s: f64, spin_rad_s: f64, gravity_m_s2: f64) -> Listing {
    let fields = vec![
        Field::given("speed_m_s", "speed, m/s"),
        Field::given("spin_rad_s", "spin, rad/s"),
        Field::given("gravity_m_s2", "gravity, m/s²").droppable(1),
        Field::number("half_turns", "half-turns"),
        Field::text("face", "face"),
        Field::number("heads_from_rad_s", "heads from"),
        Field::number("heads_to_rad_s", "to, rad/s"),
    ];
    let note = "heads from … to: the nearest band of spins that show heads at this speed";
    let mut listing = Listing::new("keller", fields, note);
    // Adding zero makes −0 a plain 0.
    let half_turns = keller::half_turns(speed_m_s, spin_rad_s, gravity_m_s2) + 0.0;
    // A speed and spin whose product overflows turn no countable number of times.
    let turns = libm::round(half_turns.abs() / 2.0);
    let countable = turns <= f64::from(u32::MAX);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just above
    let band = countable.then(|| HeadsBand::after_turns(turns as u32, speed_m_s, gravity_m_s2));
    let face = if keller::is_heads(half_turns) {
        "heads"
    } else {
        "tails"
    };
    let edge = |edge: fn(&HeadsBand) -> f64| band.as_ref().map(edge).filter(|x| x.is_finite());
    listing.push(vec![
        speed_m_s.into(),
        spin_rad_s.into(),
        gravity_m_s2.into(),
        Some(half_turns).filter(|h| h.is_finite()).into(),
        countable.then_some(face).into(),
        edge(|band| band.slowest_rad_s).into(),
        edge(|band| band.fastest_rad_s).into(),
    ]);
    listing
}

fn with_probabilities(mut fields: Vec<Field>) -> Vec<Field> {
    fields.extend([
        Field::given("ratio", "H/R"),
        Field::number("p_heads", "P(heads)"),
        Field::number("p_tails", "P(tails)"),
        Field::number("p_side", "P(side)"),
    ]);
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keller_says_tails_between_two_bands() {
        let row = &keller(2.4, 238.6, 9.81).to_json()["rows"][0];
        assert_eq!(row["face"], "tails");
        // 37.16 half-turns: the band of 19 turns begins at 37.5
        let from = row["heads_from_rad_s"].as_f64().unwrap();
        assert!((from / 238.6 - 37.5 / 37.163).abs() < 1e-4, "{from}");
    }

    #[test]
    fn keller_survives_extremes() {
        for (speed, spin) in [(0.0, 1.0), (1e300, 1e300), (1e-300, -1e-300), (1.0, 0.0)] {
            let row = &keller(speed, spin, 9.81).to_json()["rows"][0];
            assert!(row["speed_m_s"].is_number());
        }
    }

    #[test]
    fn a_target_out_of_reach_is_null() {
        let listing = fair_ratios(&Rule::ALL, 1.0);
        assert!(listing.to_json()["rows"][0]["ratio"].is_null());
        let listing = precession_fair_ratios(&[0.0, 90.0], 0.5);
        assert!(listing.to_json()["rows"][0]["ratio"].is_null());
        assert!((listing.to_json()["rows"][1]["ratio"].as_f64().unwrap() - 2.0).abs() < 1e-12);
    }
}
