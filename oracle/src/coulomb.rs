//! Impulses of several contacts at once, by projected Gauss–Seidel.
//!
//! Every contact has five rows: the normal, two tangents, the motion of the contact point along the
//! rim and the pivoting about the vertical. A row is a direction in the space of (v, ω); the
//! impulses p change the rows' velocities by W p. The solver finds impulses with
//!
//! y = W p + b,   0 <= p_n ⊥ y_n >= 0,   |p_t| <= μ p_n against y_t,
//! |p_c| <= (ρ_c/s) p_n against y_c,   |p_p| <= ρ_p p_n against y_p.
//!
//! The row of rolling (contour) friction is the turning about the horizontal projection x of u,
//! ω·x = sψ', with the arm ρ_c/s. That is the same power without large numbers near level, where it
//! matters most (it stops the coin from whirling on its rim). The offset b chooses the velocities y:
//! those after the impulses, their mean with those before, or Newton's v⁺ + e v⁻.

use crate::{Model, Motion};
use nalgebra::Vector3;

/// Rows of a contact.
pub(crate) const ROWS: usize = 5;
/// Index of the normal row.
pub(crate) const NORMAL: usize = 0;
/// Index of the first tangent's row.
pub(crate) const TANGENT: usize = 1;
/// Index of the row of contour friction.
pub(crate) const CONTOUR: usize = 3;
/// Index of the row of pivoting friction.
pub(crate) const PIVOT: usize = 4;

/// The rows of sliding, contour and pivoting friction.
pub(crate) const LAWS: [std::ops::Range<usize>; 3] =
    [TANGENT..TANGENT + 2, CONTOUR..CONTOUR + 1, PIVOT..PIVOT + 1];

/// Fraction of the friction cone above which a contact slips.
const ON_CONE: f64 = 1.0 - 1e-9;
/// Contacts at a time.
pub(crate) const MOST: usize = 8;
const SIZE: usize = ROWS * MOST;
/// Change in a sweep that counts as converged, as a fraction of the largest impulse.
const CONVERGED: f64 = 1e-12;
/// Far more sweeps than needed where the law has one solution.
const MOST_SWEEPS: usize = 2_000;
/// Sweeps over the normals of more than two contacts for each over their friction.
const INNER_SWEEPS: usize = 10;

/// Where and how a coin touches.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Touch {
    /// From the centre.
    pub(crate) arm: Vector3<f64>,
    /// Normal and two tangents of the surface: unit vectors.
    pub(crate) normal: Vector3<f64>,
    pub(crate) tangents: [Vector3<f64>; 2],
    /// Unit projection of u onto the surface, about which the coin rolls.
    pub(crate) rolling: Vector3<f64>,
    /// 1/s, s the sine between u and the normal; 0 if the point does not move along the rim.
    pub(crate) steepness: f64,
}

/// Contacts, their rows and the impulses.
#[derive(Debug)]
pub(crate) struct Contacts {
    count: usize,
    linear: [Vector3<f64>; SIZE],
    angular: [Vector3<f64>; SIZE],
    /// I⁻¹ applied to `angular`.
    response: [Vector3<f64>; SIZE],
    w: [[f64; SIZE]; SIZE],
    /// 1/largest eigenvalue of a contact's tangential block.
    relaxation: [f64; MOST],
    /// ρ_c/s of a contact.
    pub(crate) contour: [f64; MOST],
    /// Velocities of the rows before any impulse.
    pub(crate) before: [f64; SIZE],
    /// The offset b.
    pub(crate) offset: [f64; SIZE],
    /// The impulses.
    pub(crate) impulse: [f64; SIZE],
}

impl Contacts {
    pub(crate) fn new() -> Self {
        Self {
            count: 0,
            linear: [Vector3::zeros(); SIZE],
            angular: [Vector3::zeros(); SIZE],
            response: [Vector3::zeros(); SIZE],
            w: [[0.0; SIZE]; SIZE],
            relaxation: [0.0; MOST],
            contour: [0.0; MOST],
            before: [0.0; SIZE],
            offset: [0.0; SIZE],
            impulse: [0.0; SIZE],
        }
    }

    /// Contacts at these points of a coin that moves like this; impulses 0.
    pub(crate) fn gather(
        &mut self,
        model: &Model,
        motion: &Motion,
        touches: impl Iterator<Item = Touch>,
    ) {
        self.count = 0;
        for touch in touches {
            let at = self.count * ROWS;
            let [first, second] = touch.tangents;
            for (row, along) in [touch.normal, first, second].into_iter().enumerate() {
                self.linear[at + row] = along;
                self.angular[at + row] = touch.arm.cross(&along);
            }
            self.contour[self.count] = model.contour * touch.steepness;
            for (row, about) in [(CONTOUR, touch.rolling), (PIVOT, touch.normal)] {
                self.linear[at + row] = Vector3::zeros();
                self.angular[at + row] = about;
            }
            self.count += 1;
        }
        let inverse = model.inverse_inertia(&motion.axis);
        let rows = self.rows();
        for i in 0..rows {
            self.response[i] = inverse * self.angular[i];
            self.before[i] =
                self.linear[i].dot(&motion.velocity) + self.angular[i].dot(&motion.spin);
            self.impulse[i] = 0.0;
        }
        for i in 0..rows {
            for j in 0..=i {
                let w =
                    self.linear[i].dot(&self.linear[j]) + self.response[i].dot(&self.angular[j]);
                self.w[i][j] = w;
                self.w[j][i] = w;
            }
        }
        for contact in 0..self.count {
            let (xx, xy, yy) = self.tangential(contact);
            let spread = ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt();
            self.relaxation[contact] = 2.0 / (xx + yy + spread);
        }
    }

    /// Number of contacts.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Number of rows in use.
    pub(crate) fn rows(&self) -> usize {
        self.count * ROWS
    }

    /// What the weight adds to a row's velocity in a time.
    pub(crate) fn weigh(&self, row: usize, model: &Model, time: f64) -> f64 {
        self.linear[row].dot(&(model.pull - Vector3::z())) * time
    }

    /// How the velocity of a row responds to the impulse of another.
    pub(crate) fn response(&self, row: usize, to: usize) -> f64 {
        self.w[row][to]
    }

    /// y of a row.
    pub(crate) fn velocity(&self, row: usize) -> f64 {
        let rows = self.rows();
        let pushed: f64 = self.w[row][..rows]
            .iter()
            .zip(&self.impulse[..rows])
            .map(|(w, p)| w * p)
            .sum();
        self.offset[row] + pushed
    }

    /// Applies the impulses to the motion.
    pub(crate) fn apply(&self, motion: &mut Motion) {
        for row in 0..self.rows() {
            motion.velocity += self.linear[row] * self.impulse[row];
            motion.spin += self.response[row] * self.impulse[row];
        }
    }

    /// Which laws of a contact hold it still: those whose impulses are inside their cones.
    pub(crate) fn stuck(&self, model: &Model, contact: usize) -> [bool; 3] {
        let p = &self.impulse[contact * ROWS..][..ROWS];
        let inside = |size: f64, most: f64| size < ON_CONE * most * p[NORMAL];
        [
            inside(
                (p[TANGENT].powi(2) + p[TANGENT + 1].powi(2)).sqrt(),
                model.friction,
            ),
            inside(p[CONTOUR].abs(), self.contour[contact]),
            inside(p[PIVOT].abs(), model.pivoting),
        ]
    }

    /// Work of the impulses, if nothing else acts: p·(mean of the velocities before and after).
    pub(crate) fn work(&self) -> f64 {
        (0..self.rows())
            .map(|row| {
                let pushed = self.velocity(row) - self.offset[row];
                self.impulse[row] * (self.before[row] + 0.5 * pushed)
            })
            .sum()
    }

    /// Finds the impulses, starting from those held. Returns whether it converged.
    pub(crate) fn solve(&mut self, model: &Model) -> bool {
        for _ in 0..MOST_SWEEPS {
            let mut change: f64 = 0.0;
            let old = self.impulse;
            self.relax_normals();
            for contact in 0..self.count {
                self.relax_friction(model, contact);
            }
            for (p, old) in self.impulse.iter().zip(&old).take(self.rows()) {
                change = change.max((p - old).abs());
            }
            let largest = self.impulse[..self.rows()]
                .iter()
                .fold(0.0, |largest: f64, p| largest.max(p.abs()));
            if change <= CONVERGED * largest {
                return true;
            }
        }
        false
    }

    /// Relaxes the normals with all friction fixed: two of them exactly, since the impulses of the two
    /// rims of a thin coin nearly coincide and would take hundreds of sweeps; more of them in turn.
    fn relax_normals(&mut self) {
        if self.count == 2 && self.relax_pair() {
            return;
        }
        for _ in 0..if self.count > 2 { INNER_SWEEPS } else { 1 } {
            for contact in 0..self.count {
                let row = contact * ROWS + NORMAL;
                let p = self.impulse[row] - self.velocity(row) / self.w[row][row];
                self.impulse[row] = p.max(0.0);
            }
        }
    }

    /// The normals of two contacts. `false` if they are one and the same.
    fn relax_pair(&mut self) -> bool {
        let (i, j) = (NORMAL, ROWS + NORMAL);
        let (a, b, c) = (self.w[i][i], self.w[i][j], self.w[j][j]);
        let determinant = a * c - b * b;
        if determinant < 1e-9 * a * c {
            return false;
        }
        let (p, q) = (self.impulse[i], self.impulse[j]);
        // the velocities without the two
        let (u, v) = (
            self.velocity(i) - a * p - b * q,
            self.velocity(j) - b * p - c * q,
        );
        let both = ((b * v - c * u) / determinant, (b * u - a * v) / determinant);
        let (first, second) = ((-u / a).max(0.0), (-v / c).max(0.0));
        (self.impulse[i], self.impulse[j]) = if both.0 >= 0.0 && both.1 >= 0.0 {
            both
        } else if b * first + v >= 0.0 {
            (first, 0.0)
        } else {
            (0.0, second)
        };
        true
    }

    /// Relaxes the friction of a contact, law after law, with all other impulses fixed.
    fn relax_friction(&mut self, model: &Model, contact: usize) {
        let at = contact * ROWS;
        let p = self.impulse[at + NORMAL];
        self.relax_tangents(contact, model.friction * p);
        for (row, length) in [(CONTOUR, self.contour[contact]), (PIVOT, model.pivoting)] {
            let (row, most) = (at + row, length * p);
            let w = self.w[row][row];
            if most > 0.0 && w > 0.0 {
                let p = self.impulse[row] - self.velocity(row) / w;
                self.impulse[row] = p.clamp(-most, most);
            } else {
                self.impulse[row] = 0.0;
            }
        }
    }

    /// Sticks if the disc |p_t| <= most allows it; else makes a step against the slip and projects it
    /// back onto the disc. The fixed point is friction against the slip, for any length of the step.
    fn relax_tangents(&mut self, contact: usize, most: f64) {
        let x = contact * ROWS + TANGENT;
        let y = x + 1;
        let (vx, vy) = (self.velocity(x), self.velocity(y));
        let (xx, xy, yy) = self.tangential(contact);
        let determinant = xx * yy - xy * xy;
        let (px, py) = (self.impulse[x], self.impulse[y]);
        let stick = (
            px - (yy * vx - xy * vy) / determinant,
            py - (xx * vy - xy * vx) / determinant,
        );
        let size = |(x, y): (f64, f64)| (x * x + y * y).sqrt();
        let (px, py) = if size(stick) <= most {
            stick
        } else {
            let r = self.relaxation[contact];
            let step = (px - r * vx, py - r * vy);
            let back = (most / size(step)).min(1.0);
            (step.0 * back, step.1 * back)
        };
        (self.impulse[x], self.impulse[y]) = (px, py);
    }

    fn tangential(&self, contact: usize) -> (f64, f64, f64) {
        let x = contact * ROWS + TANGENT;
        (self.w[x][x], self.w[x][x + 1], self.w[x + 1][x + 1])
    }
}
