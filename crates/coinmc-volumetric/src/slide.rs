//! The last slide of a coin flat on its face, on a table with an edge or a tilted one.
//!
//! The rim carries the weight evenly (a coin's face is lower than its rim), and every point of it has
//! Coulomb friction. With the velocity v of the centre, w = R ω_a, and the slip u = (v − w sin φ,
//! w cos φ) of the point at φ from the direction of motion,
//!
//! v' = −μ ⟨u_x/|u|⟩,  w' = −μ (R²/k_a) ⟨(w − v sin φ)/|u|⟩,
//!
//! with ⟨⟩ the mean over the rim. v and w end together (Goyal, Ruina and Papadopoulos, Wear 143 (1991)
//! 307): a coin that spins slides farther than v²/2μ. The moment of friction about the centre, which
//! presses the leading rim down, is left out; it does not tip the coin where this is used.

use crate::body::Body;
use std::f64::consts::PI;

/// Points of half the rim, from −π/2 to π/2: the other half is its mirror image.
const POINTS: u32 = 12;
/// Length of a step, as a share of the time in which friction would stop the slip.
const STEP: f64 = 0.04;
/// The slide ends at this share of its speed: its square is left of the way.
const END: f64 = 0.01;
/// A way shorter than this, in D, is none.
const NEGLIGIBLE: f64 = 0.01;
/// A spin below this share of the slip holds the centre as none does: it changes friction by its square.
const NO_SPIN: f64 = 1e-3;
/// A direction whose cosine is as near to 1 is straight down.
const STRAIGHT: f64 = 1e-6;
/// The least excess of friction over the pull: rounding may leave none.
const LEAST_EXCESS: f64 = 1e-15;

/// The way, in D, and the time, in sqrt(D/g), until a coin that slides at the speed `v` and turns at
/// `w`/R rests; `mu` > 0.
pub(crate) fn way_and_time(body: &Body, mu: f64, v: f64, w: f64) -> (f64, f64) {
    let (mut v, mut w) = (v, w.abs());
    let (mut way, mut time) = (0.0, 0.0);
    let inertia = body.radius * body.radius / body.ka;
    // the two means add up to 1 at least, so that friction ends v + w within (v + w)/μ
    if v * (v + w) < NEGLIGIBLE * mu {
        return (0.0, (v + w) / mu);
    }
    let rim = rim_sines_and_cosines();
    let end = END * (v + w);
    while v + w > end {
        let step = STEP * (v + w) / (mu * inertia.max(1.0));
        let (a, b) = means(&rim, v, w);
        let half = 0.5 * step * mu;
        let (middle_v, middle_w) = ((v - half * a).max(0.0), (w - half * inertia * b).max(0.0));
        let (a, b) = means(&rim, middle_v, middle_w);
        way += step * middle_v;
        time += step;
        v = (v - step * mu * a).max(0.0);
        w = (w - step * mu * inertia * b).max(0.0);
    }
    (way, time)
}

/// The same on a tilted table: the way along x and y of the frame, from the velocity `v`, with the pull
/// in it. A coin that spins is held less, and slides down as long as it spins; once it slides straight down without
/// spin, friction less the pull ends it, which may be next to nothing: v²/2(μ − tan β).
pub(crate) fn pulled_way_and_time(
    body: &Body,
    mu: f64,
    v: [f64; 2],
    w: f64,
    pull: [f64; 2],
) -> ([f64; 2], f64) {
    let (mut v, mut w) = (v, w.abs());
    let (mut way, mut time) = ([0.0; 2], 0.0);
    let inertia = body.radius * body.radius / body.ka;
    let rim = rim_sines_and_cosines();
    let slip = |v: [f64; 2], w: f64| (v[0] * v[0] + v[1] * v[1]).sqrt() + w;
    let slope = (pull[0] * pull[0] + pull[1] * pull[1]).sqrt();
    let end = END * slip(v, w).max(NEGLIGIBLE);
    while slip(v, w) > end {
        // no faster than friction and the pull together change the slip
        let step = STEP * slip(v, w) / ((mu + slope) * inertia.max(1.0));
        let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let downwards = v[0] * pull[0] + v[1] * pull[1];
        if w <= NO_SPIN * speed && downwards >= (1.0 - STRAIGHT) * speed * slope {
            let rest = speed / (mu - slope).max(LEAST_EXCESS);
            let straight = if slope > 0.0 {
                pull.map(|part| speed / slope * part)
            } else {
                v
            };
            return (
                [0, 1].map(|i| way[i] + 0.5 * rest * straight[i]),
                time + rest,
            );
        }
        let (along, about) = means(&rim, speed, w);
        // where friction would stop the centre within the step, it holds it as far as it can
        let held = (mu * along * step / speed.max(f64::MIN_POSITIVE)).min(1.0);
        let next = [0, 1].map(|i| v[i] * (1.0 - held) + step * pull[i]);
        for i in 0..2 {
            way[i] += 0.5 * step * (v[i] + next[i]);
        }
        v = next;
        w = (w - step * mu * inertia * about).max(0.0);
        time += step;
    }
    (way, time)
}

type Rim = [[f64; 2]; POINTS as usize];

/// Of points spread evenly over half the rim.
fn rim_sines_and_cosines() -> Rim {
    let mut point = 0;
    [(); POINTS as usize].map(|()| {
        let (sin, cos) = libm::sincos(PI * ((f64::from(point) + 0.5) / f64::from(POINTS) - 0.5));
        point += 1;
        [sin, cos]
    })
}

/// ⟨u_x/|u|⟩ and ⟨(w − v sin φ)/|u|⟩.
fn means(rim: &Rim, v: f64, w: f64) -> (f64, f64) {
    let (mut along, mut about) = (0.0, 0.0);
    for [sin, cos] in rim {
        let (x, y) = (v - w * sin, w * cos);
        let slip = (x * x + y * y).sqrt().max(f64::MIN_POSITIVE);
        along += x / slip;
        about += (w - v * sin) / slip;
    }
    (along / f64::from(POINTS), about / f64::from(POINTS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Coin;

    fn body() -> Body {
        Body::new(&Coin::cylinder(0.2, 0.01).expect("a valid coin"))
    }

    /// The way and the time by the sum over short steps.
    fn plain_sum(
        body: &Body,
        mu: f64,
        mut v: [f64; 2],
        mut w: f64,
        pull: [f64; 2],
    ) -> ([f64; 2], f64) {
        let inertia = body.radius * body.radius / body.ka;
        let rim = rim_sines_and_cosines();
        let (h, mut way, mut time) = (1e-4, [0.0; 2], 0.0);
        loop {
            let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
            if speed + w < 1e-3 {
                return (way, time);
            }
            let (along, about) = means(&rim, speed, w);
            let held = (h * mu * along / speed.max(1e-9)).min(1.0);
            for i in 0..2 {
                way[i] += h * v[i];
                v[i] += h * pull[i] - held * v[i];
            }
            w = (w - h * mu * inertia * about).max(0.0);
            time += h;
        }
    }

    #[test]
    fn a_coin_that_does_not_spin_slides_for_half_the_square_of_its_speed() {
        for (mu, v) in [(0.3, 1.0), (0.1, 2.0), (0.3, 0.1)] {
            let (way, time) = way_and_time(&body(), mu, v, 0.0);
            assert!((way * 2.0 * mu / (v * v) - 1.0).abs() < 1e-3, "{way}");
            assert!((time * mu / v - 1.0).abs() < 0.02, "{time}");
        }
    }

    /// Straight down or up a slope it is slowed down by friction less or more the pull, however fast it is: it slides for
    /// half the square of its speed over that. The last hundredth of its speed takes a hundredth of the time.
    #[test]
    fn a_coin_that_does_not_spin_slides_farther_down_than_up() {
        let (body, mu) = (body(), 0.3);
        for number in 0..200 {
            let mut dice = coinmc_testkit::Dice::new(558, number);
            let (sin, cos) = libm::sincos(dice.between(-3.0, 3.0));
            let (speed, pull) = (dice.between(0.2, 2.0), dice.between(-0.2, 0.2));
            let along = |size: f64| [size * cos, size * sin];
            let ([x, y], time) = pulled_way_and_time(&body, mu, along(speed), 0.0, along(pull));
            let slowed = mu - pull;
            let [ahead, aside] = [x * cos + y * sin, y * cos - x * sin];
            let way = speed * speed / (2.0 * slowed);
            assert!((ahead / way - 1.0).abs() < 2e-3, "{ahead} {way}");
            assert!(aside.abs() < 1e-12);
            assert!((time * slowed / speed - 1.0).abs() < 0.03, "{time}");
        }
    }

    /// Friction next to no greater than the pull ends the slide all the same, far away: as that of a block, once a spin is
    /// gone and whatever way it began.
    #[test]
    fn a_slide_that_hardly_slows_down_ends() {
        let (body, mu) = (body(), 0.3);
        for (excess, w) in [(1e-3, 0.0), (1e-9, 0.0), (1e-9, 1.5)] {
            let pull = [mu - excess, 0.0];
            let ([x, y], time) = pulled_way_and_time(&body, mu, [1.0, 0.0], w, pull);
            let speed = (2.0 * x * excess).sqrt();
            // a spin lets it gain speed first
            assert!(if w == 0.0 {
                (speed - 1.0).abs() < 1e-6
            } else {
                speed > 1.0 && speed < 3.0
            });
            assert!((time * excess / speed - 1.0).abs() < 1e-3 && y == 0.0);
            let ([_, aside], _) = pulled_way_and_time(&body, mu, [0.0, 0.7], w, pull);
            assert!(aside > 0.0 && aside < 10.0, "{aside}");
        }
        let none = pulled_way_and_time(&body, mu, [1.0, 0.0], 0.0, [mu, 0.0]);
        assert!(none.0[0].is_finite() && none.1.is_finite());
    }

    /// Of a coin that slides and spins a plain sum over a hundred times as many steps tells the same way,
    /// farther than that without spin and never as far as without loss of speed until its end.
    #[test]
    fn a_coin_that_spins_slides_farther() {
        let (body, mu, v0, w0) = (body(), 0.3, 1.0, 1.5);
        let (way, time) = way_and_time(&body, mu, v0, w0);
        let ([sum, _], _) = plain_sum(&body, mu, [v0, 0.0], w0, [0.0; 2]);
        assert!((way / sum - 1.0).abs() < 2e-3, "{way} {sum}");
        assert!(way > 1.1 * v0 * v0 / (2.0 * mu) && way < v0 * time);
    }

    /// On a tilted table, against a plain sum over a hundred times as many steps; without tilt it is the slide on a
    /// level table.
    #[test]
    fn a_slide_on_a_tilted_table_is_the_plain_sum() {
        let (body, mu) = (body(), 0.3);
        for (v0, w0, pull) in [
            ([1.0, 0.0], 0.0, [0.0, 0.1]),
            ([0.6, -0.8], 1.5, [0.1, 0.05]),
            ([0.0, 0.0], 2.0, [-0.1, 0.0]),
            ([0.5, 0.5], 1.0, [0.0; 2]),
        ] {
            let (way, time) = plain_sum(&body, mu, v0, w0, pull);
            let (found, took) = pulled_way_and_time(&body, mu, v0, -w0, pull);
            for i in 0..2 {
                assert!(
                    (found[i] - way[i]).abs() < 0.02,
                    "{v0:?}: {found:?} {way:?}"
                );
            }
            assert!((took / time - 1.0).abs() < 0.03, "{v0:?}: {took} {time}");
            if pull == [0.0; 2] {
                let (level, _) = way_and_time(&body, mu, 0.5_f64.sqrt(), w0);
                let far = (found[0] * found[0] + found[1] * found[1]).sqrt();
                assert!((far / level - 1.0).abs() < 0.02, "{far} {level}");
            }
        }
    }

    /// The means over the rim are those of friction at many points all around it: the force against the motion, and
    /// the torque against the spin, per weight. The points are spread evenly over half the rim.
    #[test]
    fn means_over_half_the_rim_are_those_over_the_whole() {
        let rim = rim_sines_and_cosines();
        for (point, [sin, cos]) in (0_u32..).zip(rim) {
            let degrees = -82.5 + 15.0 * f64::from(point);
            assert!((libm::atan2(sin, cos).to_degrees() - degrees).abs() < 1e-12);
        }
        for (v, w) in [(1.0, 0.4), (0.4, 1.0), (0.7, 0.0), (0.0, 0.6), (2.0, 3.5)] {
            let count = 3_000;
            let (mut force, mut torque) = (0.0, 0.0);
            for i in 0..count {
                let (y, x) = libm::sincos((f64::from(i) + 0.5) * 2.0 * PI / f64::from(count));
                let slip = [v - w * y, w * x];
                let size = libm::hypot(slip[0], slip[1]) * f64::from(count);
                force += slip[0] / size;
                torque += (x * slip[1] - y * slip[0]) / size;
            }
            let (along, about) = means(&rim, v, w);
            assert!((along - force).abs() < 1e-4 && (about - torque).abs() < 1e-4);
        }
    }

    /// Way and time scale as dimensions ask: `k` times as fast a coin slides for `k` times as long, and where
    /// friction and pull are `k` times as strong, for a `k`-th part. Spin may have either sign.
    #[test]
    fn way_and_time_scale_with_speed_and_friction() {
        let body = body();
        let (v, w, pull) = ([0.6, -0.8], 1.5, [0.03, 0.02]);
        for (mu, k) in [(0.3, 2.0), (0.2, 8.0), (1.7, 0.25)] {
            let (way, time) = pulled_way_and_time(&body, mu, v, w, pull);
            let fast = pulled_way_and_time(&body, mu, v.map(|v| k * v), -k * w, pull);
            let strong = pulled_way_and_time(&body, k * mu, v, w, pull.map(|p| k * p));
            for ((far, near), way) in fast.0.into_iter().zip(strong.0).zip(way) {
                assert!((far - k * k * way).abs() < 1e-12 * k * k);
                assert!((near - way / k).abs() < 1e-12 / k);
            }
            assert!((fast.1 / (k * time) - 1.0).abs() < 1e-12);
            assert!((strong.1 * k / time - 1.0).abs() < 1e-12);

            let (way, time) = way_and_time(&body, mu, 1.0, w);
            let (far, long) = way_and_time(&body, mu, k, -k * w);
            assert!((far / (k * k * way) - 1.0).abs() < 1e-12);
            assert!((long / (k * time) - 1.0).abs() < 1e-12);
            let (near, short) = way_and_time(&body, k * mu, 1.0, w);
            assert!((near * k / way - 1.0).abs() < 1e-12);
            assert!((short * k / time - 1.0).abs() < 1e-12);
        }
    }

    /// A coin that hardly moves has no way; its time is no shorter than it takes, and at most (v + w)/μ.
    #[test]
    fn a_coin_that_only_spins_is_given_time_to_rest() {
        let (body, mu) = (body(), 0.3);
        for (v, w) in [(0.004, 0.3), (0.05, 0.004), (0.0, 1.0)] {
            let ([far, _], least) = plain_sum(&body, mu, [v, 0.0], w, [0.0; 2]);
            let (way, time) = way_and_time(&body, mu, v, w);
            assert!(way == 0.0 && far < NEGLIGIBLE, "{way} {far}");
            assert!(
                time >= least && time <= (v + w) / mu * (1.0 + 1e-15),
                "{time} {least}"
            );
        }
    }
}
