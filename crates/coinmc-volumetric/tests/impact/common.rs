//! Random contact points, and the motion before and after an impact from first principles.

use coinmc_core::Coin;
use coinmc_testkit::Dice;
use coinmc_volumetric::{Body, ChatterjeeRuina, Friction, ImpactLaw, Impulse, Law, Moreau};
use coinmc_volumetric::{ContactPoint, Lane, Stronge};
use nalgebra::Vector3;

/// Everything on which an impact depends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    pub(crate) body: Body,
    pub(crate) friction: Friction,
    pub(crate) point: ContactPoint<f64>,
    pub(crate) e: f64,
}

pub(crate) fn body(ratio: f64) -> Body {
    Body::new(&Coin::cylinder(ratio, 0.01).expect("a valid coin"))
}

/// A contact point at the tilt with this sine, with the given velocities.
pub(crate) fn point(body: &Body, sin: f64, slip: [f64; 3], spins: [f64; 2]) -> ContactPoint<f64> {
    let cos = (1.0 - sin * sin).sqrt();
    ContactPoint {
        sin,
        cos,
        rx: cos * body.radius - sin * body.half,
        rz: -cos * body.half - sin * body.radius,
        slip_x: slip[0],
        slip_y: slip[1],
        approach: slip[2],
        spin: spins[0],
        turn: spins[1],
    }
}

/// A random impact over all ranges: ratios 1e-3 to 1e3, e 0 to 1, μ 0 to 10, ρ 0 to R/10, tilts
/// from flat to upright, slips of 1e-3 to 1e3 of the approach.
pub(crate) fn case(seed: u64, trial: u64) -> Case {
    let mut dice = Dice::new(seed, trial);
    let body = body(dice.scale(1e-3, 1e3));
    let sin = if dice.between(0.0, 1.0) < 0.2 {
        dice.scale(1e-12, 1e-1)
    } else {
        dice.between(0.01, 0.9999)
    };
    let size = dice.pick(&[1.0, 1.0, 1.0, 1e-3, 30.0, 1e3]);
    let mut part = |size: f64| dice.between(-size, size);
    let slip = [part(size), part(size)];
    let spins = [part(4.0 * size), part(4.0 * size)];
    let approach = -dice.between(1e-3, 1.0);
    let e = match dice.pick(&[0, 1, 2, 3]) {
        0 => 0.0,
        1 => 1.0,
        _ => dice.between(0.0, 1.0),
    };
    let mu = match dice.pick(&[0, 1, 2, 3, 4]) {
        0 => 0.0,
        1 => dice.scale(1e-6, 10.0),
        2 => dice.between(1.0, 10.0),
        _ => dice.between(0.0, 1.0),
    };
    let mut length = || match dice.pick(&[0, 1, 2]) {
        0 => 0.0,
        1 => body.radius * dice.scale(1e-4, 0.1),
        _ => body.radius * dice.between(0.0, 0.1),
    };
    let (contour, pivoting) = (length(), length());
    Case {
        body,
        friction: Friction {
            mu,
            contour,
            pivoting,
        },
        point: point(&body, sin, [slip[0], slip[1], approach], spins),
        e,
    }
}

pub(crate) fn impulse<L: Lane>(
    law: Law,
    body: &Body,
    friction: &Friction,
    point: &ContactPoint<L>,
    e: L,
) -> Impulse<L> {
    match law {
        Law::Moreau => Moreau.impulse(body, friction, point, e),
        Law::ChatterjeeRuina => ChatterjeeRuina.impulse(body, friction, point, e),
        Law::Stronge => Stronge.impulse(body, friction, point, e),
    }
}

impl Case {
    pub(crate) fn impulse(&self, law: Law) -> Impulse<f64> {
        impulse(law, &self.body, &self.friction, &self.point, self.e)
    }

    /// The size of the velocities.
    pub(crate) fn size(&self) -> f64 {
        let t = &self.point;
        t.slip_x.abs() + t.slip_y.abs() + t.approach.abs()
    }
}

pub(crate) fn parts(p: &Impulse<f64>) -> [f64; 5] {
    [p.x, p.y, p.z, p.contour, p.pivoting]
}

/// Velocities at the contact and kinetic energy of a coin that moves as a rigid body in space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) slip: Vector3<f64>,
    /// ω about the horizontal axis along x, s ψ'.
    pub(crate) omega_x: f64,
    pub(crate) omega_z: f64,
    pub(crate) energy: f64,
}

/// The motion before and after, by vectors: forces at the contact point, torques about the
/// vertical and about the line through the contact point along which it runs on the rim.
pub(crate) fn motions(case: &Case, p: &Impulse<f64>) -> (Motion, Motion) {
    let (b, t) = (&case.body, &case.point);
    let axis = Vector3::new(t.sin, 0.0, t.cos);
    let across = Vector3::new(t.cos, 0.0, -t.sin);
    let up = Vector3::z();
    let arm = across * b.radius - axis * b.half;
    let omega = axis * t.spin + across * t.turn + Vector3::y() * 0.3;
    let velocity = Vector3::new(t.slip_x, t.slip_y, t.approach) - omega.cross(&arm);
    let of = |velocity: Vector3<f64>, omega: Vector3<f64>| {
        let axial = omega.dot(&axis);
        let rest = omega - axis * axial;
        Motion {
            slip: velocity + omega.cross(&arm),
            omega_x: omega.x,
            omega_z: omega.z,
            energy: 0.5
                * (velocity.norm_squared() + b.ka * axial * axial + b.kt * rest.norm_squared()),
        }
    };
    let force = Vector3::new(p.x, p.y, p.z);
    // power of J_c is −J_c ψ' with ψ' = ω_x/s: a torque −J_c/s about x
    let torque = arm.cross(&force) - Vector3::x() * (p.contour / t.sin) - up * p.pivoting;
    let axial = torque.dot(&axis);
    let kick = axis * (axial / b.ka) + (torque - axis * axial) / b.kt;
    (of(velocity, omega), of(velocity + force, omega + kick))
}
