//! Impacts: Newton's restitution at every contact, friction against the final slip (Moreau 1988).

use crate::coulomb::{Contacts, NORMAL, ROWS, TANGENT};
use crate::{Model, Motion};
use nalgebra::{Matrix3, Vector3};

/// Gain of energy that counts as rounding, as a fraction of the energy of the contact's own motion.
const ROUNDING: f64 = 1e-11;

/// Applies the impact of the gathered contacts to the motion. A contact whose rebound would be
/// slower than `rest` does not rebound. Returns whether the law itself acted, not its substitute.
///
/// Where Newton's law would gain energy (or has no solution) the impulse is that of Chatterjee and
/// Ruina for one contact, and plastic for several.
pub(crate) fn collide(
    model: &Model,
    motion: &mut Motion,
    contacts: &mut Contacts,
    rest: f64,
) -> bool {
    let restitution = |approach: f64| {
        let bounces = approach > model.threshold && model.restitution * approach >= rest;
        if bounces { model.restitution } else { 0.0 }
    };
    aim(contacts, restitution);
    let scale = scale(contacts);
    let lawful = contacts.solve(model) && contacts.work() <= ROUNDING * scale;
    if !lawful {
        if contacts.count() == 1 {
            chatterjee_ruina(model, contacts, restitution(-contacts.before[NORMAL]));
        } else {
            aim(contacts, |_| 0.0);
            contacts.impulse.fill(0.0);
            contacts.solve(model);
        }
    }
    contacts.apply(motion);
    lawful
}

/// Sets the offsets: v⁺ + e v⁻ for the normals that approach, v⁺ for all else.
fn aim(contacts: &mut Contacts, restitution: impl Fn(f64) -> f64) {
    for row in 0..contacts.rows() {
        let before = contacts.before[row];
        let bounce = if row % ROWS == NORMAL && before < 0.0 {
            restitution(-before) * before
        } else {
            0.0
        };
        contacts.offset[row] = before + bounce;
    }
}

/// Energy of the rows' own motion: the scale of a gain.
fn scale(contacts: &Contacts) -> f64 {
    (0..contacts.rows())
        .filter(|&row| contacts.response(row, row) > 0.0)
        .map(|row| contacts.before[row].powi(2) / contacts.response(row, row))
        .sum()
}

/// Chatterjee and Ruina, J. Appl. Mech. 65 (1998) 939, tangential restitution 0: between the
/// frictionless plastic impulse p_I and the one p_II that stops the contact point altogether,
/// p = (1 + e) p_I + κ (p_II − p_I) with the largest κ <= 1 inside the friction cone.
fn chatterjee_ruina(model: &Model, contacts: &mut Contacts, e: f64) {
    let before = Vector3::new(
        contacts.before[TANGENT],
        contacts.before[TANGENT + 1],
        contacts.before[NORMAL],
    );
    let rows = [TANGENT, TANGENT + 1, NORMAL];
    let w = Matrix3::from_fn(|i, j| contacts.response(rows[i], rows[j]));
    let smooth = Vector3::new(0.0, 0.0, -before.z / w[(2, 2)]);
    let stop = w.lu().solve(&-before).unwrap_or(smooth);
    let impulse = |kappa: f64| smooth * (1.0 + e) + (stop - smooth) * kappa;
    let inside = |p: Vector3<f64>| p.xy().norm() <= model.friction * p.z;
    let (mut low, mut high) = (0.0, 1.0);
    if inside(impulse(1.0)) {
        low = 1.0;
    } else {
        // inside at 0, outside at 1, and the cone is convex: one boundary between
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if inside(impulse(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    let p = impulse(low);
    contacts.impulse.fill(0.0);
    contacts.impulse[NORMAL] = p.z;
    contacts.impulse[TANGENT] = p.x;
    contacts.impulse[TANGENT + 1] = p.y;
}
