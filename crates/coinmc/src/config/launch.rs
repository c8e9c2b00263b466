//! Launches: expansion of presets, and distributions for a point.

use super::at::{Fault, get};
use super::checked::{Checked, CheckedValue};
use coinmc_core::{LaunchDistribution, Preset};

/// The launch with its preset expanded, except for values given in the config. Without a preset the
/// coin starts from rest unless a velocity is given.
pub(super) fn spelled_out(launch: &Checked) -> Checked {
    let CheckedValue::Table(entries) = &launch.value else {
        return launch.clone();
    };
    let (blamed, base) = match launch
        .get("preset")
        .map(|checked| (checked.span, checked.word()))
    {
        // with an invalid preset it is unknown what else is missing
        Some((_, None)) => return Checked::invalid(launch.span),
        Some((span, Some(name))) => {
            let preset = name.parse::<Preset>();
            (span, preset.map(|preset| preset.distribution().values()))
        }
        None => (launch.span, Ok(LaunchDistribution::defaults())),
    };
    let base = base.unwrap_or_default();
    let given = |key| entries.iter().find(|(name, _)| *name == key);
    let merged = LaunchDistribution::schema()
        .fields
        .into_iter()
        .filter_map(|field| {
            let key = field.name;
            if let Some((_, checked)) = given(key).filter(|_| key != "preset") {
                return Some((key, checked.clone()));
            }
            Some((key, Checked::of_value(blamed, base.get(key)?)))
        });
    Checked::new(launch.span, CheckedValue::Table(merged.collect()))
}

/// Rejects a launch that leaves the xz plane, and reports the part that does.
pub(super) fn require_planar(
    checked: &Checked,
    launch: &LaunchDistribution,
    engine: &str,
) -> Result<(), Fault> {
    if launch.is_planar() {
        return Ok(());
    }
    let (key, help) = if !launch.orientation.is_planar() {
        (
            "orientation",
            "orientation = { tilt_deg = … } or an axis with y = 0 stays in the plane",
        )
    } else if !launch.spin.is_planar() {
        (
            "spin",
            "spin = { about = { axis = [0, 1, 0], rate_rad_s = … } } stays in the plane",
        )
    } else {
        (
            "velocity_m_s",
            "the y component of the velocity must be the number 0",
        )
    };
    let message = format!(
        "engine.{engine} needs a launch in the xz plane, and this one's {} leaves it",
        if key == "velocity_m_s" {
            "velocity"
        } else {
            key
        }
    );
    let help = format!("the presets robot and clean-flat are flat; {help}");
    Err(Fault::Problem {
        span: get(checked, key)?.span,
        message,
        help: Some(help),
    })
}
