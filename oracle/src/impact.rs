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
/// Ruina for one contact, and plastic for several. Rolling friction on a coin that is nearly level
/// has an arm ρ_c/s longer than the coin and may lift the point that it acts at, so that there is no
/// plastic impulse either: then it is plastic without rolling friction.
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
        } else if !plastic(model, contacts) {
            contacts.contour.fill(0.0);
            plastic(model, contacts);
        }
    }
    contacts.apply(motion);
    lawful
}

/// The impulse that stops the contacts. Returns whether there is one.
fn plastic(model: &Model, contacts: &mut Contacts) -> bool {
    aim(contacts, |_| 0.0);
    contacts.impulse.fill(0.0);
    contacts.solve(model)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coulomb::Touch;
    use crate::rough::rim::Minimum;
    use coinmc_core::{Coin, Scene, Surface};

    /// A contact of the lower rim of a level coin, in this direction from its centre, on a slope.
    fn touch(model: &Model, [x, y]: [f64; 2], slope: [f64; 2]) -> Touch {
        let along = Vector3::new(x, y, 0.0).normalize();
        let contact = Minimum {
            end: -1.0,
            along,
            arm: along * model.radius - Vector3::z() * model.half,
            normal: Vector3::new(slope[0], slope[1], 1.0).normalize(),
            gap: 0.0,
        };
        contact.touch(&Vector3::z())
    }

    /// A coin that slides on its face over ground of slopes about .001: one point arrives slowly while
    /// another parts. The arm of rolling friction is about as long as the coin.
    #[test]
    fn a_coin_that_slides_on_its_face_does_not_sink_in() {
        let surface = Surface::new(0.5, 0.3)
            .and_then(|surface| surface.with_friction_lengths(5e-5, 5e-6))
            .expect("valid");
        let coin = Coin::cylinder(0.7, 0.0116).expect("valid");
        let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid");
        let model = Model::new(&scene);
        for [x, y] in [
            [1.0, 0.0],
            [0.6, 0.8],
            [0.0, 1.0],
            [-1.0, 0.0],
            [-0.6, -0.8],
            [0.0, -1.0],
        ] {
            let touches = [
                touch(&model, [0.98, -0.18], [-0.0044, 0.0008]),
                touch(&model, [-0.58, -0.81], [-0.0006, -0.0008]),
            ];
            let mut motion = Motion {
                position: Vector3::zeros(),
                velocity: Vector3::new(x, y, 0.0),
                axis: Vector3::z(),
                spin: Vector3::zeros(),
            };
            let mut contacts = Contacts::new();
            contacts.gather(&model, &motion, touches.iter().copied());
            // frictionless impulses set the normal velocities
            let rates = [2e-5, -6e-5];
            for _ in 0..100 {
                for (contact, rate) in rates.iter().enumerate() {
                    let row = contact * ROWS + NORMAL;
                    contacts.offset[row] = contacts.before[row] - rate;
                    contacts.impulse[row] -= contacts.velocity(row) / contacts.response(row, row);
                }
            }
            contacts.apply(&mut motion);
            contacts.gather(&model, &motion, touches.iter().copied());
            collide(&model, &mut motion, &mut contacts, 4e-3);
            contacts.gather(&model, &motion, touches.iter().copied());
            for contact in 0..2 {
                let rate = contacts.before[contact * ROWS + NORMAL];
                assert!(rate > -1e-9, "{x} {y}: {rate}");
            }
        }
    }
}
