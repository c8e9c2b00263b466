//! Eight coins that have landed: the end of their flights, and their impacts.

use super::arrivals::Arrivals;
use super::columns::has;
use super::departures::Departures;
use super::flights::Flights;
use super::slot::Slot;
use crate::contact::Dynamics;
use crate::flight_phase::land;
use crate::impact::ImpactLaw;
use crate::impact_phase::after_bounce;
use crate::model::Model;
use crate::motion::{FLAT, Motion, Spin};
use crate::rough::FLATTEST;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::Decided;
use coinmc_lanes::{Bits, Block, Lanes, Wide, Work};

#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct ImpactStage {
    arrivals: Arrivals,
    /// Motions and axial angular velocities after the landing, and then after the impact: in the
    /// form in which flights begin with them.
    pub(super) after: Departures,
    turn: Block,
    tilt: Block,
    /// Duration of the flight.
    duration: Block,
    reflected: Bits,
    /// Lanes whose flight was given up, or that landed level.
    gave_up: Bits,
    level: Bits,
    /// Lanes too steep for rough ground to count as a plane.
    steep: Bits,
    /// Lanes whose impact may be the last bounce; lanes where that was wrong.
    may_be_last: Bits,
    retry: Bits,
    stays: Bits,
    lifts_off: Bits,
    decided: Bits,
    on_side: Bits,
    /// Lanes almost on their side or on a face: the scalar path decides what follows.
    nearly_at_rest: Bits,
}

impl ImpactStage {
    /// Lands up to eight flights, and returns how many.
    pub(super) fn land(
        &mut self,
        lanes: Lanes,
        dynamics: &Dynamics,
        flights: &mut Flights,
    ) -> usize {
        let stage = self;
        if dynamics.drag.acts() {
            lanes.enter(Land::<true> {
                stage,
                flights,
                dynamics,
            })
        } else {
            lanes.enter(Land::<false> {
                stage,
                flights,
                dynamics,
            })
        }
    }

    /// Updates a slot for the end of its flight, except for the motion.
    #[inline]
    pub(super) fn end_flight(&self, lane: usize, slot: &mut Slot) {
        slot.toss.rim_changes = 0;
        slot.usage.time += self.duration[lane];
        slot.toss.heads_up ^= has(self.reflected, lane);
    }

    /// Puts a landed coin into a lane.
    #[inline]
    pub(super) fn put(&mut self, lane: usize, slot: usize, toss: &Toss) {
        self.after.put(lane, slot, &toss.motion, &toss.spin);
        (self.turn[lane], self.tilt[lane]) = (toss.spin.turn, toss.spin.tilt);
    }

    /// The slot that a lane works for.
    pub(super) fn slot(&self, lane: usize) -> usize {
        self.after.slots.get(lane)
    }

    /// Lanes whose impact must be computed again, because it was not the last bounce.
    pub(super) fn retry(&self) -> Bits {
        self.retry
    }

    /// Lanes that need the scalar path: their flight was given up, or they landed level.
    pub(super) fn unusual(&self) -> Bits {
        self.gave_up | self.level
    }

    /// Lanes that rough ground must take on.
    pub(super) fn steep(&self) -> Bits {
        self.steep
    }

    /// Lanes that the impact sends straight into a flight.
    pub(super) fn flies(&self) -> Bits {
        !(self.retry | self.decided | self.stays | self.lifts_off | self.nearly_at_rest)
    }

    /// Copies the motion of a lane to its toss.
    #[inline]
    pub(super) fn copy_motion(&self, lane: usize, toss: &mut Toss) {
        let [motion @ .., axial] = &self.after.start;
        toss.motion = Motion::from_columns(&motion.map(|block| block[lane]));
        toss.spin = Spin::from_columns(&[axial[lane], self.turn[lane], self.tilt[lane]]);
    }

    /// Copies the motion with which the flight began to its toss.
    pub(super) fn copy_start(&self, lane: usize, toss: &mut Toss, axial_factor: f64) {
        toss.motion = self.arrivals.start_of(lane);
        toss.spin = toss.motion.spin(axial_factor);
    }

    pub(super) fn gave_up(&self, lane: usize) -> bool {
        has(self.gave_up, lane)
    }

    /// Computes the impacts of all lanes.
    pub(super) fn bounce<I: ImpactLaw>(
        &mut self,
        lanes: Lanes,
        model: &Model<I>,
        may_be_last: bool,
    ) {
        self.may_be_last = if may_be_last { Bits::MAX } else { 0 };
        lanes.enter(Bounce { stage: self, model });
    }

    /// What follows an impact that does not send the coin straight into a flight. Unless the toss
    /// has ended on a face, it has the motion of its lane afterwards.
    #[inline]
    pub(super) fn after_impact<I: ImpactLaw>(
        &self,
        model: &Model<I>,
        lane: usize,
        slot: &mut Slot,
    ) -> Transition {
        let toss = &mut slot.toss;
        if has(self.decided, lane) {
            let decided = if has(self.on_side, lane) {
                self.copy_motion(lane, toss);
                Decided::Side
            } else {
                Decided::Face
            };
            return Transition::End(toss.ended(decided));
        }
        let next = after_bounce(has(self.stays, lane), has(self.lifts_off, lane));
        self.copy_motion(lane, toss);
        if !has(self.nearly_at_rest, lane) {
            return next;
        }
        let mut solver = model.contact_solver(slot.usage);
        let next = model.after_impact(toss, next, &mut solver, &mut ());
        slot.usage = solver.usage;
        next
    }

    #[inline(always)]
    fn store_motion<L: Wide>(&mut self, motion: &Motion<L>, spin: &Spin<L>) {
        let [blocks @ .., axial] = &mut self.after.start;
        for (block, lanes) in blocks.iter_mut().zip(motion.columns()) {
            *block = lanes.store();
        }
        *axial = spin.axial.store();
        self.turn = spin.turn.store();
        self.tilt = spin.tilt.store();
    }

    #[inline(always)]
    fn load_motion<L: Wide>(&self) -> (Motion<L>, Spin<L>) {
        let (motion, axial) = self.after.load::<L>();
        let spin = Spin {
            axial,
            turn: L::load(&self.turn),
            tilt: L::load(&self.tilt),
        };
        (motion, spin)
    }
}

struct Land<'a, const DRAGS: bool> {
    stage: &'a mut ImpactStage,
    flights: &'a mut Flights,
    dynamics: &'a Dynamics,
}

impl<const DRAGS: bool> Work for Land<'_, DRAGS> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Wide>(self) -> usize {
        let (stage, dynamics) = (self.stage, self.dynamics);
        let count = self.flights.collect::<L>(&mut stage.arrivals);
        stage.after.slots = stage.arrivals.slots;
        let orbit = stage.arrivals.orbit::<L>(dynamics.drag.known::<DRAGS>());
        let (time, gave_up) = stage.arrivals.close_in(&orbit, &dynamics.body);
        let (motion, axial) = stage.arrivals.start::<L>();
        let landed = land(dynamics, &orbit, &motion, axial, time);
        stage.store_motion(&landed.motion, &landed.spin);
        stage.gave_up = L::bits(gave_up);
        // a toss whose flight is given up ends where that flight began
        let duration = L::select(gave_up, L::splat(0.0), orbit.since_start(time));
        stage.duration = duration.store();
        stage.reflected = L::bits(landed.reflected) & !stage.gave_up;
        stage.level = L::bits(landed.motion.sin.le(L::splat(FLAT)));
        stage.steep = L::bits(L::splat(FLATTEST).le(landed.motion.sin));
        count
    }
}

struct Bounce<'a, I> {
    stage: &'a mut ImpactStage,
    model: &'a Model<I>,
}

impl<I: ImpactLaw> Work for Bounce<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (stage, model) = (self.stage, self.model);
        let (landed, falling) = stage.load_motion::<L>();
        let bounced = model.bounce(&landed, &falling, L::mask(stage.may_be_last));
        let (retry, motion, spin) = (bounced.retry, &bounced.motion, &bounced.spin);
        stage.retry = L::bits(retry);
        // a coin that must bounce again keeps the motion with which it landed
        let kept = Motion::select(retry, &landed, motion);
        stage.store_motion(&kept, &Spin::select(retry, &falling, spin));
        stage.stays = L::bits(bounced.stays);
        stage.lifts_off = L::bits(bounced.lifts_off);
        let body = &model.dynamics.body;
        let state = motion.decision_state(body, spin);
        stage.decided = L::bits(model.rule.is_decided(&state));
        stage.on_side = L::bits(model.rule.on_side(motion.cos));
        let small = model.negligible_rocking;
        let lies = motion.cos.lt(L::splat(small * body.half));
        let stands = motion.sin.le(L::splat((small * body.radius).max(FLAT)));
        stage.nearly_at_rest = L::bits(lies | stands);
    }
}

#[cfg(test)]
mod tests {
    use super::super::columns::put_start;
    use super::*;
    use crate::laws::Moreau;
    use crate::rigid::Rigid;
    use crate::settings::Settings;
    use coinmc_core::{Coin, Scene, Surface};
    use nalgebra::Vector3;

    fn landed(tilt: f64) -> Toss {
        let body = Rigid::generic_body(0.0);
        let coin = Rigid::new(
            &body,
            tilt,
            Vector3::new(0.3, -0.7, -1.1),
            Vector3::new(1.7, -2.3, 0.9),
        );
        let mut toss = Toss::still();
        (toss.motion, toss.spin) = coin.folded(1.3, 0.9);
        toss
    }

    /// A lane flies unless any one of the five reasons, or any two of them, keep it.
    #[test]
    fn lanes_fly_that_nothing_keeps() {
        for (first, second) in (0..5).flat_map(|first| (0..5).map(move |second| (first, second))) {
            let mut reasons = [0; 5];
            reasons[first] |= 0b0001_0100;
            reasons[second] |= 0b0001_0010;
            let [retry, decided, stays, lifts_off, nearly_at_rest] = reasons;
            let stage = ImpactStage {
                retry,
                stays,
                lifts_off,
                decided,
                nearly_at_rest,
                ..ImpactStage::default()
            };
            assert_eq!(stage.flies(), 0b1110_1001, "{first} {second}");
            assert_eq!(stage.retry(), retry);
        }
        let stage = ImpactStage {
            gave_up: 0b0101,
            level: 0b0011,
            ..ImpactStage::default()
        };
        assert_eq!(stage.unusual(), 0b0111);
        let gave_up: Vec<bool> = (0..4).map(|lane| stage.gave_up(lane)).collect();
        assert_eq!(gave_up, [true, false, true, false]);
    }

    /// A toss gets back what was put into its lane, and the motion with which its flight began, of which the angular
    /// velocity is a part.
    #[test]
    fn a_lane_gives_back_the_motions_of_its_toss() {
        let mut stage = ImpactStage::default();
        let (put, start) = (landed(0.4), landed(1.1));
        stage.put(3, 17, &put);
        put_start(&mut stage.arrivals.start, 3, &start.motion, &start.spin);
        assert_eq!(stage.slot(3), 17);
        let mut toss = Toss::still();
        stage.copy_motion(3, &mut toss);
        assert_eq!(toss.motion.columns(), put.motion.columns());
        assert_eq!(toss.spin.columns(), put.spin.columns());
        stage.copy_start(3, &mut toss, 1.3);
        assert_eq!(toss.motion.columns(), start.motion.columns());
        for (found, expected) in toss.spin.columns().into_iter().zip(start.spin.columns()) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    /// Impacts in lanes are those of the same coins one by one, and only coins whose lower face or lower side is within
    /// the negligible angle of the ground need more than that.
    #[test]
    fn impacts_in_lanes_are_those_of_single_coins() {
        let coin = Coin::cylinder(1.2, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 0.3).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        let model = Model::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        let (body, small) = (model.dynamics.body, model.negligible_rocking);
        let side = |share: f64| libm::acos(share * small * body.half);
        let face = |share: f64| libm::asin(share * small * body.radius);
        let tilts = [
            0.3,
            face(0.5),
            face(2.0),
            1.0,
            side(0.5),
            side(2.0),
            1.2,
            0.7,
        ];
        for lanes in Lanes::wide() {
            let mut stage = ImpactStage::default();
            let mut tosses = tilts.map(landed);
            for (lane, toss) in tosses.iter_mut().enumerate() {
                toss.motion.vz *= 1.0 + lane as f64;
                toss.motion.z = toss.motion.rest_height(&body);
                stage.put(lane, lane, toss);
            }
            stage.bounce(lanes, &model, true);
            assert_eq!(stage.nearly_at_rest, 0b0001_0010, "{lanes}");
            for (lane, toss) in tosses.iter().enumerate() {
                let bounced = model.bounce(&toss.motion, &toss.spin, true);
                assert_eq!(has(stage.retry, lane), bounced.retry, "{lanes} {lane}");
                assert_eq!(has(stage.stays, lane), bounced.stays);
                assert_eq!(has(stage.lifts_off, lane), bounced.lifts_off);
                let mut after = Toss::still();
                stage.copy_motion(lane, &mut after);
                let (motion, spin) = if bounced.retry {
                    (toss.motion, toss.spin)
                } else {
                    (bounced.motion, bounced.spin)
                };
                assert_eq!(after.motion.columns(), motion.columns(), "{lanes} {lane}");
                assert_eq!(after.spin.columns(), spin.columns(), "{lanes} {lane}");
            }
        }
    }
}
