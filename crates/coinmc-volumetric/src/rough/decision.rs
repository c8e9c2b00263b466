//! When the face of a coin on rough ground is decided.
//!
//! The energy above the ground under a rim must reach 1 (in m g D) to carry the coin over that rim.
//! On rough ground two more things can help: the ground is not as high where the coin will be, and a
//! coin that rolls is kicked by bumps.
//!
//! * *A face*: decided once the energy above the own rim's ground is below 1 − 3σ.
//! * *The side, by energy*: decided once the energy, above the ground of either rim, is below 1 less
//!   what the ground can still change: 3σ, or in proportion less if contour friction stops the coin
//!   within ℓ.
//! * *The side, of a coin that rolls, spins or hops on* (decision `tilting`): where no kick to be
//!   expected can topple the coin. Slopes under the two rims that differ by s_d, passed at speed w,
//!   make it lean at the rate w s_d/2h, and heights that differ by σ_d lean it by σ_d/2h at rest.
//!   With the correlation ρ of the ground over the coin's thickness, s_d² = 2s²(1 − ρ), σ_d² = 2σ²(1
//!   − ρ). A kick adds to the velocities that the coin already rocks and hops with, so the rule asks
//!   that sqrt(E) + sqrt(E_kick) < sqrt(well): E is the energy above rest that may become tilt, by
//!   the rule for a plane, and E_kick that of so many standard deviations of both as were measured
//!   to be enough ([`Kicks`](super::ground::Kicks)).

use super::ground::SPREAD;
use super::tracks::rim_points;
use super::walk::{Touch, Walk};
use crate::impact::ImpactLaw;
use crate::motion::Motion;
use coinmc_core::{Decided, Observer};

/// A coin rests whose kinetic energy has been below this share of its well's depth for this time,
/// in sqrt(D/g): one that turns round on a slope is slow only for a moment.
const REST: f64 = 1e-3;
const REST_TIME: f64 = 5.0;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// The face, if it is decided.
    pub(super) fn decide(&mut self, touch: Touch) -> Option<Decided> {
        let (motion, body) = (&self.toss.motion, self.body());
        if self.model.rule.awaits_rest() {
            return self.decide_at_rest();
        }
        let (own, other) = (self.tracks.own.height, self.tracks.other.height);
        let kinetic = motion.kinetic(body, &self.toss.spin);
        let energy = kinetic + motion.z;
        let sigma = self.ground.height;
        if !self.model.rule.on_side(motion.cos.abs()) {
            return self.keeps_face(energy - own).then_some(Decided::Face);
        }
        if touch != Touch::Both {
            self.at_rest_since = None;
            // a coin that rocks is decided once both rims are down, or it has toppled
            let low = own.min(other);
            let decided = energy - low < 1.0 - SPREAD * sigma || self.is_safe();
            return decided.then_some(Decided::Side);
        }
        let highest = energy - own.min(other);
        let friction = self.model.dynamics.friction.contour / body.outer_radius();
        let ahead = (kinetic / (friction * self.ground.length).max(f64::MIN_POSITIVE)).min(1.0);
        let slow = kinetic < REST * (1.0 - body.radius);
        let rests = self.rests(slow);
        let decided = highest < 1.0 - SPREAD * sigma * ahead || rests || self.is_safe();
        decided.then_some(Decided::Side)
    }

    /// Whether the face of a coin that rebounds from its landing is decided. In flight no energy is gained,
    /// and the next landing is judged by the same rule.
    pub(super) fn lies_on_face(&self) -> bool {
        let rule = &self.model.rule;
        !rule.awaits_rest()
            && !rule.on_side(self.toss.motion.cos)
            && self.keeps_face(self.energy() - self.tracks.own.height)
    }

    /// Whether a coin in the well of a face, with this energy above the ground under its own rim, stays there.
    fn keeps_face(&self, energy: f64) -> bool {
        energy < 1.0 - self.ground.face_margin
    }

    /// The face of a coin that has come to rest, on a table with an edge, whatever touches: a coin at
    /// rest on a slope may go on to leave and to touch it with either rim.
    fn decide_at_rest(&mut self) -> Option<Decided> {
        let kinetic = self.toss.motion.kinetic(self.body(), &self.toss.spin);
        let well = self.model.rule.well(self.toss.motion.cos.abs());
        self.rests(kinetic < REST * (1.0 - self.body().radius))
            .then_some(well)
    }

    /// Whether a coin, slow or not, has been slow for so long that it rests.
    fn rests(&mut self, slow: bool) -> bool {
        if !slow {
            self.at_rest_since = None;
            return false;
        }
        let now = self.usage.time;
        now - *self.at_rest_since.get_or_insert(now) >= REST_TIME
    }

    /// Whether a coin that leans towards its side will stay on it although it rolls, spins or hops on.
    fn is_safe(&self) -> bool {
        let rule = &self.model.rule;
        let (body, ground) = (self.body(), self.ground);
        let mean = 0.5 * (self.tracks.own.height + self.tracks.other.height);
        let motion = Motion {
            z: self.toss.motion.z - mean,
            ..self.toss.motion
        };
        if !rule.is_tilting() {
            return false;
        }
        let state = motion.decision_state(body, &self.toss.spin);
        let loose = (rule.loose_energy(&state) - body.radius).max(0.0);
        let thickness = 2.0 * body.half;
        let points = rim_points(body, &motion, &self.toss.spin);
        let speed = points[0].speed().max(points[1].speed());
        // and what it may gain by rolling down to the deepest place
        let drop = (mean + SPREAD * ground.height).max(0.0);
        let speed = (speed * speed + 2.0 * drop).sqrt();
        let rate = ground.kicks.rates * speed * ground.slope() * ground.contrast / thickness;
        let brim = ground.kicks.brim;
        let well = (1.0 - body.radius) * brim * brim;
        let inertia = body.kt + body.outer_radius().powi(2);
        brim > 0.0 && loose.sqrt() + (0.5 * inertia).sqrt() * rate < well.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::Rough;
    use super::super::walk::{Touch, Walk};
    use super::SPREAD;
    use crate::contact::Usage;
    use crate::laws::Moreau;
    use crate::model::Model;
    use crate::motion::{Motion, Spin};
    use coinmc_core::{Decided, Ended, Face, Outcome, Preset};
    use coinmc_oracle::Start;
    use coinmc_testkit::{Dice, preset_launch};

    /// A coin of this ratio, with this restitution, on ground of this slope and wavelength.
    fn rough([ratio, restitution, slope, wavelength_m]: [f64; 4]) -> Rough {
        Rough {
            restitution,
            friction_m: [2e-4, 2e-5],
            wavelength_m,
            ..Rough::of(ratio, slope)
        }
    }

    /// Whether coins that roll upright end on their side, where the ground may topple them with so many standard
    /// deviations before they rest. `None`: as many as the model says.
    fn stay(numbers: [f64; 4], kicks: Option<f64>) -> (Vec<bool>, u32) {
        let (scene, mut model) = (rough(numbers).scene(), rough(numbers).model());
        if let Some(count) = kicks {
            model.ground.as_mut().expect("a rough ground").kicks.rates = count;
        }
        let outcome = |toss| {
            let mut dice = Dice::new(314, toss);
            let (lean, speed) = (dice.between(-1e-3, 1e-3), dice.between(0.05, 0.6));
            let launch = Start::Rolling(speed).launch(&scene.coin, lean);
            model.run(&launch, &mut ()).outcome
        };
        let outcomes: Vec<_> = (0..80).map(outcome).collect();
        let steps = outcomes.iter().map(|outcome| outcome.contact_steps).sum();
        let stay = |outcome: &Outcome| outcome.face() == Some(Face::Side);
        (outcomes.iter().map(stay).collect(), steps)
    }

    /// A coin on both rims is on its side for good once its energy is below the balance by three standard deviations
    /// of the ground, or by as much less as rolling friction stops it within less than ℓ; one that rocks, by three.
    #[test]
    fn what_the_ground_ahead_can_change_is_left_open() {
        let numbers = [0.7, 0.5, 0.03, 3e-3];
        let (scene, model) = (rough(numbers).scene(), rough(numbers).model());
        let ground = model.ground.expect("a rough ground");
        let mut toss = model.launch(&Start::Rolling(0.1).launch(&scene.coin, 0.0));
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        (walk.tracks.own.height, walk.tracks.other.height) = (0.0, 0.0);
        let body = &model.dynamics.body;
        // the work of rolling friction over ℓ, in m g D
        let work = model.dynamics.friction.contour / body.radius * ground.length;
        let motion = walk.toss.motion;
        walk.toss.spin = Spin::still();
        for (touch, share, open) in [
            (Touch::Both, 0.25, 0.25),
            (Touch::Both, 0.8, 0.8),
            (Touch::Both, 5.0, 1.0),
            (Touch::Rim, 0.25, 1.0),
        ] {
            let kinetic = share * work;
            let limit = 1.0 - SPREAD * ground.height * open;
            for (energy, decided) in [(limit - 1e-9, Some(Decided::Side)), (limit + 1e-9, None)] {
                walk.toss.motion = Motion {
                    vx: 0.0,
                    vy: (2.0 * kinetic).sqrt(),
                    vz: 0.0,
                    z: energy - kinetic,
                    ..motion
                };
                assert_eq!(walk.decide(touch), decided, "{touch:?} {share}");
            }
        }
    }

    /// Coins that roll upright are the hardest to decide. Those decided to stay do so where no kick counts as
    /// harmless and only energy and rest decide.
    #[test]
    fn a_coin_that_is_decided_to_stay_on_its_side_does_so() {
        for numbers in [
            [0.1, 0.5, 0.003, 0.02],
            [0.1, 0.5, 0.003, 1e-3],
            [0.2, 0.5, 0.01, 3e-3],
            [0.3, 0.5, 0.01, 3e-3],
            [0.4, 0.5, 0.01, 0.02],
            [0.5, 0.5, 0.04, 0.01],
        ] {
            let (decided, steps) = stay(numbers, None);
            let (open, more) = stay(numbers, Some(1e9));
            println!("{numbers:?}: {steps} of {more} steps");
            assert_eq!(decided, open, "{numbers:?}");
        }
    }

    /// A face that rough ground decides, in most tosses as the coin rebounds from a landing, is the one
    /// that the coin shows where rough ground decides none, and it is followed until a plane does. Of 6,400
    /// tosses some 800 then take more impacts.
    #[test]
    fn a_face_that_is_decided_is_that_of_a_coin_that_is_followed_on() {
        let mut sooner = 0;
        for numbers in [
            [0.2, 0.2, 0.05, 3e-3],
            [0.3, 0.5, 0.05, 3e-3],
            [0.7, 0.5, 0.15, 1e-2],
            [1.2, 0.8, 0.1, 5e-3],
        ] {
            let (scene, early) = (rough(numbers).scene(), rough(numbers).model());
            let mut open = rough(numbers).model();
            open.ground.as_mut().expect("a rough ground").face_margin = f64::INFINITY;
            for toss in 0..1600 {
                let launch = preset_launch(Preset::Hand, &scene, 313, toss);
                let outcome = |model: &Model<Moreau>| model.run(&launch, &mut ()).outcome;
                let (decided, later) = (outcome(&early), outcome(&open));
                assert_eq!(decided.ended, later.ended, "{numbers:?} toss {toss}");
                assert!(decided.impacts <= later.impacts, "{numbers:?} toss {toss}");
                sooner += u32::from(decided.impacts < later.impacts);
            }
        }
        assert!(sooner > 600, "{sooner}");
    }

    /// Waves of a metre to a kilometre are slopes under a coin, hundreds of its sizes high. It then touches with
    /// both rims only where both are at the ground, and comes to rest. Of 12,000 such tosses 128 failed and 44
    /// met limits when a gap below a share of the height of the waves counted as none, and a rim far above the
    /// ground had its track at the mean of the ground.
    #[test]
    fn a_coin_on_long_waves_comes_to_rest() {
        for numbers in [
            [3.0, 0.5, 0.05, 1e3],
            [0.7, 0.5, 0.05, 100.0],
            [0.7, 0.5, 0.05, 1.0],
            [0.1, 0.5, 0.1, 100.0],
        ] {
            let (scene, model) = (rough(numbers).scene(), rough(numbers).model());
            for toss in 0..700 {
                let launch = preset_launch(Preset::Drop, &scene, 5, toss);
                let ended = model.run(&launch, &mut ()).outcome.ended;
                assert!(
                    matches!(ended, Ended::Decided(_)),
                    "{numbers:?} toss {toss}: {ended:?}"
                );
            }
        }
    }
}
