//! Flight segments of eight tosses, lane by lane.

use crate::flight::FlightSegment;
use coinmc_lanes::{Block, Lane, WIDTH, Wide};

impl Default for FlightSegment<Block> {
    fn default() -> Self {
        let zeros = [0.0; WIDTH];
        Self {
            quadrant: zeros,
            delta: zeros,
            omega: zeros,
            z: zeros,
            vz: zeros,
            end: zeros,
            cos_end: zeros,
        }
    }
}

impl FlightSegment<Block> {
    pub(super) fn set(&mut self, lane: usize, segment: &FlightSegment<f64>) {
        self.quadrant[lane] = segment.quadrant;
        self.delta[lane] = segment.delta;
        self.omega[lane] = segment.omega;
        self.z[lane] = segment.z;
        self.vz[lane] = segment.vz;
        self.end[lane] = segment.end;
        self.cos_end[lane] = segment.cos_end;
    }

    #[inline(always)]
    pub(super) fn load<L: Wide>(&self) -> FlightSegment<L> {
        FlightSegment {
            quadrant: L::load(&self.quadrant),
            delta: L::load(&self.delta),
            omega: L::load(&self.omega),
            z: L::load(&self.z),
            vz: L::load(&self.vz),
            end: L::load(&self.end),
            cos_end: L::load(&self.cos_end),
        }
    }

    #[inline(always)]
    pub(super) fn store<L: Wide>(&mut self, segment: &FlightSegment<L>) {
        self.quadrant = segment.quadrant.store();
        self.delta = segment.delta.store();
        self.omega = segment.omega.store();
        self.z = segment.z.store();
        self.vz = segment.vz.store();
        self.end = segment.end.store();
        self.cos_end = segment.cos_end.store();
    }
}

impl<L: Lane> FlightSegment<L> {
    #[inline(always)]
    pub(super) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            quadrant: L::select(mask, yes.quadrant, no.quadrant),
            delta: L::select(mask, yes.delta, no.delta),
            omega: L::select(mask, yes.omega, no.omega),
            z: L::select(mask, yes.z, no.z),
            vz: L::select(mask, yes.vz, no.vz),
            end: L::select(mask, yes.end, no.end),
            cos_end: L::select(mask, yes.cos_end, no.cos_end),
        }
    }
}
