//! How a coin that ends on its side came to lie there.
//!
//! The motion at the beginning of sustained contact with the coin leaning towards its side, not to
//! leave it again, tells what follows. (The motion at the decision does not: `tilting` may decide a
//! rolling coin at any time until it rests, and every rule decides a spinning one only when most of
//! its spin is gone.)
//!
//! * *Rolling*. While the coin slides, friction changes v_y by μ and the rim's speed w = −R ω_a by
//!   μR²/k_a until they are equal, and contour friction takes ρ_c R/k_a from |w|. How far the coin then
//!   rolls follows in closed form from contour friction and drag ([`RollingStop`]).
//! * *Spinning*. Pivoting friction and drag alone stop ω_z after the angle ½ k_t ω_z²/ρ_p, or less
//!   by drag. Under a coin that comes onto both rims at once these slip, too, at the distance h from
//!   the middle: with ρ_p + μh for ρ_p.

use crate::contact::{RollingStop, way_to_rest};
use crate::model::Model;
use crate::toss::Toss;
use coinmc_core::{Ended, Face, OntoSide, SideEnding};
use std::f64::consts::TAU;

/// The motion of a coin that comes onto its side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SideArrival {
    /// Speed of straight rolling, in sqrt(gD).
    rolling: f64,
    /// |ω_z|, in sqrt(g/D).
    turning: f64,
    /// The moment that stops the turning, in m g D.
    pivoting: f64,
}

impl<L> Model<L> {
    /// Notes that sustained contact begins, or goes on: the first time that the coin leans towards
    /// its side counts, unless it leaves the side again.
    #[inline]
    pub(crate) fn note_contact(&self, toss: &mut Toss) {
        if self.rule.on_side(toss.motion.cos) {
            if toss.side_arrival.is_none() {
                toss.side_arrival = Some(self.side_arrival(toss));
            }
        } else {
            toss.side_arrival = None;
        }
    }

    /// The same where both rims touch at once.
    pub(crate) fn note_contact_of_both(&self, toss: &mut Toss) {
        if toss.side_arrival.is_none() {
            let mut arrival = self.side_arrival(toss);
            arrival.pivoting += self.dynamics.friction.mu * self.dynamics.body.half;
            toss.side_arrival = Some(arrival);
        }
    }

    fn side_arrival(&self, toss: &Toss) -> SideArrival {
        let (body, m, spin) = (&self.dynamics.body, &toss.motion, &toss.spin);
        SideArrival {
            rolling: self.rolls_at(m.vy, -body.outer_radius() * spin.axial),
            turning: m.turning(spin).abs(),
            pivoting: self.dynamics.friction.pivoting,
        }
    }

    /// The speed with which a coin begins to roll whose centre moves at `v` and whose rim turns at `w`.
    fn rolls_at(&self, v: f64, w: f64) -> f64 {
        let (body, friction) = (&self.dynamics.body, &self.dynamics.friction);
        let radius = body.outer_radius();
        let (mu, contour, inertia) = (
            friction.mu,
            friction.contour / radius,
            radius * radius / body.ka,
        );
        // its mirror image slides forwards
        let (mut v, mut w) = if v >= w { (v, w) } else { (-v, -w) };
        if mu == 0.0 || v == w {
            return v.abs();
        }
        if w < 0.0 {
            // contour friction helps to stop a rim that turns backwards
            let alike = (v - w) / (mu * (1.0 + inertia) + contour * inertia);
            let still = -w / (inertia * (mu + contour));
            if alike <= still {
                return (v - mu * alike).abs();
            }
            (v, w) = (v - mu * still, 0.0);
        }
        let closing = mu * (1.0 + inertia) - contour * inertia;
        let stopping = (contour - mu) * inertia;
        let held = stopping >= 0.0 && (v - w) * stopping >= w * closing;
        if held {
            // contour friction stops the rim before it is as fast as the centre, and the coin slides to rest
            return 0.0;
        }
        v - mu * (v - w) / closing
    }

    /// How a toss that ended like this came to end on its side; `None` if it did not.
    pub(crate) fn side_ending(&self, toss: &Toss, ended: Ended) -> Option<SideEnding> {
        if ended != Ended::Decided(Face::Side) {
            return None;
        }
        if self.adhesive || self.dynamics.friction.mu == 0.0 {
            // it sticks, or slides as it landed: nothing makes it roll
            return Some(SideEnding::RESTED);
        }
        let arrival = toss.side_arrival.unwrap_or_else(|| self.side_arrival(toss));
        let onto_side = self.onto_side(arrival);
        Some(SideEnding::new(
            &onto_side,
            self.dynamics.body.outer_radius() * self.units.length_m,
        ))
    }

    fn onto_side(&self, arrival: SideArrival) -> OntoSide {
        let SideArrival {
            rolling,
            turning,
            pivoting,
        } = arrival;
        let body = &self.dynamics.body;
        // a creep, which without friction lengths never ends, is no motion
        let creep = self.contact_rules().stick_speed;
        let distance = if rolling > creep {
            RollingStop::new(&self.dynamics, rolling).distance()
        } else {
            0.0
        };
        let angle = if turning > creep {
            way_to_rest(pivoting / body.kt, self.dynamics.drag.angular, turning)
        } else {
            0.0
        };
        let r2 = body.outer_radius().powi(2);
        let energies = [
            (1.0 + body.ka / r2) * rolling * rolling,
            body.kt * turning * turning,
        ];
        OntoSide {
            rolls_m: distance * self.units.length_m,
            turns: angle / TAU,
            turning_prevails: energies[1] > energies[0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Motion, Spin};
    use crate::settings::Settings;
    use crate::toss::tests::{generic_scene, model, model_of, stops_plainly};
    use coinmc_core::{Coin, Landing, Scene, SideMotion, Surface};
    use coinmc_testkit::Dice;

    /// A wheel that rolls keeps its speed; one that slides without spin is left with 1/(1 + k_a/R²) of it, and one
    /// that spins without moving with k_a/R² of what its rim had, divided by the same: 2/3 and 1/3 for a
    /// uniform cylinder.
    #[test]
    fn a_coin_on_its_side_will_roll_with_what_friction_leaves_it() {
        let model = model();
        let radius = model.dynamics.body.outer_radius();
        for number in 0..100 {
            let mut dice = Dice::new(518, number);
            let mut toss = Toss::still();
            toss.motion.lay_on_side();
            let (speed, rim) = (dice.between(-2.0, 2.0), dice.between(-2.0, 2.0));
            toss.motion.vy = speed;
            toss.spin.axial = rim / radius;
            let rolling = model.side_arrival(&toss).rolling;
            // the point that touches moves at v_y + R ω_a
            assert!((rolling - (2.0 * speed - rim).abs() / 3.0).abs() < 1e-14);
            toss.spin.axial = -speed / radius;
            assert!((model.side_arrival(&toss).rolling - speed.abs()).abs() < 1e-14);
        }
    }

    /// The speed at which the slip of a coin on its side ends, by Newton's law in short steps: friction μ brakes the centre
    /// and turns the rim, contour friction brakes the rim, whichever way it turns, and may hold it.
    #[test]
    fn contour_friction_slows_a_coin_down_while_it_slides() {
        let (mut backwards, mut held, mut braked) = (0, 0, 0);
        for number in 0..300 {
            let mut dice = Dice::new(519, number);
            let coin = Coin::cylinder(0.7, 0.013).expect("a valid coin");
            let (mu, contour) = (dice.between(0.1, 0.5), dice.between(0.0, 0.6));
            let surface = Surface::new(0.5, mu)
                .and_then(|surface| surface.with_friction_lengths(contour * 0.013, 1e-5));
            let scene = Scene::new(coin, surface.expect("a valid surface"), 9.81);
            let model = model_of(&scene.expect("a valid scene"), &Settings::default());
            let (body, contour) = (&model.dynamics.body, model.dynamics.friction.contour);
            let radius = body.outer_radius();
            let (v, w) = (dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
            let step = 1e-5;
            let (mut centre, mut rim) = (v, w);
            let way = (v - w).signum();
            while (centre - rim) * way > 0.0 {
                centre -= step * mu * way;
                let driven = rim + step * mu * way * radius * radius / body.ka;
                let braked = step * contour * radius / body.ka;
                rim = if driven.abs() <= braked {
                    0.0
                } else {
                    driven - braked * driven.signum()
                };
            }
            let found = model.rolls_at(v, w);
            let rolls = centre.abs();
            assert!(
                (found - rolls).abs() < 1e-4,
                "{mu} {contour} {v} {w}: {found} {rolls}"
            );
            assert_eq!(model.rolls_at(-v, -w), found);
            backwards += u32::from(v * w < 0.0 && found > 0.01);
            held += u32::from(found == 0.0);
            braked += u32::from(found > 0.01 && mu < contour / radius);
        }
        let all = [backwards, held, braked];
        assert!(backwards > 50 && held > 5 && braked > 5, "{all:?}");
    }

    /// A coin that comes onto both rims at once turns against the friction of both; one on a rim only against pivoting
    /// friction.
    #[test]
    fn a_coin_on_both_rims_turns_against_their_friction() {
        let scene = generic_scene(|plane| plane);
        let model = model_of(&scene, &Settings::default());
        let mut toss = Toss::still();
        toss.motion.lay_on_side();
        (toss.spin.turn, toss.motion.vy) = (0.8, 0.0);
        let (mut both, mut one) = (toss, toss);
        model.note_contact_of_both(&mut both);
        model.note_contact(&mut one);
        let [both, one] = [both, one].map(|toss| toss.side_arrival.expect("on its side"));
        let friction = &model.dynamics.friction;
        assert_eq!(one.pivoting, friction.pivoting);
        assert_eq!(
            both.pivoting,
            friction.pivoting + friction.mu * model.dynamics.body.half
        );
        let (turns, more) = (model.onto_side(both).turns, model.onto_side(one).turns);
        assert!(turns < 0.3 * more, "{turns} {more}");
    }

    /// How far a coin rolls and turns is what its equation of motion says, in short steps: contour friction and drag
    /// slow down its rolling, pivoting friction and drag its turning. What has more energy names it, and a creep is
    /// no motion.
    #[test]
    fn a_coin_on_its_side_rolls_and_turns_as_far_as_friction_and_drag_let_it() {
        let scene = generic_scene(|plane| plane);
        let model = model_of(&scene, &Settings::default());
        let (body, drag) = (&model.dynamics.body, &model.dynamics.drag);
        let friction = &model.dynamics.friction;
        let (radius, creep) = (body.outer_radius(), Settings::default().stick_speed);
        let (mut rolls, mut spins) = (0, 0);
        for number in 0..8 {
            let mut dice = Dice::new(542, number);
            let [rolling, turning] = [0.0; 2].map(|_| dice.between(0.1, 0.9));
            let pivoting = friction.pivoting;
            let found = model.onto_side(SideArrival {
                rolling,
                turning,
                pivoting,
            });
            let share = body.ka / (radius * radius);
            let (way, _) = stops_plainly(
                |v| {
                    let dry = friction.contour / radius;
                    (dry + drag.linear * v + drag.angular * share * v) / (1.0 + share)
                },
                rolling,
            );
            let metres = way * scene.coin.rim_distance_m();
            assert!((found.rolls_m / metres - 1.0).abs() < 1e-5);
            let (angle, _) =
                stops_plainly(|w| friction.pivoting / body.kt + drag.angular * w, turning);
            assert!((found.turns / (angle / std::f64::consts::TAU) - 1.0).abs() < 1e-5);

            let mut rolls_on = Motion::still();
            rolls_on.vy = rolling;
            let wheel = Spin {
                axial: -rolling / radius,
                ..Spin::still()
            };
            let top = Spin {
                turn: turning,
                ..Spin::still()
            };
            let more = Motion::still().kinetic(body, &top) > rolls_on.kinetic(body, &wheel);
            assert_eq!(found.turning_prevails, more);
            if more {
                spins += 1;
            } else {
                rolls += 1;
            }

            let creeps = model.onto_side(SideArrival {
                rolling: 0.99 * creep,
                turning: 0.99 * creep,
                pivoting,
            });
            assert_eq!((creeps.rolls_m, creeps.turns), (0.0, 0.0));
        }
        assert!(rolls > 0 && spins > 0, "{rolls} {spins}");
    }

    /// The first sustained contact on the side counts, until the coin leaves the side again: not a later one, and
    /// none with the coin leaning towards its face.
    #[test]
    fn the_first_contact_on_the_side_counts() {
        let model = model();
        let balance = model.dynamics.body.half;
        let mut toss = Toss::still();
        let leans = |toss: &mut Toss, cos: f64, speed: f64| {
            toss.motion.set_tilt((1.0 - cos * cos).sqrt(), cos);
            toss.motion.vy = speed;
            model.note_contact(toss);
            toss.side_arrival.map(|arrival| arrival.rolling)
        };
        assert_eq!(leans(&mut toss, 1.01 * balance, 0.3), None);
        let first = leans(&mut toss, 0.99 * balance, 0.6).expect("on its side");
        assert!((first - 0.4).abs() < 1e-14);
        assert_eq!(leans(&mut toss, 0.0, 0.9), Some(first));
        assert_eq!(leans(&mut toss, 1.01 * balance, 0.9), None);
        let second = leans(&mut toss, 0.5 * balance, -0.9).expect("on its side again");
        assert!((second - 0.6).abs() < 1e-14);
    }

    /// A coin that sticks where it lands, or on which no friction acts, does not begin to roll.
    #[test]
    fn without_friction_a_coin_on_its_side_rests_or_slides() {
        let on_side = Ended::Decided(Face::Side);
        let ending = |surface: Surface| {
            let coin = Coin::cylinder(0.7, 0.013).expect("a valid coin");
            let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
            let mut toss = Toss::still();
            toss.motion.lay_on_side();
            toss.motion.vy = 0.5;
            let model = model_of(&scene, &Settings::default());
            assert_eq!(model.side_ending(&toss, Ended::Decided(Face::Heads)), None);
            model
                .side_ending(&toss, on_side)
                .expect("on its side")
                .motion
        };
        let plane = |friction| Surface::new(0.5, friction).expect("a valid surface");
        assert_eq!(ending(plane(0.3)), SideMotion::Rolled);
        assert_eq!(ending(plane(0.0)), SideMotion::Rested);
        let sticky = plane(0.3)
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        assert_eq!(ending(sticky), SideMotion::Rested);
    }
}
