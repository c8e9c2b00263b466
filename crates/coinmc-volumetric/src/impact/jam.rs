//! Tangential impact: the contact point jams although it does not approach.

use super::contact_point::Condensed;
use super::{ContactPoint, Impulse, friction_moments::FrictionMoments};
use crate::body::{Body, Friction};
use coinmc_lanes::Lane;

/// The impulse at a contact point that slips in the direction n, does not approach (its normal
/// velocity is taken as 0, and does not change) and jams: K_zz − μ K_xz n_x <= 0. In such a
/// configuration of Painlevé, slip pushes the coin into the surface faster than any normal force
/// can push it out.
///
/// Moreau's conditions, with 0 on the right of the normal one,
/// p_x(σ + K_xx) + K_xz p_z = −slip_x, K_xz p_x + K_zz p_z = 0, p_y(σ + K_yy) = −slip_y,
/// |p_t| <= μ p_z, have besides p = 0 the solution p_x = −slip_x/(σ + α), p_z = −p_x K_xz/K_zz with
/// α = K_xx − K_xz²/K_zz, where either σ = 0 (the slip stops) or the impulse lies on the cone:
///
/// μ (K_xz/K_zz) slip_x = sqrt(slip_x² + q² slip_y²),   q = (σ + α)/(σ + K_yy).
///
/// In a jam the left side is at least |slip|, so the equation requires q >= 1. If α <= K_yy, then
/// q < 1 for every σ: the contact sticks. Otherwise q decreases from α/K_yy to 1 as σ increases. If
/// the equation requires q >= α/K_yy, the contact sticks; if not, σ follows from q. So a solution
/// exists. If rounding puts a point just outside these cases, p of σ = 0 is used too.
///
/// # Energy
/// p·u⁻ + ½p·K p = p·u⁺ − ½p·K p with p·u⁺ = p_t·slip⁺ = −σ p_t² <= 0, as u_z⁺ = u_z⁻ = 0: the
/// impulse dissipates. The friction lengths then leave the least energy within |J| <= ρ p_z.
#[inline(always)]
pub(crate) fn jam_impulse<L: Lane>(
    body: &Body,
    friction: &Friction,
    point: &ContactPoint<L>,
) -> Impulse<L> {
    let k = point.matrix(body);
    let zero = L::splat(0.0);
    let Condensed {
        coupling, alpha, ..
    } = k.condensed();
    let mu = L::splat(friction.mu);

    let pull = mu * coupling * point.slip_x;
    let square = (pull * pull - point.slip_x * point.slip_x).max(zero);
    let q = square.sqrt() / point.slip_y.abs();
    // without slip_y, q is infinite or NaN: then the contact sticks
    let slides = L::splat(1.0).lt(q) & (q * k.yy).lt(alpha);
    let sigma = (alpha - q * k.yy) / (q - L::splat(1.0));
    let sigma = L::select(slides, sigma, zero);

    let x = -point.slip_x / (sigma + alpha);
    let mut p = Impulse {
        x,
        y: -point.slip_y / (sigma + k.yy),
        z: (-coupling * x).max(zero),
        ..Impulse::none()
    };
    if friction.has_lengths() {
        let (contour, pivoting) = FrictionMoments::new(body, friction, point, k.yy).held(p.y, p.z);
        p.contour = point.sin * contour;
        p.pivoting = pivoting;
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Domain, Stream, UniformSource};

    /// Calls `check` for random jams: the coin leans over its contact point, μ is high, and the
    /// slip drives the point into the surface.
    fn for_each_jam(
        mut check: impl FnMut(&Body, &Friction, &ContactPoint<f64>, &Impulse<f64>),
    ) -> u32 {
        let mut jams = 0;
        for trial in 0..200_000 {
            let mut uniforms = Stream::new(71, Domain::Launch, 0).toss(trial);
            let mut at = |i: u32, from: f64, to: f64| from + (to - from) * uniforms.uniform(i);
            let coin = Coin::cylinder(libm::exp(at(0, -4.0, 4.0)), 0.01).expect("a valid coin");
            let body = Body::new(&coin);
            let sin = at(1, 1e-6, 1.0);
            let cos = (1.0 - sin * sin).sqrt();
            let across = |y: f64| if trial % 7 == 0 { 0.0 } else { y };
            let velocity = [at(2, -1.0, 1.0), across(at(3, -1.0, 1.0)), 0.0];
            let turning = [at(4, -1.0, 1.0), at(5, -1.0, 1.0)];
            let point = ContactPoint::at(&body, (sin, cos), velocity, turning);
            let friction = Friction {
                mu: at(6, 1.0, 10.0),
                contour: at(7, -0.1, 0.1).max(0.0),
                pivoting: at(8, -0.1, 0.1).max(0.0),
            };
            let k = point.matrix(&body);
            let n = point.slip_x / libm::hypot(point.slip_x, point.slip_y);
            if k.zz > friction.mu * k.xz * n {
                continue;
            }
            jams += 1;
            check(
                &body,
                &friction,
                &point,
                &jam_impulse(&body, &friction, &point),
            );
        }
        jams
    }

    #[test]
    fn a_jam_stops_or_slows_the_slip_inside_the_cone() {
        let (mut stuck, mut slid) = (0, 0);
        let jams = for_each_jam(|body, friction, point, p| {
            let k = point.matrix(body);
            assert!(
                p.z > 0.0 && (k.xz * p.x + k.zz * p.z).abs() <= 1e-14,
                "{p:?}"
            );
            let tangential = libm::hypot(p.x, p.y);
            assert!(tangential <= friction.mu * p.z * (1.0 + 1e-10), "{p:?}");
            let after = (
                point.slip_x + k.xx * p.x + k.xz * p.z,
                point.slip_y + k.yy * p.y,
            );
            let speed = libm::hypot(after.0, after.1);
            if speed <= 1e-12 {
                stuck += 1;
            } else {
                slid += 1;
                let along = p.x * after.0 + p.y * after.1;
                assert!((along + speed * tangential).abs() <= 1e-9 * speed * tangential);
                assert!((tangential - friction.mu * p.z).abs() <= 1e-9 * tangential);
            }
            assert!(p.work(body, point) < 0.0, "{p:?}");
        });
        assert!(jams > 2_000 && stuck > 0, "{jams} {stuck} {slid}");
    }
}
