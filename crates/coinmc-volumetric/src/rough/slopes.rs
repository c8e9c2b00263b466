//! The pull of a slope on a coin in contact.
//!
//! The ground under a rim slopes by g_x across the coin's plane and g_y along it. The rim touches
//! where it is parallel to the ground, g_y R/s ahead of its lowest point, and the normal force
//! leans by as much:
//!
//! force (−g_x, −g_y, 1) N at the arm (r_x, g_y R/s, r_z).
//!
//! On an upright disc this passes through the centre. A contact point that sticks takes up the
//! horizontal force, and what is left is the moment N g_y R/s about x: a coin at rest begins to
//! roll downhill, unless rolling friction holds it. A point that slips does not.
//!
//! On a tilted table its pull acts in the same way, on the centre: a point that sticks holds it, as
//! far as it can without turning the coin.
//!
//! The pull acts at the nodes, half of it before the way to the next node and half after it (the
//! Störmer–Verlet method). In between the coin has kinetic energy ahead of the height that it is
//! going to lose, the walk's `lead`.

use super::rim_contact::Contact;
use super::walk::Walk;
use crate::contact::{LineState, Mode};
use crate::impact::{ImpactLaw, Impulse};
use crate::place::Place;
use coinmc_core::Observer;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Half of the pull of the slopes under the own rim in `time`.
    pub(super) fn descend_on_rim(&mut self, contact: &Contact, slopes: [f64; 2], time: f64) {
        self.pull_on_rim(contact.mode, 0.5 * time);
        let dynamics = &self.model.dynamics;
        let [gx, gy] = slopes;
        let push = 0.5 * contact.now.normal.max(0.0) * time;
        let (body, contour) = (&dynamics.body, dynamics.friction.contour);
        let spin = self.toss.spin;
        self.push(|point| {
            let k = point.matrix(body);
            let (radius, half) = point.levers(body);
            let lever = radius * point.sin / body.ka + half * point.cos / body.kt;
            let mut steep = gy * body.outer_radius() / point.sin;
            if contact.mode == Mode::Stick {
                // rolling friction that stops the coin holds it on a gentle slope
                let rolls = spin.axial * point.sin + spin.turn * point.cos;
                let gives = point.sin * point.sin / body.ka + point.cos * point.cos / body.kt
                    - lever * lever / k.yy;
                if rolls.abs() <= (contour - steep.abs()) * push * gives {
                    steep = 0.0;
                }
            }
            // the moment changes the slip, and a point that sticks takes that back
            let moment = push * steep;
            let (x, y) = match contact.mode {
                Mode::Stick => (0.0, -(moment * lever) / k.yy),
                Mode::Slip => (-push * gx, -push * gy),
            };
            Impulse {
                x,
                y,
                z: -(k.xz / k.zz) * x,
                contour: -point.sin * moment,
                pivoting: 0.0,
            }
        });
    }

    /// The pull of a tilted table on a coin on its own rim.
    fn pull_on_rim(&mut self, mode: Mode, time: f64) {
        let [x, y] = self.pull().map(|pull| pull * time);
        if x == 0.0 && y == 0.0 {
            return;
        }
        self.toss.motion.vx += x;
        self.toss.motion.vy += y;
        if mode == Mode::Stick {
            let body = &self.model.dynamics.body;
            self.push(|point| {
                let k = point.matrix(body);
                let held = -x * k.zz / (k.xx + k.zz - 1.0);
                Impulse {
                    x: held,
                    y: -y / k.yy,
                    z: -(k.xz / k.zz) * held,
                    contour: 0.0,
                    pivoting: 0.0,
                }
            });
        }
    }

    /// Adds to the budget what the way down a tilted table has given since the coin was at
    /// `before`.
    pub(super) fn descend_from(&mut self, before: &Place) {
        if let Some(pull) = &self.model.pull {
            self.budget += pull.work(before, &self.toss.place);
        }
    }

    /// The motion along the ground of a coin on both rims, after half of the pull of the slopes in
    /// `time`.
    pub(super) fn descend_on_both(
        &self,
        state: &LineState,
        [own, other]: [[f64; 2]; 2],
        time: f64,
    ) -> LineState {
        let body = self.body();
        let [gx, gy] = [0, 1].map(|i| 0.25 * time * (own[i] + other[i]));
        let [px, py] = self.pull().map(|pull| 0.5 * time * pull);
        let [vx, vy, wa, wz] = *state;
        if self.model.contact_rules().rolls_straight(state) {
            let radius = body.outer_radius();
            let turn = (gy - py) * radius / (body.ka + radius * radius);
            [vx, vy - radius * turn, wa + turn, wz]
        } else {
            let px = if self.holds_across(state) { 0.0 } else { px };
            [vx - gx + px, vy - gy + py, wa, wz]
        }
    }

    /// The pull of a tilted table in the coin's frame; none on a level one.
    pub(super) fn pull(&self) -> [f64; 2] {
        let pull = self.model.pull.as_ref();
        pull.map_or([0.0; 2], |pull| pull.in_frame(&self.toss.place, 0.0))
    }

    /// Whether friction holds a coin on both rims along its axis.
    pub(super) fn holds_across(&self, [vx, ..]: &LineState) -> bool {
        vx.abs() <= self.model.contact_rules().creep
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::Rough;
    use super::*;
    use crate::contact::Usage;
    use crate::laws::Moreau;
    use crate::model::Model;
    use crate::toss::Toss;
    use coinmc_core::Launch;
    use nalgebra::{UnitVector3, Vector3};

    /// A coin on ground with much rolling friction; its R and ρ_c, m.
    fn held_by_rolling_friction() -> (Model<Moreau>, f64, f64) {
        let friction = 1e-3;
        let rough = Rough {
            friction: 0.4,
            friction_m: [friction, 1e-4],
            ..Rough::of(0.7, 0.02)
        };
        (rough.model(), rough.scene().coin.radius_m(), friction)
    }

    /// Rolling friction holds a coin at rest on a slope of less than ρ_c/R, and no other: neither
    /// on a steeper one, nor one that rolls too fast to be stopped on the way.
    #[test]
    fn rolling_friction_holds_a_coin_at_rest_on_a_gentle_slope() {
        let time = 0.05;
        let (model, radius, friction) = held_by_rolling_friction();
        let ground = model.ground.expect("a rough ground");
        for (slope, speed, held) in [(0.9, 0.0, true), (1.1, 0.0, false), (0.9, 0.1, false)] {
            let mut toss = touching(&model, &leaning(0.1, [0.0, -speed], speed / radius));
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let contact = walk.contact();
            assert_eq!(contact.mode, Mode::Stick);
            let before = walk.toss.spin.axial;
            let steep = slope * friction / radius * walk.toss.motion.sin;
            walk.descend_on_rim(&contact, [0.0, steep], time);
            let gained = walk.toss.spin.axial - before;
            assert_eq!(gained == 0.0, held, "{slope} {speed}: {gained:e}");
        }
    }

    /// A leaning coin that pivots about the vertical through its contact point does not roll: a gentle slope
    /// does not move it, either.
    #[test]
    fn a_coin_that_pivots_on_the_spot_is_held_on_a_gentle_slope() {
        let (model, radius, friction) = held_by_rolling_friction();
        let ground = model.ground.expect("a rough ground");
        let mut pivoting = leaning(0.3, [0.0; 2], 0.0);
        pivoting.spin_rad_s = Vector3::z() * 3.0;
        for (slope, held) in [(0.9, true), (1.1, false)] {
            let mut toss = touching(&model, &pivoting);
            let point = toss.motion.contact_point(&model.dynamics.body, &toss.spin);
            toss.motion.vy -= point.slip_y;
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let contact = walk.contact();
            assert_eq!(contact.mode, Mode::Stick);
            let before = walk.toss.spin;
            assert!(before.axial.abs() > 0.01);
            let steep = slope * friction / radius * walk.toss.motion.sin;
            walk.descend_on_rim(&contact, [0.0, steep], 0.05);
            assert_eq!(walk.toss.spin.axial == before.axial, held, "{slope}");
        }
    }

    /// A coin in contact, leaning at this angle from upright, with this velocity of its centre
    /// along and across its rim and this rate about its axis, m/s and rad/s.
    fn leaning(angle: f64, [vx, vy]: [f64; 2], rate: f64) -> Launch {
        let (sin, cos) = libm::sincos(angle);
        let axis = Vector3::new(cos, 0.0, sin);
        Launch {
            height_m: 0.0,
            velocity_m_s: Vector3::new(vx, vy, 0.0),
            axis: UnitVector3::new_unchecked(axis),
            spin_rad_s: axis * rate,
        }
    }

    /// A toss that begins where the coin touches the mean ground.
    fn touching(model: &Model<Moreau>, launch: &Launch) -> Toss {
        let mut toss = model.launch(launch);
        toss.motion.z = toss.motion.rest_height(&model.dynamics.body);
        toss
    }

    /// Momentum, and angular momentum about the lowest point of the own rim, per m D sqrt(gD).
    fn momenta(walk: &Walk<'_, Moreau, ()>) -> [Vector3<f64>; 2] {
        let (m, spin, body) = (&walk.toss.motion, &walk.toss.spin, walk.body());
        let u = Vector3::new(m.sin, 0.0, m.cos);
        let across = Vector3::new(m.cos, 0.0, -m.sin);
        let velocity = Vector3::new(m.vx, m.vy, m.vz);
        let point = m.contact_point(body, spin);
        let centre = -Vector3::new(point.rx, 0.0, point.rz);
        let own = u * (body.ka * spin.axial)
            + across * (body.kt * spin.turn)
            + Vector3::y() * (body.kt * spin.tilt);
        [velocity, own + centre.cross(&velocity)]
    }

    /// Half of the pull of a slope on a rim, by Newton's and Euler's laws: about the contact point
    /// its moment is N g_y R/s about x. A point that sticks stays at rest; one that slips takes −N
    /// (g_x, g_y) and stays at the ground, too. So a thin upright wheel rolls downhill at g_y/(1 +
    /// k_a/R²), as textbooks have it.
    #[test]
    fn a_slope_pulls_with_its_moment_about_the_contact_point() {
        let (time, slopes) = (0.05, [0.03, 0.04]);
        for (ratio, angle, sliding, mode) in [
            (1e-3, 1e-5, 0.0, Mode::Stick),
            (0.7, 0.3, 0.0, Mode::Stick),
            (0.7, 0.3, 1.0, Mode::Slip),
        ] {
            let rough = Rough {
                friction_m: [1e-9, 1e-9],
                ..Rough::of(ratio, 0.02)
            };
            let model = rough.model();
            let ground = model.ground.expect("a rough ground");
            let radius = rough.scene().coin.radius_m();
            let mut toss = touching(&model, &leaning(angle, [sliding, -0.3], 0.3 / radius));
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let contact = walk.contact();
            assert_eq!(contact.mode, mode);
            let point = |walk: &Walk<'_, Moreau, ()>| {
                walk.toss.motion.contact_point(walk.body(), &walk.toss.spin)
            };
            let (before, [momentum, angular]) = (point(&walk), momenta(&walk));
            walk.descend_on_rim(&contact, slopes, time);
            let (after, now) = (point(&walk), momenta(&walk));
            let push = 0.5 * time * contact.now.normal;
            let body = model.dynamics.body;
            let moment = push * slopes[1] * body.radius / before.sin;
            let turned = now[1] - angular;
            assert!((turned - Vector3::x() * moment).norm() < 1e-12, "{turned}");
            assert!((after.approach - before.approach).abs() < 1e-12);
            let pushed = now[0] - momentum;
            if mode == Mode::Slip {
                assert!((pushed.x + push * slopes[0]).abs() < 1e-14, "{pushed}");
                assert!((pushed.y + push * slopes[1]).abs() < 1e-14, "{pushed}");
            } else {
                assert!((after.slip_x - before.slip_x).abs() < 1e-12);
                assert!((after.slip_y - before.slip_y).abs() < 1e-12);
            }
            if angle < 1e-3 {
                let rolls = -push * slopes[1] / (1.0 + body.ka / (body.radius * body.radius));
                assert!((pushed.y / rolls - 1.0).abs() < 1e-4, "{pushed} {rolls}");
            }
        }
    }

    /// On both rims half of the pull is that of the mean slope: all of it on a coin that slides,
    /// that of a rolling wheel, g_y/(1 + k_a/R²), on one that rolls straight, which goes on
    /// rolling.
    #[test]
    fn on_both_rims_the_mean_slope_pulls() {
        let model = Rough::of(0.7, 0.02).model();
        let ground = model.ground.expect("a rough ground");
        let mut toss = model.launch(&leaning(0.01, [0.0; 2], 0.0));
        let (mut usage, mut observer) = (Usage::default(), ());
        let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let body = model.dynamics.body;
        let (slopes, time) = ([[0.03, 0.05], [0.01, -0.02]], 0.1);
        let pull = [0.5 * time * 0.02, 0.5 * time * 0.015];
        let [vx, vy, wa, wz] = walk.descend_on_both(&[0.4, 0.3, 0.1, 0.2], slopes, time);
        assert!((vx - (0.4 - pull[0])).abs() < 1e-15);
        assert!((vy - (0.3 - pull[1])).abs() < 1e-15);
        assert_eq!([wa, wz], [0.1, 0.2]);
        let rolling = [0.0, 0.3, -0.3 / body.radius, 0.0];
        let [vx, vy, wa, wz] = walk.descend_on_both(&rolling, slopes, time);
        let gained = -pull[1] / (1.0 + body.ka / (body.radius * body.radius));
        assert!((vy - 0.3 - gained).abs() < 1e-15, "{vy}");
        assert!((vy + body.radius * wa).abs() < 1e-15, "{wa}");
        assert_eq!([vx, wz], [0.0; 2]);
    }
}
