//! One impact of the lowest corner: the coin then flies, stays in contact, or is decided.

use crate::contact_matrix::Impulse;
use crate::impact_law::{Impact, ImpactLaw, ImpactRecord, Resolution};
use crate::motion::Motion;
use crate::parameters::Parameters;
use crate::shape::Shape;
use crate::toss::Toss;
use crate::touching::Touching;
use coinmc_core::{Breaks, Face};
use coinmc_lanes::{Lane, sin_cos};

/// What follows an impact.
pub(crate) enum AfterImpact {
    Flight,
    /// Sustained contact, with this slip velocity of the corner.
    Contact {
        slip: f64,
    },
    Decided(Face),
}

impl<L: ImpactLaw> Parameters<L> {
    /// The impact of the lowest corner.
    #[inline(always)]
    pub(crate) fn impact(&self, toss: &mut Toss) -> AfterImpact {
        let motion = &mut toss.motion;
        let touching = Touching::of(motion);
        motion.z = touching.cos;
        let k = self.shape.k;
        let before = motion.energy(k);
        if let Some(slip) = self.collapse_bounces(motion, &touching) {
            motion.cap_energy(k, before);
            return self.in_contact(motion, slip);
        }
        let (resolution, _) = self.apply_law(motion, &mut toss.counters.breaks);
        if resolution == Resolution::StaysInContact {
            let slip = self.stop_normal_motion(motion, before);
            return self.in_contact(motion, slip);
        }
        motion.cap_energy(k, before);
        if self.is_nearly_flat(motion) {
            self.lay_flat(motion)
        } else {
            AfterImpact::Flight
        }
    }

    /// Applies the law of impact to the lowest corner.
    #[inline(always)]
    pub(crate) fn apply_law(
        &self,
        motion: &mut Motion,
        breaks: &mut Breaks,
    ) -> (Resolution, ImpactRecord) {
        let mut impact = self.at_touch(motion, breaks);
        let resolution = self.law.resolve(&mut impact);
        let record = impact.record;
        if resolution == Resolution::UseImpulse {
            let touching = Touching::of(motion);
            let p = self.impulse(&touching, self.restitution);
            let after = touching.after(&p, self.shape.k);
            (motion.vx, motion.vz, motion.omega) = (after.vx, after.vz, after.omega);
        }
        (resolution, record)
    }

    /// The law's impulse with restitution `e`.
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

    /// The motion a time `t` into an impact that lasts longer, for observers. The law resolves the
    /// impact again, so that tosses without an observer store nothing.
    pub(crate) fn motion_within_impact(&self, touching: Motion, t: f64) -> Motion {
        let mut motion = touching;
        motion.z = sin_cos(motion.delta).1;
        let mut ignored = Breaks::default();
        self.law
            .resolve_until(&mut self.at_touch(&mut motion, &mut ignored), t);
        motion
    }

    /// A corner that stays on the surface: sustained contact, unless the coin is nearly flat.
    #[inline(always)]
    fn in_contact(&self, motion: &mut Motion, slip: f64) -> AfterImpact {
        if self.is_nearly_flat(motion) {
            self.lay_flat(motion)
        } else {
            AfterImpact::Contact { slip }
        }
    }

    /// Stops the normal motion of a corner that stays on the surface by an impact with e = 0;
    /// returns its slip velocity.
    pub(crate) fn stop_normal_motion(&self, motion: &mut Motion, before: f64) -> f64 {
        let touching = Touching::of(motion);
        let p = self.impulse(&touching, 0.0);
        let slip = self.place_on_corner(motion, &touching, &p);
        motion.cap_energy(self.shape.k, before);
        // the cap may have slowed it down
        if slip == 0.0 {
            0.0
        } else {
            motion.vx - motion.omega * touching.cos
        }
    }

    /// If all remaining bounces would be over before the coin has turned noticeably, replaces them
    /// by one impact with e = 0; returns the slip velocity after it.
    ///
    /// Between impacts the corner falls with a = 1 − ω²cos δ (its acceleration without contact),
    /// so the remaining bounces take 2 e v/(a(1 − e)), v the present normal speed.
    #[inline(always)]
    fn collapse_bounces(&self, motion: &mut Motion, touching: &Touching<f64>) -> Option<f64> {
        if self.keeps_bouncing(touching) {
            return None;
        }
        let e = self.law.effective_restitution(self.restitution);
        let (_, uz) = touching.approach();
        let p = self.impulse(touching, 0.0);
        let omega = touching.omega_after(&p, self.shape.k);
        let fall = 1.0 - omega * omega * touching.cos;
        let rate = 1.0 + omega.abs() / self.half_short_edge;
        if !(fall > 0.0 && -uz * 2.0 * e * rate < self.settings.zeno * (1.0 - e) * fall) {
            return None;
        }
        Some(self.place_on_corner(motion, touching, &p))
    }

    /// Whether the remaining bounces take long, however the coin turns. The bounds a <= 1 and rate
    /// of turning >= 1 are enough for most impacts.
    #[inline(always)]
    pub(crate) fn keeps_bouncing<N: Lane>(&self, touching: &Touching<N>) -> N::Mask {
        let e = self.law.effective_restitution(self.restitution);
        let (_, uz) = touching.approach();
        let least = N::splat(self.settings.zeno * (1.0 - e));
        least.le(-uz * N::splat(2.0) * N::splat(e))
    }

    /// Sets the motion after an impulse that leaves the corner on the surface; returns its slip
    /// velocity.
    #[inline]
    fn place_on_corner(&self, motion: &mut Motion, from: &Touching<f64>, p: &Impulse) -> f64 {
        let k = self.shape.k;
        let slip = if p.sticks {
            0.0
        } else {
            let matrix = from.matrix(k);
            from.approach().0 + matrix.xx * p.x + matrix.xz * p.z
        };
        motion.set_on_corner(from.sin, from.cos, from.omega_after(p, k), slip);
        slip
    }

    /// Whether a coin whose vertical velocity is `vz` may be [nearly flat](Self::is_nearly_flat).
    #[inline(always)]
    pub(crate) fn may_be_nearly_flat<N: Lane>(&self, vz: N) -> N::Mask {
        // without friction, energy decides a coin this slow
        let slowest = if self.friction == 0.0 {
            f64::NAN
        } else {
            0.1 * self.settings.zeno
        };
        vz.abs().le(N::splat(slowest))
    }

    /// Whether the coin rocks on an edge so little that it may be laid flat: angular velocity,
    /// vertical velocity and gap are all below zeno/10 of the edge, the energy of rocking below
    /// (zeno/10)² of the barrier.
    #[inline]
    fn is_nearly_flat(&self, motion: &Motion) -> bool {
        if !self.may_be_nearly_flat(motion.vz) {
            return false;
        }
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let small = 0.1 * self.settings.zeno * self.shape.base(motion.quadrant, at_end).1;
        gap < small && motion.omega.abs() < small && motion.vz.abs() < small
    }

    /// Lays the coin flat: a plastic impact of the whole edge. The coin then slides. It never tips
    /// if the torque of friction at the base is below that of the normal force, μ·height <= half
    /// width: the face is decided. Otherwise it trips over its leading corner.
    fn lay_flat(&self, motion: &mut Motion) -> AfterImpact {
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let (height, half_width) = self.shape.base(motion.quadrant, at_end);
        motion.delta += if at_end { gap } else { -gap };
        let braking = (self.friction * motion.vz.abs()).min(motion.vx.abs());
        motion.vx -= braking.copysign(motion.vx);
        (motion.z, motion.vz, motion.omega) = (height, 0.0, 0.0);
        if self.friction * height <= half_width || motion.vx == 0.0 {
            return AfterImpact::Decided(Shape::face(motion.quadrant, motion.delta));
        }
        // a coin that slides to +x trips forwards (ω > 0), from the start of a quadrant
        let forwards = motion.vx > 0.0;
        if forwards == at_end {
            motion.cross_flat(&self.shape, forwards);
        }
        AfterImpact::Contact { slip: motion.vx }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::FlatEngine;
    use crate::laws::moreau::Moreau;
    use crate::settings::Settings;
    use coinmc_testkit::scene;

    /// A corner under the centre of a frictionless coin that turns at ω falls with 1 − ω² between its
    /// bounces, each e times as fast as the last. They are replaced where the coin turns by less than zeno
    /// in the time that they all take, be it by an angle or by the share of its shorter edge.
    #[test]
    fn bounces_that_are_over_before_the_coin_turns_are_replaced() {
        let settings = Settings::default();
        for (ratio, e, omega) in [
            (0.2, 0.2, 0.1),
            (1.0, 0.5, -0.3),
            (1.0, 0.5, 0.9),
            (4.0, 0.8, 0.5),
        ] {
            let engine = FlatEngine::new(&scene(ratio, e, 0.0), &settings, Moreau).expect("valid");
            let parameters = &engine.parameters;
            // from the speed of the next approach to the end of the last bounce
            let time = |approach: f64| {
                let mut speed = e * approach;
                let mut time = 0.0;
                while speed > 1e-12 * approach {
                    time += 2.0 * speed / (1.0 - omega * omega);
                    speed *= e;
                }
                time
            };
            let half_edge = f64::min(ratio / 2.0, 1.0) / (1.0 + ratio * ratio / 4.0).sqrt();
            let allowed = settings.zeno / (1.0 + omega.abs() / half_edge);
            let replaced = |approach: f64| {
                let mut motion = Motion {
                    quadrant: 0,
                    delta: 0.0,
                    omega,
                    x: 0.0,
                    z: 1.0,
                    vx: 0.4,
                    vz: -approach,
                    time: 0.0,
                };
                let touching = Touching::of(&motion);
                let slip = parameters.collapse_bounces(&mut motion, &touching);
                // a frictionless corner keeps its slip and its turning, and stays on the surface
                assert!(slip.is_none_or(|slip| (slip - (0.4 - omega)).abs() < 1e-15));
                assert!(slip.is_none() || motion.vz == 0.0 && motion.omega == omega);
                slip.is_some()
            };
            let longest = allowed / time(1.0);
            assert!(replaced(0.999 * longest), "H/R {ratio}, e {e}, ω {omega}");
            assert!(!replaced(1.001 * longest), "H/R {ratio}, e {e}, ω {omega}");
        }
    }

    fn parameters(ratio: f64, e: f64, mu: f64) -> Parameters<Moreau> {
        let engine = FlatEngine::new(&scene(ratio, e, mu), &Settings::default(), Moreau);
        engine.expect("valid").parameters
    }

    /// A coin that rocks a little on its face.
    fn rocking(parameters: &Parameters<Moreau>, gap: f64, omega: f64, vz: f64) -> Motion {
        Motion {
            quadrant: 0,
            delta: gap - parameters.shape.first_span(0),
            omega,
            x: 0.0,
            z: parameters.shape.base(0, false).0,
            vx: 0.3,
            vz,
            time: 0.0,
        }
    }

    /// Bounces at a speed v that lose the share 1 - e each time take 2 e v/(1 - e) at least, and more of zeno is not
    /// replaced.
    #[test]
    fn long_bounces_go_on_however_the_coin_turns() {
        for e in [0.2, 0.5, 0.9] {
            let parameters = parameters(1.0, e, 0.0);
            let longest = parameters.settings.zeno * (1.0 - e) / (2.0 * e);
            let bouncing = |approach: f64| {
                let mut motion = rocking(&parameters, 0.1, 0.0, -approach);
                motion.delta = 0.0;
                parameters.keeps_bouncing(&Touching::of(&motion))
            };
            assert!(bouncing(1.001 * longest) && !bouncing(0.999 * longest));
        }
    }

    /// Where the energy is capped, the slip is that of the slower coin.
    #[test]
    fn a_stopped_corner_has_the_slip_of_its_coin() {
        let parameters = parameters(1.0, 0.5, 0.1);
        let mut motion = rocking(&parameters, 0.6, 0.7, -0.4);
        let touching = Touching::of(&motion);
        motion.z = touching.cos;
        let before = touching.cos + 0.02;
        let slip = parameters.stop_normal_motion(&mut motion, before);
        assert!(slip != 0.0 && (slip - (motion.vx - motion.omega * touching.cos)).abs() < 1e-15);
        assert!((motion.vz + motion.omega * touching.sin).abs() < 1e-15);
        assert!((motion.energy(parameters.shape.k) - before).abs() < 1e-15);
    }

    /// Gap, angular and vertical velocity are each below zeno/10 of the edge.
    #[test]
    fn only_a_coin_that_hardly_rocks_is_nearly_flat() {
        let parameters = parameters(1.0, 0.5, 0.3);
        let most = 0.1 * parameters.settings.zeno;
        let small = most * parameters.shape.base(0, false).1;
        let flat = |gap: f64, omega: f64, vz: f64| {
            parameters.is_nearly_flat(&rocking(&parameters, gap, omega, vz))
        };
        let (below, above) = (0.99 * small, 1.01 * small);
        for sign in [1.0, -1.0] {
            assert!(flat(below, sign * below, sign * below));
            assert!(!flat(above, 0.0, 0.0));
            assert!(!flat(0.0, sign * above, 0.0));
            assert!(!flat(0.0, 0.0, sign * above));
            // no coin this fast is looked at any closer
            assert!(parameters.may_be_nearly_flat(sign * 0.99 * most));
            assert!(!parameters.may_be_nearly_flat(sign * 1.01 * most));
        }
    }

    /// The coin then lies flat on the edge that it was near to, at either end of a quadrant.
    #[test]
    fn a_coin_laid_flat_is_flat() {
        let parameters = parameters(1.0, 0.5, 0.3);
        let shape = &parameters.shape;
        for (forwards, turned) in [(false, 1.0), (true, -1.0)] {
            let flat = shape.last_angle(0, -turned);
            let mut motion = rocking(&parameters, 0.0, 0.0, 0.0);
            motion.delta = flat + turned * 1e-4;
            let after = parameters.lay_flat(&mut motion);
            assert!(matches!(after, AfterImpact::Decided(face) if face == Shape::face(0, flat)));
            assert!((motion.delta - flat).abs() < 1e-15, "{}", motion.delta);
            assert_eq!(motion.z, shape.base(0, forwards).0);
            assert_eq!((motion.vx, motion.vz, motion.omega), (0.3, 0.0, 0.0));
        }
    }
}
