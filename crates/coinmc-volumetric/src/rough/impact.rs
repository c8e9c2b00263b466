//! Impacts on rough ground: with the plane that touches the ground there.
//!
//! A slope turns the normal impulse, and static friction does not take that up: the horizontal part of the
//! impulses is what slows down a coin that runs over bumps. On a coin that rolls on one rim it acts beside
//! the centre, and turns the coin.

use super::incline::Incline;
use super::tracks::{carried_now, rim_points};
use super::walk::{Next, Touch, Walk};
use crate::impact::ImpactLaw;
use coinmc_core::{EventKind, Observer};

/// Draws of a place after which the last one is taken.
const MOST_DRAWS: u64 = 64;
/// Standard deviations of the slope that count when a place is drawn.
const STEEPEST: f64 = 4.0;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Draws where a coin lands. Ground that rises against the rim is met more often, in proportion to the
    /// speed at which the two approach (Sommerfeld & Huber, 1999): by rejection. Returns the slopes under the
    /// own rim there.
    pub(super) fn draw_place(&mut self) -> [f64; 2] {
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        let ([wx, wy], down) = (own.velocity(), self.approach().max(0.0));
        let most = down + STEEPEST * self.ground.slope() * own.speed();
        let mut slopes = [0.0; 2];
        for draw in 0..MOST_DRAWS {
            let (place, uniform) = self.ground.random_place(&self.toss.motion, draw);
            self.place = place;
            slopes = self.slopes_under_rim();
            let [gx, gy] = slopes;
            if uniform * most <= down + gx * wx + gy * wy {
                break;
            }
        }
        slopes
    }

    /// The slopes of the ground that carries the own rim, along x and y of the coin's frame.
    pub(super) fn slopes_under_rim(&self) -> [f64; 2] {
        let (motion, body) = (&self.toss.motion, self.body());
        let [own, _] = rim_points(body, motion, &self.toss.spin);
        let (_, footing) = carried_now(self.ground, body, motion, &self.place, own.rx);
        footing.slopes(self.ground)
    }

    /// One impact of the own rim with a bump on its way, or with the ground that it comes down to: with the
    /// slopes of what carries the rim at the next node. Bumps are many, and count as steps.
    pub(super) fn collide(&mut self) -> Next {
        let slopes = self.tracks.own.slopes(self.ground);
        self.collide_with(slopes)
    }

    /// One impact of the own rim with ground of these slopes.
    pub(super) fn collide_with(&mut self, slopes: [f64; 2]) -> Next {
        let model = self.model;
        self.usage.steps += 1;
        model.notify(self.toss, EventKind::Touching, self.observer);
        let stays = self.bounce_off(slopes);
        if !stays {
            // before it is shown how the coin leaves the ground
            self.give_back_lead();
        }
        model.notify(self.toss, EventKind::Impact, self.observer);
        if stays {
            Next::Goes(Touch::Rim)
        } else {
            self.rise()
        }
    }

    /// The bounce of the own rim off ground of these slopes; returns whether it stays there.
    fn bounce_off(&mut self, slopes: [f64; 2]) -> bool {
        let model = self.model;
        let (factor, body) = (model.dynamics.axial_factor, &model.dynamics.body);
        let (before, spin) = (self.toss.motion, self.toss.spin);
        let incline = Incline::new(&before, slopes);
        let (motion, turned) = incline.onto(&before, &spin, factor);
        let mut bounced = model.bounce(&motion, &turned, true);
        if bounced.retry {
            bounced = model.bounce(&motion, &turned, false);
        }
        let after = incline.back(&before, (&bounced.motion, &bounced.spin), factor);
        (self.toss.motion, self.toss.spin) = after;
        let lost = before.kinetic(body, &spin) - after.0.kinetic(body, &after.1);
        self.budget -= lost.max(0.0);
        // the track may lead more steeply than the ground rises: the rim does not touch it again at once
        let rises = -self.approach();
        let rate = &mut self.tracks.own.rate;
        *rate = if bounced.stays {
            rises
        } else {
            rate.min(rises)
        };
        self.balance();
        bounced.stays
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::{Rough, leaning};
    use super::*;
    use crate::contact::Usage;
    use crate::motion::{Motion, Spin};
    use coinmc_core::Launch;
    use coinmc_testkit::Dice;
    use nalgebra::{UnitVector3, Vector3};

    /// The slope that a coin meets which comes down at v with the horizontal velocity w: places in proportion
    /// to (v + g·w)₊ have the mean g·w = s²w²/v as long as v is many times s w. 4,000 landings; the mean has a
    /// standard error of s w/√4000, and 5 of them are a false alarm in 1.7 million tests.
    #[test]
    fn a_coin_meets_rising_ground_more_often_in_proportion_to_the_speed_of_approach() {
        let (slope, landings) = (0.02, 4_000);
        let rough = Rough {
            friction_m: [0.0; 2],
            wavelength_m: 1.0,
            ..Rough::of(0.6, slope)
        };
        let model = rough.model();
        let ground = model.ground.expect("a rough ground");
        let launch = Launch {
            height_m: 0.0,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 0.5)),
            spin_rad_s: Vector3::zeros(),
        };
        let (along, down) = (1.0, 0.1);
        let mut sum = 0.0;
        for landing in 0..landings {
            let mut toss = model.launch(&launch);
            let heading = Dice::new(316, landing).between(0.0, 6.0);
            toss.motion = Motion {
                vx: along * libm::cos(heading),
                vy: along * libm::sin(heading),
                vz: -down,
                ..toss.motion
            };
            toss.spin = Spin::still();
            let [wx, wy] = [toss.motion.vx, toss.motion.vy];
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let [gx, gy] = walk.draw_place();
            sum += gx * wx + gy * wy;
        }
        let (mean, steep) = (sum / landings as f64, slope * along);
        let error = mean - steep * steep / down;
        assert!(
            error.abs() < 5.0 * steep / (landings as f64).sqrt(),
            "{mean}"
        );
    }

    /// Bumps count as steps of contact, one each, and not as impacts.
    #[test]
    fn a_bump_counts_as_a_step() {
        let model = Rough::of(0.6, 0.02).model();
        let ground = model.ground.expect("a rough ground");
        let mut toss = leaning(&model, 0.1, [0.0, 0.1, -0.2]);
        let impacts = toss.impacts;
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        for bumps in 1..=3 {
            walk.toss.motion.vz = -0.2;
            walk.budget = walk.energy();
            walk.collide_with([0.0; 2]);
            assert_eq!((walk.usage.steps, walk.toss.impacts), (bumps, impacts));
        }
    }
}
