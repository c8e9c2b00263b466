//! The quantity of a launch that is integrated out in closed form.

use crate::passage::is_constant;
use coinmc_core::{LaunchDistribution, Marginal, Orientation, Spin};

/// A random quantity that is integrated out in closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variable {
    /// Azimuth of an isotropic axis about an angular velocity that does not depend on it.
    Azimuth,
    /// Tilt at launch of a planar toss.
    Tilt,
    /// Rate of a spin of known direction.
    Rate,
    /// Vertical velocity at launch.
    Velocity,
    /// Height at launch.
    Height,
}

impl Variable {
    /// A description for messages.
    pub fn description(self) -> &'static str {
        match self {
            Self::Azimuth => "the azimuth of the axis about the spin",
            Self::Tilt => "the tilt",
            Self::Rate => "the rate of spin",
            Self::Velocity => "the vertical velocity",
            Self::Height => "the height",
        }
    }
}

/// The random tilt of a coin that turns in the plane of its tilt.
pub(crate) fn planar_tilt(launches: &LaunchDistribution) -> Option<Marginal> {
    match launches.orientation {
        Orientation::Tilt(tilt) if launches.spin.is_planar() && !is_constant(&tilt) => Some(tilt),
        _ => None,
    }
}

/// The rate of a spin whose direction does not depend on the rate.
pub(crate) fn rate(spin: &Spin) -> Option<Marginal> {
    match *spin {
        Spin::About { rate_rad_s, .. } | Spin::Precessing { rate_rad_s, .. } => Some(rate_rad_s),
        Spin::Components(_) => None,
    }
}

/// The quantity to integrate out. Angles come first: over a whole turn the others hardly matter.
pub(crate) fn variable(launches: &LaunchDistribution) -> Option<Variable> {
    let random = |marginal: &Marginal| !is_constant(marginal);
    let isotropic = launches.orientation == Orientation::Isotropic;
    if isotropic && !matches!(launches.spin, Spin::Precessing { .. }) {
        Some(Variable::Azimuth)
    } else if planar_tilt(launches).is_some() {
        Some(Variable::Tilt)
    } else if rate(&launches.spin).is_some_and(|rate| random(&rate)) {
        Some(Variable::Rate)
    } else if random(&launches.velocity_m_s[2]) {
        Some(Variable::Velocity)
    } else if random(&launches.height_m) {
        Some(Variable::Height)
    } else {
        None
    }
}

/// The same launches with the quantity set to 1 (a rate) or 0: it is integrated out, and the others
/// do not depend on it.
pub(crate) fn without(launches: &LaunchDistribution, variable: Variable) -> LaunchDistribution {
    let mut rest = upright(launches);
    let none = Marginal::Constant(0.0);
    match variable {
        Variable::Azimuth => {}
        Variable::Tilt => rest.orientation = Orientation::Tilt(none),
        Variable::Rate => match &mut rest.spin {
            Spin::About { rate_rad_s, .. } | Spin::Precessing { rate_rad_s, .. } => {
                *rate_rad_s = Marginal::Constant(1.0);
            }
            Spin::Components(_) => {}
        },
        Variable::Velocity => rest.velocity_m_s[2] = none,
        Variable::Height => rest.height_m = none,
    }
    rest
}

/// The same launches without horizontal velocity, which changes only the place of the first
/// contact.
pub(crate) fn upright(launches: &LaunchDistribution) -> LaunchDistribution {
    let mut upright = *launches;
    upright.velocity_m_s[..2].fill(Marginal::Constant(0.0));
    upright
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn descriptions_name_the_quantity() {
        let all = [
            (Variable::Azimuth, "azimuth"),
            (Variable::Tilt, "tilt"),
            (Variable::Rate, "rate"),
            (Variable::Velocity, "vertical velocity"),
            (Variable::Height, "height"),
        ];
        for (variable, word) in all {
            let description = variable.description();
            assert!(description.starts_with("the ") && description.contains(word));
        }
    }
}
