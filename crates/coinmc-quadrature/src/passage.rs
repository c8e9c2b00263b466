//! When the centre of the coin passes the height D on its way down, and the reverse: which launch
//! passes it at a given time.
//!
//! With linear drag k, z(t) = h + v τ(t) − g σ(t), where τ = (1 − e^(−kt))/k and
//! σ = (t − τ)/k; without, τ = t and σ = t²/2. The same τ, with the angular rate of drag, is the
//! time for which an undamped spin would have turned the coin as far.

use coinmc_core::{LaunchDistribution, Marginal, Scene};

/// Standard deviations beyond which no launch lies: an inverse CDF of 52 binary digits ends at 8.2.
const FARTHEST: f64 = 8.5;
/// Products of drag and time below which the first term of a series tells the size of its effect.
const LITTLE: f64 = 1e-3;
/// Those that change no digit.
const NOTHING: f64 = 1e-17;
/// Steps of a search that needs about six.
const MOST_STEPS: u32 = 200;

/// The fall to D of a scene, SI units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Passage {
    distance: f64,
    gravity: f64,
    linear: f64,
    angular: f64,
}

impl Passage {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            distance: scene.coin.rim_distance_m(),
            gravity: scene.gravity_m_s2(),
            linear: scene.drag().linear_per_s(),
            angular: scene.drag().angular_per_s(),
        }
    }

    /// Whether every launch begins at D or above, and so passes it.
    pub(crate) fn is_certain(&self, launches: &LaunchDistribution) -> bool {
        support(&launches.height_m).0 >= self.distance
    }

    /// Whether every toss has touched before `time_limit_s`: at the latest when its centre comes to
    /// the surface.
    pub(crate) fn ends_before(&self, time_limit_s: f64, launches: &LaunchDistribution) -> bool {
        let (_, high) = support(&launches.height_m);
        let (_, fastest) = support(&launches.velocity_m_s[2]);
        let surface = Self {
            distance: 0.0,
            ..*self
        };
        // a coin that would begin in the surface is lifted, at most to D
        surface.time(high.max(self.distance), fastest) < time_limit_s
    }

    /// When the centre, let go at height h >= D with vertical velocity v, passes D, s.
    pub(crate) fn time(&self, h: f64, v: f64) -> f64 {
        let (above, g, k) = (h - self.distance, self.gravity, self.linear);
        let end = (v * v + 2.0 * g * above).sqrt();
        let free = if v < 0.0 {
            // the root by its other form: a fast throw downwards would cancel
            2.0 * above / (end - v)
        } else {
            (end + v).max(0.0) / g
        };
        if k == 0.0 {
            return free;
        }
        // So little drag changes the time by some of that part of it: twice the time is above. Else
        // e^(−kt) > 0 bounds it. The height is concave in time, so that Newton's steps from there
        // come down to the root and never pass it; from 1/k alone, each would but halve the way.
        let mut time = if k * free < LITTLE {
            2.0 * free
        } else {
            (k * above + (v + g / k).max(0.0)) / g
        };
        for _ in 0..MOST_STEPS {
            let tau = undamped(k, time);
            let height = above + v * tau - g * self.sag(time);
            let rate = v * (1.0 - k * tau) - g * tau;
            let next = (time - height / rate).max(0.0);
            // at the root, or not a number
            if next >= time || next.is_nan() {
                break;
            }
            time = next;
        }
        time
    }

    /// How long an undamped spin would have turned the coin as far as it has after `time`, s.
    pub(crate) fn turning_time(&self, time: f64) -> f64 {
        undamped(self.angular, time)
    }

    /// The time at which [`turning_time`](Self::turning_time) is `turned`; infinity if never.
    pub(crate) fn time_of_turning(&self, turned: f64) -> f64 {
        let k = self.angular;
        if k * turned < NOTHING {
            turned
        } else if k * turned < 1.0 {
            -libm::log1p(-k * turned) / k
        } else {
            f64::INFINITY
        }
    }

    /// The vertical velocity with which a centre let go at h passes D at `time`, m/s; it rises with
    /// the time.
    pub(crate) fn velocity(&self, h: f64, time: f64) -> f64 {
        let tau = undamped(self.linear, time);
        (self.distance - h + self.gravity * self.sag(time)) / tau
    }

    /// The height from which a centre let go at vertical velocity v passes D at `time`, m; where it
    /// is D at least it rises with the time.
    pub(crate) fn height(&self, v: f64, time: f64) -> f64 {
        self.distance - v * undamped(self.linear, time) + self.gravity * self.sag(time)
    }

    /// σ.
    fn sag(&self, t: f64) -> f64 {
        let x = self.linear * t;
        if x < 0.1 {
            // (x − 1 + e^(−x))/x² by its series, whose ninth term is below rounding
            let terms = [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];
            let series = terms.iter().rev().fold(0.0, |sum, n| (1.0 - x * sum) / n);
            t * t * series
        } else {
            (t - undamped(self.linear, t)) / self.linear
        }
    }
}

/// (1 − e^(−kt))/k.
fn undamped(k: f64, t: f64) -> f64 {
    if k * t < NOTHING {
        t
    } else {
        -libm::expm1(-k * t) / k
    }
}

/// The least and the largest value that a marginal can take.
pub(crate) fn support(marginal: &Marginal) -> (f64, f64) {
    match *marginal {
        Marginal::Constant(x) => (x, x),
        Marginal::Uniform { from, to } => (from, to),
        Marginal::Normal { mean, sd } => (mean - FARTHEST * sd, mean + FARTHEST * sd),
    }
}

/// Whether a marginal has one value only.
pub(crate) fn is_constant(marginal: &Marginal) -> bool {
    let (low, high) = support(marginal);
    low == high
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Drag, Surface};

    fn passage(linear: f64, angular: f64) -> Passage {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.0, 0.0).unwrap(), 9.81).unwrap();
        Passage::new(&scene.with_drag(Drag::new(linear, angular).unwrap()))
    }

    /// Times, velocities and heights are each other's inverses to 1e-11, from no drag through the
    /// change of formula to drag that stops the coin at once.
    #[test]
    fn the_passage_and_its_inverses_agree() {
        for k in [0.0, 1e-9, 1e-3, 0.05, 0.3, 2.0, 100.0] {
            let passage = passage(k, k);
            for (h, v) in [(1.0, 0.0), (5.0, 20.0), (0.5, -3.0), (0.02, 0.1)] {
                let time = passage.time(h, v);
                assert!(time > 0.0, "{k} {h} {v}");
                let scale = v.abs().max(1.0) * (1.0 + k * time).powi(2);
                assert!(
                    (passage.height(v, time) - h).abs() < 1e-11 * scale,
                    "{k} {h} {v}"
                );
                assert!(
                    (passage.velocity(h, time) - v).abs()
                        < 1e-11 * scale / time.min(1.0) * (1.0 + k),
                    "{k} {h} {v}"
                );
                let turned = passage.turning_time(time);
                if k * time < 10.0 {
                    assert!((passage.time_of_turning(turned) - time).abs() < 1e-10 * time);
                }
            }
        }
    }

    /// Drag of 1e-12/s and less moves nothing by more than some 1e-12, down to the least number.
    #[test]
    fn drag_may_be_as_little_as_it_likes() {
        for (h, v) in [(1.0, 0.0), (5.0, 20.0), (0.5, -3.0)] {
            let none = passage(0.0, 0.0).time(h, v);
            for k in [1e-12, 1e-30, 1e-61, 1e-100, 1e-300, 1e-310, 5e-324] {
                let passage = passage(k, k);
                let time = passage.time(h, v);
                assert!((time - none).abs() < 1e-10 * none, "{k} {time} {none}");
                let turned = passage.turning_time(time);
                assert!((turned - none).abs() < 1e-10 * none, "{k} {turned}");
                assert!((passage.time_of_turning(turned) - none).abs() < 1e-10 * none);
            }
        }
    }

    /// Thrown downwards, the coin needs above/|v| less what gravity saves: a share of
    /// g·above/(2v²), here 5e-12 and less.
    #[test]
    fn a_throw_downwards_keeps_its_digits() {
        let passage = passage(0.0, 0.0);
        let above = 0.75;
        for v in [-1e6, -1e9] {
            let time = passage.time(above + passage.distance, v);
            assert!((time * -v / above - 1.0).abs() < 1e-11, "{v} {time}");
        }
    }

    /// Drag of 1e-9/s moves nothing by more than some 1e-9.
    #[test]
    fn the_limit_without_drag_is_smooth() {
        for (h, v) in [(1.0, 0.0), (5.0, 20.0)] {
            let (none, little) = (passage(0.0, 0.0).time(h, v), passage(1e-9, 0.0).time(h, v));
            assert!((none - little).abs() < 1e-7 * none, "{none} {little}");
        }
    }
}
