//! How a coin came to end on its side: at rest as it landed, rolling, or spinning.

/// Bounds on the way that a coin rolls, in metres: what a [`Tally`](crate::Tally) counts.
pub const ROLL_BOUNDS_M: [f64; 7] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0];

/// What a coin did that ended on its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SideMotion {
    /// It came to rest where it landed: it neither rolled nor spun.
    Rested,
    /// It rolled along its side, by more than its radius.
    Rolled,
    /// It turned about the vertical, more than once.
    Spun,
}

/// The motion of a coin as it came onto its side: when sustained contact began with the coin leaning
/// towards its side, not to leave it again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OntoSide {
    /// Way along its side until rolling friction and drag stop the coin, m.
    pub rolls_m: f64,
    /// Turns about the vertical until pivoting friction and drag stop it, in revolutions.
    pub turns: f64,
    /// Whether turning about the vertical has more kinetic energy than rolling.
    pub turning_prevails: bool,
}

/// How a coin came to end on its side.
///
/// A coin that both rolls and spins is counted by what has the more energy.
///
/// # Example
/// ```
/// use coinmc_core::{OntoSide, SideEnding, SideMotion};
/// let wheel = OntoSide { rolls_m: 0.4, turns: 0.1, turning_prevails: false };
/// let ending = SideEnding::new(&wheel, 0.0116);
/// assert_eq!(ending.motion, SideMotion::Rolled);
/// // 1 cm, 3 cm, 10 cm and 30 cm
/// assert_eq!(ending.roll_bounds_passed, 4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SideEnding {
    /// What it did.
    pub motion: SideMotion,
    /// How many of [`ROLL_BOUNDS_M`] it rolled past, whatever else it did.
    pub roll_bounds_passed: u8,
}

impl SideEnding {
    /// A coin that came to rest where it landed.
    pub const RESTED: Self = Self {
        motion: SideMotion::Rested,
        roll_bounds_passed: 0,
    };

    /// The ending of a coin of this radius that came onto its side with this motion.
    pub fn new(onto_side: &OntoSide, radius_m: f64) -> Self {
        let (rolls, spins) = (onto_side.rolls_m > radius_m, onto_side.turns > 1.0);
        let motion = if spins && (onto_side.turning_prevails || !rolls) {
            SideMotion::Spun
        } else if rolls {
            SideMotion::Rolled
        } else {
            SideMotion::Rested
        };
        let passed = ROLL_BOUNDS_M.map(|bound| u8::from(onto_side.rolls_m > bound));
        Self {
            motion,
            roll_bounds_passed: passed.iter().sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn onto_side(rolls_m: f64, turns: f64, turning_prevails: bool) -> OntoSide {
        OntoSide {
            rolls_m,
            turns,
            turning_prevails,
        }
    }

    #[test]
    fn energy_names_a_coin_that_rolls_and_spins() {
        let cases = [
            (0.009, 0.9, true, SideMotion::Rested, 0),
            (0.02, 0.9, true, SideMotion::Rolled, 1),
            (0.009, 1.1, false, SideMotion::Spun, 0),
            (0.02, 1.1, true, SideMotion::Spun, 1),
            (2.0, 1.1, false, SideMotion::Rolled, 5),
            (f64::INFINITY, 0.0, false, SideMotion::Rolled, 7),
        ];
        for (rolls, turns, prevails, motion, passed) in cases {
            let ending = SideEnding::new(&onto_side(rolls, turns, prevails), 0.01);
            assert_eq!((ending.motion, ending.roll_bounds_passed), (motion, passed));
        }
    }

    #[test]
    fn bounds_rise_and_one_that_is_met_is_not_passed() {
        assert!(ROLL_BOUNDS_M.is_sorted());
        for (passed, bound) in ROLL_BOUNDS_M.into_iter().enumerate() {
            let ending = SideEnding::new(&onto_side(bound, 0.0, false), 0.01);
            assert_eq!(usize::from(ending.roll_bounds_passed), passed);
        }
    }
}
