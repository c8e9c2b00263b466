//! Both rims at one time of a flight.

use super::tracks::Track;
use crate::body::Body;
use crate::flight::{Bounds, Gap, Orbit};
use crate::place::Place;

/// Which rim, as seen at the start of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rim {
    Own,
    Other,
}

impl Rim {
    pub(super) const BOTH: [Self; 2] = [Self::Own, Self::Other];

    /// The rim is at this times h u.
    fn end(self) -> f64 {
        match self {
            Self::Own => -1.0,
            Self::Other => 1.0,
        }
    }
}

/// The coin at one time of a flight, in the frame of the flight's start.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimsInFlight<'a> {
    body: &'a Body,
    gap: Gap<f64>,
    pub(super) time: f64,
    /// The cotangent of the tilt.
    cot: f64,
}

/// The gap between a rim and its track, and its rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimGap {
    pub(super) height: f64,
    pub(super) rate: f64,
}

impl<'a> RimsInFlight<'a> {
    pub(super) fn new(body: &'a Body, orbit: &Orbit<f64>, time: f64) -> Self {
        let gap = orbit.gap(body, time);
        Self {
            body,
            time,
            cot: gap.uz / gap.sin,
            gap,
        }
    }

    /// The same coin at another time of its flight.
    pub(super) fn at(&self, orbit: &Orbit<f64>, time: f64) -> Self {
        Self::new(self.body, orbit, time)
    }

    /// Whether the axis points down.
    pub(super) fn points_down(&self) -> bool {
        self.gap.uz < 0.0
    }

    /// The cosine of the tilt, and its rate.
    pub(super) fn lean(&self) -> (f64, f64) {
        (self.gap.uz, self.gap.uz_rate)
    }

    pub(super) fn sin(&self) -> f64 {
        self.gap.sin
    }

    /// The height of the lowest point of a rim.
    pub(super) fn height(&self, rim: Rim) -> f64 {
        let half = rim.end() * self.body.half;
        self.gap.z + half * self.gap.uz - self.body.radius * self.gap.sin
    }

    /// The gap above a track that has its height at the time `since`.
    pub(super) fn gap_above(&self, rim: Rim, track: &Track, since: f64) -> RimGap {
        let half = rim.end() * self.body.half;
        let rate = self.gap.vz + half * self.gap.uz_rate - self.body.radius * self.gap.sin_rate;
        RimGap {
            height: self.height(rim) - (track.height + track.rate * (self.time - since)),
            rate: rate - track.rate,
        }
    }

    /// What the downward acceleration of no rim's lowest point exceeds from now on: z'' ∓ h u_z'' −
    /// R s'' with s² bounded by its parabola.
    pub(super) fn bend(&self, bounds: &Bounds<f64>) -> f64 {
        1.0 + self.body.half * bounds.swing + self.body.radius * bounds.spread / self.gap.sin
    }

    /// How much lower than on the straight line between its heights now and `time` later a rim's lowest
    /// point can be in between. Its height is the least of those of the points of the rim, none of which
    /// accelerates upwards by more than a: a time²/8.
    pub(super) fn dip(&self, orbit: &Orbit<f64>, bounds: &Bounds<f64>, time: f64) -> f64 {
        let climb = (bounds.climb - orbit.weakest_pull(self.gap.vz)).max(0.0);
        0.125 * climb * time * time
    }

    /// The lever of the lowest point of a rim along the horizontal part of u, divided by s.
    fn reach(&self, rim: Rim) -> f64 {
        self.body.radius * self.cot + rim.end() * self.body.half
    }

    /// The horizontal place of the lowest point of a rim, with the centre at `centre` of the flight's frame.
    pub(super) fn point(&self, place: &Place, rim: Rim, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([ux, uy], reach) = (self.gap.across, self.reach(rim));
        place.point(x + reach * ux, y + reach * uy)
    }

    /// The horizontal direction along the rims.
    pub(super) fn along(&self, place: &Place) -> [f64; 2] {
        let [ux, uy] = self.gap.across.map(|part| part / self.gap.sin);
        place.direction(-uy, ux)
    }

    /// The speed over the ground of the faster one of the lowest points, and the rate at which the
    /// frame turns; the centre moves at `velocity`.
    pub(super) fn pace(&self, [vx, vy]: [f64; 2]) -> (f64, f64) {
        let (gap, radius) = (&self.gap, self.body.radius);
        let ([ux, uy], [wx, wy]) = (gap.across, gap.across_rate);
        let swing = radius * (gap.uz_rate - self.cot * gap.sin_rate) / gap.sin;
        let speeds = Rim::BOTH.map(|rim| {
            let reach = self.reach(rim);
            let (x, y) = (vx + wx * reach + ux * swing, vy + wy * reach + uy * swing);
            (x * x + y * y).sqrt()
        });
        let turn = (ux * wy - uy * wx) / (gap.sin * gap.sin);
        (speeds[0].max(speeds[1]), turn)
    }
}

impl RimGap {
    /// The earliest time at which the gap may close: it never accelerates downwards by more than
    /// `bend`.
    pub(super) fn earliest(&self, bend: f64) -> f64 {
        let height = self.height.max(0.0);
        let root = (self.rate * self.rate + 2.0 * bend * height).sqrt();
        if self.rate >= 0.0 {
            (self.rate + root) / bend
        } else {
            2.0 * height / (root - self.rate)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::Drag;
    use crate::motion::{Motion, Spin};
    use crate::rough::tracks::rim_points;
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;

    const NO_DRAG: Drag = Drag {
        linear: 0.0,
        angular: 0.0,
    };

    /// A coin that leaves the ground within .5 rad of upright.
    fn leaving(dice: &mut Dice, axial_factor: f64) -> Motion<f64> {
        let mut motion = Motion::still();
        let lean = dice.between(0.0, 0.5);
        motion.set_tilt(libm::cos(lean), libm::sin(lean));
        [motion.vx, motion.vy] = [dice.between(-2.0, 2.0), dice.between(-2.0, 2.0)];
        (motion.vz, motion.z) = (dice.between(-0.1, 0.5), 1.0);
        let spin = Spin {
            axial: dice.between(-3.0, 3.0),
            turn: dice.between(-3.0, 3.0),
            tilt: dice.between(-3.0, 3.0),
        };
        motion.set_spin(&spin, axial_factor);
        motion
    }

    fn body(dice: &mut Dice) -> Body {
        let coin = Coin::cylinder(dice.between(0.1, 1.5), 0.01).expect("a valid coin");
        Body::new(&coin)
    }

    /// Heights, places, speeds and the turn are those of the motion that the orbit leads to.
    #[test]
    fn rims_are_where_the_motion_has_them() {
        let mut reflections = 0;
        for number in 0..2_000 {
            let mut dice = Dice::new(41, number);
            let body = body(&mut dice);
            let axial_factor = body.axial_factor(true);
            let motion = leaving(&mut dice, axial_factor);
            let orbit = Orbit::new(&motion, NO_DRAG);
            let time = dice.between(0.0, 0.3);
            let rims = RimsInFlight::new(&body, &orbit, time);
            let (after, [nx, ny], reflected): (Motion<f64>, _, _) = orbit.at(&motion, time);
            let spin = after.spin(axial_factor);
            let points = rim_points(&body, &after, &spin);
            let mut place = Place::at([0.3, -0.2], [0.6, 0.8]);
            let (dx, dy) = orbit.drift(&motion, time);
            let at = Rim::BOTH.map(|rim| rims.point(&place, rim, [dx, dy]));
            let along = rims.along(&place);
            place.shift(dx, dy);
            place.align(nx, ny);
            let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{number}: {a} {b}");
            for (i, rim) in Rim::BOTH.into_iter().enumerate() {
                let point = points[if reflected { 1 - i } else { i }];
                near(rims.height(rim), after.z + point.rz);
                let [x, y] = place.point(point.rx, 0.0);
                near(at[i][0], x);
                near(at[i][1], y);
            }
            let [x, y] = place.direction(0.0, if reflected { -1.0 } else { 1.0 });
            near(along[0], x);
            near(along[1], y);
            let (speed, turn) = rims.pace([motion.vx, motion.vy]);
            near(speed, points[0].speed().max(points[1].speed()));
            near(turn, -spin.turn / after.sin);
            assert_eq!(rims.points_down(), reflected);
            reflections += u32::from(reflected);
        }
        assert!(reflections > 100, "{reflections}");
    }

    /// A rim that counts as clear of a height stays above it: between two nodes, and until the time at
    /// which it may reach it.
    #[test]
    fn rims_that_are_clear_of_a_height_stay_above_it() {
        let (mut dips, mut nearest) = (0, f64::INFINITY);
        for number in 0..5_000 {
            let mut dice = Dice::new(42, number);
            let body = body(&mut dice);
            let motion = leaving(&mut dice, body.axial_factor(true));
            let orbit = Orbit::new(&motion, NO_DRAG);
            let bounds = orbit.bounds(&orbit.extent(&body));
            let start = RimsInFlight::new(&body, &orbit, dice.between(0.0, 0.3));
            let time = dice.between(0.01, 0.2);
            let end = start.at(&orbit, start.time + time);
            let level = Track::level(start.height(Rim::Own).min(start.height(Rim::Other)) - 0.05);
            let bend = start.bend(&bounds);
            for rim in Rim::BOTH {
                let least = start.height(rim).min(end.height(rim));
                let dip = start.dip(&orbit, &bounds, time);
                let clear = start.gap_above(rim, &level, start.time).earliest(bend);
                for share in (0..=50).map(|k| 0.02 * f64::from(k)) {
                    let height = start.at(&orbit, start.time + share * time).height(rim);
                    assert!(height >= least - dip - 1e-12, "{number} {share}");
                    dips += u32::from(height < least - 1e-9);
                    let later = start.at(&orbit, start.time + share * clear);
                    let above = later.height(rim) - level.height;
                    assert!(above >= -1e-12, "{number} {share}: {above}");
                    nearest = nearest.min(above);
                }
            }
        }
        assert!(dips > 1_000 && nearest < 1e-4, "{dips} {nearest}");
    }

    /// Between two times a point that accelerates upwards at a dips by a t²/8 below the straight line. Of a coin that turns
    /// at ω about a horizontal axis, a point at the distance 1 accelerates at ω² less its weight.
    #[test]
    fn rims_dip_as_a_parabola_does() {
        let mut dice = Dice::new(43, 0);
        let body = body(&mut dice);
        for rate in [0.5, 1.5, 3.0] {
            let mut motion = leaving(&mut dice, body.axial_factor(true));
            (motion.ox, motion.oy, motion.oz) = (0.0, rate, 0.0);
            let orbit = Orbit::new(&motion, NO_DRAG);
            let bounds = orbit.bounds(&orbit.extent(&body));
            let rims = RimsInFlight::new(&body, &orbit, 0.1);
            for time in [0.02, 0.1] {
                let dip = (rate * rate - 1.0).max(0.0) * time * time / 8.0;
                assert!((rims.dip(&orbit, &bounds, time) - dip).abs() < 1e-15);
            }
        }
    }
}
