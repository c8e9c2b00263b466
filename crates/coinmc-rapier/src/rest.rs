//! Coming to rest, for the decision `rest`: in contact, and slow for as long as the coin takes to topple.

use crate::motion::Motion;
use coinmc_core::Body;

/// Kinetic energy below which a coin counts as still, as a fraction of the depth of its shallower
/// well.
const STILL: f64 = 1e-4;
/// How long it must be still, in sqrt(D/g).
const DURATION: f64 = 1.0;

/// Watches for rest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RestDetector {
    still_since: Option<f64>,
}

impl RestDetector {
    /// Whether the coin, which moves like this at `time`, has come to rest; `pushed` if the last step had
    /// contact. To be asked after every step.
    pub(crate) fn is_at_rest(
        &mut self,
        motion: &Motion,
        body: &Body,
        pushed: bool,
        time: f64,
    ) -> bool {
        let kinetic = motion.energy(body) - motion.position.z;
        if !pushed || kinetic >= STILL * body.shallower_well() {
            self.still_since = None;
            return false;
        }
        time - *self.still_since.get_or_insert(time) >= DURATION
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Coin;
    use nalgebra::Vector3;

    /// A coin that hardly moves rests once it has touched for the time 1, and not in the air, where a toss may begin or
    /// turn back at rest.
    #[test]
    fn only_a_coin_that_touches_comes_to_rest() {
        let body = Body::new(&Coin::cylinder(0.4, 0.01).expect("a valid coin"));
        let motion = Motion {
            position: Vector3::z(),
            velocity: Vector3::zeros(),
            axis: Vector3::z(),
            spin: Vector3::zeros(),
        };
        let mut detector = RestDetector::default();
        for time in [0.0, 2.0, 4.0] {
            assert!(!detector.is_at_rest(&motion, &body, false, time));
        }
        assert!(!detector.is_at_rest(&motion, &body, true, 4.1));
        assert!(!detector.is_at_rest(&motion, &body, true, 5.0));
        assert!(detector.is_at_rest(&motion, &body, true, 5.2));
        assert!(!detector.is_at_rest(&motion, &body, false, 5.3));
        assert!(!detector.is_at_rest(&motion, &body, true, 6.0));
    }
}
