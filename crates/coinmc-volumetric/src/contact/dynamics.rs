//! The constants of a scene in contact, and friction against rolling and pivoting.

use super::held_friction::holds_rocking;
use crate::body::{Body, Friction};
use crate::drag::Drag;
use crate::motion::{Motion, Spin};
use coinmc_lanes::Lane;

/// The body, friction and drag of a scene, with the constants derived from them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dynamics {
    pub(crate) body: Body,
    pub(crate) friction: Friction,
    pub(crate) drag: Drag,
    /// Ω_a/ω_a: I_a/I_t with gyroscopic torque, 1 without.
    pub(crate) axial_factor: f64,
    /// 1/k_t and 1/k_a.
    pub(super) inverse_kt: f64,
    pub(super) inverse_ka: f64,
    /// K_yy and 1/K_yy, which with sharp rims do not depend on the tilt.
    pub(super) kyy: f64,
    pub(super) inverse_kyy: f64,
    /// 1/(K_xx K_zz − K_xz²). With sharp rims it does not depend on the tilt either, as the distance
    /// of the rim from the centre is constant.
    pub(super) inverse_det: f64,
    /// 1/(ρ_c smoothing_time) and 1/(ρ_p smoothing_time), see [`smoothed_sign`].
    contour_smoothing: f64,
    pivoting_smoothing: f64,
    /// 1/smoothing_time where friction holds the rocking of the coin, else 0: see
    /// [`held_friction`](super::held_friction).
    pub(super) holding_rate: f64,
    /// The least cosine of the tilt: below 0 where a coin on the edge of a cone leans on its wider rim.
    pub(super) least_cos: f64,
    /// How far ahead of its lowest point, along y, the rim touches: not 0 where the ground slopes.
    pub(crate) ahead: f64,
    /// The pull of a tilted table, along x and y of the coin's frame at present.
    pub(crate) pull: Option<[f64; 2]>,
}

/// The smoothed sign of a rate in dry friction.
///
/// Friction slows the rate down by b per normal force. Where it would stop the rate within
/// `smoothing_time`, the sign is replaced by a linear function through 0, so that the rate decays
/// exponentially at 1/`smoothing_time` whatever the inertia. `share` is rate/(b `smoothing_time`).
#[inline(always)]
fn smoothed_sign<L: Lane>(share: L) -> L {
    share.min(L::splat(1.0)).max(L::splat(-1.0))
}

/// Quotients that depend on the tilt only.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quotients<L> {
    /// 1/s.
    pub(super) sin: L,
    /// 1/A and 1/G, A = s²/ka + c²/kt and G = c²/ka + s²/kt: the inertia of the coin about the
    /// horizontal x axis and about the vertical.
    along: L,
    about: L,
}

impl Dynamics {
    pub(crate) fn new(
        body: Body,
        friction: Friction,
        drag: Drag,
        axial_factor: f64,
        smoothing_time: f64,
    ) -> Self {
        let (inverse_kt, inverse_ka) = (1.0 / body.kt, 1.0 / body.ka);
        let kyy = 1.0 + body.half * body.half * inverse_kt + body.radius * body.radius * inverse_ka;
        // without a friction length the quotient is not used, but must be finite
        let inverse_smoothing =
            |length: f64| 1.0 / (length * smoothing_time).max(f64::MIN_POSITIVE);
        Self {
            body,
            friction,
            drag,
            axial_factor,
            inverse_kt,
            inverse_ka,
            kyy,
            inverse_kyy: 1.0 / kyy,
            inverse_det: 1.0 / (1.0 + inverse_kt),
            contour_smoothing: inverse_smoothing(friction.contour),
            pivoting_smoothing: inverse_smoothing(friction.pivoting),
            holding_rate: if holds_rocking(body.half, friction.contour, friction.pivoting) {
                1.0 / smoothing_time
            } else {
                0.0
            },
            least_cos: 0.0,
            ahead: 0.0,
            pull: None,
        }
    }

    /// The same dynamics of a rim that touches so far ahead of its lowest point.
    pub(crate) fn touching_ahead(&self, ahead: f64) -> Self {
        Self { ahead, ..*self }
    }

    /// How much more slowly along x the point that touches slips than the lowest one, as the coin turns
    /// about the vertical: ω_z ξ.
    #[inline(always)]
    pub(crate) fn drift<L: Lane>(&self, s: L, c: L, wa: L, wt: L) -> L {
        (c * wa - s * wt) * L::splat(self.ahead)
    }

    /// The same dynamics on a rim that need not be at the distance 1 from the centre, and on which the
    /// coin leans up to this cosine of the tilt.
    pub(crate) fn on_rim(self, least_cos: f64) -> Self {
        let Body { radius, half, .. } = self.body;
        Self {
            inverse_det: 1.0 / (1.0 + (radius * radius + half * half) * self.inverse_kt),
            least_cos: least_cos.min(0.0),
            ..self
        }
    }

    /// The same dynamics on a table that pulls like this.
    pub(crate) fn pulled_by(&self, pull: [f64; 2]) -> Self {
        Self {
            pull: Some(pull),
            ..*self
        }
    }

    /// The same dynamics in the frame turned by half a turn.
    pub(super) fn reversed(&self) -> Self {
        Self {
            pull: self.pull.map(|pull| pull.map(|p| -p)),
            ..*self
        }
    }

    /// K_yy and 1/K_yy, given the levers about u and e_θ.
    #[inline(always)]
    pub(super) fn across<L: Lane>(&self, radius: L, half: L) -> (L, L) {
        if self.body.rim == 0.0 {
            return (L::splat(self.kyy), L::splat(self.inverse_kyy));
        }
        let turn = half * half * L::splat(self.inverse_kt);
        let kyy = L::splat(1.0) + turn + radius * radius * L::splat(self.inverse_ka);
        (kyy, L::splat(1.0) / kyy)
    }

    /// 1/(K_xx K_zz − K_xz²) = 1/(K_xx + K_zz − 1).
    #[inline(always)]
    pub(super) fn inverse_along<L: Lane>(&self, kxx: L, kzz: L) -> L {
        if self.body.rim == 0.0 {
            L::splat(self.inverse_det)
        } else {
            L::splat(1.0) / (kxx + kzz - L::splat(1.0))
        }
    }

    /// Whether friction against rolling and pivoting holds at rest, instead of creeping.
    pub(crate) fn holds(&self) -> bool {
        self.holding_rate > 0.0
    }

    /// The same dynamics with sharp rims.
    #[inline(always)]
    pub(crate) fn with_sharp_rims(&self) -> Self {
        let body = Body {
            rim: 0.0,
            ..self.body
        };
        Self { body, ..*self }
    }

    /// Whether drag acts or the rims are rounded: the kernels for neither are faster.
    pub(crate) fn drags_or_rounds(&self) -> bool {
        self.drag.acts() || self.body.rim != 0.0
    }

    /// Whether these are the dynamics of most scenes: of a coin with sharp rims on a level table, whose rocking
    /// friction does not hold.
    pub(super) fn is_ordinary(&self) -> bool {
        self.body.rim == 0.0 && !self.holds() && self.pull.is_none() && self.least_cos == 0.0
    }

    /// The same dynamics, with the cases "no drag and sharp rims" and "friction that does not hold"
    /// known to the compiler: `DRAGS` is [`drags_or_rounds`](Self::drags_or_rounds) (or may be true
    /// without), `HOLDS` is [`holds`](Self::holds).
    #[inline(always)]
    pub(crate) fn with_known<const DRAGS: bool, const HOLDS: bool>(&self) -> Self {
        Self {
            drag: self.drag.known::<DRAGS>(),
            body: Body {
                rim: if DRAGS { self.body.rim } else { 0.0 },
                ..self.body
            },
            holding_rate: if HOLDS { self.holding_rate } else { 0.0 },
            // a batch knows no places and no cones
            pull: None,
            least_cos: 0.0,
            ahead: 0.0,
            ..*self
        }
    }

    /// The quotients of a tilt, by one division for all three.
    #[inline(always)]
    pub(super) fn quotients<L: Lane>(&self, s: L, c: L) -> Quotients<L> {
        if !self.friction.has_lengths() {
            let zero = L::splat(0.0);
            return Quotients {
                sin: L::splat(1.0) / s,
                along: zero,
                about: zero,
            };
        }
        let (ikt, ika) = (L::splat(self.inverse_kt), L::splat(self.inverse_ka));
        let along = s * s * ika + c * c * ikt;
        let about = c * c * ika + s * s * ikt;
        let both = along * about;
        let inverse = L::splat(1.0) / (s * both);
        let inverse_both = s * inverse;
        Quotients {
            sin: both * inverse,
            along: about * inverse_both,
            about: along * inverse_both,
        }
    }

    /// (t_a, t_θ): torques of contour and pivoting friction per normal force.
    #[inline(always)]
    pub(crate) fn friction_torques<L: Lane>(&self, s: L, c: L, wa: L, wt: L) -> (L, L) {
        self.friction_torques_at(s, c, &self.quotients(s, c), wa, wt)
    }

    /// The same, with the quotients of the tilt given.
    #[inline(always)]
    pub(super) fn friction_torques_at<L: Lane>(
        &self,
        s: L,
        c: L,
        inverse: &Quotients<L>,
        wa: L,
        wt: L,
    ) -> (L, L) {
        if !self.friction.has_lengths() {
            return (L::splat(0.0), L::splat(0.0));
        }
        // ω_x = s ψ' and ω_z; friction slows them down at ρ_c A/s and ρ_p G
        let (along, about) = (wa * s + wt * c, wa * c - wt * s);
        let along = along * s * inverse.along * L::splat(self.contour_smoothing);
        let about = about * inverse.about * L::splat(self.pivoting_smoothing);
        let contour = L::splat(self.friction.contour) * smoothed_sign(along);
        let pivoting = L::splat(self.friction.pivoting) * smoothed_sign(about);
        let cot = c * inverse.sin;
        (contour + pivoting * c, contour * cot - pivoting * s)
    }

    /// ω_θ(Ω_a − φ'c): the gyroscopic part of ω_y', without drag.
    #[inline(always)]
    fn gyroscopic<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        let azimuth = -(spin.turn / m.sin);
        spin.turn * (L::splat(self.axial_factor) * spin.axial - azimuth * m.cos)
    }

    /// The acceleration at which the contact point would enter the surface if it were free: −bz.
    #[inline(always)]
    pub(crate) fn press<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        let (radius, half) = (L::splat(self.body.radius), L::splat(self.body.half));
        let rx = radius * m.cos - half * m.sin;
        let rz = -(half * m.cos + radius * m.sin);
        L::splat(1.0) + rz * spin.tilt * spin.tilt + rx * self.gyroscopic(m, spin)
    }

    /// An estimate from the motion before an impact of by how much [`press`](Self::press) may
    /// exceed 1 after it.
    #[inline(always)]
    pub(crate) fn uplift<L: Lane>(&self, m: &Motion<L>, spin: &Spin<L>) -> L {
        self.gyroscopic(m, spin).abs()
    }
}

/// The fastest rate of a coin in contact: of rolling, tilting, precessing, toppling.
#[inline(always)]
pub(crate) fn fastest_rate<L: Lane>(m: &Motion<L>, spin: &Spin<L>) -> L {
    let azimuth = spin.turn / m.sin;
    (L::splat(1.0) + spin.axial * spin.axial + spin.tilt * spin.tilt + azimuth * azimuth).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::Orbit;
    use crate::flight_phase::tests::height_of_rim;
    use crate::toss::tests::{launch, model};
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    const BODY: Body = Body {
        radius: 0.7,
        half: 0.5,
        rim: 0.0,
        kt: 0.35,
        ka: 0.22,
    };
    const AIRLESS: Drag = Drag {
        linear: 0.0,
        angular: 0.0,
    };

    fn with_lengths(contour: f64, pivoting: f64, smoothing_time: f64) -> Dynamics {
        let friction = Friction {
            mu: 0.3,
            contour,
            pivoting,
        };
        Dynamics::new(BODY, friction, AIRLESS, 0.6, smoothing_time)
    }

    /// Contour friction alone brakes ω_x, pivoting friction alone ω_z, at its length whatever the rate; and a rate
    /// that they would end within the smoothing time τ decays at 1/τ. Both at once are the sum.
    #[test]
    fn friction_lengths_brake_fast_rates_dryly_and_slow_ones_in_the_smoothing_time() {
        let (contour, pivoting, time) = (0.013, 0.021, 0.17);
        let [rolls, pivots, both] = [(contour, 0.0), (0.0, pivoting), (contour, pivoting)]
            .map(|(contour, pivoting)| with_lengths(contour, pivoting, time));
        for trial in 0..200 {
            let mut dice = Dice::new(842, trial);
            let (s, c) = libm::sincos(dice.between(0.1, 1.5));
            let (wx, wz) = (dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
            let torques = |dynamics: &Dynamics, scale: f64| {
                let (wx, wz) = (scale * wx, scale * wz);
                let (a, t) = dynamics.friction_torques(s, c, s * wx + c * wz, c * wx - s * wz);
                [a, t]
            };
            // about x and about the vertical, and the rates of ω_x and ω_z that they brake
            let about = |[a, t]: [f64; 2]| [s * a + c * t, c * a - s * t];
            let brakes = |[a, t]: [f64; 2]| about([a / BODY.ka, t / BODY.kt]);
            let [x, z] = about(torques(&rolls, 1e3));
            assert!((x - contour / s * wx.signum()).abs() < 1e-14 && z.abs() < 1e-15);
            let [x, z] = about(torques(&pivots, 1e3));
            assert!(x.abs() < 1e-15 && (z - pivoting * wz.signum()).abs() < 1e-14);
            let tiny = 1e-5;
            let [x, _] = brakes(torques(&rolls, tiny));
            assert!((x * time / (tiny * wx) - 1.0).abs() < 1e-12, "{x}");
            let [_, z] = brakes(torques(&pivots, tiny));
            assert!((z * time / (tiny * wz) - 1.0).abs() < 1e-12, "{z}");
            for scale in [tiny, 1e3] {
                let [one, other, sum] = [&rolls, &pivots, &both].map(|d| torques(d, scale));
                let off = [0, 1].map(|i| one[i] + other[i] - sum[i]);
                assert!(off.iter().all(|off| off.abs() < 1e-15), "{off:?}");
            }
        }
        assert_eq!(
            with_lengths(0.0, 0.0, time).friction_torques(0.6, 0.8, 1.0, 2.0),
            (0.0, 0.0)
        );
    }

    /// Each thing that a scene may have beyond the ordinary is noticed; what is known to be absent is dropped.
    #[test]
    fn scenes_beyond_the_ordinary_are_told_apart() {
        let plain = with_lengths(0.01, 0.01, 1e-2);
        let mut rounded = plain;
        rounded.body.rim = 0.1;
        let mut dragged = plain;
        dragged.drag.linear = 0.1;
        let held = with_lengths(0.0, 0.0501, 1e-2);
        let conical = plain.on_rim(-0.1);
        let pulled = plain.pulled_by([0.1, 0.2]);
        let told = |dynamics: &Dynamics| {
            (
                dynamics.drags_or_rounds(),
                dynamics.holds(),
                dynamics.is_ordinary(),
            )
        };
        assert_eq!(told(&plain), (false, false, true));
        assert_eq!(told(&dragged), (true, false, true));
        assert_eq!(told(&rounded), (true, false, false));
        assert_eq!(told(&held), (false, true, false));
        assert_eq!(told(&conical), (false, false, false));
        assert_eq!(told(&pulled), (false, false, false));
        assert_eq!(told(&plain.on_rim(0.1)), (false, false, true));
        assert_eq!(told(&rounded.with_sharp_rims()), (false, false, true));
        assert!(!told(&held.with_known::<false, false>()).1);
        assert!(told(&held.with_known::<true, true>()).1);
        assert!(!told(&rounded.with_known::<false, true>()).0);
        assert!(told(&rounded.with_known::<true, true>()).0);
        assert_eq!(pulled.reversed().pull, Some([-0.1, -0.2]));
    }

    /// The fastest rate of a coin that only stands is 1; rolling, tilting and precessing add to its square, the last
    /// one as fast as the axis turns about the vertical.
    #[test]
    fn the_fastest_rate_holds_those_of_all_motions() {
        let model = model();
        for number in 0..100 {
            let toss = model.launch(&launch(&mut Dice::new(843, number), None));
            let (motion, spin) = (&toss.motion, &toss.spin);
            let axis = Vector3::new(motion.sin, 0.0, motion.cos);
            let across = Vector3::new(motion.cos, 0.0, -motion.sin);
            let turns =
                (axis * spin.axial + across * spin.turn + Vector3::y() * spin.tilt).cross(&axis);
            let azimuth = axis.cross(&turns).z / (motion.sin * motion.sin);
            let square = 1.0 + Vector3::new(spin.axial, spin.tilt, azimuth).norm_squared();
            let found = fastest_rate(motion, spin);
            assert!((found * found / square - 1.0).abs() < 1e-12);
        }
        let (still, turned) = (Motion::<f64>::still(), Spin::still());
        let mut leans = still;
        leans.set_tilt(0.6, 0.8);
        assert!((fastest_rate(&leans, &turned) - 1.0).abs() < 1e-15);
    }

    /// What the estimate allows above 1 is never less than the press has, and for a coin that does not tilt the lever of
    /// the centre's weight times that.
    #[test]
    fn no_coin_presses_by_more_than_its_estimate() {
        let model = model();
        let dynamics = &model.dynamics;
        for number in 0..200 {
            let toss = model.launch(&launch(&mut Dice::new(844, number), None));
            let (motion, mut spin) = (&toss.motion, toss.spin);
            let most = dynamics.uplift(motion, &spin);
            assert!(dynamics.press(motion, &spin) <= 1.0 + most + 1e-12);
            spin.tilt = 0.0;
            let lever = dynamics.body.radius * motion.cos - dynamics.body.half * motion.sin;
            let excess = dynamics.press(motion, &spin) - 1.0;
            assert!((excess.abs() - lever.abs() * most).abs() < 1e-12 * (1.0 + most));
        }
    }

    /// The height of the lowest point of the rim of a coin in flight, differenced twice. With steps of 1e-3 the
    /// second difference is good to some 1e-6 rates⁴/12.
    #[test]
    fn a_free_contact_point_enters_the_surface_at_the_second_rate_of_its_height() {
        let model = model();
        let dynamics = &model.dynamics;
        for number in 0..200 {
            let toss = model.launch(&launch(&mut Dice::new(521, number), Some(0.4)));
            let orbit = Orbit::new(&toss.motion, dynamics.drag);
            let gap = |t: f64| height_of_rim(&orbit, &toss.motion, &dynamics.body, t);
            let step = 1e-3;
            let rate = (gap(step) - 2.0 * gap(0.0) + gap(-step)) / (step * step);
            let press = dynamics.press(&toss.motion, &toss.spin);
            let turns = toss.motion.ox.abs() + toss.motion.oy.abs() + toss.motion.oz.abs();
            let tolerance = 1e-6 * (1.0 + turns.powi(4));
            assert!(
                (press + rate).abs() < tolerance,
                "{press} {rate} {tolerance}"
            );
        }
    }
}
