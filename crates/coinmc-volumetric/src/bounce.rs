//! One impact of the lowest point: an ordinary bounce, or the end of a sequence of bounces.
//! Generic over lanes: one toss or several at once.

use crate::contact::{self, Dynamics};
use crate::impact::{ContactPoint, ImpactLaw};
use crate::model::Model;
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Lane, Mask};

/// The coin after an impact.
pub(crate) struct Bounced<L: Lane> {
    pub(crate) motion: Motion<L>,
    pub(crate) spin: Spin<L>,
    /// Sustained contact follows; otherwise flight.
    pub(crate) stays: L::Mask,
    /// The contact point separates by its acceleration alone.
    pub(crate) lifts_off: L::Mask,
    /// The impact was computed as the last bounce and turned out not to be. The rest of the result
    /// is not valid; the impact must be computed again with `may_be_last` off.
    pub(crate) retry: L::Mask,
}

impl<I: ImpactLaw> Model<I> {
    /// The impact of the lowest point.
    ///
    /// If all remaining bounces would be over before the coin has turned noticeably, they are
    /// replaced by one impact with e = 0 and sustained contact. This is tried only where
    /// `may_be_last` is set.
    #[inline(always)]
    pub(crate) fn bounce<L: Lane>(
        &self,
        motion: &Motion<L>,
        spin: &Spin<L>,
        may_be_last: L::Mask,
    ) -> Bounced<L> {
        let dynamics = &self.dynamics;
        // sharp rims, known to the compiler, take fewer operations
        if dynamics.body.rim == 0.0 {
            self.bounce_of(&dynamics.with_sharp_rims(), motion, spin, may_be_last)
        } else {
            self.bounce_of(dynamics, motion, spin, may_be_last)
        }
    }

    /// The same, with the dynamics as the compiler knows them.
    #[inline(always)]
    fn bounce_of<L: Lane>(
        &self,
        dynamics: &Dynamics,
        motion: &Motion<L>,
        spin: &Spin<L>,
        may_be_last: L::Mask,
    ) -> Bounced<L> {
        let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
        let energy = motion.energy(&dynamics.body, spin);
        let mut point = motion.contact_point(&dynamics.body, spin);
        // a rim point that has just become the lowest may already recede, by rounding
        point.approach = point.approach.min(zero);
        let speed = -point.approach;
        let most = self.restitution.most(speed);
        let plastic = most.le(zero);
        // the remaining bounces take 2 e v/(a(1 − e)) at most, where a is the acceleration that
        // closes the gap
        let rest = two * most * speed;
        let quick = L::splat(self.zeno) * (one - most);
        let short = rest.lt(quick * (two + two * dynamics.uplift(motion, spin)));
        let tries = (may_be_last & short) | plastic;
        let e = L::select(tries, zero, self.restitution.at(speed, most));
        let (mut motion, spin) = self.after_impulse(dynamics, motion, spin, &point, e, energy);
        let never = <L::Mask as Mask>::splat(false);
        let (mut stays, mut lifts_off, mut retry) = (never, never, never);
        if tries.any() {
            let press = dynamics.press(&motion, &spin);
            let over = (rest * contact::fastest_rate(&motion, &spin)).lt(quick * press);
            stays = tries & zero.lt(press) & over;
            lifts_off = plastic & !stays;
            retry = tries & !stays & !plastic;
        }
        motion.set_spin(&spin, dynamics.axial_factor);
        Bounced {
            motion,
            spin,
            stays,
            lifts_off,
            retry,
        }
    }

    /// The motion after the impact with restitution `e`, with no more energy than `energy`.
    #[inline(always)]
    fn after_impulse<L: Lane>(
        &self,
        dynamics: &Dynamics,
        motion: &Motion<L>,
        spin: &Spin<L>,
        point: &ContactPoint<L>,
        e: L,
        energy: L,
    ) -> (Motion<L>, Spin<L>) {
        let p = self
            .impact
            .impulse(&dynamics.body, &dynamics.friction, point, e);
        let (mut motion, mut spin) = (*motion, *spin);
        motion.apply_impulse(&mut spin, &dynamics.body, point, p);
        motion.cap_energy(&dynamics.body, &mut spin, energy);
        // rough ground turns its normal from impact to impact, so nothing stays in a plane there
        if self.ground.is_none() {
            motion.stop_residue(&mut spin);
        }
        (motion, spin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::four::{Bits, Four};
    use crate::laws::Moreau;
    use crate::rigid::Rigid;
    use crate::settings::Settings;
    use crate::toss::tests::model_of;
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;
    use std::array::from_fn;

    /// Impacts without restitution below 3e-3 sqrt(gD), with one half above, of a coin with this radius of its rims.
    fn model(rim_m: f64) -> Model<Moreau> {
        let coin = Coin::cylinder(0.4, 0.0116).and_then(|coin| coin.with_rim_radius(rim_m));
        let coin = coin.expect("a valid coin");
        let scene = |surface| Scene::new(coin, surface, 9.81).expect("a valid scene");
        let plane = Surface::new(0.5, 0.3).expect("a valid surface");
        let unit = crate::body::Units::new(&scene(plane)).speed_m_s();
        let plane = plane.with_restitution_threshold(3e-3 * unit);
        model_of(
            &scene(plane.expect("a valid threshold")),
            &Settings::default(),
        )
    }

    /// A coin whose lowest point comes down at this speed.
    fn coming_down(model: &Model<Moreau>, dice: &mut Dice, speed: f64) -> (Motion<f64>, Spin<f64>) {
        let body = &model.dynamics.body;
        let mut rate = |size: f64| dice.between(-size, size);
        let spin = Spin {
            axial: rate(1.0),
            turn: rate(0.5),
            tilt: rate(1.5),
        };
        let mut motion = Motion::still();
        (motion.vx, motion.vy) = (rate(0.5), rate(0.5));
        let (sin, cos) = libm::sincos(dice.between(0.1, 1.5));
        motion.set_tilt(sin, cos);
        motion.z = motion.rest_height(body);
        motion.set_spin(&spin, model.dynamics.axial_factor);
        motion.vz = -speed - motion.contact_point(body, &spin).approach;
        (motion, spin)
    }

    /// Whatever the impulse at the lowest point, the angular momentum about that point stays, of rounded rims, too.
    #[test]
    fn an_impact_keeps_the_angular_momentum_about_the_lowest_point() {
        for model in [model(0.0), model(0.002)] {
            let body = &model.dynamics.body;
            let momentum = |motion: &Motion<f64>, spin: &Spin<f64>| {
                let (s, c) = (motion.sin, motion.cos);
                let omega = Vector3::new(
                    s * spin.axial + c * spin.turn,
                    spin.tilt,
                    c * spin.axial - s * spin.turn,
                );
                let velocity = Vector3::new(motion.vx, motion.vy, motion.vz);
                let coin = Rigid::new(body, libm::atan2(s, c), velocity, omega);
                coin.angular_momentum() - coin.arm.cross(&velocity)
            };
            for number in 0..200 {
                let (motion, spin) = coming_down(&model, &mut Dice::new(545, number), 0.7);
                let after = model.bounce(&motion, &spin, false);
                let change = momentum(&after.motion, &after.spin) - momentum(&motion, &spin);
                assert!(change.norm() < 1e-12, "{change}");
            }
        }
    }

    /// After an impact without restitution the coin stays if its contact point presses on the surface, and else lifts
    /// off. One with restitution rebounds unless it is so slow that what remains of its bounces counts as none; if
    /// that was tried in vain, it is to be tried again. It is tried where the bounces may take no longer than that, pressed
    /// onto the surface at most twice as much as by the weight and the gyroscopic torque before the impact.
    #[test]
    fn a_plastic_impact_stays_or_lifts_off() {
        let models = [model(0.0), model(0.002)];
        let mut seen = [0; 5];
        for number in 0..2_000 {
            let mut dice = Dice::new(543, number);
            let model = if number % 2 == 0 {
                &models[0]
            } else {
                &models[1]
            };
            let speed = dice.scale(5e-4, 1.0);
            let (motion, spin) = coming_down(model, &mut dice, speed);
            let found = model.bounce(&motion, &spin, true);
            let press = model.dynamics.press(&found.motion, &found.spin);
            let point = found
                .motion
                .contact_point(&model.dynamics.body, &found.spin);
            if speed < 3e-3 {
                assert_eq!([found.stays, found.lifts_off], [press > 0.0, press <= 0.0]);
                assert!(!found.retry && point.approach.abs() < 1e-12);
                seen[usize::from(found.stays)] += 1;
            } else {
                assert!(!found.lifts_off);
                assert!(!found.stays || !found.retry);
                let momentum = Vector3::new(motion.ox, motion.oy, motion.oz);
                let turning = Vector3::z() * (-spin.turn / motion.sin);
                let gyroscopic = turning.cross(&momentum).y.abs();
                let most = 2.0 * (1.0 + gyroscopic) * model.zeno;
                assert_eq!(found.stays || found.retry, 2.0 * speed < most);
                if found.stays {
                    // 2 e v/(a (1 − e)) of bounces
                    assert!(press > 0.0 && 2.0 * speed / press < model.zeno);
                    assert!(point.approach.abs() < 1e-12);
                    seen[2] += 1;
                } else if found.retry {
                    let again = model.bounce(&motion, &spin, false);
                    assert!(!again.stays && !again.lifts_off && !again.retry);
                    seen[3] += 1;
                } else {
                    assert!((point.approach - 0.5 * speed).abs() < 1e-12);
                    seen[4] += 1;
                }
            }
        }
        assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
    }

    /// Of four impacts at once, each is what it is alone, whichever of them may be the last bounce.
    #[test]
    fn impacts_in_lanes_are_those_of_single_coins() {
        let model = model(0.0);
        for number in 0..500 {
            let mut dice = Dice::new(544, number);
            let coins: [_; 4] = from_fn(|_| {
                let speed = dice.scale(5e-4, 1.0);
                coming_down(&model, &mut dice, speed)
            });
            let motion = Motion::from_columns(&from_fn(|i| {
                Four(coins.map(|(motion, _)| motion.columns()[i]))
            }));
            let spin =
                Spin::from_columns(&from_fn(|i| Four(coins.map(|(_, spin)| spin.columns()[i]))));
            let may_be_last: [bool; 4] = from_fn(|_| dice.chance());
            let all = model.bounce(&motion, &spin, Bits(may_be_last));
            for (lane, (motion, spin)) in coins.into_iter().enumerate() {
                let one = model.bounce(&motion, &spin, may_be_last[lane]);
                let masks = [all.stays, all.lifts_off, all.retry].map(|mask| mask.0[lane]);
                assert_eq!(masks, [one.stays, one.lifts_off, one.retry]);
                if masks != [false, false, true] {
                    let columns = all.motion.columns().map(|column| column.0[lane]);
                    assert_eq!(columns, one.motion.columns());
                    let columns = all.spin.columns().map(|column| column.0[lane]);
                    assert_eq!(columns, one.spin.columns());
                }
            }
        }
    }
}
