//! Coins given by lengths: their ratio H/R and their radius.

use super::checked::{Checked, CheckedValue};
use super::diagnostics::Problems;
use super::quantity::{Quantity, digits};
use coinmc_core::Coin;
use coinmc_core::schema::Bounds;

/// Digits of a number that is computed from others of the config: 23.25 mm over 2 is 0.011625 m.
const DIGITS: usize = 15;

/// The coin with `ratio` and `radius_m` in the place of other lengths.
pub(super) fn spelled_out(coin: &Checked, problems: &mut Problems) -> Checked {
    let CheckedValue::Table(given) = &coin.value else {
        return coin.clone();
    };
    let first = |keys: &[(&'static str, f64)]| {
        let found = keys.iter().find_map(|(key, factor)| {
            let checked = coin.get(key)?;
            Some((*key, checked.clone(), *factor))
        });
        found.map(|(key, mut checked, factor)| {
            if let CheckedValue::Number(quantity, _) = &mut checked.value
                && factor != 1.0
            {
                *quantity = quantity.map(|value| digits(value * factor, DIGITS));
            }
            (key, checked)
        })
    };
    let radius = first(&Coin::RADII).map_or_else(
        || {
            let default = CheckedValue::Number(Quantity::Constant(Coin::DEFAULT_RADIUS_M), None);
            Checked::new(coin.span, default)
        },
        |(_, radius)| radius,
    );
    let ratio = match first(&Coin::HEIGHTS) {
        Some((key, height)) => Some(over_radius(key, height, &radius, problems)),
        None => coin.get("ratio").cloned(),
    };
    let fields = Coin::schema().fields.into_iter();
    let entries = fields.filter_map(|field| {
        let key = field.name;
        let converted = [Coin::HEIGHTS.as_slice(), Coin::RADII.as_slice()].concat();
        match key {
            "ratio" => ratio.clone().map(|ratio| (key, ratio)),
            "radius_m" => Some((key, radius.clone())),
            _ if converted.iter().any(|(other, _)| *other == key) => None,
            _ => {
                let found = given.iter().find(|(name, _)| *name == key);
                found.map(|(_, checked)| (key, checked.clone()))
            }
        }
    });
    Checked::new(coin.span, CheckedValue::Table(entries.collect()))
}

/// The ratio of a height, which is a number or swept, and a radius, which is a number.
fn over_radius(
    key: &str,
    mut height: Checked,
    radius: &Checked,
    problems: &mut Problems,
) -> Checked {
    let (CheckedValue::Number(heights, _), CheckedValue::Number(radii, _)) =
        (&mut height.value, &radius.value)
    else {
        return Checked::invalid(height.span);
    };
    let Quantity::Constant(radius_m) = *radii else {
        let message = format!("`coin.{key}` does not go with a sweep of radii");
        let help = "give `ratio`, H/R: it is the same for all radii, or not, as you wish";
        problems.add_with_help(height.span, message, help);
        return Checked::invalid(height.span);
    };
    *heights = heights.map(|height_m| digits(height_m / radius_m, DIGITS));
    let bounds: Bounds = Coin::RATIO;
    let values = heights.values();
    let Some(bad) = values.iter().find(|ratio| !bounds.contains(**ratio)) else {
        return height;
    };
    let message = format!("with this `coin.{key}` H/R is {bad:e}: it must be {bounds}");
    problems.add(height.span, message);
    Checked::invalid(height.span)
}
