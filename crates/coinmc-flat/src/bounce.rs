//! One impact of the lowest corner, and what follows it: flight, sustained contact, a decision.

use crate::contact_matrix::Impulse;
use crate::engine::{FlatEngine, Toss};
use crate::impact_law::{Impact, ImpactLaw, ImpactRecord, Resolution};
use crate::motion::Motion;
use crate::shape::Shape;
use crate::touching::Touching;
use coinmc_core::{Breaks, Face};
use coinmc_lanes::{Lane, sin_cos};

/// What follows an impact.
pub(crate) enum After {
    Flight,
    /// Sustained contact, with this slip of the corner.
    Contact(f64),
    Decided(Face),
}

impl<L: ImpactLaw> FlatEngine<L> {
    /// The impact of the lowest corner.
    #[inline(always)]
    pub(crate) fn impact(&self, toss: &mut Toss) -> After {
        let motion = &mut toss.motion;
        let touching = Touching::of(motion);
        motion.z = touching.cos;
        let k = self.shape.k;
        let before = motion.energy(k);
        if let Some(slip) = self.plastic(motion, &touching) {
            motion.cap_energy(k, before);
            return if self.is_rocking_out(motion) {
                self.lie_flat(motion)
            } else {
                After::Contact(slip)
            };
        }
        let (carried, _) = self.strike(motion, &mut toss.breaks);
        if carried == Resolution::StaysInContact {
            return self.settle(motion, before);
        }
        motion.cap_energy(k, before);
        if self.is_rocking_out(motion) {
            self.lie_flat(motion)
        } else {
            After::Flight
        }
    }

    /// The law's impact of the lowest corner.
    #[inline(always)]
    pub(crate) fn strike(
        &self,
        motion: &mut Motion,
        breaks: &mut Breaks,
    ) -> (Resolution, ImpactRecord) {
        let mut strike = self.at_touch(motion, breaks);
        let carried = self.law.resolve(&mut strike);
        let record = strike.record;
        if carried == Resolution::UseImpulse {
            let touching = Touching::of(motion);
            let p = self.impulse(&touching, self.restitution);
            let struck = touching.pushed(&p, self.shape.k);
            (motion.vx, motion.vz, motion.omega) = (struck.vx, struck.vz, struck.omega);
        }
        (carried, record)
    }

    /// The law's impulse, with this restitution.
    #[inline(always)]
    pub(crate) fn impulse<N: Lane>(&self, touching: &Touching<N>, e: f64) -> Impulse<N> {
        let (ux, uz) = touching.approach();
        let matrix = touching.matrix(self.shape.k);
        self.law.impulse(matrix, ux, uz, e, self.friction)
    }

    #[inline(always)]
    fn at_touch<'a>(&'a self, motion: &'a mut Motion, breaks: &'a mut Breaks) -> Impact<'a> {
        Impact {
            motion,
            shape: &self.shape,
            restitution: self.restitution,
            friction: self.friction,
            tolerance: self.settings.tolerance,
            breaks,
            record: ImpactRecord::default(),
        }
    }

    /// The coin a time `t` into an impact that lasts longer, for observers: the law is followed
    /// again, so that tosses nobody looks at keep nothing of it.
    pub(crate) fn resolve_until(&self, touching: Motion, t: f64) -> Motion {
        let mut motion = touching;
        motion.z = sin_cos(motion.delta).1;
        let mut unseen = Breaks::default();
        self.law
            .resolve_until(&mut self.at_touch(&mut motion, &mut unseen), t);
        motion
    }

    /// Sustained contact of a corner whose law has carried it to where it stays on the surface.
    fn settle(&self, motion: &mut Motion, before: f64) -> After {
        let slip = self.press(motion, before);
        if self.is_rocking_out(motion) {
            self.lie_flat(motion)
        } else {
            After::Contact(slip)
        }
    }

    /// Puts a corner that stays on the surface to rest along the normal, by an impact with e = 0;
    /// returns its slip.
    pub(crate) fn press(&self, motion: &mut Motion, before: f64) -> f64 {
        let touching = Touching::of(motion);
        let p = self.impulse(&touching, 0.0);
        let slip = self.lay_on_corner(motion, &touching, &p);
        motion.cap_energy(self.shape.k, before);
        // the cap may have slowed it down
        if slip == 0.0 {
            0.0
        } else {
            motion.vx - motion.omega * touching.cos
        }
    }

    /// If the bounces that remain would all be over before the coin has turned noticeably, ends
    /// them at once by an impact with e = 0; returns the slip after it.
    ///
    /// Between impacts the corner falls with a = 1 − ω²cos δ (its acceleration without contact),
    /// so the remaining bounces take 2 e v/(a(1 − e)), v the normal speed now.
    #[inline(always)]
    fn plastic(&self, motion: &mut Motion, touching: &Touching<f64>) -> Option<f64> {
        if self.bounces_on(touching) {
            return None;
        }
        let e = self.law.effective_restitution(self.restitution);
        let (_, uz) = touching.approach();
        let p = self.impulse(touching, 0.0);
        let omega = touching.turned(&p, self.shape.k);
        let press = 1.0 - omega * omega * touching.cos;
        let rate = 1.0 + omega.abs() / self.narrow;
        if !(press > 0.0 && -uz * 2.0 * e * rate < self.settings.zeno * (1.0 - e) * press) {
            return None;
        }
        Some(self.lay_on_corner(motion, touching, &p))
    }

    /// Whether the bounces that remain take long whatever the coin's turning: a <= 1 and the rate
    /// of turning >= 1 tell most impacts apart.
    #[inline(always)]
    pub(crate) fn bounces_on<N: Lane>(&self, touching: &Touching<N>) -> N::Mask {
        let e = self.law.effective_restitution(self.restitution);
        let (_, uz) = touching.approach();
        let least = N::splat(self.settings.zeno * (1.0 - e));
        least.le(-uz * N::splat(2.0) * N::splat(e))
    }

    /// The motion after an impulse that leaves the corner on the surface; returns its slip.
    #[inline]
    fn lay_on_corner(&self, motion: &mut Motion, from: &Touching<f64>, p: &Impulse) -> f64 {
        let k = self.shape.k;
        let slip = if p.sticks {
            0.0
        } else {
            let matrix = from.matrix(k);
            from.approach().0 + matrix.xx * p.x + matrix.xz * p.z
        };
        motion.set_on_corner(from.sin, from.cos, from.turned(p, k), slip);
        slip
    }

    /// Whether a coin that rises or falls at `vz` may be [rocking out](Self::is_rocking_out).
    #[inline(always)]
    pub(crate) fn may_rock_out<N: Lane>(&self, vz: N) -> N::Mask {
        // without friction a coin this still is decided by its energy
        let slowest = if self.friction == 0.0 {
            f64::NAN
        } else {
            0.1 * self.settings.zeno
        };
        vz.abs().le(N::splat(slowest))
    }

    /// Whether the coin rocks on an edge so little that it may be laid flat: turning, falling and
    /// gap all below zeno/10 of the edge, an energy below (zeno/10)² of the barrier's.
    #[inline]
    fn is_rocking_out(&self, motion: &Motion) -> bool {
        if !self.may_rock_out(motion.vz) {
            return false;
        }
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let small = 0.1 * self.settings.zeno * self.shape.base(motion.quadrant, at_end).1;
        gap < small && motion.omega.abs() < small && motion.vz.abs() < small
    }

    /// Lays the coin flat: a plastic impact of the whole edge. It then slides, and either never
    /// tips (friction μN at the base against the lever of N: μ·height <= half width, certain), or
    /// trips over its leading corner.
    fn lie_flat(&self, motion: &mut Motion) -> After {
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let (height, half_width) = self.shape.base(motion.quadrant, at_end);
        motion.delta += if at_end { gap } else { -gap };
        let braking = (self.friction * motion.vz.abs()).min(motion.vx.abs());
        motion.vx -= braking.copysign(motion.vx);
        (motion.z, motion.vz, motion.omega) = (height, 0.0, 0.0);
        if self.friction * height <= half_width || motion.vx == 0.0 {
            return After::Decided(Shape::face(motion.quadrant, motion.delta));
        }
        // sliding to +x it trips forwards (ω > 0), from the start of a quadrant
        let forwards = motion.vx > 0.0;
        if forwards == at_end {
            motion.cross_flat(&self.shape, forwards);
        }
        After::Contact(motion.vx)
    }
}
