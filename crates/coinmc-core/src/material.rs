//! What coins land on: typical surfaces, each number with where it comes from.

use crate::schema::{Value, Values};

/// A typical surface under a coin of metal, such as a euro.
///
/// No series of measurements of coins on such surfaces is known, so every number is either taken from
/// the nearest one that was measured, or an estimate, and says which. Measure your own:
/// docs/guide/surfaces.md.
///
/// # Example
/// ```
/// use coinmc_core::Material;
/// let wood: Material = "wood".parse()?;
/// assert_eq!(wood.restitution.value, 0.5);
/// assert!(wood.roughness_slope.source.starts_with("estimate"));
/// assert!("marble".parse::<Material>().is_err());
/// # Ok::<(), coinmc_core::EngineError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Its name in configs.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Coefficient of restitution e.
    pub restitution: Sourced,
    /// Coefficient of friction μ.
    pub friction: Sourced,
    /// Rolling friction length ρ_c, m.
    pub rolling_friction_m: Sourced,
    /// Radius a of the contact patch, m, which gives the pivoting friction length (3π/16) μ a.
    pub contact_patch_m: Sourced,
    /// Root mean square slope of the ground.
    pub roughness_slope: Sourced,
    /// Wavelength of the ground, m.
    pub roughness_wavelength_m: Sourced,
}

/// A number and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sourced {
    /// The number, in SI units.
    pub value: f64,
    /// Its source, or "estimate" and what it rests on.
    pub source: &'static str,
}

/// A number with its source.
const fn of(value: f64, source: &'static str) -> Sourced {
    Sourced { value, source }
}

/// Dropped balls: the nearest to a coin of metal that was measured.
const BALLS: &str = "estimate, from steel balls (0.6) and glass marbles (0.66) dropped on a hard floor \
                     (The Physics Factbook)";
/// Kinetic friction of pairs of materials.
const HILL: &str = "kinetic, metal on wood (Hill, howwhy.com, Coefficients of Friction)";
/// Billiard balls on cloth.
const BILLIARDS: &str = "billiard ball (Alciatore, billiards.colostate.edu, Physical Properties)";
/// The waviness of table tops, of which no measurement at millimetres is known.
const GUESS: &str = "estimate";

/// The estimate of a Hertz patch, by [`hertz_radius_m`](crate::hertz_radius_m).
macro_rules! hertz {
    ($modulus:literal) => {
        concat!("estimate, Hertz: a euro with E* = ", $modulus)
    };
}

impl Material {
    /// All of them, from hard to soft.
    pub const ALL: [Self; 7] = [
        Self {
            name: "glass",
            doc: "a pane of float glass on a firm base",
            restitution: of(0.6, BALLS),
            friction: of(
                0.25,
                "glass on metal, not degreased, 0.2 to 0.3 (Engineering ToolBox, Friction Coefficients)",
            ),
            rolling_friction_m: of(
                4e-6,
                "steel disc of 75 mm on glass: ρ_c/R = 1e-4 (Thorne et al., arXiv 2603.14520, at second \
                 hand)",
            ),
            contact_patch_m: of(1.3e-5, hertz!("44 GPa")),
            roughness_slope: of(0.002, GUESS),
            roughness_wavelength_m: of(1e-2, GUESS),
        },
        Self {
            name: "steel",
            doc: "a ground plate of steel",
            restitution: of(0.6, BALLS),
            friction: of(
                0.3,
                "kinetic, steel on steel, dry (Hill, howwhy.com, Coefficients of Friction)",
            ),
            rolling_friction_m: of(
                1e-5,
                "estimate, above the least ρ_c/R of steel balls on hard surfaces, 1e-4 (Cross, Am. J. \
                 Phys. 84 (2016) 221)",
            ),
            contact_patch_m: of(1.0e-5, hertz!("92 GPa")),
            roughness_slope: of(0.005, GUESS),
            roughness_wavelength_m: of(2e-3, GUESS),
        },
        Self {
            name: "laminate",
            doc: "high-pressure laminate on chipboard: kitchen tops, desks, floors",
            restitution: of(0.5, GUESS),
            friction: of(0.25, GUESS),
            rolling_friction_m: of(3e-5, GUESS),
            contact_patch_m: of(2.2e-5, hertz!("9 GPa")),
            roughness_slope: of(0.01, GUESS),
            roughness_wavelength_m: of(3e-3, GUESS),
        },
        Self {
            name: "wood",
            doc: "a finished table top of solid wood",
            restitution: of(0.5, "estimate, the middle of 0.3 to 0.6"),
            friction: of(0.3, HILL),
            rolling_friction_m: of(
                5e-5,
                "estimate: a coin that whirrs for some seconds has ρ_c/R of about 0.003",
            ),
            contact_patch_m: of(4.7e-5, hertz!("1 GPa (across the grain)")),
            roughness_slope: of(
                0.05,
                "estimate: with it a nickel, H/R = 0.184, stands in about 1 of 300 tosses by hand, with 0.025 in 1 of 50",
            ),
            roughness_wavelength_m: of(3e-3, GUESS),
        },
        Self {
            name: "cloth",
            doc: "billiard cloth stretched over slate",
            restitution: of(0.5, BILLIARDS),
            friction: of(0.2, BILLIARDS),
            rolling_friction_m: of(
                2.9e-4,
                "billiard ball, 0.01 R with R = 28.6 mm (Alciatore, billiards.colostate.edu, Physical \
                 Properties)",
            ),
            contact_patch_m: of(
                2.8e-3,
                "billiard ball that slows its spin by 10 rad/s² (Alciatore, billiards.colostate.edu, \
                 Physical Properties): ρ_p = 0.33 mm",
            ),
            roughness_slope: of(0.02, GUESS),
            roughness_wavelength_m: of(1e-3, GUESS),
        },
        Self {
            name: "felt",
            doc: "loose felt, a few millimetres thick",
            restitution: of(0.2, GUESS),
            friction: of(0.4, GUESS),
            rolling_friction_m: of(1e-3, "estimate, above that of billiard cloth"),
            contact_patch_m: of(2e-3, "estimate, as billiard cloth"),
            roughness_slope: of(0.05, GUESS),
            roughness_wavelength_m: of(3e-3, GUESS),
        },
        Self {
            name: "carpet",
            doc: "a short-pile carpet on a hard floor",
            restitution: of(0.15, "estimate, below felt"),
            friction: of(0.5, GUESS),
            rolling_friction_m: of(2e-3, "estimate, twice that of felt"),
            contact_patch_m: of(4e-3, "estimate, twice that of felt"),
            roughness_slope: of(0.1, GUESS),
            roughness_wavelength_m: of(5e-3, GUESS),
        },
    ];

    /// Its numbers, by the keys of the table `[surface]`.
    pub fn numbers(&self) -> [(&'static str, Sourced); 6] {
        [
            ("restitution", self.restitution),
            ("friction", self.friction),
            ("rolling_friction_m", self.rolling_friction_m),
            ("contact_patch_m", self.contact_patch_m),
            ("roughness_slope", self.roughness_slope),
            ("roughness_wavelength_m", self.roughness_wavelength_m),
        ]
    }

    /// The values of the table `[surface]` that it stands for.
    pub fn values(&self) -> Values {
        let numbers = self.numbers().into_iter();
        let values = numbers.map(|(key, number)| (key, Value::Number(number.value)));
        Values::new(values.collect())
    }
}

impl std::str::FromStr for Material {
    type Err = crate::EngineError;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let mut all = Self::ALL.into_iter();
        all.find(|material| material.name == name).ok_or_else(|| {
            let known = Self::ALL.map(|material| material.name).join(", ");
            crate::EngineError::mismatch(format_args!(
                "there is no `material` called `{name}`: there are {known}"
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coin, Surface, hertz_radius_m, pivoting_friction_of_patch_m};

    /// With the keys that a config fills in by itself.
    fn surface(material: &Material) -> Surface {
        let mut entries: Vec<_> = material
            .values()
            .entries()
            .map(|(k, v)| (k, v.clone()))
            .collect();
        entries.push(("restitution_threshold_m_s", Value::Number(0.0)));
        entries.push(("landing", Value::Word("bouncing")));
        let euro = Coin::cylinder(0.2, 0.0116).unwrap();
        Surface::read(&Values::new(entries), &euro).unwrap()
    }

    #[test]
    fn every_material_is_a_surface_and_says_where_its_numbers_come_from() {
        for material in &Material::ALL {
            let surface = surface(material);
            let pivoting =
                pivoting_friction_of_patch_m(surface.friction(), material.contact_patch_m.value);
            assert_eq!(surface.pivoting_friction_m(), pivoting, "{}", material.name);
            assert!(surface.rolling_friction_m() > 0.0 && surface.roughness().is_some());
            for (key, number) in material.numbers() {
                let source = number.source;
                assert!(
                    source.starts_with("estimate") || source.contains(['(', ',']),
                    "{} {key}: {source}",
                    material.name
                );
            }
            assert_eq!(material.name.parse::<Material>().unwrap(), *material);
        }
    }

    #[test]
    fn the_patches_are_those_of_hertz() {
        let euro = |modulus| hertz_radius_m(7.5e-3 * 9.81, 11.6e-3, 0.3e-3, modulus);
        for (name, modulus) in [
            ("glass", 44e9),
            ("steel", 92e9),
            ("laminate", 9e9),
            ("wood", 1e9),
        ] {
            let material: Material = name.parse().unwrap();
            let off = material.contact_patch_m.value / euro(modulus) - 1.0;
            assert!(off.abs() < 0.05, "{name}: {off}");
        }
        // a ball that spins on cloth: ρ_p = k_t ω'/g, k_t = 2R²/5
        let cloth: Material = "cloth".parse().unwrap();
        let length = 0.4 * 28.6e-3 * 28.6e-3 * 10.0 / 9.81;
        let off = surface(&cloth).pivoting_friction_m() / length - 1.0;
        assert!(off.abs() < 0.02, "{off}");
    }
}
