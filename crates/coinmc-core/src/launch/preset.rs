//! Named launch distributions and their sources.

use super::{LaunchDistribution, Marginal, Orientation, Spin};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::str::FromStr;

/// A named launch distribution.
///
/// # Example
/// ```
/// use coinmc_core::Preset;
/// assert_eq!("robot".parse(), Ok(Preset::Robot));
/// assert!(Preset::Robot.distribution().is_planar());
/// assert!(!Preset::Clean.distribution().is_planar());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Preset {
    /// The coin-tossing robot: planar, tilt and spin uniform.
    Robot,
    /// The published Unity scene.
    Table1,
    /// The scene engines are compared on.
    Clean,
    /// `Clean` brought into the plane.
    CleanFlat,
    /// A vigorous toss by hand.
    Hand,
    /// A drop without spin.
    Drop,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 6] = [
        Self::Robot,
        Self::Table1,
        Self::Clean,
        Self::CleanFlat,
        Self::Hand,
        Self::Drop,
    ];

    /// The name used in configs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::Table1 => "table1",
            Self::Clean => "clean",
            Self::CleanFlat => "clean-flat",
            Self::Hand => "hand",
            Self::Drop => "drop",
        }
    }

    /// What it is and where it comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::Robot => {
                "Gaek & Sukhov, arXiv 2401.03557: spin 0-5 rev/s, start angle 0-180 degrees, both \
                 uniform. The drop from rest at 0.5 m is ours."
            }
            Self::Table1 => {
                "Gaek & Sukhov, arXiv 2401.03557, table 1 (Unity): centre at 5 m, upwards at \
                 16-24 m/s, three uniform Euler angles, each spin component within 50 rad/s."
            }
            Self::Clean => {
                "Ours, for comparing engines: from rest at 1 m, isotropic, each spin component \
                 normal with 20 rad/s."
            }
            Self::CleanFlat => {
                "Ours, for comparing flat engines: from rest at 1 m, uniform tilt, spin normal \
                 with 20 rad/s."
            }
            Self::Hand => {
                "Keller, Amer. Math. Monthly 93 (1986) 191: 2.4 m/s upwards, 238.6 rad/s, heads \
                 up; the 10 % spreads, the start at 1 m and psi = 81 +- 5 degrees (mean: the \
                 0.508 of Diaconis, Holmes & Montgomery 2007) are ours."
            }
            Self::Drop => {
                "Ours: from rest at 1 m, isotropic, without spin; the bounce alone sets the coin \
                 turning."
            }
        }
    }

    /// The distribution itself.
    pub fn distribution(self) -> LaunchDistribution {
        use Marginal::{Constant, Normal, Uniform};
        const REST: [Marginal; 3] = [Constant(0.0); 3];
        let from_rest = |height_m, orientation, spin| LaunchDistribution {
            height_m: Constant(height_m),
            velocity_m_s: REST,
            orientation,
            spin,
        };
        let about_y = |rate_rad_s| Spin::About {
            axis: Vector3::y_axis(),
            rate_rad_s,
        };
        match self {
            Self::Robot => from_rest(
                0.5,
                Orientation::Tilt(Uniform { from: 0.0, to: PI }),
                about_y(Uniform {
                    from: 0.0,
                    to: 5.0 * TAU,
                }),
            ),
            Self::Table1 => LaunchDistribution {
                height_m: Constant(5.0),
                velocity_m_s: [
                    Constant(0.0),
                    Constant(0.0),
                    Uniform {
                        from: 16.0,
                        to: 24.0,
                    },
                ],
                orientation: Orientation::EulerAngles,
                spin: Spin::Components(
                    [Uniform {
                        from: -50.0,
                        to: 50.0,
                    }; 3],
                ),
            },
            Self::Clean => from_rest(
                1.0,
                Orientation::Isotropic,
                Spin::Components(
                    [Normal {
                        mean: 0.0,
                        sd: 20.0,
                    }; 3],
                ),
            ),
            Self::Drop => from_rest(
                1.0,
                Orientation::Isotropic,
                Spin::Components([Constant(0.0); 3]),
            ),
            Self::CleanFlat => from_rest(
                1.0,
                Orientation::Tilt(Uniform { from: 0.0, to: TAU }),
                about_y(Normal {
                    mean: 0.0,
                    sd: 20.0,
                }),
            ),
            Self::Hand => LaunchDistribution {
                height_m: Constant(1.0),
                velocity_m_s: [
                    Constant(0.0),
                    Constant(0.0),
                    Normal {
                        mean: 2.4,
                        sd: 0.24,
                    },
                ],
                orientation: Orientation::Fixed(Vector3::z_axis()),
                spin: Spin::Precessing {
                    rate_rad_s: Normal {
                        mean: 238.6,
                        sd: 23.86,
                    },
                    psi_rad: Normal {
                        mean: 81.0_f64.to_radians(),
                        sd: 5.0_f64.to_radians(),
                    },
                },
            },
        }
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// No preset has this name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no such preset; the presets are {}", Preset::ALL.map(Preset::name).join(", "))]
pub struct UnknownPreset;

impl FromStr for Preset {
    type Err = UnknownPreset;

    fn from_str(name: &str) -> Result<Self, UnknownPreset> {
        Self::ALL
            .into_iter()
            .find(|preset| preset.name() == name)
            .ok_or(UnknownPreset)
    }
}
