//! The laws of impact against their definitions, at random contacts.

use coinmc_flat::{ChatterjeeRuina, ContactMatrix, ImpactLaw, Impulse, Moreau};
use coinmc_testkit::Dice;

/// A contact before its impact.
#[derive(Debug, Clone, Copy)]
struct Contact {
    matrix: ContactMatrix,
    ux: f64,
    uz: f64,
    e: f64,
    mu: f64,
}

impl Contact {
    fn random(seed: u64, trial: u64) -> Self {
        let mut dice = Dice::new(seed, trial);
        let delta = dice.between(-1.57, 1.57);
        let (sin, cos) = libm::sincos(delta);
        let matrix = ContactMatrix::new(sin, cos, dice.scale(1e-3, 1.0));
        let e = dice.pick(&[0.0, 0.0, 1.0, 0.5, 0.3, 0.9, 0.123]);
        let mu_range = dice.pick(&[(1e-3, 1e2), (0.1, 2.0)]);
        let mu = dice.scale(mu_range.0, mu_range.1) * dice.pick(&[0.0, 1.0, 1.0, 1.0, 1.0]);
        Self {
            matrix,
            ux: dice.pick(&[0.0, 1.0, 1.0, -1.0, -1.0]) * dice.scale(1e-3, 1e2),
            uz: -dice.scale(1e-3, 1e2),
            e,
            mu,
        }
    }

    fn impulse(&self, law: impl ImpactLaw) -> Impulse {
        law.impulse(self.matrix, self.ux, self.uz, self.e, self.mu)
    }

    /// u⁺ = u⁻ + K p
    fn after(&self, x: f64, z: f64) -> (f64, f64) {
        let m = self.matrix;
        (self.ux + m.xx * x + m.xz * z, self.uz + m.xz * x + m.zz * z)
    }

    /// The largest term in u⁺, the scale of its rounding.
    fn size(&self, p: &Impulse) -> f64 {
        let m = self.matrix;
        let terms = [
            self.ux,
            self.uz,
            m.xx * p.x,
            m.xz * p.z,
            m.xz * p.x,
            m.zz * p.z,
        ];
        terms
            .iter()
            .fold(0.0, |most: f64, term| most.max(term.abs()))
    }

    /// Energy gained, p·u⁻ + ½ p·K p.
    fn gain(&self, p: &Impulse) -> f64 {
        let m = self.matrix;
        let quadratic = m.xx * p.x * p.x + 2.0 * m.xz * p.x * p.z + m.zz * p.z * p.z;
        p.x * self.ux + p.z * self.uz + 0.5 * quadratic
    }

    fn mirrored(&self) -> Self {
        let matrix = ContactMatrix {
            xz: -self.matrix.xz,
            ..self.matrix
        };
        Self {
            matrix,
            ux: -self.ux,
            ..*self
        }
    }

    fn scaled(&self, factor: f64) -> Self {
        Self {
            ux: factor * self.ux,
            uz: factor * self.uz,
            ..*self
        }
    }
}

/// Checks what every law must obey. Rounding: 1e-12 of the largest term (about ten operations of
/// 1e-16, and a condition number of K of up to 1e3 in the impulse that stops the contact).
fn check_requirements(law: impl ImpactLaw) {
    let mut worst = [0.0_f64; 3];
    for trial in 0..200_000 {
        let contact = Contact::random(50, trial);
        let p = contact.impulse(law);
        let (ux, uz) = contact.after(p.x, p.z);
        let size = contact.size(&p);
        let normal = (uz + contact.e * contact.uz).abs() / size;
        let cone = (p.x.abs() - contact.mu * p.z) / (p.x.abs() + p.z);
        let gain = contact.gain(&p) / (size * (p.x.abs() + p.z));
        worst = [worst[0].max(normal), worst[1].max(cone), worst[2].max(gain)];
        assert!(p.z > 0.0, "{contact:?} {p:?}");
        assert!(normal <= 1e-12, "normal velocity {uz}: {contact:?} {p:?}");
        assert!(cone <= 1e-12, "outside the cone: {contact:?} {p:?}");
        assert!(gain <= 1e-13, "gains {gain}: {contact:?} {p:?}");
        if p.sticks {
            assert!(ux.abs() <= 1e-12 * size, "slips {ux}: {contact:?} {p:?}");
        }
        let mirrored = contact.mirrored().impulse(law);
        assert_eq!(
            (mirrored.x, mirrored.z, mirrored.sticks),
            (-p.x, p.z, p.sticks)
        );
        let scaled = contact.scaled(4.0).impulse(law);
        assert_eq!(
            (scaled.x, scaled.z, scaled.sticks),
            (4.0 * p.x, 4.0 * p.z, p.sticks)
        );
    }
    println!(
        "normal {:e}, cone {:e}, gain {:e}",
        worst[0], worst[1], worst[2]
    );
}

#[test]
fn moreau_meets_the_requirements_of_every_law() {
    check_requirements(Moreau);
}

#[test]
fn chatterjee_ruina_meets_the_requirements_of_every_law() {
    check_requirements(ChatterjeeRuina);
}

/// All solutions of Moreau's implicit law, by brute force: for the slip σ = |u_x⁺|/(μ p_z) >= 0,
/// p_x(σ + K_xx) + K_xz p_z = −u_x and K_xz p_x + K_zz p_z = −(1 + e)u_z. Solutions with |p_x| = μ
/// p_z slide; the one at σ = 0 sticks if it lies within the cone.
fn solutions(contact: &Contact) -> Vec<(f64, f64)> {
    const POINTS: u32 = 2000;
    let m = contact.matrix;
    let rebound = -(1.0 + contact.e) * contact.uz;
    let at = |sigma: f64| {
        let determinant = (sigma + m.xx) * m.zz - m.xz * m.xz;
        let x = (-contact.ux * m.zz - m.xz * rebound) / determinant;
        let z = ((sigma + m.xx) * rebound + m.xz * contact.ux) / determinant;
        (x, z)
    };
    let excess = |sigma: f64| {
        let (x, z) = at(sigma);
        x.abs() - contact.mu * z
    };
    let grid = |i: u32| libm::exp(-25.0 + 50.0 * f64::from(i) / f64::from(POINTS));
    let mut found = Vec::new();
    if excess(0.0) <= 0.0 {
        found.push(at(0.0));
    }
    for i in 0..POINTS {
        let (mut low, mut high) = (if i == 0 { 0.0 } else { grid(i) }, grid(i + 1));
        if (excess(low) > 0.0) != (excess(high) > 0.0) {
            for _ in 0..100 {
                let middle = f64::midpoint(low, high);
                if (excess(middle) > 0.0) == (excess(low) > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push(at(low));
        }
    }
    found.retain(|(_, z)| *z >= 0.0);
    found
}

/// Moreau's impulse is one of the solutions found by brute force and slides against its friction.
/// Chatterjee–Ruina replaces it only where no solution exists or one gains energy. The root is
/// found to 1e-15 of σ; 1e-9 leaves room for its condition. Contacts within 1e-6 of the cone's edge
/// or of zero gain, where both answers are correct, are excluded (1e-5 of them).
#[test]
fn moreau_solves_the_implicit_law() {
    let (mut slides, mut sticks, mut guarded) = (0, 0, 0);
    for trial in 0..20_000 {
        let contact = Contact::random(51, trial);
        if contact.mu == 0.0 {
            continue;
        }
        let p = contact.impulse(Moreau);
        let guard = contact.impulse(ChatterjeeRuina);
        let near = |(x, z): &(f64, f64)| {
            (x - p.x).abs() + (z - p.z).abs() <= 1e-9 * (p.x.abs() + p.z.abs())
        };
        let all = solutions(&contact);
        if all.iter().any(near) {
            let (ux, _) = contact.after(p.x, p.z);
            if p.sticks {
                sticks += 1;
            } else {
                slides += 1;
                assert!(
                    ux * p.x <= 0.0,
                    "friction drives the slip: {contact:?} {p:?}"
                );
                let edge = (p.x.abs() / (contact.mu * p.z) - 1.0).abs();
                assert!(edge < 1e-12, "slides inside the cone: {contact:?} {p:?}");
            }
            continue;
        }
        assert_eq!((p.x, p.z), (guard.x, guard.z), "{contact:?} {all:?}");
        guarded += 1;
        let scale = contact.uz * contact.uz + contact.ux * contact.ux;
        let gains = |(x, z): &(f64, f64)| {
            let sticks = false;
            contact.gain(&Impulse {
                x: *x,
                z: *z,
                sticks,
            }) > -1e-6 * scale
        };
        assert!(
            all.is_empty() || all.iter().any(gains),
            "{contact:?} {all:?}"
        );
    }
    println!("{slides} slide, {sticks} stick, {guarded} guarded");
    assert!(slides > 4000 && sticks > 2000 && guarded > 20);
}

/// Chatterjee & Ruina's energy balance: with p_I the frictionless plastic impulse, p_II the impulse
/// that stops the contact and κ the largest share in [0, 1] within the cone (here by bisection),
/// ΔE = −½(1 − e²) u_z²/K_zz − κ(1 − κ/2) |p_II − p_I|²_K.
#[test]
fn chatterjee_ruina_dissipates_the_derived_energy() {
    for trial in 0..50_000 {
        let contact = Contact::random(52, trial);
        let m = contact.matrix;
        let p = contact.impulse(ChatterjeeRuina);
        let determinant = m.xx * m.zz - m.xz * m.xz;
        let stop = (
            (-m.zz * contact.ux + m.xz * contact.uz) / determinant,
            (m.xz * contact.ux - m.xx * contact.uz) / determinant,
        );
        let smooth = -contact.uz / m.zz;
        let (dx, dz) = (stop.0, stop.1 - smooth);
        let base = (1.0 + contact.e) * smooth;
        let inside = |kappa: f64| (kappa * dx).abs() <= contact.mu * (base + kappa * dz);
        let (mut low, mut high) = (0.0, 1.0);
        if inside(1.0) {
            low = 1.0;
        } else {
            for _ in 0..200 {
                let middle = f64::midpoint(low, high);
                if inside(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
        }
        let kappa: f64 = low;
        let size = contact.size(&p);
        assert!(
            (p.x - kappa * dx).abs() <= 1e-11 * size,
            "{contact:?} {p:?}"
        );
        assert!(
            (p.z - base - kappa * dz).abs() <= 1e-11 * size,
            "{contact:?} {p:?}"
        );
        let square = m.xx * dx * dx + 2.0 * m.xz * dx * dz + m.zz * dz * dz;
        let lost = 0.5 * (1.0 - contact.e * contact.e) * contact.uz * contact.uz / m.zz
            + kappa * (1.0 - kappa / 2.0) * square;
        let error = (contact.gain(&p) + lost).abs();
        assert!(
            error <= 1e-11 * size * (p.x.abs() + p.z),
            "{error} {contact:?}"
        );
    }
}
