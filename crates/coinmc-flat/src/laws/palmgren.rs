//! Elastic line contact: force as a function of compression, and the lossless impact of a mass.
//!
//! Palmgren (1959), after Harris & Kotzalas, *Essential Concepts of Bearing Technology*, 5th ed.:
//! δ = 1.36 [(1 − ν₁²)/E₁ + (1 − ν₂²)/E₂]^0.9 Q^0.9/l^0.8 in mm, N and MPa, which for steel on
//! steel is 3.84e-5 Q^0.9/l^0.8. Hence Q = K δ^(10/9) with K = E* l^(8/9)/1.36^(10/9), 1/E* the
//! bracket. The exponents of length add up to 2, so the constant is the same in m, N and Pa.

use coinmc_core::schema::{Absent, Bounds, Field, OutOfRange, Values, default, number};
use coinmc_core::{EngineError, Scene};

/// n of Q = K δⁿ.
pub(crate) const EXPONENT: f64 = 10.0 / 9.0;
/// 1.36^(−10/9).
const FACTOR: f64 = 0.710_597_107_159_390_5;
/// 1/(n + 1).
const SHARE: f64 = 9.0 / 19.0;
/// 2√π Γ(1 + 1/(n + 1))/Γ(1/2 + 1/(n + 1)): duration of a lossless impact in units of δ_max/u.
const PULSE: f64 = 3.090_487_848_387_577_5;

/// The materials of coin and surface, and the length of their line of contact.
///
/// # Example
/// ```
/// use coinmc_flat::Materials;
/// let steel = Materials {
///     coin_young_pa: 206e9, coin_poisson: 0.3, surface_young_pa: 206e9, surface_poisson: 0.3,
///     length_m: 0.01,
/// };
/// // steel on steel: 3.84e-5·Q^0.9/l^0.8 in mm and N
/// let force_n = steel.stiffness() * 1e-6_f64.powf(10.0 / 9.0);
/// assert!((3.84e-5 * force_n.powf(0.9) / 10_f64.powf(0.8) - 1e-3).abs() < 5e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Materials {
    /// Young's modulus of the coin, Pa.
    pub coin_young_pa: f64,
    /// Poisson's ratio of the coin.
    pub coin_poisson: f64,
    /// Young's modulus of the surface, Pa.
    pub surface_young_pa: f64,
    /// Poisson's ratio of the surface.
    pub surface_poisson: f64,
    /// Length of the line of contact, m.
    pub length_m: f64,
}

impl Materials {
    /// K of Q = K δ^(10/9), N/m^(10/9).
    pub fn stiffness(&self) -> f64 {
        let compliance_of = |young: f64, poisson: f64| (1.0 - poisson * poisson) / young;
        let compliance = compliance_of(self.coin_young_pa, self.coin_poisson)
            + compliance_of(self.surface_young_pa, self.surface_poisson);
        FACTOR / compliance * libm::pow(self.length_m, 8.0 / 9.0)
    }

    /// The keys of a table of materials.
    pub(crate) fn parameters() -> Vec<Field> {
        vec![
            number(
                "coin_young_pa",
                "Young's modulus of the coin, Pa.",
                YOUNG_PA,
                Absent::Required,
            ),
            number(
                "coin_poisson",
                "Poisson's ratio of the coin.",
                POISSON,
                default(0.3),
            ),
            number(
                "surface_young_pa",
                "Young's modulus of the surface, Pa.",
                YOUNG_PA,
                Absent::Required,
            ),
            number(
                "surface_poisson",
                "Poisson's ratio of the surface.",
                POISSON,
                default(0.3),
            ),
            number(
                "length_m",
                "Length of the line of contact, m.",
                LENGTH_M,
                Absent::Required,
            ),
        ]
    }

    /// The materials that the values of such a table give.
    pub(crate) fn read(values: &Values) -> Result<Self, EngineError> {
        Ok(Self {
            coin_young_pa: values.number("coin_young_pa")?,
            coin_poisson: values.number("coin_poisson")?,
            surface_young_pa: values.number("surface_young_pa")?,
            surface_poisson: values.number("surface_poisson")?,
            length_m: values.number("length_m")?,
        })
    }

    pub(crate) fn validate(&self) -> Result<(), OutOfRange> {
        YOUNG_PA.check("coin_young_pa", self.coin_young_pa)?;
        POISSON.check("coin_poisson", self.coin_poisson)?;
        YOUNG_PA.check("surface_young_pa", self.surface_young_pa)?;
        POISSON.check("surface_poisson", self.surface_poisson)?;
        LENGTH_M.check("length_m", self.length_m)
    }
}

/// Far beyond any material: studies make the contact ever stiffer.
const YOUNG_PA: Bounds = Bounds::closed(1e3, 1e30);
const POISSON: Bounds = Bounds::closed(-0.99, 0.5);
const LENGTH_M: Bounds = Bounds::closed(1e-9, 1e6);

/// K in units of m g/D^(10/9).
pub(crate) fn scene_stiffness(scene: &Scene, materials: &Materials) -> f64 {
    let weight = scene.coin.mass_kg() * scene.gravity_m_s2();
    materials.stiffness() * libm::pow(scene.coin.rim_distance_m(), EXPONENT) / weight
}

/// δ^(10/9), 0 for δ <= 0. Two cube roots are faster than a power.
#[inline]
pub(crate) fn power(compression: f64) -> f64 {
    let depth = compression.max(0.0);
    depth * ninth_root(depth)
}

/// δ^(1/9).
#[inline]
pub(crate) fn ninth_root(depth: f64) -> f64 {
    libm::cbrt(libm::cbrt(depth))
}

/// The greatest compression when a mass meets a contact of this stiffness at `speed`, without
/// losses.
pub(crate) fn max_compression(stiffness: f64, mass: f64, speed: f64) -> f64 {
    libm::pow(
        0.5 * (EXPONENT + 1.0) * mass * speed * speed / stiffness,
        SHARE,
    )
}

/// The duration of that impact.
pub(crate) fn duration(stiffness: f64, mass: f64, speed: f64) -> f64 {
    PULSE * max_compression(stiffness, mass, speed) / speed
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::schema::Value;

    #[test]
    fn constants_match_their_formulas() {
        assert!((FACTOR - libm::pow(1.36, -EXPONENT)).abs() < 1e-15);
        let gammas = libm::tgamma(1.0 + SHARE) / libm::tgamma(0.5 + SHARE);
        let pulse = 2.0 * std::f64::consts::PI.sqrt() * gammas;
        assert!((PULSE - pulse).abs() < 1e-13, "{pulse:.17}");
    }

    /// Harris & Kotzalas's constant for steel on steel has three digits: 3.84e-5 ± 0.3 %.
    #[test]
    fn steel_on_steel_matches_the_handbook() {
        let steel = Materials {
            coin_young_pa: 206e9,
            coin_poisson: 0.3,
            surface_young_pa: 206e9,
            surface_poisson: 0.3,
            length_m: 0.02,
        };
        for force in [1.0, 100.0, 1e4] {
            let compression = libm::pow(force / steel.stiffness(), 0.9);
            let handbook = 3.84e-5 * libm::pow(force, 0.9) / libm::pow(20.0, 0.8);
            assert!((compression * 1e3 / handbook - 1.0).abs() < 3e-3);
        }
    }

    /// Compared with the quadrature of dt = dδ/u sqrt(1 − (δ/δ_max)^(n+1)), substituted δ = δ_max
    /// (1 − y²).
    #[test]
    fn duration_matches_its_quadrature() {
        let (stiffness, mass, speed) = (3.0e7, 0.4, 1.7);
        let steps = 20_000;
        let integrand = |y: f64| {
            let depth = 1.0 - y * y;
            2.0 * y / (1.0 - depth * ninth_root(depth) * depth).sqrt()
        };
        let width = 1.0 / f64::from(steps);
        let middle = |i: i32| (f64::from(i) + 0.5) * width;
        let sum: f64 = (0..steps).map(|i| integrand(middle(i)) * width).sum();
        let expected = 2.0 * max_compression(stiffness, mass, speed) / speed * sum;
        let found = duration(stiffness, mass, speed);
        assert!((found / expected - 1.0).abs() < 1e-6);
    }

    /// At the greatest compression all of the energy is stored: K δ^(n + 1)/(n + 1) = m v²/2.
    #[test]
    fn the_greatest_compression_stores_the_energy() {
        for (stiffness, mass, speed) in [(3.0e7, 0.4, 1.7), (1e5, 2.0, 0.3)] {
            let depth = max_compression(stiffness, mass, speed);
            let stored = stiffness * libm::pow(depth, EXPONENT + 1.0) / (EXPONENT + 1.0);
            assert!((stored / (0.5 * mass * speed * speed) - 1.0).abs() < 1e-13);
        }
    }

    /// A table of materials may hold just the keys that are read, and those without a default must be there.
    #[test]
    fn the_keys_of_materials_are_those_that_are_read() {
        let steel = Materials {
            coin_young_pa: 206e9,
            coin_poisson: 0.29,
            surface_young_pa: 207e9,
            surface_poisson: 0.31,
            length_m: 0.02,
        };
        let entries = Materials::parameters().into_iter().map(|field| {
            let value = match field.name {
                "coin_young_pa" => steel.coin_young_pa,
                "coin_poisson" => steel.coin_poisson,
                "surface_young_pa" => steel.surface_young_pa,
                "surface_poisson" => steel.surface_poisson,
                "length_m" => steel.length_m,
                other => panic!("nobody reads {other}"),
            };
            (field.name, Value::Number(value))
        });
        let values = Values::new(entries.collect());
        assert_eq!(Materials::read(&values).expect("all are there"), steel);
    }
}
