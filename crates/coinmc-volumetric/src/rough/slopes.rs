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
    use crate::settings::Settings;
    use crate::toss::Toss;
    use coinmc_core::{Launch, Scene, TableTilt};
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

    /// The same on a table that is tilted by 4° in this direction.
    fn tilted(direction_deg: f64) -> Model<Moreau> {
        let scene = Rough {
            friction_m: [1e-9, 1e-9],
            ..Rough::of(0.7, 0.02)
        }
        .scene();
        let tilt = TableTilt::new(4.0, direction_deg).expect("a valid tilt");
        let surface = scene.surface.with_tilt(tilt).expect("a valid surface");
        let scene = Scene::new(scene.coin, surface, 9.81).expect("a valid scene");
        Model::new(&scene, &Settings::default(), Moreau).expect("valid settings")
    }

    /// Half of the pull of a tilted table in a time t is ½ t tan β on the centre. A point that slips leaves it at that; one that
    /// sticks takes up what would move it, so that what is left is the moment of the pull about it.
    #[test]
    fn a_tilted_table_pulls_at_the_centre() {
        let (model, time) = (tilted(30.0), 0.05);
        let ground = model.ground.expect("a rough ground");
        let radius = model.dynamics.body.radius;
        for (sliding, mode) in [(0.0, Mode::Stick), (1.0, Mode::Slip)] {
            let mut launch = leaning(0.3, [sliding, -0.3], 0.3 / (radius * model.units.length_m));
            launch.velocity_m_s =
                nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.4) * launch.velocity_m_s;
            let axis = launch.axis.into_inner();
            launch.axis = UnitVector3::new_unchecked(
                nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.4) * axis,
            );
            launch.spin_rad_s = launch.axis.into_inner() * (0.3 / (radius * model.units.length_m));
            let mut toss = touching(&model, &launch);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let contact = walk.contact();
            assert_eq!(contact.mode, mode);
            // 30° downhill, seen from a frame at .4 rad
            let (sin, cos) = libm::sincos(30.0_f64.to_radians() - 0.4);
            let slope = libm::tan(4.0_f64.to_radians());
            let pull = Vector3::new(cos, sin, 0.0) * (0.5 * time * slope);
            let point = |walk: &Walk<'_, Moreau, ()>| {
                walk.toss.motion.contact_point(walk.body(), &walk.toss.spin)
            };
            let (before, [momentum, angular]) = (point(&walk), momenta(&walk));
            walk.descend_on_rim(&contact, [0.0; 2], time);
            let (after, now) = (point(&walk), momenta(&walk));
            assert!((after.approach - before.approach).abs() < 1e-12);
            if mode == Mode::Slip {
                assert!(
                    (now[0] - momentum - pull).norm() < 1e-12,
                    "{momentum} {pull}"
                );
            } else {
                assert!((after.slip_x - before.slip_x).abs() < 1e-12);
                assert!((after.slip_y - before.slip_y).abs() < 1e-12);
            }
            let centre = -Vector3::new(before.rx, 0.0, before.rz);
            let moment = centre.cross(&pull);
            assert!((now[1] - angular - moment).norm() < 1e-12, "{moment}");
        }
    }

    /// On both rims half of the pull moves a coin that slides, a rolling wheel by 1/(1 + k_a/R²) of it along the ground, and
    /// none that friction holds along its axis.
    #[test]
    fn a_tilted_table_pulls_a_coin_on_both_rims() {
        let (model, time) = (tilted(30.0), 0.1);
        let ground = model.ground.expect("a rough ground");
        let mut toss = model.launch(&leaning(0.01, [0.0; 2], 0.0));
        let (mut usage, mut observer) = (Usage::default(), ());
        let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let body = model.dynamics.body;
        let (sin, cos) = libm::sincos(30.0_f64.to_radians());
        let half = 0.5 * time * libm::tan(4.0_f64.to_radians());
        let (level, close) = ([[0.0; 2]; 2], |a: f64, b: f64| (a - b).abs() < 1e-12);
        let [vx, vy, wa, wz] = walk.descend_on_both(&[0.4, 0.3, 0.1, 0.2], level, time);
        assert!(
            close(vx, 0.4 + half * cos) && close(vy, 0.3 + half * sin),
            "{vx} {vy}"
        );
        assert_eq!([wa, wz], [0.1, 0.2]);
        // it creeps, held by friction, and slides along the ground
        let creep = 0.5 * model.contact_rules().creep;
        let [vx, vy, ..] = walk.descend_on_both(&[creep, 0.3, 0.1, 0.2], level, time);
        assert!(vx == creep && close(vy, 0.3 + half * sin), "{vx} {vy}");
        let rolling = [0.0, 0.3, -0.3 / body.radius, 0.0];
        let [vx, vy, wa, _] = walk.descend_on_both(&rolling, level, time);
        let gained = half * sin / (1.0 + body.ka / (body.radius * body.radius));
        assert!(vx == 0.0 && close(vy, 0.3 + gained) && close(vy, -body.radius * wa));
    }

    /// The way down a tilted table gives the budget what the height is worth, and the way up takes it.
    #[test]
    fn the_way_down_a_tilted_table_adds_to_the_budget() {
        let model = tilted(30.0);
        let ground = model.ground.expect("a rough ground");
        let mut toss = model.launch(&leaning(0.01, [0.0; 2], 0.0));
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let slope = libm::tan(4.0_f64.to_radians());
        let (sin, cos) = libm::sincos(30.0_f64.to_radians());
        for [x, y] in [[0.3, 0.2], [-0.1, 0.4], [-0.5, -0.3]] {
            let (before, budget) = (walk.toss.place, walk.budget);
            walk.toss.place.shift(x, y);
            walk.descend_from(&before);
            let gained = walk.budget - budget;
            assert!(
                (gained - slope * (x * cos + y * sin)).abs() < 1e-14,
                "{gained}"
            );
        }
    }

    /// Rolling friction ρ_c N holds a coin on a gentler slope as long as it stops its rolling within the time: its moment, less
    /// that of the slope, about a contact point that stays where it is, over the moment of inertia there.
    #[test]
    fn rolling_friction_holds_a_coin_that_it_stops_in_time() {
        let (time, friction) = (0.05, 1e-3);
        let (model, radius_m, _) = held_by_rolling_friction();
        let ground = model.ground.expect("a rough ground");
        for angle in [0.1, 0.5] {
            for share in [0.2, 0.6] {
                for (speed, held) in [(0.98, true), (1.02, false)] {
                    let mut toss = touching(&model, &leaning(angle, [0.0; 2], 0.0));
                    let body = model.dynamics.body;
                    let point = toss.motion.contact_point(&body, &toss.spin);
                    // about the contact point, of a body whose centre is at −r
                    let r = -Vector3::new(point.rx, 0.0, point.rz);
                    let u = Vector3::new(point.sin, 0.0, point.cos);
                    let tensor = nalgebra::Matrix3::identity() * (body.kt + r.norm_squared())
                        + u * u.transpose() * (body.ka - body.kt)
                        - r * r.transpose();
                    let gives = tensor.try_inverse().expect("a moment of inertia")[(0, 0)];
                    let (mut usage, mut observer) = (Usage::default(), ());
                    let normal = {
                        let mut still = toss;
                        Walk::above_ground(&model, &ground, &mut still, &mut usage, &mut observer)
                            .contact()
                            .now
                            .normal
                    };
                    let moment = (1.0 - share) * friction / radius_m * body.radius;
                    let rolls = speed * moment * 0.5 * time * normal * gives;
                    // it turns about the horizontal through its contact point, across its plane
                    let spin = Vector3::x() * rolls;
                    let velocity = spin.cross(&r);
                    (toss.motion.vx, toss.motion.vy, toss.motion.vz) =
                        (velocity.x, velocity.y, velocity.z);
                    toss.spin.axial = spin.dot(&u);
                    toss.spin.turn = spin.dot(&Vector3::new(point.cos, 0.0, -point.sin));
                    toss.motion
                        .set_spin(&toss.spin, model.dynamics.axial_factor);
                    let mut walk =
                        Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
                    let contact = walk.contact();
                    assert_eq!(contact.mode, Mode::Stick);
                    let before = walk.toss.spin.axial;
                    let steep = share * friction / radius_m * walk.toss.motion.sin;
                    walk.descend_on_rim(&contact, [0.0, steep], time);
                    let gained = walk.toss.spin.axial - before;
                    assert_eq!(gained == 0.0, held, "{angle} {speed}: {gained:e}");
                }
            }
        }
    }

    /// A pull straight along the coin's axis, or straight along its plane, pulls as well: all of it a coin that slides.
    #[test]
    fn a_table_pulls_a_coin_that_faces_downhill_or_across() {
        let (model, time) = (tilted(0.0), 0.05);
        let ground = model.ground.expect("a rough ground");
        let pull = 0.5 * time * libm::tan(4.0_f64.to_radians());
        let (sin, cos) = libm::sincos(0.3);
        // downhill is along x; a coin whose axis points to y has that at its right
        for (axis, expected) in [([cos, 0.0], [pull, 0.0]), ([0.0, cos], [0.0, -pull])] {
            let mut launch = leaning(0.3, [1.0, 0.0], 0.0);
            launch.axis = UnitVector3::new_unchecked(Vector3::new(axis[0], axis[1], sin));
            let mut toss = touching(&model, &launch);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            let contact = walk.contact();
            assert_eq!(contact.mode, Mode::Slip);
            assert!(walk.pull().contains(&0.0));
            let before = walk.toss.motion;
            walk.descend_on_rim(&contact, [0.0; 2], time);
            let after = walk.toss.motion;
            let gained = [after.vx - before.vx, after.vy - before.vy];
            for (gained, expected) in gained.into_iter().zip(expected) {
                assert!((gained - expected).abs() < 1e-12, "{gained} {expected}");
            }
        }
    }
}
