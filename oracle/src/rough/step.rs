//! A step of contact on rough ground.
//!
//! The scheme is that of [`TimeStepper`](crate::TimeStepper): half a step of free motion, the
//! impulses of gravity and of all contacts together, another half. The contacts and the ground's
//! normals are those in the middle. Points that already rest obey the constraint with the mean of
//! the velocities before and after, so that normal forces do no work. Gaps that open, of third order in
//! the step, are closed by the smallest displacement of the coin (in the metric of its mass).

use crate::coulomb::{Contacts, LAWS, MOST, NORMAL, ROWS};
use crate::ground::Ground;
use crate::motion::rotate;
use crate::rough::rim::{Minimum, Rim};
use crate::{Model, Motion};
use nalgebra::Vector3;

/// Distance at which a point that rested no longer touches.
const RELEASED: f64 = 1e-6;
/// Regularization of redundant contacts, as a fraction of the largest diagonal element.
const REDUNDANT: f64 = 1e-9;
/// Distance between minima, as a part of the coin's plane, at which they are the same.
const MERGED: f64 = 1e-6;

/// A point that rests on the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Resting {
    pub(crate) minimum: Minimum,
    /// Impulses of the last step divided by its length.
    pub(crate) force: [f64; ROWS],
    /// Distance at which it came to rest, between ∓ the gap that counts as touching. It is kept: to close
    /// it would lift the coin, with every impact of one that rocks.
    pub(crate) distance: f64,
    /// Whether it came to rest by an impact just now. It may still part, slowly: its normal velocity
    /// is 0 after the step, not in the mean.
    pub(crate) new: bool,
    /// Which of the laws of friction held it still.
    pub(crate) stuck: [bool; 3],
}

/// The coin and the points that carry it.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) motion: Motion,
    pub(crate) resting: Vec<Resting>,
}

impl State {
    /// Finds the resting points again after the coin has moved. Those that are gone are left out.
    fn follow(&mut self, model: &Model, ground: &mut Ground) {
        let rims = [-1.0, 1.0].map(|end| Rim::new(model, &self.motion, end));
        let mut kept: Vec<Resting> = Vec::with_capacity(self.resting.len());
        for mut resting in self.resting.drain(..) {
            let old = resting.minimum;
            let rim = &rims[usize::from(old.end > 0.0)];
            let Some(minimum) = rim.follow(ground, &old.along) else {
                continue;
            };
            let same = |other: &Resting| {
                let other = &other.minimum;
                other.end == minimum.end && (other.along - minimum.along).norm() < MERGED
            };
            if !kept.iter().any(same) {
                resting.minimum = minimum;
                kept.push(resting);
            }
        }
        self.resting = kept;
    }

    /// Makes a step of contact. Returns whether the impulses converged.
    pub(crate) fn step(
        &mut self,
        model: &Model,
        ground: &mut Ground,
        contacts: &mut Contacts,
        h: f64,
    ) -> bool {
        self.motion.drift(model, h / 2.0);
        self.follow(model, ground);
        let axis = self.motion.axis;
        let touches = self
            .resting
            .iter()
            .map(|resting| resting.minimum.touch(&axis));
        contacts.gather(model, &self.motion, touches);
        for (contact, resting) in self.resting.iter().enumerate() {
            for (row, force) in resting.force.iter().enumerate() {
                contacts.impulse[contact * ROWS + row] = force * h;
            }
        }
        let converged = self.solve(model, contacts, h);
        contacts.apply(&mut self.motion);
        self.motion.velocity += (model.pull - Vector3::z()) * h;
        self.motion.drift(model, h / 2.0);
        self.keep_pressed(model, contacts, h);
        self.follow(model, ground);
        self.close(model, ground);
        converged
    }

    /// The impulses. Rows that newly stick do so with their velocity after the step.
    fn solve(&self, model: &Model, contacts: &mut Contacts, h: f64) -> bool {
        for row in 0..contacts.rows() {
            contacts.offset[row] = 2.0 * contacts.before[row] + contacts.weigh(row, model, h);
        }
        for (contact, resting) in self.resting.iter().enumerate() {
            if resting.new {
                let row = contact * ROWS + NORMAL;
                contacts.offset[row] = contacts.before[row] + contacts.weigh(row, model, h);
            }
        }
        let mut converged = contacts.solve(model);
        let mut again = false;
        for (contact, resting) in self.resting.iter().enumerate() {
            let stuck = contacts.stuck(model, contact);
            for (law, rows) in LAWS.iter().enumerate() {
                if stuck[law] && !resting.stuck[law] {
                    for row in rows.clone() {
                        let row = contact * ROWS + row;
                        contacts.offset[row] = contacts.before[row] + contacts.weigh(row, model, h);
                    }
                    again = true;
                }
            }
        }
        if again {
            converged = contacts.solve(model);
        }
        converged
    }

    /// Keeps the points that press, with their forces.
    fn keep_pressed(&mut self, model: &Model, contacts: &Contacts, h: f64) {
        let mut contact = 0;
        self.resting.retain_mut(|resting| {
            let impulse = &contacts.impulse[contact * ROWS..][..ROWS];
            let presses = impulse[NORMAL] > 0.0;
            for (force, p) in resting.force.iter_mut().zip(impulse) {
                *force = p / h;
            }
            resting.new = false;
            resting.stuck = contacts.stuck(model, contact);
            contact += 1;
            presses
        });
    }

    /// Closes the gaps of the resting points.
    fn close(&mut self, model: &Model, ground: &mut Ground) {
        if self.resting.is_empty() {
            return;
        }
        let inverse = model.inverse_inertia(&self.motion.axis);
        let count = self.resting.len();
        let mut rows = [(Vector3::zeros(), Vector3::zeros(), Vector3::zeros()); MOST];
        let mut gaps = [0.0; MOST];
        for (index, resting) in self.resting.iter().enumerate() {
            let (n, arm) = (resting.minimum.normal, resting.minimum.arm);
            let angular = arm.cross(&n);
            rows[index] = (n, angular, inverse * angular);
            gaps[index] = resting.distance - resting.minimum.distance();
        }
        let mut matrix = [[0.0; MOST]; MOST];
        let mut largest: f64 = 0.0;
        for i in 0..count {
            for j in 0..count {
                matrix[i][j] = rows[i].0.dot(&rows[j].0) + rows[i].1.dot(&rows[j].2);
            }
            largest = largest.max(matrix[i][i]);
        }
        for (i, row) in matrix.iter_mut().enumerate().take(count) {
            row[i] += REDUNDANT * largest;
        }
        eliminate(&mut matrix, &mut gaps, count);
        let mut turned = Vector3::zeros();
        for (row, share) in rows.iter().zip(&gaps).take(count) {
            self.motion.position += row.0 * *share;
            turned += row.2 * *share;
        }
        self.motion.axis = rotate(&self.motion.axis, &turned);
        self.follow(model, ground);
        self.resting
            .retain(|resting| resting.minimum.distance() - resting.distance < RELEASED);
    }
}

/// Solves a small symmetric positive definite system in place.
fn eliminate(matrix: &mut [[f64; MOST]; MOST], right: &mut [f64; MOST], count: usize) {
    for pivot in 0..count {
        let row = matrix[pivot];
        for below in pivot + 1..count {
            let factor = matrix[below][pivot] / row[pivot];
            for column in pivot..count {
                matrix[below][column] -= factor * row[column];
            }
            right[below] -= factor * right[pivot];
        }
    }
    for pivot in (0..count).rev() {
        let known: f64 = (pivot + 1..count)
            .map(|column| matrix[pivot][column] * right[column])
            .sum();
        right[pivot] = (right[pivot] - known) / matrix[pivot][pivot];
    }
}
