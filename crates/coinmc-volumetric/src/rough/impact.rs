//! Impacts on rough ground: with the plane that touches the ground there.
//!
//! A slope turns the normal impulse, and static friction does not take that up: the horizontal part of the
//! impulses is what slows down a coin that runs over bumps. On a coin that rolls on one rim it acts beside
//! the centre, and turns the coin.

use super::incline::Incline;
use super::tracks::{Footing, rim_points};
use super::walk::{Next, Touch, Walk};
use crate::impact::ImpactLaw;
use coinmc_core::{EventKind, Observer};

/// Draws of a place after which the last one is taken.
const MOST_DRAWS: u64 = 64;
/// Standard deviations of the slope that count when a place is drawn.
const STEEPEST: f64 = 4.0;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Draws where a coin lands. Ground that rises against the rim is met more often, in proportion to the
    /// speed at which the two approach (Sommerfeld & Huber, 1999): by rejection.
    pub(super) fn draw_place(&mut self) {
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        let ([wx, wy], down) = (own.velocity(), self.approach().max(0.0));
        let most = down + STEEPEST * self.ground.slope() * own.speed();
        for draw in 0..MOST_DRAWS {
            let (place, uniform) = self.ground.random_place(&self.toss.motion, draw);
            self.place = place;
            let [gx, gy] = self.slopes_under_rim();
            if uniform * most <= down + gx * wx + gy * wy {
                return;
            }
        }
    }

    /// The slopes of the ground that carries the own rim, along x and y of the coin's frame.
    pub(super) fn slopes_under_rim(&self) -> [f64; 2] {
        let motion = &self.toss.motion;
        let [own, _] = rim_points(self.body(), motion, &self.toss.spin);
        let (point, along) = (
            self.place.point(own.rx, 0.0),
            self.place.direction(0.0, 1.0),
        );
        let curvature = motion.sin / self.body().outer_radius();
        let support = self.ground.under_rim(point, along, curvature);
        Footing::new(&support, point, along).slopes(self.ground)
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
