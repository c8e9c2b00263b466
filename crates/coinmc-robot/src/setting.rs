//! Settings of a throw: spin and start angle in the units of the link.

use coinmc_core::Launch;
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// Greatest spin of the protocol, 1/1000 rev/s.
pub const MAX_SPIN_MREV_S: u16 = 5000;

/// Greatest start angle, 1/100 degree.
pub const MAX_ANGLE_CDEG: u16 = 18_000;

/// Rounding error in a config's numbers that does not count as exceeding a limit, in link units.
const SLACK: f64 = 1e-6;

/// Spin and start angle of one throw, as transmitted.
///
/// The robot turns the coin about a horizontal axis. The **start angle** is the tilt of the coin's
/// axis u (the outward normal of heads) from the vertical: 0° is heads up, 90° is on edge, 180° is
/// tails up. With the axis of rotation along y that is u = (sin θ, 0, cos θ), and a positive spin
/// turns u from the vertical towards +x, so that θ grows while the coin falls: the launch of the
/// preset `robot`.
///
/// # Example
/// ```
/// use coinmc_robot::Setting;
/// let setting = Setting::new(3200, 9000)?;            // 3.2 rev/s, starting on edge
/// assert_eq!(setting.spin_rev_s(), 3.2);
/// assert_eq!(setting.angle_deg(), 90.0);
/// assert!(Setting::new(5001, 0).is_err());
/// # Ok::<(), coinmc_robot::SettingError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Setting {
    spin_mrev_s: u16,
    angle_cdeg: u16,
}

/// Why a setting is invalid.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SettingError {
    /// The spin.
    #[error("a spin of {0} rev/s is out of the robot's range: give 0 to 5 rev/s")]
    Spin(f64),
    /// The start angle.
    #[error("a start angle of {0} degrees is out of the robot's range: give 0 to 180 degrees")]
    Angle(f64),
}

impl Setting {
    /// A setting in the units of the link.
    ///
    /// # Errors
    /// [`SettingError`] outside 0 to 5000 mrev/s and 0 to 18 000 cdeg.
    pub fn new(spin_mrev_s: u16, angle_cdeg: u16) -> Result<Self, SettingError> {
        Self::nearest(f64::from(spin_mrev_s) / 1e3, f64::from(angle_cdeg) / 1e2)
    }

    /// The setting nearest to a spin, rev/s, and a start angle, degrees.
    ///
    /// # Errors
    /// [`SettingError`] outside the robot's range.
    pub fn nearest(spin_rev_s: f64, angle_deg: f64) -> Result<Self, SettingError> {
        let spin_mrev_s = steps(spin_rev_s * 1e3, MAX_SPIN_MREV_S);
        let angle_cdeg = steps(angle_deg * 1e2, MAX_ANGLE_CDEG);
        Ok(Self {
            spin_mrev_s: spin_mrev_s.ok_or(SettingError::Spin(spin_rev_s))?,
            angle_cdeg: angle_cdeg.ok_or(SettingError::Angle(angle_deg))?,
        })
    }

    /// The setting nearest to a launch in the plane.
    ///
    /// # Errors
    /// [`SettingError`] if the launch's spin about y or tilt is outside the robot's range.
    pub fn of_launch(launch: &Launch) -> Result<Self, SettingError> {
        let angle = libm::atan2(launch.axis.x, launch.axis.z);
        Self::nearest(launch.spin_rad_s.y / TAU, angle * (180.0 / PI))
    }

    /// Spin, 1/1000 rev/s.
    pub fn spin_mrev_s(self) -> u16 {
        self.spin_mrev_s
    }

    /// Start angle, 1/100 degree.
    pub fn angle_cdeg(self) -> u16 {
        self.angle_cdeg
    }

    /// Spin, rev/s.
    pub fn spin_rev_s(self) -> f64 {
        f64::from(self.spin_mrev_s) / 1e3
    }

    /// Start angle, degrees.
    pub fn angle_deg(self) -> f64 {
        f64::from(self.angle_cdeg) / 1e2
    }

    /// The launch with this spin and angle in place of its own.
    pub fn applied_to(self, launch: &Launch) -> Launch {
        let (sin, cos) = libm::sincos(self.angle_deg() * (PI / 180.0));
        Launch {
            axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
            spin_rad_s: Vector3::new(0.0, self.spin_rev_s() * TAU, 0.0),
            ..*launch
        }
    }
}

/// Rounds to a whole number of steps from 0 to `max`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn steps(value: f64, max: u16) -> Option<u16> {
    let inside = value >= -SLACK && value <= f64::from(max) + SLACK;
    // the cast saturates, and the value is within the range except for rounding
    inside.then(|| (libm::round(value).max(0.0) as u16).min(max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Domain, Preset, Stream};
    use proptest::prelude::*;

    #[test]
    fn the_ends_of_the_range_are_included() {
        let max = Setting::nearest(5.0 + 1e-12, 180.0 + 1e-12).unwrap();
        assert_eq!((max.spin_mrev_s(), max.angle_cdeg()), (5000, 18_000));
        let least = Setting::nearest(-1e-12, -0.0).unwrap();
        assert_eq!((least.spin_mrev_s(), least.angle_cdeg()), (0, 0));
        for bad in [-0.001, 5.001, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Setting::nearest(bad, 0.0),
                Err(SettingError::Spin(_))
            ));
        }
        for bad in [-0.01, 180.01, f64::NAN, f64::NEG_INFINITY] {
            assert!(matches!(
                Setting::nearest(0.0, bad),
                Err(SettingError::Angle(_))
            ));
        }
    }

    #[test]
    fn launches_of_the_preset_are_rounded_to_the_nearest_step() {
        let (coin, stream) = (
            Coin::cylinder(1.0, 0.01).unwrap(),
            Stream::new(5, Domain::Launch, 0),
        );
        for toss in 0..1000 {
            let launch = Preset::Robot
                .distribution()
                .launch(&coin, &mut stream.toss(toss));
            let again = Setting::of_launch(&launch).unwrap().applied_to(&launch);
            assert!((again.spin_rad_s.y - launch.spin_rad_s.y).abs() <= TAU * 0.5e-3 * 1.000_001);
            let turned = again.axis.dot(&launch.axis);
            assert!(turned > 1.0 - 5e-9, "{turned}"); // half a hundredth of a degree
            assert_eq!(again.height_m, launch.height_m);
        }
    }

    proptest! {
        #[test]
        fn a_setting_applied_to_a_launch_reads_back(spin in 0..=MAX_SPIN_MREV_S, angle in 0..=MAX_ANGLE_CDEG) {
            let setting = Setting::new(spin, angle).unwrap();
            prop_assert_eq!((setting.spin_mrev_s(), setting.angle_cdeg()), (spin, angle));
            let launch = Preset::Robot.distribution().launch(
                &Coin::cylinder(1.0, 0.01).unwrap(),
                &mut Stream::new(1, Domain::Launch, 0).toss(0),
            );
            prop_assert_eq!(Setting::of_launch(&setting.applied_to(&launch)), Ok(setting));
        }
    }
}
