//! Newton restitution with Coulomb friction against the final slip.

use super::ChatterjeeRuina;
use crate::body::{Body, Friction};
use crate::impact::contact_point::Condensed;
use crate::impact::friction_moments::{FrictionMoments, JointSolution};
use crate::impact::{ContactMatrix, ContactPoint, ImpactLaw, Impulse};
use coinmc_core::schema::Values;
use coinmc_core::{EngineError, LawSettings};
use coinmc_lanes::{Lane, Mask};

/// Newton restitution u_z⁺ = −e u_z⁻ and friction against the slip **after** the impact.
///
/// Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988). With
/// σ = |slip⁺|/(μ p_z) >= 0, friction −μ p_z along slip⁺ reads p_t = −slip⁺/σ:
///
/// p_x(σ + K_xx) + K_xz p_z = −slip_x, K_xz p_x + K_zz p_z = (1 + e)|u_z|, p_y(σ + K_yy) = −slip_y,
///
/// and the contact sticks (σ = 0) if that impulse lies in the friction cone. Otherwise σ is the
/// root of
/// |p_t| = μ p_z. The friction lengths obey the same kind of law: J_c and J_p are at their limits
/// against the final ψ' and ω_z, or stop them. They are solved exactly together with p_y for each σ
/// (they change neither slip_x nor u_z).
///
/// # Energy
/// An impulse adds the energy ½p·(u⁻ + u⁺) = p·u⁺ − ½p·K p (with J as part of p). Friction has
/// p·u⁺ <= 0 by definition, so the energy added is at most e|u_z|p_z − ½p·K p: plastic impacts
/// (e = 0) always dissipate. With e > 0 this may be positive at high friction. There, and where no
/// root exists, the impulse is that of [`ChatterjeeRuina`], which dissipates.
///
/// # Compared with the other laws
/// It is the law that Moreau–Jean time stepping solves. Where it can, it stops the slip of the
/// contact point for any e; [`ChatterjeeRuina`] then lets the point rebound sideways.
/// [`Stronge`](super::Stronge) relates e to work instead of velocity: u_z⁺ differs where the slip
/// changes direction during the impact.
#[derive(Debug, Clone, Copy)]
pub struct Moreau;

/// Newton's method converges quadratically on a smooth function, and φ is nearly linear: a step
/// from a relative error below this leaves less than 1e-11.
const LAST: f64 = 1e-6;

/// With friction lengths φ has kinks where one of their limits is reached. One in 1e8 final steps
/// passes a kink, and then has an error no larger than the step.
const LAST_WITH_KINKS: f64 = 1e-8;

/// Bisection alone needs 60 halvings of the bracket for full precision.
const MAX_STEPS: u32 = 100;

impl LawSettings for Moreau {
    const NAME: &'static str = "moreau";
    const DOC: &'static str = "Newton restitution, Coulomb friction against the final slip";

    fn read(_: &Values) -> Result<Self, EngineError> {
        Ok(Self)
    }
}

impl ImpactLaw for Moreau {
    #[inline(always)]
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        point: &ContactPoint<L>,
        e: L,
    ) -> Impulse<L> {
        if friction.mu == 0.0 {
            // nothing to solve: the impulse is exactly that of the other law
            return ChatterjeeRuina.impulse(body, friction, point, e);
        }
        let k = point.matrix(body);
        let p = if friction.has_lengths() {
            let limited = FrictionMoments::new(body, friction, point, k.yy);
            Problem::new(friction, point, &k, e, Some(limited)).solve(point.sin)
        } else {
            Problem::new(friction, point, &k, e, None).solve(point.sin)
        };
        let sound = p.work(body, point).le(L::splat(0.0)) & L::splat(0.0).le(p.z);
        if (!sound).any() {
            let guard = ChatterjeeRuina.impulse(body, friction, point, e);
            return Impulse::select(sound, p, guard);
        }
        p
    }
}

/// The scalar problem for σ.
struct Problem<L> {
    mu: L,
    /// (1 + e)|u_z|/K_zz, the frictionless impulse.
    base: L,
    /// slip_x after the frictionless impulse.
    slip_x: L,
    slip_y: L,
    /// K_xx − K_xz²/K_zz.
    alpha: L,
    yy: L,
    coupling: L,
    moments: Option<FrictionMoments<L>>,
}

/// One σ, and the quotients of it that are needed.
struct Trial<L> {
    sigma: L,
    /// 1/(σ + α), 1/(σ + K_yy) and 1/(1 + σ).
    x: L,
    y: L,
    rigid: L,
}

/// φ(σ) = μ p_z/|p_t| − 1 as a difference over |p_t|, and Newton's step to its root, σ and all
/// impulses scaled by σ + α.
struct Cone<L> {
    /// μ p_z and |p_t|.
    limit: L,
    size: L,
    /// Newton's step as a quotient; its denominator has the sign of φ'.
    step: L,
    over: L,
}

impl<L: Lane> Problem<L> {
    #[inline(always)]
    fn new(
        friction: &Friction,
        point: &ContactPoint<L>,
        k: &ContactMatrix<L>,
        e: L,
        moments: Option<FrictionMoments<L>>,
    ) -> Self {
        let Condensed {
            mass_z,
            coupling,
            alpha,
        } = k.condensed();
        let base = (L::splat(1.0) + e) * (-point.approach).max(L::splat(0.0)) * mass_z;
        Self {
            mu: L::splat(friction.mu),
            base,
            slip_x: point.slip_x + k.xz * base,
            slip_y: point.slip_y,
            alpha,
            yy: k.yy,
            coupling,
            moments,
        }
    }

    /// σ with its quotients, two of them by one division. (One division for all three would
    /// overflow at very low friction, where σ exceeds 1e100.)
    #[inline(always)]
    fn at(&self, sigma: L) -> Trial<L> {
        let one = L::splat(1.0);
        let (y, rigid) = (sigma + self.yy, sigma + one);
        let inverse = one / (y * rigid);
        Trial {
            sigma,
            x: one / (sigma + self.alpha),
            y: rigid * inverse,
            rigid: y * inverse,
        }
    }

    /// The sideways slip that p_y opposes, including the part of the friction lengths.
    #[inline(always)]
    fn sideways(&self, at: &Trial<L>) -> JointSolution<L> {
        let zero = L::splat(0.0);
        match &self.moments {
            None => JointSolution {
                contour: zero,
                pivoting: zero,
                slip_y: self.slip_y,
                slope: zero,
            },
            Some(limited) => {
                let lift = self.coupling * self.slip_x * at.x;
                limited.joint(at.sigma, at.y, at.rigid, self.base + lift, -(lift * at.x))
            }
        }
    }

    /// φ expanded by (σ + α): numerator and denominator are then of the size of the velocities, and
    /// φ is linear in σ apart from the ratio q = (σ + α)/(σ + K_yy), which changes little.
    #[inline(always)]
    fn cone(&self, sigma: L) -> Cone<L> {
        let at = self.at(sigma);
        let side = self.sideways(&at);
        let (y, dy) = (side.slip_y, side.slope);
        let reach = sigma + self.alpha;
        let q = reach * at.y;
        let dq = (self.yy - self.alpha) * at.y * at.y;
        let cross = y * q;
        let square = self.slip_x * self.slip_x + cross * cross;
        let size = square.sqrt();
        let limit = self.mu * (self.base * reach + self.coupling * self.slip_x);
        let growth = cross * (dy * q + y * dq);
        Cone {
            limit,
            size,
            step: (limit - size) * square,
            over: self.mu * self.base * square - limit * growth,
        }
    }

    /// A first guess: σ for the ratio q at the root that q = 1 (its limit for low friction) would
    /// give. Nearly exact without friction lengths.
    #[inline(always)]
    fn guess(&self) -> L {
        let inverse = L::splat(1.0) / (self.mu * self.base);
        let first = self.sigma(self.slip_y, inverse);
        let q = (first + self.alpha) / (first + self.yy);
        self.sigma(self.slip_y * q, inverse)
    }

    /// σ if the sideways slip times q were `cross`; `inverse` is 1/(μ·base).
    #[inline(always)]
    fn sigma(&self, cross: L, inverse: L) -> L {
        let size = (self.slip_x * self.slip_x + cross * cross).sqrt();
        let reach = (size - self.mu * self.coupling * self.slip_x) * inverse;
        // bounded, so that friction too low for its root to be representable stays finite
        (reach - self.alpha).max(L::splat(0.0)).min(L::splat(1e150))
    }

    #[inline(always)]
    fn solve(&self, sin: L) -> Impulse<L> {
        let zero = L::splat(0.0);
        let still = self.at(zero);
        let stick = self.impulse(&still, &self.sideways(&still), sin);
        let (size, limit) = (stick.x * stick.x + stick.y * stick.y, self.mu * stick.z);
        let sticks = zero.lt(stick.z) & size.le(limit * limit);
        let active = zero.lt(self.base) & !sticks;
        if !active.any() {
            return Impulse::select(sticks, stick, Impulse::none());
        }
        let slides = self.at(self.root(self.guess(), active));
        let slide = self.impulse(&slides, &self.sideways(&slides), sin);
        let slide = Impulse::select(active, slide, Impulse::none());
        Impulse::select(sticks, stick, slide)
    }

    /// The root of φ by Newton's method inside a bracket: φ(0) < 0, φ(∞) = ∞.
    #[inline(always)]
    fn root(&self, guess: L, mut active: L::Mask) -> L {
        let (zero, two) = (L::splat(0.0), L::splat(2.0));
        let close = L::splat(if self.moments.is_some() {
            LAST_WITH_KINKS
        } else {
            LAST
        });
        let mut sigma = guess;
        let (mut low, mut high) = (zero, L::splat(f64::INFINITY));
        for _ in 0..MAX_STEPS {
            let cone = self.cone(sigma);
            let below = cone.limit.lt(cone.size);
            low = L::select(active & below, sigma, low);
            high = L::select(active & !below, sigma, high);
            let newton = sigma - cone.step / cone.over;
            let inside = low.le(newton) & newton.le(high) & zero.lt(cone.over);
            // until it has an upper end the bracket grows; then it is halved
            let open = two * (sigma + self.alpha);
            let half = low + (high - low) * L::splat(0.5);
            let fallback = L::select(high.lt(L::splat(f64::INFINITY)), half, open);
            let next = L::select(inside, newton, fallback);
            let moved = (next - sigma).abs();
            let converged = (cone.limit - cone.size).abs().le(close * cone.size) & inside
                | moved.le(L::splat(f64::EPSILON) * (sigma + self.alpha));
            sigma = L::select(active, next, sigma);
            active = active & !converged;
            if !active.any() {
                break;
            }
        }
        sigma
    }

    #[inline(always)]
    fn impulse(&self, at: &Trial<L>, side: &JointSolution<L>, sin: L) -> Impulse<L> {
        let x = -(self.slip_x * at.x);
        Impulse {
            x,
            y: -(side.slip_y * at.y),
            z: self.base - self.coupling * x,
            contour: sin * side.contour,
            pivoting: side.pivoting,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Stronge;
    use crate::rigid::Rigid;
    use coinmc_core::Coin;
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// Friction with either length or without it.
    fn any_friction(dice: &mut Dice) -> Friction {
        let mut length = || dice.pick(&[0.0, 1.0]) * dice.scale(0.003, 0.2);
        Friction {
            contour: length(),
            pivoting: length(),
            mu: dice.between(0.05, 0.6),
        }
    }

    /// The lowest point rebounds with e of its speed, and every friction opposes what is left of the rate that it acts
    /// against, or stops it: in the motion of a coin in vectors after the impulse.
    #[test]
    fn friction_opposes_what_is_left_after_the_impact() {
        let (mut slides, mut sticks, mut held, mut runs) = (0, 0, 0, 0);
        for trial in 0..2000 {
            let mut dice = Dice::new(324, trial);
            let body = Rigid::generic_body(dice.pick(&[0.0, 0.15]));
            let friction = any_friction(&mut dice);
            let tilt = dice.between(0.2, 1.5);
            let mut coin = Rigid::new(&body, tilt, dice.vector(1.0), dice.vector(2.0));
            let e = dice.between(0.0, 0.6);
            let speed = dice.between(0.3, 1.5);
            coin.velocity.z -= coin.at_contact().z + speed;
            let (motion, spin) = coin.folded(1.0, 1.0);
            let point = motion.contact_point(&body, &spin);
            let p = Moreau.impulse(&body, &friction, &point, e);
            let after = coin.after(&p);
            let slip = after.at_contact();
            assert!((slip.z - e * speed).abs() < 1e-10, "trial {trial}");
            let guard = ChatterjeeRuina.impulse(&body, &friction, &point, e);
            if (p.x, p.y) == (guard.x, guard.y) {
                continue;
            }
            let pull = Vector3::new(p.x, p.y, 0.0);
            let along = Vector3::new(slip.x, slip.y, 0.0);
            let limit = friction.mu * p.z;
            if along.norm() < 1e-9 {
                sticks += 1;
                assert!(pull.norm() < limit * (1.0 + 1e-9), "trial {trial}");
            } else {
                slides += 1;
                let wrong = (pull + along.normalize() * limit).norm();
                assert!(wrong < 1e-8, "trial {trial}: {wrong:e}");
            }
            let limits = [friction.contour * p.z, friction.pivoting * p.z];
            let turns = [after.omega.x, after.omega.z];
            for ((friction, turn), limit) in
                [p.contour, p.pivoting].into_iter().zip(turns).zip(limits)
            {
                if turn.abs() < 1e-9 {
                    held += 1;
                    assert!(friction.abs() < limit + 1e-9, "trial {trial}");
                } else {
                    runs += u32::from(limit > 0.0);
                    let wrong = friction - limit * turn.signum();
                    assert!(wrong.abs() < 1e-9, "trial {trial}: {wrong:e}");
                }
            }
        }
        let counts = [slides, sticks, held, runs];
        assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
    }

    /// Nothing in an impact knows a unit of speed: impulses are proportional to the velocities before it. With a power of
    /// 2 that is exact, as no digit is rounded otherwise.
    #[test]
    fn impulses_are_proportional_to_the_velocities() {
        let impulses = |trial: u64, unit: f64| {
            let mut dice = Dice::new(327, trial);
            let body = Rigid::generic_body(dice.pick(&[0.0, 0.15]));
            let friction = any_friction(&mut dice);
            let tilt = dice.between(0.2, 1.5);
            let (velocity, omega) = (dice.vector(1.0), dice.vector(2.0));
            let mut coin = Rigid::new(&body, tilt, velocity * unit, omega * unit);
            coin.velocity.z -= coin.at_contact().z + unit;
            let (motion, spin) = coin.folded(1.0, 1.0);
            let point = motion.contact_point(&body, &spin);
            let laws = [
                Moreau.impulse(&body, &friction, &point, 0.4),
                ChatterjeeRuina.impulse(&body, &friction, &point, 0.4),
                Stronge.impulse(&body, &friction, &point, 0.4),
            ];
            laws.map(|p| [p.x, p.y, p.z, p.contour, p.pivoting].map(|part| part / unit))
        };
        for trial in 0..300 {
            let expected = impulses(trial, 1.0);
            for unit in [libm::exp2(-40.0), libm::exp2(40.0)] {
                assert_eq!(impulses(trial, unit), expected, "{trial} {unit}");
            }
        }
    }

    /// Newton's step is φ/φ' of φ = μ p_z/|p_t| − 1, by differences: with and without friction lengths.
    #[test]
    fn newtons_step_divides_by_the_derivative() {
        let mut compared = 0;
        for trial in 0..2000 {
            let mut dice = Dice::new(323, trial);
            let coin = Coin::cylinder(libm::exp(dice.between(-2.0, 1.0)), 0.01);
            let body = Body::new(&coin.expect("a valid coin"));
            let lengths = if dice.chance() { 0.05 } else { 0.0 };
            let friction = Friction {
                mu: dice.between(0.1, 0.5),
                contour: lengths * dice.between(0.0, 1.0),
                pivoting: lengths * dice.between(0.0, 1.0),
            };
            let tilt = libm::sincos(dice.between(0.2, 1.5));
            let approach = -dice.between(0.5, 1.0);
            let mut part = || dice.between(-1.0, 1.0);
            let point = ContactPoint::at(&body, tilt, [part(), part(), approach], [part(), part()]);
            let k = point.matrix(&body);
            let moments = friction
                .has_lengths()
                .then(|| FrictionMoments::new(&body, &friction, &point, k.yy));
            let problem = Problem::new(&friction, &point, &k, 0.5, moments);
            let sigma = dice.between(0.5, 3.0);
            let phi = |sigma: f64| {
                let cone = problem.cone(sigma);
                cone.limit / cone.size - 1.0
            };
            let slope = |small: f64| (phi(sigma + small) - phi(sigma - small)) / (2.0 * small);
            let (found, finer) = (slope(1e-5), slope(2e-6));
            // a limit of the friction lengths is reached between
            if (found / finer - 1.0).abs() > 1e-6 {
                continue;
            }
            compared += 1;
            let cone = problem.cone(sigma);
            let step = cone.step / cone.over;
            assert!((step * finer / phi(sigma) - 1.0).abs() < 1e-6, "{step}");
        }
        assert!(compared > 1900, "{compared}");
    }
}
