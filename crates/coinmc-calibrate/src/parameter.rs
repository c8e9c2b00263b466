//! The numbers of a surface that are calibrated.

use coinmc_core::{EngineDescriptor, EngineKind, Roughness, Surface};

/// A number of a surface that is calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Coefficient of restitution e.
    Restitution,
    /// Coefficient of friction μ.
    Friction,
    /// Rolling friction length ρ_c, m.
    RollingFriction,
    /// Pivoting friction length ρ_p, m.
    PivotingFriction,
    /// Rms slope s of rough ground; its wavelength is not calibrated.
    RoughnessSlope,
}

impl Parameter {
    /// All of them, in the order of every table and array.
    pub const ALL: [Self; 5] = [
        Self::Restitution,
        Self::Friction,
        Self::RollingFriction,
        Self::PivotingFriction,
        Self::RoughnessSlope,
    ];

    /// Its key in the table `[surface]`.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::Friction => "friction",
            Self::RollingFriction => "rolling_friction_m",
            Self::PivotingFriction => "pivoting_friction_m",
            Self::RoughnessSlope => "roughness_slope",
        }
    }

    /// Its name in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::Friction => "friction",
            Self::RollingFriction => "rolling friction",
            Self::PivotingFriction => "pivoting friction",
            Self::RoughnessSlope => "slope of the ground",
        }
    }

    /// Its unit; `1` for a plain number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Restitution | Self::Friction | Self::RoughnessSlope => "1",
            Self::RollingFriction | Self::PivotingFriction => "m",
        }
    }

    /// The parameters on which tosses on such a surface depend: an engine in the plane knows no friction
    /// lengths, and a plane has no slope.
    pub fn of_scene(engine: &EngineDescriptor, surface: &Surface) -> Vec<Self> {
        let known = match engine.kind {
            EngineKind::Planar => 2,
            EngineKind::Spatial | EngineKind::ClosedForm if surface.roughness().is_none() => 4,
            EngineKind::Spatial | EngineKind::ClosedForm => 5,
        };
        Self::ALL[..known].to_vec()
    }

    /// Its value on a surface.
    pub fn of_surface(self, surface: &Surface) -> f64 {
        match self {
            Self::Restitution => surface.restitution(),
            Self::Friction => surface.friction(),
            Self::RollingFriction => surface.rolling_friction_m(),
            Self::PivotingFriction => surface.pivoting_friction_m(),
            Self::RoughnessSlope => surface.roughness().map_or(0.0, |ground| ground.slope()),
        }
    }

    /// The greatest number that it may be; infinite if there is none.
    pub(crate) const fn most(self) -> f64 {
        match self {
            Self::Restitution => 1.0,
            Self::RoughnessSlope => Roughness::MAX_SLOPE,
            _ => f64::INFINITY,
        }
    }

    /// Whether it lies between 0 and 1 and has the scale of a share.
    const fn is_share(self) -> bool {
        matches!(self, Self::Restitution)
    }

    /// The number on the scale on which its prior is normal: ln(e/(1 − e)) for the restitution, else the
    /// logarithm.
    pub fn to_scale(self, value: f64) -> f64 {
        if self.is_share() {
            libm::log(value / (1.0 - value))
        } else {
            libm::log(value)
        }
    }

    /// Back from that scale.
    pub fn from_scale(self, scaled: f64) -> f64 {
        if self.is_share() {
            1.0 / (1.0 + libm::exp(-scaled))
        } else {
            libm::exp(scaled)
        }
    }

    /// ln |d(scaled)/d(value)|.
    pub fn log_stretch(self, value: f64) -> f64 {
        if self.is_share() {
            -libm::log(value * (1.0 - value))
        } else {
            -libm::log(value)
        }
    }

    /// Whether a number can be its value.
    pub fn allows(self, value: f64) -> bool {
        value > 0.0
            && value.is_finite()
            && value <= self.most()
            && !(self.is_share() && value >= 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_lead_there_and_back() {
        for parameter in Parameter::ALL {
            for value in [1e-6, 0.1, 0.9] {
                let scaled = parameter.to_scale(value);
                let back = parameter.from_scale(scaled);
                assert!((back / value - 1.0).abs() < 1e-12);
                let step = 1e-6;
                let slope = (parameter.from_scale(scaled + step)
                    - parameter.from_scale(scaled - step))
                    / (2.0 * step);
                assert!((libm::log(slope) + parameter.log_stretch(value)).abs() < 1e-6);
            }
        }
    }
}
