//! A rough ground as a rim of the coin meets it.

use super::field::HeightField;
use crate::body::Body;

/// The ground under a rim's arc is not expected to be higher than its mean by more than this many σ. (One
/// place in a thousand is, and there only the points next to the middle are looked at.)
const HIGHEST: f64 = 3.0;
/// Distance between the points of the arc that are examined, in ℓ.
const SPACING: f64 = 0.6;
/// Most points on either side of the middle of the arc.
const MOST_POINTS: u32 = 12;
/// The same as a number of points.
const FARTHEST: f64 = MOST_POINTS as f64;
/// Standard deviations of the ground's height that a decided coin may still meet.
pub(super) const SPREAD: f64 = 3.0;
/// A rim bridges no hollow if the ground's rms curvature is below this share of the rim's own.
const BRIDGING: f64 = 0.1;

/// The other rim is near the ground while it is lower than this many times the rms difference of
/// the ground's heights under the rims.
const NEAR: f64 = 6.0;
/// Largest cosine of a tilt at which the other rim counts as near.
const LARGEST_NEAR: f64 = 0.5;

/// A coin on one rim feels the ground up to this many times the lean at which it topples, whose cosine
/// is h; at most up to this cosine; and farther than its other rim does. With 2 instead of 3 times, half as
/// many thin coins end on their side; with 5 times, as many (`docs/methods/rough.md`).
const FELT: f64 = 3.0;
const LARGEST_FELT: f64 = 0.5;
const BEYOND_NEAR: f64 = 1.2;

/// A random ground of stated rms slope and correlation length, under a coin of stated thickness; lengths
/// in the kernel's unit D.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ground {
    /// Correlation length ℓ.
    pub(super) length: f64,
    /// Rms height σ.
    pub(super) height: f64,
    /// sqrt(2(1 − C)) over the coin's thickness: the rms difference of the heights under the rims of a
    /// coin on its side, in σ, or of the slopes there, in s.
    pub(super) contrast: f64,
    /// The cosine of the tilt below which the other rim of the coin is near the ground.
    pub(super) near: f64,
    /// The cosine of the tilt up to which a coin on one rim feels the ground. It leans farther only on the
    /// way to its face, and moves as on a plane.
    pub(crate) felt: f64,
    /// A height that the ground, and so a rim that it carries, nowhere exceeds.
    pub(super) highest: f64,
    /// A face is decided where the energy above the ground under the rim falls short of the balance by
    /// this: the ground may be as much lower where the coin will be.
    pub(super) face_margin: f64,
    /// What a coin that is decided to stay on its side may still meet.
    pub(super) kicks: Kicks,
}

/// What of the ground does not topple a decided coin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kicks {
    /// How many standard deviations of the rates at which slopes make it lean.
    pub(super) rates: f64,
    /// The lean at which it topples, less that at which so many of the heights let it rest, as a share of
    /// the former.
    pub(super) brim: f64,
}

/// What carries a rim.
#[derive(Debug, Clone, Copy)]
pub(super) struct Support {
    pub(super) height: f64,
    /// The slope along the rim, of a rim that bridges hollows, and the place of the ground that
    /// carries it.
    pub(super) bridge: Option<(f64, [f64; 2])>,
}

impl Ground {
    /// A ground of this rms slope and correlation length, under a coin.
    pub(crate) fn new(slope: f64, length: f64, body: &Body) -> Self {
        let (height, thickness) = (slope * length, 2.0 * body.half);
        let distance = thickness / length;
        let contrast = (-2.0 * libm::expm1(-0.5 * distance * distance)).sqrt();
        // one standard deviation of the lean at which a coin with both rims down rests, as a share of
        // the lean at which it topples
        let lean = height * contrast / thickness / (body.half / body.radius);
        let near = (NEAR * height * contrast / thickness).min(LARGEST_NEAR);
        Self {
            length,
            height,
            contrast,
            near,
            felt: (FELT * body.half).min(LARGEST_FELT).max(BEYOND_NEAR * near),
            highest: height * HeightField::shared().highest(),
            face_margin: SPREAD * height,
            kicks: Kicks::new(thickness / body.outer_radius(), lean),
        }
    }

    /// The rms slope along a direction.
    pub(super) fn slope(&self) -> f64 {
        self.height / self.length
    }

    /// The rms difference of the heights under both rims of a coin on its side, at most σ: on long waves it is
    /// far less.
    pub(super) fn unevenness(&self) -> f64 {
        self.height * self.contrast.min(1.0)
    }

    /// The slopes of the ground along x and y.
    pub(super) fn gradient(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.in_lengths(point);
        let [gx, gy] = HeightField::shared().gradient(x, y);
        [self.slope() * gx, self.slope() * gy]
    }

    /// A point in units of ℓ.
    fn in_lengths(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let per_length = self.length.recip();
        [x * per_length, y * per_length]
    }

    /// What carries a rim whose lowest point is above `point`.
    ///
    /// Near its lowest point the rim is a parabola, ½κξ² above it at a distance ξ along the
    /// horizontal unit vector `along`. It rests where the ground under this parabola reaches
    /// highest: max over ξ of h(point + ξ along) − ½κξ². So a rim bridges hollows that are narrower
    /// than its own curvature fits into.
    pub(super) fn under_rim(&self, point: [f64; 2], along: [f64; 2], curvature: f64) -> Support {
        // from here on in units of ℓ and σ
        let bend = 0.5 * curvature * self.length * self.length / self.height;
        let field = HeightField::shared();
        let [x, y] = self.in_lengths(point);
        // rms curvature √3 σ/ℓ²
        if 3.0_f64.sqrt() * BRIDGING.recip() < 2.0 * bend {
            // the rim follows the ground: the first order in h'/κ
            return Support {
                height: self.height * field.height(x, y),
                bridge: None,
            };
        }
        let [dx, dy] = along.map(|component| SPACING * component);
        let bend = bend * SPACING * SPACING;
        let at = |k: f64| field.height(x + k * dx, y + k * dy) - bend * k * k;
        let at_most = |k: f64| field.height_at_most(x + k * dx, y + k * dy) - bend * k * k;
        let (k, top) = climb(highest(bend, at, at_most), |k| {
            let [height, rate, turn] = field.height_along([x + k * dx, y + k * dy], [dx, dy]);
            [
                height - bend * k * k,
                rate - 2.0 * bend * k,
                turn - 2.0 * bend,
            ]
        });
        let way = k * SPACING * self.length;
        Support {
            height: self.height * top,
            // at its highest the ground is as steep as the rim
            bridge: Some((
                curvature * way,
                [point[0] + way * along[0], point[1] + way * along[1]],
            )),
        }
    }
}

impl Kicks {
    /// Of a coin with this H/R, on ground whose heights let it rest at this lean, as a share of that at which
    /// it topples: one standard deviation.
    ///
    /// A coin rolls past a thousand correlation lengths and meets five standard deviations on the way. A
    /// thin one needs more, and a thick one less: its rims land and roll with the small velocity of the
    /// contact point, and not with w. Where heights are small, one standard deviation of the rates is enough,
    /// as the rule counts all of the loose energy as tilt already. The numbers are measured, with coins that
    /// roll upright, the hardest to decide (`docs/methods/rough.md`).
    fn new(ratio: f64, lean: f64) -> Self {
        const FEWEST: f64 = 3.0;
        const MOST: f64 = 20.0;
        let heights = (3.0 / ratio).clamp(FEWEST, MOST);
        let small = lean < (0.08 * ratio).min(0.03);
        Self {
            rates: if small { 1.0 } else { heights },
            brim: 1.0 - heights * lean,
        }
    }
}

/// Where and how high the arc's highest point is. `at(k)` is the height of point k, which lies
/// `bend` k² lower than it would under a straight rim; `at_most(k)` costs little and is no less.
fn highest(bend: f64, at: impl Fn(f64) -> f64, at_most: impl Fn(f64) -> f64) -> (f64, f64) {
    let middle = at(0.0);
    let mut best = (0.0, middle);
    // the heights of the points before these on either side, and those next to the best, nearer to
    // the middle and farther from it; NaN: not known
    let mut last = [middle; 2];
    let (mut nearer, mut farther) = (f64::NAN, f64::NAN);
    for k in 1..=MOST_POINTS {
        let k = f64::from(k);
        if HIGHEST - bend * k * k < best.1 {
            break;
        }
        for (last, side) in last.iter_mut().zip([-k, k]) {
            if at_most(side) <= best.1 {
                *last = f64::NAN;
                continue;
            }
            let height = at(side);
            if height > best.1 {
                best = (side, height);
                (nearer, farther) = (*last, f64::NAN);
            } else if side - best.0 == 1.0_f64.copysign(side) && best.0 != 0.0 {
                farther = height;
            }
            *last = height;
        }
    }
    let outwards = 1.0_f64.copysign(best.0);
    let known = |height: f64, k: f64| if height.is_nan() { at(k) } else { height };
    let (before, after) = (
        known(nearer, best.0 - outwards),
        known(farther, best.0 + outwards),
    );
    // the top of the parabola through the best point and its neighbours
    let (rise, bow) = (0.5 * (after - before), 2.0 * best.1 - before - after);
    if bow > rise.abs() {
        (
            best.0 + outwards * rise / bow,
            best.1 + 0.5 * rise * rise / bow,
        )
    } else {
        best
    }
}

/// The top near a point of the arc, and how high it is, by Newton's method. `at(k)` is the height of point
/// k and its first two rates with k.
fn climb((mut k, mut top): (f64, f64), at: impl Fn(f64) -> [f64; 3]) -> (f64, f64) {
    /// The last step, a way of .06 ℓ. The height at its end is right to the third order in it: to 4e-5 σ where
    /// the ground's third rate is of the usual size.
    const LAST: f64 = 0.1;
    /// The longest step, and its length where the ground is not concave.
    const LONGEST: f64 = 0.3;
    const MOST_STEPS: u32 = 8;
    for _ in 0..MOST_STEPS {
        let [height, rate, turn] = at(k);
        let step = if turn < 0.0 {
            (-rate / turn).clamp(-LONGEST, LONGEST)
        } else {
            LONGEST.copysign(rate)
        };
        let step = (k + step).clamp(-FARTHEST, FARTHEST) - k;
        k += step;
        top = height + 0.5 * rate * step;
        if step.abs() <= LAST {
            break;
        }
    }
    (k, top)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Coin;

    #[test]
    fn a_sharply_curved_rim_feels_the_point_and_a_flat_one_the_highest_bump() {
        let coin = Coin::cylinder(0.6, 1.0).expect("a valid coin");
        let ground = Ground::new(0.05, 0.02, &Body::new(&coin));
        let at = |point| {
            let [x, y] = ground.in_lengths(point);
            HeightField::shared().height(x, y)
        };
        let along = [1.0, 0.0];
        let mut squares = 0.0;
        for i in 0..200 {
            let point = [0.013 * f64::from(i), 0.007 * f64::from(i)];
            let below = ground.height * at(point);
            let sharp = ground.under_rim(point, along, 1e9).height;
            assert!((sharp - below).abs() <= 1e-9);
            let flat = ground.under_rim(point, along, 1e-3).height;
            let highest = (-720..=720)
                .map(|k| at([point[0] + f64::from(k) * 2e-4, point[1]]))
                .fold(f64::NEG_INFINITY, f64::max);
            // the arc is examined up to 12 points of 0.6 ℓ = 0.144 on either side
            let error = (flat - ground.height * highest) / ground.height;
            // where two tops between the points are nearly as high, the lower one may be found
            assert!(error.abs() <= 0.2, "{error}");
            squares += error * error;
        }
        assert!(squares <= 200.0 * 0.03 * 0.03, "{squares}");
    }

    /// A rim whose curvature is like that of the ground rests where the ground under its parabola reaches highest,
    /// by a search in fine steps, and is as steep as the ground there.
    #[test]
    fn a_rim_rests_on_the_highest_ground_under_its_parabola() {
        let coin = Coin::cylinder(0.6, 1.0).expect("a valid coin");
        let ground = Ground::new(0.05, 0.02, &Body::new(&coin));
        let height = |[x, y]: [f64; 2]| {
            let [x, y] = ground.in_lengths([x, y]);
            ground.height * HeightField::shared().height(x, y)
        };
        let unit = ground.height / (ground.length * ground.length);
        let along = [0.6, 0.8];
        let mut squares = 0.0;
        for i in 0..300 {
            let curvature = unit * [0.3, 1.0, 3.0][i % 3];
            let point = [0.013 * i as f64, 0.007 * i as f64];
            let place = |way: f64| [point[0] + way * along[0], point[1] + way * along[1]];
            let highest = (-800..=800)
                .map(|k| {
                    let way = 1e-4 * f64::from(k);
                    height(place(way)) - 0.5 * curvature * way * way
                })
                .fold(f64::NEG_INFINITY, f64::max);
            let found = ground.under_rim(point, along, curvature);
            let error = (found.height - highest) / ground.height;
            assert!(error.abs() <= 0.05, "{curvature}: {error}");
            squares += error * error;
            let (slope, carries) = found.bridge.expect("a rim that bridges hollows");
            let way = slope / curvature;
            let off = [0, 1].map(|axis| carries[axis] - place(way)[axis]);
            assert!(off[0].abs() + off[1].abs() < 1e-12, "{off:?}");
        }
        assert!(squares <= 300.0 * 0.005 * 0.005, "{squares}");
    }

    /// The top of the parabola through the middle and its neighbours, whether these were looked at or not: through
    /// (−1, −.5), (0, 0) and (1, −.2) it is at .15/.7.
    #[test]
    fn the_top_lies_between_the_middle_and_its_neighbours() {
        for side in [1.0, -1.0] {
            let at = |k: f64| match side * k {
                -1.0 => -0.5,
                0.0 => 0.0,
                1.0 => -0.2,
                _ => -k * k,
            };
            for looked_at in [[true, true], [true, false], [false, true], [false, false]] {
                let at_most = |k: f64| {
                    let over = k.abs() == 1.0 && looked_at[usize::from(k > 0.0)];
                    if over { 0.1 } else { at(k) }
                };
                let (k, top) = highest(0.5, at, at_most);
                assert!(
                    (k - side * 0.15 / 0.7).abs() < 1e-15,
                    "{side} {looked_at:?}: {k}"
                );
                assert!((top - 0.5 * 0.15 * 0.15 / 0.7).abs() < 1e-15);
            }
        }
    }

    /// The rms curvature of the ground is √3 σ/ℓ². A rim that bends ten times as much follows it, and bridges nothing.
    #[test]
    fn a_rim_follows_ground_that_bends_a_tenth_as_much() {
        let coin = Coin::cylinder(0.6, 1.0).expect("a valid coin");
        for (length, height) in [(0.05, 0.02), (0.2, 0.001)] {
            let ground = Ground::new(length, height, &Body::new(&coin));
            let limit = 10.0 * 3.0_f64.sqrt() * ground.height / (ground.length * ground.length);
            let bridges = |curvature| {
                let found = ground.under_rim([0.3, 0.1], [1.0, 0.0], curvature);
                found.bridge.is_some()
            };
            assert!(bridges(0.999 * limit) && !bridges(1.001 * limit));
        }
    }

    /// How much the heights under both rims differ: the root mean square of differences at random places, on waves much
    /// longer than the coin is thick; on short ones no more than the heights do.
    #[test]
    fn unevenness_is_the_rms_difference_of_the_heights_under_both_rims() {
        let coin = Coin::cylinder(0.6, 1.0).expect("a valid coin");
        let body = Body::new(&coin);
        let thickness = 2.0 * body.half;
        for (length, expected) in [(3.0 * thickness, None), (0.05 * thickness, Some(1.0))] {
            let ground = Ground::new(0.05, length, &body);
            let mut squares = 0.0;
            let count = 20_000;
            for i in 0..count {
                let mut dice = coinmc_testkit::Dice::new(551, i);
                let [x, y] = [0, 1].map(|_| dice.between(-60.0, 60.0) * length);
                let (sin, cos) = libm::sincos(dice.between(0.0, 6.0));
                let height = |[x, y]: [f64; 2]| {
                    let [x, y] = ground.in_lengths([x, y]);
                    ground.height * HeightField::shared().height(x, y)
                };
                let difference =
                    height([x + thickness * cos, y + thickness * sin]) - height([x, y]);
                squares += difference * difference;
            }
            let found = expected.map_or((squares / count as f64).sqrt(), |share| {
                share * ground.height
            });
            // one field on a torus of 128 ℓ is no whole ensemble: it differs by some per cent
            assert!((ground.unevenness() / found - 1.0).abs() < 0.03, "{found}");
        }
    }

    /// The highest of points of an arc of a rim that lies on a parabola is its top, wherever that is between the points.
    #[test]
    fn the_highest_point_of_a_parabola_is_its_top() {
        for top in [-7.3, -0.4, 0.0, 0.6, 3.5, 9.8] {
            let at = |k: f64| 2.0 - 0.03 * (k - top) * (k - top);
            for spare in [0.0, 10.0] {
                let (k, height) = highest(1e-6, at, |k| at(k) + spare);
                assert!((k - top).abs() < 1e-9, "{top}: {k}");
                assert!((height - 2.0).abs() < 1e-9, "{top}: {height}");
            }
        }
    }

    /// No point of the rim is looked at from where on even ground of 3 σ would not reach higher under it than the highest
    /// found: 3 − b k² < best. Here that is the middle.
    #[test]
    fn points_that_ground_of_three_deviations_does_not_reach_are_not_looked_at() {
        for (bend, middle, farthest) in [
            (1.0, 0.0, 1.0),
            (0.1, 0.0, 5.0),
            (0.1, 2.5, 2.0),
            (0.01, 0.0, FARTHEST),
        ] {
            let seen = std::cell::Cell::new(0.0);
            let at_most = |k: f64| {
                seen.set(k.abs().max(seen.get()));
                f64::NEG_INFINITY
            };
            let (k, height) = highest(bend, |k| middle - bend * k * k, at_most);
            assert_eq!(seen.get(), farthest, "{bend} {middle}");
            assert!(k == 0.0 && height == middle, "{k} {height}");
        }
    }
}
