//! A toss in sustained contact: on one rim point, on its side, or on its face.

use crate::contact::{ContactSolver, Exit, SideExit};
use crate::flight::Departure;
use crate::model::Model;
use crate::motion::{FLAT, Spin};
use crate::slide::{pulled_way_and_time, way_and_time};
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Decided, Ended, EventKind, Observer};

impl<L> Model<L> {
    /// Follows sustained contact of the lowest point to its end.
    pub(crate) fn follow_contact<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        self.note_contact(toss);
        let (motion, spin, mut adapter) = toss.observed(&self.units, observer);
        let exit = match &self.pull {
            None => solver.follow(motion, spin, &mut adapter),
            Some(pull) => solver.follow_pulled(pull, motion, spin, &mut adapter),
        };
        if exit == Exit::LiftOff {
            self.notify(toss, EventKind::LiftOff, observer);
        }
        self.after_contact(toss, exit)
    }

    /// What follows sustained contact.
    pub(crate) fn after_contact(&self, toss: &mut Toss, exit: Exit) -> Transition {
        match exit {
            Exit::LiftOff => Transition::Flight(Departure::LiftOff),
            // rough ground: the other rim is near it; and the rule for a plane decides faces only
            Exit::OtherRim | Exit::Decided(Decided::Side) if self.ground.is_some() => {
                Transition::NearGround
            }
            Exit::OtherRim => {
                toss.motion.lay_on_side();
                toss.switch_rim();
                Transition::Impact
            }
            Exit::Level => Transition::Impact,
            Exit::Decided(decided) => Transition::End(toss.ended(decided)),
            Exit::NeverSettles => Transition::End(Ended::NeverSettles),
            Exit::TimeLimit => Transition::End(Ended::TimeLimit),
            Exit::GivenUp => Transition::End(self.end_given_up(toss)),
        }
    }

    /// Whether the coin rocks on its side so little that it may be laid down: gap, speed and
    /// angular velocity are below a tenth of zeno of half its thickness.
    #[inline]
    pub(crate) fn barely_rocks_on_side(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let small = self.negligible_rocking * self.dynamics.body.half;
        m.vz.abs() < small && m.cos < small && toss.spin.tilt.abs() < small
    }

    /// Lays the coin on its side, and follows contact of both rims to its end.
    pub(crate) fn lie_on_side<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        self.note_contact_of_both(toss);
        let (motion, spin, mut adapter) = toss.observed(&self.units, observer);
        let exit = match &self.pull {
            None => solver.follow_on_side(motion, spin, &mut adapter),
            Some(pull) => solver.follow_on_side_pulled(pull, motion, spin, &mut adapter),
        };
        match exit {
            SideExit::TipsOntoThisRim => Transition::Contact,
            SideExit::TipsOntoOtherRim => {
                toss.switch_rim();
                Transition::Contact
            }
            SideExit::Leaves(exit) => self.after_contact(toss, exit),
        }
    }

    /// Whether the coin stands on its face, apart from negligible rocking.
    pub(crate) fn stands_on_face(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let small = self.negligible_rocking * self.dynamics.body.radius;
        m.sin < small
            && m.vz.abs() < small
            && toss.spin.tilt.abs() < small
            && toss.spin.turn.abs() < small
    }

    /// What follows for a coin that stands on its face and slides.
    ///
    /// Friction at the leading rim point tips it if μ n_x h > R, where n is the direction of slip
    /// there. Otherwise the face counts as decided. That is rigorous for μh <= R, and nearly so
    /// beyond: n_x may still grow while sliding and spinning die away together.
    pub(crate) fn tip_over_or_decide(&self, toss: &mut Toss) -> Transition {
        let body = &self.dynamics.body;
        let m = &mut toss.motion;
        let speed = (m.vx * m.vx + m.vy * m.vy).sqrt();
        let turning = body.radius * toss.spin.axial;
        let slip = (speed * speed + turning * turning).sqrt();
        if self.dynamics.friction.mu * speed * (body.half + body.rim) <= body.radius * slip {
            if self.rule.awaits_rest() {
                self.slide_to_rest(toss);
            }
            return Transition::End(Ended::Decided(toss.face()));
        }
        let before = m.energy(body, &toss.spin);
        let (nx, ny) = (m.vx / speed, m.vy / speed);
        m.align(nx, ny);
        // a first tilt, which raises the centre by no more than its own size
        m.set_tilt(FLAT, 1.0);
        (m.vz, m.z) = (0.0, m.rest_height(body));
        (toss.spin.tilt, toss.spin.turn) = (0.0, 0.0);
        m.cap_energy(body, &mut toss.spin, before);
        m.set_spin(&toss.spin, self.dynamics.axial_factor);
        toss.place.align(nx, ny);
        Transition::Contact
    }

    /// Slides a coin that stays flat on its face to where it rests.
    fn slide_to_rest(&self, toss: &mut Toss) {
        let (body, m) = (&self.dynamics.body, &mut toss.motion);
        let speed = (m.vx * m.vx + m.vy * m.vy).sqrt();
        let turning = body.radius * toss.spin.axial;
        let mu = self.dynamics.friction.mu;
        let (way, time) = if let Some(pull) = &self.pull {
            let pull = pull.in_frame(&toss.place, 0.0);
            pulled_way_and_time(body, mu, [m.vx, m.vy], turning, pull)
        } else {
            let (way, time) = way_and_time(body, mu, speed, turning);
            let along = |v: f64| if speed > 0.0 { way * v / speed } else { 0.0 };
            ([along(m.vx), along(m.vy)], time)
        };
        toss.place.shift(way[0], way[1]);
        toss.place.time += time;
        (m.vx, m.vy, m.vz) = (0.0, 0.0, 0.0);
        toss.spin = Spin::still();
        m.set_spin(&toss.spin, self.dynamics.axial_factor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::Place;
    use crate::settings::Settings;
    use crate::toss::tests::{agree, generic_scene, model_of};
    use coinmc_core::{Coin, Face, Scene, Surface, TableTilt};
    use coinmc_testkit::Dice;
    use nalgebra::{Vector2, Vector3};

    /// A coin on its face that slides at `v` and spins at `spin`, at some place in some direction.
    fn flat<L>(model: &Model<L>, dice: &mut Dice, v: [f64; 2], spin: f64) -> Toss {
        let mut toss = Toss::still();
        let (sin, cos) = libm::sincos(dice.between(-3.0, 3.0));
        toss.place = Place::at([0.3, -0.7], [cos, sin]);
        toss.heads_up = dice.chance();
        toss.motion.set_tilt(0.0, 1.0);
        (toss.motion.vx, toss.motion.vy) = (v[0], v[1]);
        toss.motion.z = model.dynamics.body.half;
        toss.spin.axial = spin;
        toss.motion
            .set_spin(&toss.spin, model.dynamics.axial_factor);
        toss
    }

    /// Rocking is negligible below a fraction of the lever of the rim, which is half the height on the side and the
    /// radius on the face: each of its parts counts by itself, whatever its sign.
    #[test]
    fn rocking_is_negligible_only_if_every_part_of_it_is() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        let body = &model.dynamics.body;
        let most = 0.1 * Settings::default().zeno;
        for way in [-1.0, 1.0] {
            for part in 0..4 {
                for (share, negligible) in [(0.99, true), (1.01, false)] {
                    let parts = |lever: f64| {
                        let size = |i: usize| if i == part { share } else { 0.9 };
                        [0, 1, 2, 3].map(|i| size(i) * most * lever)
                    };
                    let mut lies = Toss::still();
                    let [cos, vz, tilt, turn] = parts(body.half);
                    (lies.motion.sin, lies.motion.cos) = (1.0, cos);
                    (lies.motion.vz, lies.spin.tilt) = (way * vz, way * tilt);
                    // on its side a coin turns about the vertical without rocking
                    lies.spin.turn = 100.0 * turn;
                    assert_eq!(model.barely_rocks_on_side(&lies), negligible || part == 3);

                    let mut stands = Toss::still();
                    let [sin, vz, tilt, turn] = parts(body.radius);
                    stands.motion.sin = sin;
                    (stands.motion.vz, stands.spin.tilt) = (way * vz, way * tilt);
                    (stands.spin.turn, stands.spin.axial) = (way * turn, 3.0);
                    assert_eq!(model.stands_on_face(&stands), negligible);
                }
            }
        }
    }

    /// A coin that slides on its face trips over its leading rim point where friction there has more moment about
    /// its centre than the weight. In the laboratory it goes on as it was, but for a first tilt into its way.
    #[test]
    fn a_sliding_coin_trips_where_friction_has_more_moment_than_the_weight() {
        let coin = Coin::cylinder(1.3, 0.012).and_then(|coin| coin.with_rim_radius(0.002));
        let surface = Surface::new(0.5, 2.2).expect("a valid surface");
        let scene = Scene::new(coin.expect("a valid coin"), surface, 9.81).expect("a valid scene");
        let model = model_of(&scene, &Settings::default());
        let body = &model.dynamics.body;
        let (mut trips, mut slides) = (0, 0);
        for number in 0..400 {
            let mut dice = Dice::new(540, number);
            let [vx, vy] = [0.0; 2].map(|_| dice.between(-0.8, 0.8));
            let spin = dice.between(-2.5, 2.5);
            let mut toss = flat(&model, &mut dice, [vx, vy], spin);
            // the leading point, below the centre by half the thickness of the coin
            let ahead = Vector3::new(vx, vy, 0.0).normalize();
            let arm = ahead * body.radius - Vector3::z() * (body.half + body.rim);
            let slip = Vector3::new(vx, vy, 0.0) + (Vector3::z() * spin).cross(&arm);
            let force = Vector3::z() - slip.normalize() * model.dynamics.friction.mu;
            let tips = Vector3::z().cross(&ahead).dot(&arm.cross(&force)) > 0.0;

            let before = toss.state(&model.units);
            let energy = toss.motion.energy(body, &toss.spin);
            let next = model.tip_over_or_decide(&mut toss);
            let after = toss.state(&model.units);
            // of a slow coin the first tilt takes more of the speed
            agree(&after, &before, 1e-7);
            if tips {
                trips += 1;
                assert!(matches!(next, Transition::Contact));
                assert_eq!(
                    (toss.motion.sin, toss.spin.tilt, toss.spin.turn),
                    (FLAT, 0.0, 0.0)
                );
                assert!(toss.motion.energy(body, &toss.spin) <= energy * (1.0 + 1e-15));
                let up = if toss.heads_up {
                    after.axis.xy()
                } else {
                    -after.axis.xy()
                };
                let along = up.dot(&before.velocity_m_s.xy().normalize());
                assert!((along / FLAT - 1.0).abs() < 1e-6, "{along}");
                let kept = toss.motion.spin(model.dynamics.axial_factor);
                assert!((kept.axial - toss.spin.axial).abs() < 1e-12);
            } else {
                slides += 1;
                let face = if toss.heads_up {
                    Face::Heads
                } else {
                    Face::Tails
                };
                assert!(
                    matches!(next, Transition::End(Ended::Decided(decided)) if decided == face)
                );
            }
        }
        assert!(trips > 50 && slides > 50, "{trips} {slides}");
    }

    /// The way of the centre and the time to rest of a ring that slides and spins on a plane: Coulomb friction at
    /// points all around it, in short steps.
    fn slide_plainly(
        model: &Model<crate::laws::Moreau>,
        mut v: Vector2<f64>,
        mut spin: f64,
        pull: Vector2<f64>,
    ) -> (Vector2<f64>, f64) {
        let (body, mu) = (&model.dynamics.body, model.dynamics.friction.mu);
        let (points, step) = (32, 1e-3);
        let arms: Vec<_> = (0..points)
            .map(|i| libm::sincos(f64::from(i) * std::f64::consts::TAU / f64::from(points)))
            .map(|(sin, cos)| Vector2::new(cos, sin) * body.radius)
            .collect();
        let (mut way, mut time) = (Vector2::zeros(), 0.0);
        while v.norm() + body.radius * spin.abs() > 3e-3 {
            let (mut force, mut torque) = (pull, 0.0);
            for arm in &arms {
                let slip = v + Vector2::new(-arm.y, arm.x) * spin;
                let size = (slip.norm_squared() + 1e-6).sqrt();
                let friction = -slip * (mu / f64::from(points) / size);
                force += friction;
                torque += arm.perp(&friction);
            }
            way += v * step;
            time += step;
            v += force * step;
            spin += torque / body.ka * step;
        }
        (way, time)
    }

    /// On a table with an edge, level or tilted, a coin on its face slides on to rest: there in the laboratory, and
    /// then, where a ring with friction at every point comes to rest.
    #[test]
    fn on_a_table_with_an_edge_a_coin_slides_to_rest() {
        let tilt = TableTilt::new(4.0, 130.0).expect("a valid tilt");
        for tilted in [false, true] {
            let scene = generic_scene(|plane| {
                let round = plane.with_table_radius(0.5).expect("a valid table");
                if tilted {
                    round.with_tilt(tilt).expect("a valid tilt")
                } else {
                    round
                }
            });
            let model = model_of(&scene, &Settings::default());
            for (number, (v, spin)) in [([0.6, -0.5], 1.2), ([-0.3, 0.7], -0.4), ([0.8, 0.2], 0.0)]
                .into_iter()
                .enumerate()
            {
                let mut toss = flat(&model, &mut Dice::new(541, number as u64), v, spin);
                toss.place.time = 2.0;
                let place = toss.place;
                let [vx, vy] = place.direction(v[0], v[1]);
                let pull = if tilted {
                    Vector2::from(tilt.downhill()) * libm::tan(4.0_f64.to_radians())
                } else {
                    Vector2::zeros()
                };
                let (way, time) = slide_plainly(&model, Vector2::new(vx, vy), spin, pull);
                let next = model.tip_over_or_decide(&mut toss);
                assert!(matches!(next, Transition::End(Ended::Decided(_))));
                let gone = Vector2::from(toss.place.way_from(&place));
                let took = toss.place.time - 2.0;
                assert!((gone - way).norm() < 0.02 * way.norm(), "{gone} {way}");
                assert!((took / time - 1.0).abs() < 0.03, "{took} {time}");
                let rests = toss.state(&model.units);
                assert_eq!(rests.velocity_m_s.norm() + rests.spin_rad_s.norm(), 0.0);
            }
        }
    }
}
