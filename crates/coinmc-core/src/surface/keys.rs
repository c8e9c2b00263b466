//! The keys of the table `[surface]` of a config.

use super::{DEFAULT_REFERENCE_M_S, Landing, Surface};
use crate::contact_patch::{ESTIMATED_RADIUS_M, ESTIMATED_ROLLING_M, pivoting_friction_of_patch_m};
use crate::schema::{
    Absent, Bounds, Condition, Fallback, Field, Kind, ReadError, Rule, TableKind, Value, Values,
    Word, choice, default, field, number,
};
use crate::{Coin, EngineError, Material, Roughness, SurfaceError, TableTilt};

/// Lengths and speeds: typing errors end here.
const LARGE: Bounds = Bounds::closed(0.0, 1e6);
/// Friction lengths over R.
const FRACTION: Bounds = Bounds::closed(0.0, 1e6);
const WAVELENGTH: &str = "roughness_wavelength_m";
const TABLE_RADIUS: &str = "table_radius_m";
const TILT: &str = "table_tilt_deg";
const DOWNHILL: &str = "table_downhill_deg";
const ROLLING_OVER_RADIUS: &str = "rolling_friction_over_radius";
const PIVOTING_OVER_RADIUS: &str = "pivoting_friction_over_radius";

const FIRST_CONTACT_DECIDES: Condition = Condition::Word("landing", Landing::Adhesive.name());
const OF_A_MATERIAL: Condition = Condition::Given("material");

impl Surface {
    /// Keys of configs that say the same: of each list, a config has one at most.
    pub const ALTERNATIVES: [&'static [&'static str]; 2] = [
        &["rolling_friction_m", ROLLING_OVER_RADIUS],
        &[
            "pivoting_friction_m",
            PIVOTING_OVER_RADIUS,
            "contact_patch_m",
        ],
    ];

    /// The keys of the table `[surface]` of a config.
    pub fn schema() -> TableKind {
        let mut fields = vec![material()];
        fields.extend(friction());
        fields.extend(restitution_by_speed());
        fields.extend(ground());
        fields.push(table_radius());
        fields.extend(table_tilt());
        fields.push(choice(
            "landing",
            "What a contact does.",
            Landing::ALL.map(|landing| (landing.name(), landing.doc())),
            Landing::default().name(),
        ));
        TableKind {
            fields,
            rules: vec![
                Rule::Unless {
                    condition: Condition::Either(&[FIRST_CONTACT_DECIDES, OF_A_MATERIAL]),
                    keys: &["restitution", "friction"],
                    fallback: None,
                },
                Rule::NotBoth(["rolling_friction_m", ROLLING_OVER_RADIUS]),
                Rule::NotBoth(["pivoting_friction_m", "contact_patch_m"]),
                Rule::NotBoth(["pivoting_friction_m", PIVOTING_OVER_RADIUS]),
                Rule::NotBoth([PIVOTING_OVER_RADIUS, "contact_patch_m"]),
                Rule::GoesWith {
                    key: "restitution_reference_m_s",
                    others: &["restitution_exponent"],
                    fallback: Some(Fallback::Number(DEFAULT_REFERENCE_M_S)),
                },
                Rule::GoesWith {
                    key: DOWNHILL,
                    others: &[TILT],
                    fallback: Some(Fallback::Number(0.0)),
                },
                Rule::Together {
                    keys: ["roughness_slope", WAVELENGTH],
                    unless: OF_A_MATERIAL,
                },
            ],
        }
    }

    /// What a surface in space has where neither the config nor a material says it: friction lengths
    /// without which nothing would stop a coin that rolls or spins.
    ///
    /// # Example
    /// ```
    /// let estimates = coinmc_core::Surface::estimates();
    /// assert_eq!(estimates.number("rolling_friction_m")?, 5e-5);
    /// # Ok::<(), coinmc_core::EngineError>(())
    /// ```
    pub fn estimates() -> Values {
        Values::new(vec![
            ("rolling_friction_m", Value::Number(ESTIMATED_ROLLING_M)),
            ("contact_patch_m", Value::Number(ESTIMATED_RADIUS_M)),
        ])
    }

    /// The surface that a config gives for a coin, its material spelled out. Friction lengths that are
    /// absent are 0.
    ///
    /// # Errors
    /// [`ReadError`] where [`SurfaceError`](crate::SurfaceError) applies.
    pub fn read(values: &Values, coin: &Coin) -> Result<Self, ReadError> {
        let number = |key| values.number(key);
        let or = |key, fallback| Ok::<_, ReadError>(values.optional(key)?.unwrap_or(fallback));
        let landing = values.one_of("landing", Landing::ALL, Landing::name)?;
        let of_radius = |key| {
            let fraction = values.optional(key)?;
            Ok::<_, ReadError>(fraction.map(|fraction| fraction * coin.radius_m()))
        };
        let rolling = match of_radius(ROLLING_OVER_RADIUS)? {
            Some(rolling) => rolling,
            None => or("rolling_friction_m", 0.0)?,
        };
        let pivoting = match of_radius(PIVOTING_OVER_RADIUS)? {
            Some(pivoting) => pivoting,
            None => pivoting_friction(values)?,
        };
        let threshold = number("restitution_threshold_m_s")?;
        let exponent = or("restitution_exponent", 0.0)?;
        let reference = or("restitution_reference_m_s", DEFAULT_REFERENCE_M_S)?;
        let roughness = roughness(values, coin)?;
        let table_radius = values.optional(TABLE_RADIUS)?;
        let tilt = TableTilt::new(or(TILT, 0.0)?, or(DOWNHILL, 0.0)?)
            .map_err(|error| ReadError::new(error.to_string()).at(TILT))?;
        Self::new(number("restitution")?, number("friction")?)
            .and_then(|surface| surface.with_friction_lengths(rolling, pivoting))
            .and_then(|surface| surface.with_restitution_threshold(threshold))
            .and_then(|surface| surface.with_speed_dependent_restitution(exponent, reference))
            .and_then(|surface| surface.with_roughness(roughness).with_landing(landing))
            .and_then(|surface| match table_radius {
                Some(radius_m) => surface.with_table_radius(radius_m),
                None => Ok(surface),
            })
            .map_err(|error| ReadError::new(error.to_string()))?
            .with_tilt(tilt)
            .map_err(|error| ReadError::new(error.to_string()).at(TILT))?
            .for_coin(coin)
    }

    /// The surface, if the coin is modelled on it.
    fn for_coin(self, coin: &Coin) -> Result<Self, ReadError> {
        let Some((key, error)) = self.unfit_for(coin) else {
            return Ok(self);
        };
        Err(ReadError::new(error.to_string()).at(key))
    }

    /// What of this surface is not modelled with this coin: the key of a config, and why.
    pub(crate) fn unfit_for(&self, coin: &Coin) -> Option<(&'static str, SurfaceError)> {
        if coin.has_like_faces() {
            return None;
        }
        let grounds = [
            (
                self.roughness().is_some(),
                "roughness_slope",
                [
                    "on rough ground: `coin.draft_deg` or `surface.roughness_slope` must be 0",
                    "on rough ground: `coin.centre_of_mass_over_height` or `surface.roughness_slope` must be 0",
                ],
            ),
            (
                self.table_radius_m().is_some(),
                TABLE_RADIUS,
                [
                    "on a table with an edge: `coin.draft_deg` must be 0 or `surface.table_radius_m` absent",
                    "on a table with an edge: `coin.centre_of_mass_over_height` must be 0 or \
                     `surface.table_radius_m` absent",
                ],
            ),
            (
                self.tilt().is_some(),
                TILT,
                [
                    "on a tilted table: `coin.draft_deg` or `surface.table_tilt_deg` must be 0",
                    "on a tilted table: `coin.centre_of_mass_over_height` or `surface.table_tilt_deg` must be 0",
                ],
            ),
        ];
        let (_, key, [conical, loaded]) = grounds.into_iter().find(|(is_so, ..)| *is_so)?;
        let error = if coin.is_conical() {
            SurfaceError::Conical(conical)
        } else {
            SurfaceError::Loaded(loaded)
        };
        Some((key, error))
    }
}

fn material() -> Field {
    let words = Material::ALL.map(|material| Word {
        name: material.name,
        doc: material.doc,
    });
    field(
        "material",
        "A typical surface: it gives every number below that is not given here.",
        Kind::Word(words.to_vec()),
        Absent::Omitted,
    )
}

/// Restitution, friction and the friction lengths.
fn friction() -> [Field; 8] {
    [
        number(
            "restitution",
            "Coefficient of restitution e at the contact point.",
            Bounds::closed(0.0, 1.0),
            Absent::Omitted,
        ),
        number(
            "friction",
            "Coefficient of friction μ.",
            LARGE,
            Absent::Omitted,
        ),
        number(
            "rolling_friction_m",
            "Rolling (contour) friction length ρ_c, m: the power lost is normal force × this × rate at \
             which the contact point moves along the rim. Coins on hard surfaces: about 0.001 to 0.01 R. \
             In space 5e-5 if absent, an estimate; 0 lets a coin roll for ever.",
            LARGE,
            Absent::Omitted,
        ),
        number(
            ROLLING_OVER_RADIUS,
            "The same as a fraction of R, instead of `rolling_friction_m`.",
            FRACTION,
            Absent::Omitted,
        ),
        number(
            "pivoting_friction_m",
            "Pivoting friction length ρ_p, m: the power lost is normal force × this × rate at which the \
             coin turns about the vertical. In space that of the contact patch if absent.",
            LARGE,
            Absent::Omitted,
        ),
        number(
            PIVOTING_OVER_RADIUS,
            "The same as a fraction of R, instead of `pivoting_friction_m`.",
            FRACTION,
            Absent::Omitted,
        ),
        number(
            "contact_patch_m",
            "Radius a of the contact patch, m, instead of `pivoting_friction_m`: ρ_p = (3π/16) μ a. In \
             space 3e-5 if both are absent, an estimate.",
            LARGE,
            Absent::Omitted,
        ),
        number(
            "restitution_threshold_m_s",
            "Speed of approach, m/s, below which a contact point does not bounce (restitution 0), as in \
             game engines; nature has none.",
            LARGE,
            default(0.0),
        ),
    ]
}

fn restitution_by_speed() -> [Field; 2] {
    [
        number(
            "restitution_exponent",
            "Exponent p with which restitution falls with the speed of approach v: e min(1, (v/v_ref)^-p). \
             Plastic impacts of metal: 0.25; 0: the same at every speed.",
            Bounds::closed(0.0, 1.0),
            Absent::Omitted,
        ),
        number(
            "restitution_reference_m_s",
            "Speed of approach v_ref, m/s, up to which the coefficient of restitution is `restitution` (1 \
             if absent).",
            Bounds::above_zero(1e6),
            Absent::Omitted,
        ),
    ]
}

fn ground() -> [Field; 2] {
    [
        number(
            "roughness_slope",
            "Root mean square slope of the ground along any direction; 0: a plane.",
            Bounds::closed(0.0, Roughness::MAX_SLOPE),
            Absent::Omitted,
        ),
        number(
            WAVELENGTH,
            "Mean distance, m, between points where a profile of the ground crosses its mean upwards: 2π × \
             root mean square height / root mean square slope.",
            Bounds::above_zero(1e6),
            Absent::Omitted,
        ),
    ]
}

fn table_radius() -> Field {
    number(
        TABLE_RADIUS,
        "Radius of a round table, m, above whose middle the coin is launched. A coin whose centre \
         passes the edge has left the table, an outcome of its own. Absent: the table is endless.",
        Bounds::above_zero(1e6),
        Absent::Omitted,
    )
}

fn table_tilt() -> [Field; 2] {
    [
        number(
            TILT,
            "Angle of the table to the horizontal, degrees; its tangent must be below `friction`. The coin \
             is launched straight above the middle of the table. In space only.",
            Bounds::closed(0.0, TableTilt::MAX_DEG),
            Absent::Omitted,
        ),
        number(
            DOWNHILL,
            "Direction in which a tilted table descends, degrees from the x axis towards the y axis (0 if \
             absent).",
            Bounds::closed(-360.0, 360.0),
            Absent::Omitted,
        ),
    ]
}

/// The pivoting friction length as given, or that of the contact patch.
fn pivoting_friction(values: &Values) -> Result<f64, EngineError> {
    let patch_m = values.optional("contact_patch_m")?.unwrap_or(0.0);
    let of_patch = pivoting_friction_of_patch_m(values.number("friction")?, patch_m);
    Ok(values.optional("pivoting_friction_m")?.unwrap_or(of_patch))
}

/// The roughness that a config gives for a coin.
fn roughness(values: &Values, coin: &Coin) -> Result<Option<Roughness>, ReadError> {
    let (Some(slope), Some(wavelength)) = (
        values.optional("roughness_slope")?,
        values.optional(WAVELENGTH)?,
    ) else {
        return Ok(None);
    };
    let roughness = Roughness::new(slope, wavelength);
    roughness
        .and_then(|roughness| roughness.check_for(coin).map(|()| Some(roughness)))
        .map_err(|error| ReadError::new(error.to_string()).at(WAVELENGTH))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Scene, hertz_radius_m};

    /// What a config says, with the keys that it fills in by itself.
    fn read(keys: &[(&'static str, f64)], coin: &Coin) -> Result<Surface, ReadError> {
        let given = [
            ("restitution", 0.5),
            ("friction", 0.3),
            ("restitution_threshold_m_s", 0.0),
        ];
        let numbers = given.iter().chain(keys);
        let mut entries: Vec<_> = numbers
            .map(|(key, number)| (*key, Value::Number(*number)))
            .collect();
        entries.push(("landing", Value::Word("bouncing")));
        Surface::read(&Values::new(entries), coin)
    }

    #[test]
    fn friction_lengths_over_the_radius_are_those_lengths() {
        for radius_m in [0.01, 0.25, 3.0] {
            let coin = Coin::cylinder(0.2, radius_m).expect("a good coin");
            let over = [(ROLLING_OVER_RADIUS, 0.004), (PIVOTING_OVER_RADIUS, 0.03)];
            let lengths = [
                ("rolling_friction_m", 0.004 * radius_m),
                ("pivoting_friction_m", 0.03 * radius_m),
            ];
            assert_eq!(read(&over, &coin), read(&lengths, &coin));
            let surface = read(&over, &coin).expect("a surface");
            assert_eq!(surface.rolling_friction_m(), 0.004 * radius_m);
            assert_eq!(surface.pivoting_friction_m(), 0.03 * radius_m);
        }
    }

    /// Estimates are for a coin like a euro on a surface between glass and wood: a rolling friction length of
    /// 0.001 to 0.01 R, and the contact patch of Hertz with E* of 44 GPa to 1 GPa.
    #[test]
    fn estimates_are_those_of_a_euro_on_something_hard() {
        let estimates = Surface::estimates();
        let number = |key| estimates.number(key).expect("an estimate");
        let over_radius = number("rolling_friction_m") / 11.6e-3;
        assert!((0.001..0.01).contains(&over_radius), "{over_radius}");
        let patch_on = |modulus| hertz_radius_m(7.5e-3 * 9.81, 11.6e-3, 0.3e-3, modulus);
        let patch = number("contact_patch_m");
        assert!(patch_on(44e9) < patch && patch < patch_on(1e9), "{patch}");
    }

    /// Numbers of a ground on which coins whose faces are not alike are not modelled, with the key at fault.
    const GROUNDS: [&[(&str, f64)]; 3] = [
        &[("roughness_slope", 0.05), (WAVELENGTH, 2e-3)],
        &[(TABLE_RADIUS, 0.2)],
        &[(TILT, 3.0)],
    ];

    #[test]
    fn a_coin_of_unlike_faces_lies_on_an_endless_level_plane_only() {
        let cylinder = Coin::cylinder(0.8, 0.01).expect("a good coin");
        let conical = cylinder.with_draft(5.0).expect("a conical coin");
        let loaded = cylinder
            .with_centre_of_mass(0.1, None, None)
            .expect("a loaded coin");
        for coin in [conical, loaded] {
            assert!(read(&[], &coin).is_ok());
            for keys in GROUNDS {
                let error = read(keys, &coin).expect_err("not modelled");
                assert_eq!(error.path().collect::<Vec<_>>(), [keys[0].0]);
                // nor is a scene of both, however it came about
                let ground = read(keys, &cylinder).expect("a ground for cylinders");
                let refused = match Scene::new(coin, ground, 9.81) {
                    Err(SurfaceError::Conical(_)) => coin.is_conical(),
                    Err(SurfaceError::Loaded(_)) => !coin.is_conical(),
                    _ => false,
                };
                assert!(refused, "{keys:?}");
                assert!(Scene::new(cylinder, ground, 9.81).is_ok());
            }
        }
    }

    /// A full turn either way.
    #[test]
    fn a_table_descends_in_any_direction() {
        let schema = Surface::schema();
        let field = schema.field(DOWNHILL).expect("a key");
        let Kind::Number(bounds) = field.kind else {
            panic!("a direction is a number")
        };
        assert!(
            [-360.0, -90.0, 0.0, 90.0, 360.0]
                .iter()
                .all(|turn| bounds.contains(*turn))
        );
        assert!(!bounds.contains(-361.0) && !bounds.contains(361.0));
        let coin = Coin::cylinder(0.2, 0.01).expect("a good coin");
        let downhill = |deg| {
            let table = read(&[(TILT, 3.0), (DOWNHILL, deg)], &coin).expect("a table");
            table.tilt().expect("a tilted one").downhill()
        };
        let [one, other] = [-90.0, 270.0].map(downhill);
        // an angle in radians up to 5 is rounded by 4e-16
        assert!(
            (0..2).all(|i| (one[i] - other[i]).abs() < 2e-15),
            "{one:?} {other:?}"
        );
    }

    #[test]
    fn each_word_of_a_surface_has_a_meaning_of_its_own() {
        for field in Surface::schema().fields {
            let Kind::Word(words) = field.kind else {
                continue;
            };
            let mut meanings: Vec<_> = words.iter().map(|word| word.doc).collect();
            assert!(meanings.iter().all(|meaning| !meaning.is_empty()));
            meanings.sort_unstable();
            meanings.dedup();
            assert_eq!(meanings.len(), words.len(), "{}", field.name);
        }
    }
}
