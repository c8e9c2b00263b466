//! The stage of impact: the touching lanes of a flight stage, all at once.

use super::flight_stage::FlightStage;
use crate::decision::decided_by_energy;
use crate::flight::{FlightSegment, LEAST_DEPARTURE};
use crate::impact_law::ImpactLaw;
use crate::parameters::Parameters;
use crate::touching::Touching;
use coinmc_lanes::{Bits, Lanes, Wide, Work};

/// The lanes that do not fly on after an impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct AfterImpacts {
    /// Left to the scalar path: they touch, with the motion before the impact.
    pub(super) scalar: Bits,
    /// Energy decides the face.
    pub(super) decided: Bits,
}

impl FlightStage {
    /// The impacts of the lanes that touch. Those that bounce begin their next flight.
    pub(super) fn impact<I: ImpactLaw>(
        &mut self,
        lanes: Lanes,
        parameters: &Parameters<I>,
    ) -> AfterImpacts {
        lanes.enter(ImpactStage {
            flights: self,
            parameters,
        })
    }
}

struct ImpactStage<'a, I> {
    flights: &'a mut FlightStage,
    parameters: &'a Parameters<I>,
}

impl<I: ImpactLaw> Work for ImpactStage<'_, I> {
    type Output = AfterImpacts;

    #[inline(always)]
    fn run<L: Wide>(self) -> AfterImpacts {
        let (flights, parameters) = (self.flights, self.parameters);
        let (shape, k) = (&parameters.shape, parameters.shape.k);
        let touching_bits = std::mem::take(&mut flights.touching);
        let mask = L::mask(touching_bits);
        let before: FlightSegment<L> = flights.segment.load();
        let mut landed = before;
        landed.advance(L::load(&flights.t));
        let vx = L::load(&flights.vx);
        let touching = Touching::new(landed.delta, vx, landed.vz, landed.omega);
        let p = parameters.impulse(&touching, parameters.restitution);
        let after = touching.after(&p, k).capped(k, touching.energy(k));
        let bounces =
            parameters.keeps_bouncing(&touching) & !parameters.may_be_nearly_flat(after.vz);
        let without_sliding = after.energy_without_sliding(k);
        let decided = decided_by_energy(parameters.friction, without_sliding, after.vx);
        let flies = mask & bounces & !decided;
        let state = [landed.delta, after.omega, after.cos, after.vz];
        let departure = FlightSegment::new(shape, landed.quadrant, state);
        let next = departure.first_step(after.sin, after.cos);
        let grounded = FlightSegment::select(mask, &landed, &before);
        let segment = FlightSegment::select(flies, &departure, &grounded);
        flights.segment.store(&segment);
        flights.vx = L::select(flies, after.vx, vx).store();
        let evaluations = L::load(&flights.evaluations);
        flights.evaluations = L::select(flies, L::splat(1.0), evaluations).store();
        let least = L::load(&flights.least);
        let least = L::select(flies, L::splat(2.0 * LEAST_DEPARTURE), least);
        flights.searching |= L::bits(flies);
        flights.continue_search(shape, &segment, (L::load(&flights.t), next, least), flies);
        AfterImpacts {
            scalar: touching_bits & !L::bits(bounces),
            decided: touching_bits & L::bits(bounces & decided),
        }
    }
}
