//! When the centre of the coin passes the height D on its way down, and the inverse: which launch
//! passes it at a given time.
//!
//! With linear drag k, z(t) = h + v τ(t) − g σ(t), where τ = (1 − e^(−kt))/k and
//! σ = (t − τ)/k; without, τ = t and σ = t²/2. The same τ, with the angular rate of drag, is the
//! time for which an undamped spin would have turned the coin as far.

use coinmc_core::{LaunchDistribution, Marginal, Scene};

/// Standard deviations within which every launch lies: an inverse CDF of 52 binary digits ends at
/// 8.2.
const MAX_DEVIATIONS: f64 = 8.5;
/// Products of drag and time below which the first term of a series bounds their effect.
const SMALL: f64 = 1e-3;
/// Products of drag and time that change no digit.
const NEGLIGIBLE: f64 = 1e-17;
/// Limit of the steps of a search that needs about six.
const MAX_STEPS: u32 = 200;

/// The fall to the height D in a scene, SI units.
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

    /// Whether every launch starts at D or above, so that its centre passes D.
    pub(crate) fn is_always_reached(&self, launches: &LaunchDistribution) -> bool {
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
        // a coin that would start inside the surface is lifted, at most to D
        surface.time(high.max(self.distance), fastest) < time_limit_s
    }

    /// The time, s, at which a centre that starts at height h >= D with vertical velocity v passes
    /// D.
    pub(crate) fn time(&self, h: f64, v: f64) -> f64 {
        let (above, g, k) = (h - self.distance, self.gravity, self.linear);
        let end = (v * v + 2.0 * g * above).sqrt();
        let free = if v < 0.0 {
            // the other form of the root: for a fast throw downwards this one would cancel
            2.0 * above / (end - v)
        } else {
            (end + v).max(0.0) / g
        };
        if k == 0.0 {
            return free;
        }
        // A start above the root: little drag changes the time by a small share, so twice the free
        // time is above; otherwise e^(−kt) > 0 gives a bound. The height is concave in time, so
        // Newton's steps come down to the root and never pass it. From 1/k alone each step would
        // only halve the way.
        let mut time = if k * free < SMALL {
            2.0 * free
        } else {
            (k * above + (v + g / k).max(0.0)) / g
        };
        for _ in 0..MAX_STEPS {
            let tau = equivalent_time(k, time);
            let height = above + v * tau - g * self.sag(time);
            let rate = v * (1.0 - k * tau) - g * tau;
            let next = (time - height / rate).max(0.0);
            // at the root, or NaN
            if next >= time || next.is_nan() {
                break;
            }
            time = next;
        }
        time
    }

    /// The time, s, in which an undamped spin would turn the coin as far as the damped one has
    /// after `time`.
    pub(crate) fn turning_time(&self, time: f64) -> f64 {
        equivalent_time(self.angular, time)
    }

    /// The time at which [`turning_time`](Self::turning_time) is `turned`; infinity if never.
    pub(crate) fn time_of_turning(&self, turned: f64) -> f64 {
        let k = self.angular;
        if k * turned < NEGLIGIBLE {
            turned
        } else if k * turned < 1.0 {
            -libm::log1p(-k * turned) / k
        } else {
            f64::INFINITY
        }
    }

    /// The vertical velocity, m/s, with which a centre that starts at height h passes D at `time`;
    /// it rises with the time.
    pub(crate) fn velocity(&self, h: f64, time: f64) -> f64 {
        let tau = equivalent_time(self.linear, time);
        (self.distance - h + self.gravity * self.sag(time)) / tau
    }

    /// The height, m, from which a centre that starts with vertical velocity v passes D at `time`;
    /// where it is at least D it rises with the time.
    pub(crate) fn height(&self, v: f64, time: f64) -> f64 {
        self.distance - v * equivalent_time(self.linear, time) + self.gravity * self.sag(time)
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
            (t - equivalent_time(self.linear, t)) / self.linear
        }
    }
}

/// (1 − e^(−kt))/k.
fn equivalent_time(k: f64, t: f64) -> f64 {
    if k * t < NEGLIGIBLE {
        t
    } else {
        -libm::expm1(-k * t) / k
    }
}

/// The smallest and the largest value of a marginal.
pub(crate) fn support(marginal: &Marginal) -> (f64, f64) {
    match *marginal {
        Marginal::Constant(x) => (x, x),
        Marginal::Uniform { from, to } => (from, to),
        Marginal::Normal { mean, sd } => (mean - MAX_DEVIATIONS * sd, mean + MAX_DEVIATIONS * sd),
    }
}

/// Whether a marginal has only one value.
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

    /// Times, velocities and heights are inverse to each other to 1e-11, from no drag through the
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

    /// Drag of 1e-12/s and less changes nothing by more than about 1e-12, down to the smallest
    /// number.
    #[test]
    fn tiny_drag_changes_nothing() {
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

    /// Thrown downwards, the coin needs above/|v| minus what gravity saves, a share of
    /// g·above/(2v²): here 5e-12 or less.
    #[test]
    fn a_throw_downwards_keeps_its_digits() {
        let passage = passage(0.0, 0.0);
        let above = 0.75;
        for v in [-1e6, -1e9] {
            let time = passage.time(above + passage.distance, v);
            assert!((time * -v / above - 1.0).abs() < 1e-11, "{v} {time}");
        }
    }

    /// Drag of 1e-9/s changes nothing by more than about 1e-9.
    #[test]
    fn the_limit_without_drag_is_smooth() {
        for (h, v) in [(1.0, 0.0), (5.0, 20.0)] {
            let (none, little) = (passage(0.0, 0.0).time(h, v), passage(1e-9, 0.0).time(h, v));
            assert!((none - little).abs() < 1e-7 * none, "{none} {little}");
        }
    }

    /// 8.5 standard deviations hold all numbers that 52 binary digits can give.
    #[test]
    fn the_support_holds_every_launch() {
        assert_eq!(
            support(&Marginal::Normal { mean: 2.0, sd: 0.5 }),
            (-2.25, 6.25)
        );
        assert_eq!(
            support(&Marginal::Uniform {
                from: -1.0,
                to: 3.0
            }),
            (-1.0, 3.0)
        );
        assert_eq!(support(&Marginal::Constant(4.0)), (4.0, 4.0));
        let smallest = 0.5_f64.powi(53);
        let normal = Marginal::Normal { mean: 0.0, sd: 1.0 };
        assert!(normal.quantile(smallest) > -8.5);
    }

    /// Little drag for a long time slows a spin as much as more drag in less time: (1 − e^(−x))/x of the time.
    #[test]
    fn a_spin_slows_by_the_product_of_drag_and_time() {
        for x in [1e-3_f64, 0.01, 1.0, 5.0] {
            let share = -libm::expm1(-x) / x;
            for k in [1e-12, 1e-10, 1e-3, 1.0, 1e6] {
                let passage = passage(0.0, k);
                let turned = passage.turning_time(x / k);
                assert!((turned * k / x / share - 1.0).abs() < 1e-14, "{k} {x}");
                assert!((passage.time_of_turning(turned) * k / x - 1.0).abs() < 1e-9);
            }
        }
    }
}
