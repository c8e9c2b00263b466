//! Six equations of motion and three of contact, as one linear system.
//!
//! A coin touches with the lowest point of one rim. Unknown are v', ω' and the force F at the
//! contact; given are
//!
//! v' = F − ẑ − k v,
//! I ω' = r × F + N t − ω × Iω − k' Iω,
//! gap'' = 0 and, sticking, γ' = 0, or, slipping, F_t = −μ N γ/|γ|.
//!
//! The gap z − h(u) and the slip γ = (v + ω × r(u))_t are functions of the state, and their
//! derivatives are taken by the chain rule, with r(u) the geometric point of contact, which wanders
//! along the rim. Nothing is expressed in a frame that moves with the coin.

use crate::{Model, Motion};
use nalgebra::{SMatrix, SVector, Vector2, Vector3};

/// How the contact point moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact {
    /// Its slip stays as it is (zero, when it sticks).
    Stick,
    /// It slides, and friction opposes this direction: a horizontal unit vector, the direction of
    /// the slip or, at its onset, of the slip to come.
    Slip(Vector2<f64>),
}

/// How much of contour and of pivoting friction acts: 1 against a positive rate (ψ', ω_z), −1
/// against a negative, between them where a law fades near zero or sticks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// Share of ρ_c N.
    pub contour: f64,
    /// Share of ρ_p N.
    pub pivoting: f64,
}

/// Time derivatives of a motion in contact, and the contact's force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// v'.
    pub velocity: Vector3<f64>,
    /// u'.
    pub axis: Vector3<f64>,
    /// ω'.
    pub spin: Vector3<f64>,
    /// Force on the coin at the contact; its z component is N, negative where the coin would
    /// lift off.
    pub force: Vector3<f64>,
    /// γ', the rate of the slip of the contact point.
    pub slip: Vector2<f64>,
}

/// The lowest rim point as a function of the state, with its first time derivative.
struct Lowest {
    arm: Vector3<f64>,
    arm_rate: Vector3<f64>,
    /// h'' = slope·u_z'' + bend.
    slope: f64,
    bend: f64,
}

impl Lowest {
    /// r = −b h u + R (c u − ẑ)/s at the height b h c + R s, b = 1 for the rim of tails, −1 for heads, of the centre line of
    /// a rounded rim; and the rim's radius below that.
    fn new(model: &Model, motion: &Motion, axis_rate: &Vector3<f64>) -> Self {
        let (u, s) = (&motion.axis, motion.sine());
        let (c, c_rate) = (u.z, axis_rate.z);
        let s_rate = -c * c_rate / s;
        let [(heads, above), (tails, below)] = model.rims;
        let (radius, face) = if tails * s + below * c > heads * s - above * c {
            (tails, below)
        } else {
            (heads, -above)
        };
        let along = u * c - Vector3::z();
        let along_rate = u * c_rate + axis_rate * c;
        Self {
            arm: along * (radius / s) - u * face - Vector3::z() * model.rim,
            arm_rate: (along_rate / s - along * (s_rate / (s * s))) * radius - axis_rate * face,
            slope: face - radius * c / s,
            bend: -radius / (s * s * s) * c_rate * c_rate,
        }
    }
}

/// Slip of the contact point: the horizontal velocity of the material point that is there.
pub fn slip(model: &Model, motion: &Motion) -> Vector2<f64> {
    let axis_rate = motion.spin.cross(&motion.axis);
    let lowest = Lowest::new(model, motion, &axis_rate);
    (motion.velocity + motion.spin.cross(&lowest.arm)).xy()
}

/// ψ' and ω_z: the rates that contour and pivoting friction oppose.
pub fn twist_rates(motion: &Motion) -> (f64, f64) {
    let s = motion.sine();
    let horizontal = motion.axis.xy();
    (horizontal.dot(&motion.spin.xy()) / (s * s), motion.spin.z)
}

/// The derivatives of a motion whose lowest rim point touches and neither sinks nor rises.
///
/// # Panics
/// If the system is singular: a coin flat on its face, or sliding on the edge of a Painlevé
/// configuration.
pub fn rates(model: &Model, motion: &Motion, contact: Contact, twist: Twist) -> Rates {
    let Motion {
        velocity: v,
        axis: u,
        spin: w,
        ..
    } = *motion;
    let axis_rate = w.cross(&u);
    let lowest = Lowest::new(model, motion, &axis_rate);
    let s = motion.sine();
    let inertia = model.inertia(&u);
    let momentum = inertia * w;

    let mut matrix = SMatrix::<f64, 9, 9>::zeros();
    let mut right = SVector::<f64, 9>::zeros();
    // v' − F = −ẑ − kv
    matrix.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    matrix.fixed_view_mut::<3, 3>(0, 6).fill_diagonal(-1.0);
    let mut free = -v * model.linear_drag;
    free.z -= 1.0;
    right.fixed_rows_mut::<3>(0).copy_from(&free);
    // Iω' − r × F − N t = −ω × Iω − k'Iω
    let wander = Vector3::new(u.x, u.y, 0.0) / (s * s);
    let torque = -wander * (model.contour * twist.contour)
        - Vector3::z() * (model.pivoting * twist.pivoting);
    let mut of_force = lowest.arm.cross_matrix();
    of_force.set_column(2, &(of_force.column(2) + torque));
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
    matrix.fixed_view_mut::<3, 3>(3, 6).copy_from(&-of_force);
    let mut free = -momentum * model.angular_drag;
    if model.gyroscopic {
        free -= w.cross(&momentum);
    }
    right.fixed_rows_mut::<3>(3).copy_from(&free);
    // gap'' = v_z' − slope·u_z'' − bend = 0, u'' = ω' × u + ω × u'; (ω' × u)_z = ω'·(u × ẑ)
    matrix[(6, 2)] = 1.0;
    let lever = u.cross(&Vector3::z()) * -lowest.slope;
    matrix
        .fixed_view_mut::<1, 3>(6, 3)
        .copy_from(&lever.transpose());
    right[6] = lowest.slope * w.cross(&axis_rate).z + lowest.bend;
    // the rate of the slip is v' − [r]ω' + ω × r'
    let carried = w.cross(&lowest.arm_rate);
    let turned = -lowest.arm.cross_matrix();
    for i in 0..2 {
        match contact {
            Contact::Stick => {
                matrix[(7 + i, i)] = 1.0;
                matrix
                    .fixed_view_mut::<1, 3>(7 + i, 3)
                    .copy_from(&turned.row(i));
                right[7 + i] = -carried[i];
            }
            Contact::Slip(direction) => {
                matrix[(7 + i, 6 + i)] = 1.0;
                matrix[(7 + i, 8)] = model.friction * direction[i];
            }
        }
    }
    let solution = matrix.lu().solve(&right).expect("a regular contact");
    let velocity: Vector3<f64> = solution.fixed_rows::<3>(0).into();
    let spin: Vector3<f64> = solution.fixed_rows::<3>(3).into();
    Rates {
        velocity,
        axis: axis_rate,
        spin,
        force: solution.fixed_rows::<3>(6).into(),
        slip: (velocity + turned * spin + carried).xy(),
    }
}

/// One step of the classical Runge–Kutta method, for motions that stay in one mode of contact.
/// `mode` chooses it from the state, so that a slip may turn.
pub fn runge_kutta(
    model: &Model,
    motion: &Motion,
    h: f64,
    mode: impl Fn(&Motion) -> (Contact, Twist),
) -> Motion {
    let slope = |at: &Motion| {
        let (contact, twist) = mode(at);
        let rates = rates(model, at, contact, twist);
        Motion {
            position: at.velocity,
            velocity: rates.velocity,
            axis: rates.axis,
            spin: rates.spin,
        }
    };
    let ahead = |slope: &Motion, h: f64| Motion {
        position: motion.position + slope.position * h,
        velocity: motion.velocity + slope.velocity * h,
        axis: (motion.axis + slope.axis * h).normalize(),
        spin: motion.spin + slope.spin * h,
    };
    let first = slope(motion);
    let second = slope(&ahead(&first, h / 2.0));
    let third = slope(&ahead(&second, h / 2.0));
    let fourth = slope(&ahead(&third, h));
    let mean = |of: fn(&Motion) -> Vector3<f64>| {
        (of(&first) + (of(&second) + of(&third)) * 2.0 + of(&fourth)) / 6.0
    };
    let mean = Motion {
        position: mean(|m| m.position),
        velocity: mean(|m| m.velocity),
        axis: mean(|m| m.axis),
        spin: mean(|m| m.spin),
    };
    ahead(&mean, h)
}
