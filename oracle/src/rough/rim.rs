//! The rims over the ground: where they are nearest.
//!
//! A point of a rim is p + b(H/2)u + R(cos β d + sin β e), d the direction of the coin's plane that
//! points down most steeply and e = u × d, horizontal. Contacts are local minima of its height
//! above the ground, G(β): there the rim is tangent to the ground, so that the ground's normal is
//! normal to the rim as well.

use crate::coulomb::Touch;
use crate::ground::Ground;
use crate::{Model, Motion};
use nalgebra::Vector3;

/// Distance of the places at which minima are looked for, in ℓ. Minima of a profile are 2πℓ/√3 =
/// 3.6ℓ apart in the mean.
const SAMPLING: f64 = 0.5;
/// Error of a minimum's gap at which its search ends.
const GAP_ERROR: f64 = 1e-15;
/// Heights in σ above which no ground rises.
const HIGHEST: f64 = 6.0;
/// How far a minimum may move while it is followed, in ℓ.
const ASTRAY: f64 = 1.5;
/// Sine of the tilt below which it has no direction.
const NO_TILT: f64 = 1e-150;

/// A local minimum of a rim's height above the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Minimum {
    /// The rim: 1 heads, −1 tails.
    pub(crate) end: f64,
    /// From the rim's centre, a unit vector.
    pub(crate) along: Vector3<f64>,
    /// From the coin's centre.
    pub(crate) arm: Vector3<f64>,
    /// The ground's normal.
    pub(crate) normal: Vector3<f64>,
    /// Height above the ground.
    pub(crate) gap: f64,
}

impl Minimum {
    /// Velocity of the material point along the normal.
    pub(crate) fn approach(&self, motion: &Motion) -> f64 {
        -self.velocity(motion).dot(&self.normal)
    }

    pub(crate) fn velocity(&self, motion: &Motion) -> Vector3<f64> {
        motion.velocity + motion.spin.cross(&self.arm)
    }

    /// Distance along the normal.
    pub(crate) fn distance(&self) -> f64 {
        self.gap * self.normal.z
    }

    pub(crate) fn touch(&self, axis: &Vector3<f64>) -> Touch {
        let n = self.normal;
        let first = (Vector3::x() - n * n.x).normalize();
        let across = axis - n * axis.dot(&n);
        let sine = across.norm().max(NO_TILT);
        Touch {
            arm: self.arm,
            normal: n,
            tangents: [first, n.cross(&first)],
            rolling: across / sine,
            steepness: 1.0 / sine,
        }
    }
}

/// G and its first two derivatives, and what they come from.
#[derive(Debug, Clone, Copy)]
struct Place {
    minimum: Minimum,
    slope: f64,
    bend: f64,
}

/// A rim in space.
#[derive(Debug)]
pub(crate) struct Rim {
    end: f64,
    centre: Vector3<f64>,
    position: Vector3<f64>,
    down: Vector3<f64>,
    level: Vector3<f64>,
    radius: f64,
    sine: f64,
}

impl Rim {
    pub(crate) fn new(model: &Model, motion: &Motion, end: f64) -> Self {
        let (u, sine) = (motion.axis, motion.sine());
        let down = if sine > NO_TILT {
            (u * u.z - Vector3::z()) / sine
        } else {
            Vector3::x()
        };
        Self {
            end,
            centre: u * (end * model.half),
            position: motion.position,
            down,
            level: u.cross(&down),
            radius: model.radius,
            sine,
        }
    }

    fn place(&self, ground: &mut Ground, angle: f64) -> Place {
        let (sin, cos) = libm::sincos(angle);
        let along = self.down * cos + self.level * sin;
        let arm = self.centre + along * self.radius;
        let at = self.position + arm;
        let relief = ground.at(at.x, at.y);
        let first = (self.level * cos - self.down * sin) * self.radius;
        let second = -along * self.radius;
        let [gx, gy] = relief.gradient;
        let [xx, xy, yy] = relief.curvature;
        let bent = xx * first.x * first.x + 2.0 * xy * first.x * first.y + yy * first.y * first.y;
        Place {
            minimum: Minimum {
                end: self.end,
                along,
                arm,
                normal: Vector3::new(-gx, -gy, 1.0).normalize(),
                gap: at.z - relief.height,
            },
            slope: first.z - gx * first.x - gy * first.y,
            bend: second.z - gx * second.x - gy * second.y - bent,
        }
    }

    /// Half of the arc that the ground may reach when its lowest point is `lowest` above the mean.
    fn reach(&self, top: f64) -> Option<f64> {
        let room = top - (self.position.z + self.centre.z - self.radius * self.sine);
        (room >= 0.0).then(|| {
            let share = room / (self.radius * self.sine).max(NO_TILT);
            if share >= 2.0 {
                std::f64::consts::PI
            } else {
                libm::acos(1.0 - share)
            }
        })
    }

    /// Follows a minimum from a direction in the coin's plane, or one near it. `None` if it is gone.
    pub(crate) fn follow(&self, ground: &mut Ground, along: &Vector3<f64>) -> Option<Minimum> {
        let start = libm::atan2(along.dot(&self.level), along.dot(&self.down));
        let unit = ground.correlation_length() / self.radius;
        let mut angle = start;
        for _ in 0..40 {
            let place = self.place(ground, angle);
            let step = if place.bend > 0.0 {
                -place.slope / place.bend
            } else {
                -0.3 * unit * place.slope.signum()
            };
            let settled = place.bend > 0.0 && 0.5 * place.slope * step > -GAP_ERROR;
            if settled {
                return Some(place.minimum);
            }
            angle += step.clamp(-0.3 * unit, 0.3 * unit);
            if (angle - start).abs() > ASTRAY * unit {
                return None;
            }
        }
        None
    }

    /// All minima that are nearer than `within`, and the nearest in any case, except those that
    /// are `known`. The lowest point of a rim that the ground cannot reach.
    pub(crate) fn search(
        &self,
        ground: &mut Ground,
        known: &[Option<Minimum>],
        within: f64,
        found: &mut Vec<Minimum>,
    ) {
        let Some(reach) = self.reach(HIGHEST * ground.deviation() + within) else {
            found.push(self.place(ground, 0.0).minimum);
            return;
        };
        let unit = ground.correlation_length() / self.radius;
        // a number of samples
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = ((2.0 * reach / (SAMPLING * unit)).ceil() as usize).clamp(2, 4000);
        let width = 2.0 * reach / count as f64;
        let mut nearest = f64::INFINITY;
        let begin = found.len();
        let mut last = self.place(ground, -reach);
        for index in 1..=count {
            let angle = -reach + width * index as f64;
            let next = self.place(ground, angle);
            if last.slope < 0.0 && next.slope >= 0.0 {
                // a bound from below that holds for parabolas, and nearly for the rest
                let (a, b) = (last.minimum.gap, next.minimum.gap);
                let least = (a + last.slope * width).max(b - next.slope * width);
                if least < nearest.max(within)
                    && let Some(minimum) = self.refine(ground, angle - width, angle)
                    && !known
                        .iter()
                        .flatten()
                        .any(|other| self.same(ground, &minimum, other))
                {
                    nearest = nearest.min(minimum.gap);
                    found.push(minimum);
                }
            }
            last = next;
        }
        let mut index = begin;
        while index < found.len() {
            if found[index].gap > nearest.max(within) {
                found.swap_remove(index);
            } else {
                index += 1;
            }
        }
    }

    fn same(&self, ground: &Ground, a: &Minimum, b: &Minimum) -> bool {
        let near = 0.02 * ground.correlation_length() / self.radius;
        a.end == b.end && (a.along - b.along).norm() < near
    }

    /// The minimum between two angles at which G' is negative and positive: Newton's iteration,
    /// with bisection where it leaves the bracket.
    fn refine(&self, ground: &mut Ground, low: f64, high: f64) -> Option<Minimum> {
        let (mut low, mut high) = (low, high);
        let mut angle = 0.5 * (low + high);
        for _ in 0..60 {
            let place = self.place(ground, angle);
            if place.bend > 0.0 && 0.5 * place.slope * place.slope < GAP_ERROR * place.bend {
                return Some(place.minimum);
            }
            if place.slope < 0.0 {
                low = angle;
            } else {
                high = angle;
            }
            let newton = angle - place.slope / place.bend;
            let inside = place.bend > 0.0 && newton > low && newton < high;
            angle = if inside { newton } else { 0.5 * (low + high) };
        }
        None
    }
}
