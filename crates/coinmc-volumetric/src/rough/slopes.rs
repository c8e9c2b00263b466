//! The pull of a slope on a coin in contact.
//!
//! The ground under a rim slopes by g_x across the coin's plane and g_y along it. The rim touches
//! where it is parallel to the ground, g_y R/s ahead of its lowest point, and the normal force
//! leans by as much:
//!
//! force (−g_x, −g_y, 1) N at the arm (r_x, g_y R/s, r_z).
//!
//! On an upright disc this passes through the centre. A contact point that sticks takes up the
//! horizontal force, and what is left is the moment N g_y R/s about x: a coin at rest begins to roll
//! downhill, unless rolling friction holds it. A point that slips does not.
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

    /// Adds to the budget what the way down a tilted table has given since the coin was at `before`.
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
    use coinmc_core::Launch;
    use nalgebra::{UnitVector3, Vector3};

    /// Rolling friction holds a coin at rest on a slope of less than ρ_c/R, and no other: neither on a
    /// steeper one, nor one that rolls too fast to be stopped on the way.
    #[test]
    fn rolling_friction_holds_a_coin_at_rest_on_a_gentle_slope() {
        let (friction, time) = (1e-3, 0.05);
        let rough = Rough {
            friction: 0.4,
            friction_m: [friction, 1e-4],
            ..Rough::of(0.7, 0.02)
        };
        let radius = rough.scene().coin.radius_m();
        let model = rough.model();
        let ground = model.ground.expect("a rough ground");
        for (slope, speed, held) in [(0.9, 0.0, true), (1.1, 0.0, false), (0.9, 0.1, false)] {
            let axis = Vector3::new(1.0, 0.0, 0.1).normalize();
            let launch = Launch {
                height_m: 0.0,
                velocity_m_s: Vector3::new(0.0, -speed, 0.0),
                axis: UnitVector3::new_unchecked(axis),
                spin_rad_s: axis * (speed / radius),
            };
            let mut toss = model.launch(&launch);
            toss.motion.z = toss.motion.rest_height(&model.dynamics.body);
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
}
