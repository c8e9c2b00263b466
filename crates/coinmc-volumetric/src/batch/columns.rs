//! Columns of lanes in memory: each number of a stage is a block of eight, one for each lane.

use crate::flight::OrbitState;
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Bits, Block, Route, Wide};

/// Columns of an orbit.
pub(super) const ORBIT: usize = OrbitState::<f64>::COLUMNS;
/// Columns of a search: time, smallest step, evaluations.
pub(super) const SEARCH: usize = 3;
/// Columns of the motion at the start of a flight: those of [`Motion`], and the axial angular
/// velocity.
pub(super) const START: usize = 10;

/// Loads columns into registers.
#[inline(always)]
pub(super) fn load<L: Wide, const N: usize>(blocks: &[Block; N]) -> [L; N] {
    let mut lanes = [L::splat(0.0); N];
    for (lanes, block) in lanes.iter_mut().zip(blocks) {
        *lanes = L::load(block);
    }
    lanes
}

/// Stores registers as columns.
#[inline(always)]
pub(super) fn store<L: Wide, const N: usize>(blocks: &mut [Block; N], from: &[L; N]) {
    for (block, lanes) in blocks.iter_mut().zip(from) {
        *block = lanes.store();
    }
}

/// The motion at the start of a flight and its axial angular velocity, from their columns.
#[inline(always)]
pub(super) fn start_of_flight<L: Wide>(columns: &[L; START]) -> (Motion<L>, L) {
    let [sin, cos, ox, oy, oz, vx, vy, vz, z, axial] = *columns;
    let motion = Motion::from_columns(&[sin, cos, ox, oy, oz, vx, vy, vz, z]);
    (motion, axial)
}

/// Writes a motion and its axial angular velocity into one lane.
#[inline]
pub(super) fn put_start(
    columns: &mut [Block; START],
    lane: usize,
    motion: &Motion<f64>,
    spin: &Spin<f64>,
) {
    let [blocks @ .., axial] = columns;
    for (block, number) in blocks.iter_mut().zip(motion.columns()) {
        block[lane] = number;
    }
    axial[lane] = spin.axial;
}

/// Whether the bit of a lane is set.
pub(super) fn has(bits: Bits, lane: usize) -> bool {
    bits & (1 << lane) != 0
}

/// Which slot of the pool each lane works for. Slot numbers are stored as the bits of an `f64`, so
/// that they can move between stages like every other column; no arithmetic is done on them.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub(super) struct SlotNumbers([Block; 1]);

impl SlotNumbers {
    #[inline]
    pub(super) fn get(&self, lane: usize) -> usize {
        // the bits are those of a `usize`: see `set`
        #[allow(clippy::cast_possible_truncation)]
        let slot = self.0[0][lane].to_bits() as usize;
        slot
    }

    #[inline]
    pub(super) fn set(&mut self, lane: usize, slot: usize) {
        self.0[0][lane] = f64::from_bits(slot as u64);
    }

    #[inline(always)]
    pub(super) fn follow<L: Wide>(&mut self, route: &Route, from: &Self) {
        L::follow(route, &from.0, &mut self.0);
    }
}
