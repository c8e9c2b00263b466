//! Drawing launches, one or several in lanes.

use super::{Launch, Marginal};
use crate::UniformSource;
use coinmc_lanes::{Block, Lane, Wide};
use nalgebra::UnitVector3;

/// Uniform numbers of one toss, or of several in lanes.
pub(super) trait Uniforms<L> {
    /// The uniforms of this dimension, each in the open interval (0, 1).
    fn uniform(&mut self, dimension: u32) -> L;
}

impl<S: UniformSource> Uniforms<f64> for S {
    #[inline(always)]
    fn uniform(&mut self, dimension: u32) -> f64 {
        UniformSource::uniform(self, dimension)
    }
}

/// The numbers of a launch; `T` is one number or one per lane.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub(super) struct Draw<T> {
    pub(super) axis: [T; 3],
    pub(super) spin: [T; 3],
    pub(super) height: T,
    pub(super) velocity: [T; 3],
}

impl<T> Draw<T> {
    /// The launch that `pick` takes from each number.
    #[inline(always)]
    pub(super) fn launch(&self, one: impl Fn(&T) -> f64) -> Launch {
        Launch {
            height_m: one(&self.height),
            velocity_m_s: self.velocity.each_ref().map(&one).into(),
            axis: UnitVector3::new_unchecked(self.axis.each_ref().map(&one).into()),
            spin_rad_s: self.spin.each_ref().map(&one).into(),
        }
    }
}

impl<L: Wide> Draw<L> {
    /// For memory.
    #[inline(always)]
    pub(super) fn store(&self) -> Draw<Block> {
        Draw {
            axis: store3(&self.axis),
            spin: store3(&self.spin),
            height: self.height.store(),
            velocity: store3(&self.velocity),
        }
    }
}

#[inline(always)]
fn store3<L: Wide>([x, y, z]: &[L; 3]) -> [Block; 3] {
    [x.store(), y.store(), z.store()]
}

#[inline(always)]
pub(super) fn sample3<L: Lane>(
    marginals: &[Marginal; 3],
    dimensions: [u32; 3],
    uniforms: &mut impl Uniforms<L>,
) -> [L; 3] {
    let [x, y, z] = marginals;
    let [dx, dy, dz] = dimensions;
    [
        x.sample(dx, uniforms),
        y.sample(dy, uniforms),
        z.sample(dz, uniforms),
    ]
}
