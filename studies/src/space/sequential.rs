//! Friction first, then the friction lengths: the law of impact of an earlier study.

use coinmc_volumetric::{Body, ContactPoint, Friction, ImpactLaw, Impulse, Lane, Moreau};

/// Fraction of the friction cone within which a contact counts as sticking.
const INSIDE: f64 = 1.0 - 1e-9;

/// Moreau's impulse as if there were no friction lengths; then Gauss–Seidel sweeps over J_c, J_p
/// and, where that impulse sticks, p_y, each against its own final rate with p_x and p_z as they
/// are. It dissipates (every move of a sweep is towards the least kinetic energy along one
/// direction, stopped at a limit), but where the contact slides p_y never learns of J_c and J_p,
/// and the limits of a few sweeps depend on their number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sequential {
    /// Sweeps over the three.
    pub(super) sweeps: u32,
}

/// What a sweep changes.
#[derive(Clone, Copy)]
struct Parts<L> {
    y: L,
    contour: L,
    pivoting: L,
}

/// Angular velocities about u and about e_θ.
struct Rates<L> {
    spin: L,
    turn: L,
}

impl ImpactLaw for Sequential {
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        point: &ContactPoint<L>,
        e: L,
    ) -> Impulse<L> {
        let smooth = Friction {
            contour: 0.0,
            pivoting: 0.0,
            ..*friction
        };
        let p = Moreau.impulse(body, &smooth, point, e);
        let zero = L::splat(0.0);
        let mut parts = Parts {
            y: p.y,
            contour: zero,
            pivoting: zero,
        };
        let most = L::splat(friction.mu) * p.z;
        let size = (p.x * p.x + p.y * p.y).sqrt();
        let sticks = size.lt(L::splat(INSIDE) * most);
        let room = (most * most - p.x * p.x).max(zero).sqrt();
        for _ in 0..self.sweeps {
            parts.contour = contour(body, friction, point, &parts, p.z);
            parts.pivoting = pivoting(body, friction, point, &parts, p.z);
            let held = hold(body, point, &parts);
            let y = held.min(room).max(-room);
            // a contact that has once come to its cone slides from then on
            let size = (p.x * p.x + parts.y * parts.y).sqrt();
            let still = size.lt(L::splat(INSIDE) * most);
            parts.y = L::select(sticks & still, y, parts.y);
        }
        Impulse {
            y: parts.y,
            contour: parts.contour,
            pivoting: parts.pivoting,
            ..p
        }
    }
}

/// The rates after these parts of the impulse.
fn after<L: Lane>(body: &Body, point: &ContactPoint<L>, parts: &Parts<L>) -> Rates<L> {
    let (s, c) = (point.sin, point.cos);
    let axial = L::splat(body.radius) * parts.y - parts.contour - c * parts.pivoting;
    let across = L::splat(body.half) * parts.y - parts.contour * c / s + s * parts.pivoting;
    Rates {
        spin: point.spin + axial / L::splat(body.ka),
        turn: point.turn + across / L::splat(body.kt),
    }
}

/// J_c that stops ψ', or its limit.
fn contour<L: Lane>(
    body: &Body,
    friction: &Friction,
    point: &ContactPoint<L>,
    parts: &Parts<L>,
    z: L,
) -> L {
    let one = L::splat(1.0);
    let cot = point.cos / point.sin;
    let rates = after(body, point, parts);
    let inverse_mass = one / L::splat(body.ka) + cot * cot / L::splat(body.kt);
    let limit = L::splat(friction.contour) * z;
    let free = parts.contour + (rates.spin + rates.turn * cot) / inverse_mass;
    free.min(limit).max(-limit)
}

/// J_p that stops ω_z, or its limit.
fn pivoting<L: Lane>(
    body: &Body,
    friction: &Friction,
    point: &ContactPoint<L>,
    parts: &Parts<L>,
    z: L,
) -> L {
    let (s, c) = (point.sin, point.cos);
    let rates = after(body, point, parts);
    let inverse_mass = c * c / L::splat(body.ka) + s * s / L::splat(body.kt);
    let limit = L::splat(friction.pivoting) * z;
    let free = parts.pivoting + (rates.spin * c - rates.turn * s) / inverse_mass;
    free.min(limit).max(-limit)
}

/// p_y that stops the slip along y.
fn hold<L: Lane>(body: &Body, point: &ContactPoint<L>, parts: &Parts<L>) -> L {
    let free = Parts {
        y: L::splat(0.0),
        ..*parts
    };
    let rates = after(body, point, &free);
    let slip = point.slip_y
        + L::splat(body.radius) * (rates.spin - point.spin)
        + L::splat(body.half) * (rates.turn - point.turn);
    -(slip / point.matrix(body).yy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Scene, Surface};

    /// A coin that leans by 0.5 rad and touches with a small slip: it sticks.
    fn point(body: &Body) -> ContactPoint<f64> {
        let (sin, cos) = libm::sincos(0.5);
        ContactPoint {
            sin,
            cos,
            rx: cos * body.radius - sin * body.half,
            rz: -(cos * body.half + sin * body.radius),
            slip_x: 0.01,
            slip_y: 0.02,
            approach: -1.0,
            spin: 0.4,
            turn: -0.3,
        }
    }

    #[test]
    fn many_sweeps_of_a_sticking_contact_are_the_joint_law() {
        let coin = Coin::cylinder(0.85, 0.01).unwrap();
        let surface = Surface::new(0.5, 3.0).unwrap();
        let surface = surface.with_friction_lengths(5e-3, 5e-3).unwrap();
        let scene = Scene::new(coin, surface, 9.81).unwrap();
        let (body, friction) = (Body::new(&coin), Friction::new(&scene));
        let point = point(&body);
        let joint = Moreau.impulse(&body, &friction, &point, 0.5);
        let error = |sweeps| {
            let p = Sequential { sweeps }.impulse(&body, &friction, &point, 0.5);
            (p.y - joint.y).abs() + (p.contour - joint.contour).abs()
        };
        assert!(error(1) > 1e-6, "{}", error(1));
        assert!(error(3000) < 1e-9, "{}", error(3000));
    }

    #[test]
    fn no_sweep_gains_energy() {
        let coin = Coin::cylinder(2.0, 0.01).unwrap();
        let surface = Surface::new(0.5, 0.3).unwrap();
        let surface = surface.with_friction_lengths(1e-3, 1e-3).unwrap();
        let scene = Scene::new(coin, surface, 9.81).unwrap();
        let (body, friction) = (Body::new(&coin), Friction::new(&scene));
        let point = point(&body);
        let works = (0..8).map(|sweeps| {
            let p = Sequential { sweeps }.impulse(&body, &friction, &point, 0.5);
            p.work(&body, &point)
        });
        let works: Vec<f64> = works.collect();
        assert!(
            works[0] < 0.0 && works.is_sorted_by(|a, b| *b <= *a + 1e-15),
            "{works:?}"
        );
    }
}
