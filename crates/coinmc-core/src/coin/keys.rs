//! The keys of the table `[coin]` of a config.

use super::{Coin, CoinError};
use crate::schema::{
    Absent, Bounds, Condition, Field, ReadError, Rule, TableKind, Values, default, number,
};

/// Lengths: typing errors end here.
const LENGTH: Bounds = Bounds::closed(1e-9, 1e6);
/// The same in mm.
const MILLIMETRES: Bounds = Bounds::closed(1e-6, 1e9);
const DRAFT: &str = "draft_deg";
const CENTRE: &str = "centre_of_mass_over_height";
const BY_HEIGHT: Condition = Condition::Either(&[
    Condition::Given("height_m"),
    Condition::Given("height_mm"),
    Condition::Given("thickness_m"),
    Condition::Given("thickness_mm"),
]);

impl CoinError {
    /// The key of a config that gives the quantity.
    fn key(&self) -> &'static str {
        match self {
            Self::Ratio(_) => "ratio",
            Self::Radius(_) => "radius_m",
            Self::Mass(_) => "mass_kg",
            Self::RimRadius { .. } => "rim_radius_m",
            Self::Draft { .. } | Self::RoundedDraft => DRAFT,
            Self::Centre(_) | Self::LoadedShape | Self::LoadedMoment(_) => CENTRE,
            Self::AxialMoment { .. } => "axial_moment_kg_m2",
            Self::TransverseMoment { .. } => "transverse_moment_kg_m2",
        }
    }
}

impl Coin {
    /// Radius where a config gives none, m.
    pub const DEFAULT_RADIUS_M: f64 = 0.01;
    /// Limits of H/R in configs.
    pub const RATIO: Bounds = Bounds::closed(1e-12, 1e12);
    /// Keys that give the height, H, of which a config has one at most and then no `ratio`; and how
    /// many metres their unit has.
    pub const HEIGHTS: [(&'static str, f64); 4] = [
        ("height_m", 1.0),
        ("height_mm", 1e-3),
        ("thickness_m", 1.0),
        ("thickness_mm", 1e-3),
    ];
    /// Keys that give the radius, R, of which a config has one at most; and R in metres for 1.
    pub const RADII: [(&'static str, f64); 4] = [
        ("radius_m", 1.0),
        ("radius_mm", 1e-3),
        ("diameter_m", 0.5),
        ("diameter_mm", 5e-4),
    ];

    /// The keys of the table `[coin]` of a config. Of its lengths a config as understood has `ratio`
    /// and `radius_m` only.
    pub fn schema() -> TableKind {
        let mut fields = shape();
        fields.extend(matter());
        let mut rules = vec![Rule::Unless {
            condition: BY_HEIGHT,
            keys: &["ratio"],
            fallback: None,
        }];
        rules.extend(EXCLUSIVE.map(Rule::NotBoth));
        TableKind { fields, rules }
    }

    /// The coin that a config gives.
    ///
    /// # Errors
    /// [`ReadError`] where [`CoinError`] applies; it blames the key of the quantity.
    pub fn read(values: &Values) -> Result<Self, ReadError> {
        let axial = values.optional("axial_moment_kg_m2")?;
        let transverse = values.optional("transverse_moment_kg_m2")?;
        let blame = |error: CoinError| {
            // a given axial moment alone can rule out the uniform cylinder's transverse one
            let key = match error {
                CoinError::TransverseMoment { .. } if transverse.is_none() => "axial_moment_kg_m2",
                error => error.key(),
            };
            ReadError::new(error.to_string()).at(key)
        };
        let coin = Self::cylinder(values.number("ratio")?, values.number("radius_m")?)
            .map_err(blame)?
            .with_mass(values.number("mass_kg")?)
            .map_err(blame)?
            .with_rim_radius(values.optional("rim_radius_m")?.unwrap_or(0.0))
            .map_err(blame)?
            .with_draft(values.optional(DRAFT)?.unwrap_or(0.0))
            .map_err(blame)?;
        let centre = values.optional(CENTRE)?.unwrap_or(0.0);
        coin.with_centre_of_mass(centre, axial, transverse)
            .map_err(blame)
    }
}

/// Pairs of keys that say the same.
const EXCLUSIVE: [[&str; 2]; 16] = [
    ["ratio", "height_m"],
    ["ratio", "height_mm"],
    ["ratio", "thickness_m"],
    ["ratio", "thickness_mm"],
    ["height_m", "height_mm"],
    ["height_m", "thickness_m"],
    ["height_m", "thickness_mm"],
    ["height_mm", "thickness_m"],
    ["height_mm", "thickness_mm"],
    ["thickness_m", "thickness_mm"],
    ["radius_m", "radius_mm"],
    ["radius_m", "diameter_m"],
    ["radius_m", "diameter_mm"],
    ["radius_mm", "diameter_m"],
    ["radius_mm", "diameter_mm"],
    ["diameter_m", "diameter_mm"],
];

fn shape() -> Vec<Field> {
    let length = |name, doc, bounds| number(name, doc, bounds, Absent::Omitted);
    vec![
        length("ratio", "Height over radius, H/R.", Coin::RATIO),
        length(
            "height_m",
            "Height (thickness) H, m, instead of `ratio`: a number, or swept with one radius.",
            LENGTH,
        ),
        length("height_mm", "The same in mm.", MILLIMETRES),
        length("thickness_m", "The same as `height_m`.", LENGTH),
        length("thickness_mm", "The same as `height_mm`.", MILLIMETRES),
        length(
            "radius_m",
            "Radius R, m; 0.01 if no radius or diameter is given.",
            LENGTH,
        ),
        length("radius_mm", "The same in mm.", MILLIMETRES),
        length(
            "diameter_m",
            "Diameter 2R, m, instead of the radius.",
            LENGTH,
        ),
        length("diameter_mm", "The same in mm.", MILLIMETRES),
    ]
}

fn matter() -> Vec<Field> {
    let moment = Bounds::open(0.0, 1e30);
    vec![
        number(
            "mass_kg",
            "Mass, kg. It cancels everywhere but in given moments of inertia and in laws of impact \
                 that name forces or stiffness.",
            Bounds::closed(1e-12, 1e12),
            default(0.01),
        ),
        number(
            "rim_radius_m",
            "Radius r of the rounding of both rims, m, below R and H/2: the coin is a smaller cylinder \
                 with a layer of thickness r all around. 0, or absent: sharp edges.",
            Bounds::closed(0.0, 1e6),
            Absent::Omitted,
        ),
        number(
            DRAFT,
            "Angle of the edge with the axis, degrees, of a coin with a conical edge (draft). R is then the \
             radius of the wider face: of heads if above 0, of tails if below. 0, or absent: a cylinder.",
            Coin::DRAFT_DEG,
            Absent::Omitted,
        ),
        number(
            CENTRE,
            "Distance of the centre of mass from the middle, on the axis, over H, of a loaded cylinder: above 0 \
             nearer to heads, below 0 nearer to tails. Without a given transverse moment the coin is of two \
             uniform layers: at most 0.25 either way. 0, or absent: the middle.",
            Coin::CENTRE_OVER_HEIGHT,
            Absent::Omitted,
        ),
        number(
            "axial_moment_kg_m2",
            "Moment of inertia about the coin's axis, kg m², of a hollow or loaded coin; a uniform \
                 cylinder's if absent.",
            moment,
            Absent::Omitted,
        ),
        number(
            "transverse_moment_kg_m2",
            "Moment of inertia about a diameter through the centre of mass, kg m²; a uniform cylinder's if \
                 absent.",
            moment,
            Absent::Omitted,
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::Value;

    /// A coin of 10 g with H/R = 1.2 and R = 10 mm, or what `others` say.
    fn read(others: &[(&'static str, f64)]) -> Result<Coin, ReadError> {
        let usual = [("ratio", 1.2), ("radius_m", 0.01), ("mass_kg", 0.01)];
        let is_usual = |key: &str| others.iter().all(|(other, _)| *other != key);
        let usual = usual.into_iter().filter(|(key, _)| is_usual(key));
        let entries = usual.chain(others.iter().copied());
        let entries = entries.map(|(key, value)| (key, Value::Number(value)));
        Coin::read(&Values::new(entries.collect()))
    }

    #[test]
    fn a_config_says_the_coin() {
        let plain = Coin::cylinder(1.2, 0.01).expect("a good coin");
        assert_eq!(read(&[]).ok(), Some(plain));
        let heavy = plain.with_mass(0.02);
        assert_eq!(read(&[("mass_kg", 0.02)]).ok(), heavy.ok());
        let rounded = plain.with_rim_radius(1e-3);
        assert_eq!(read(&[("rim_radius_m", 1e-3)]).ok(), rounded.ok());
        assert_eq!(read(&[(DRAFT, 5.0)]).ok(), plain.with_draft(5.0).ok());
        let loaded = plain.with_centre_of_mass(0.1, Some(6e-7), Some(5e-7));
        let keys = [
            (CENTRE, 0.1),
            ("axial_moment_kg_m2", 6e-7),
            ("transverse_moment_kg_m2", 5e-7),
        ];
        assert_eq!(read(&keys).ok(), loaded.ok());
    }

    /// m R² = 1e-6 kg m², and with I_a = 5e-7 the transverse moment is from 2.5e-7 to 6.1e-7.
    #[test]
    fn an_error_blames_the_key_of_the_quantity() {
        let axial = "axial_moment_kg_m2";
        let transverse = "transverse_moment_kg_m2";
        let cases: [(&[(&'static str, f64)], &str); 11] = [
            (&[("ratio", 0.0)], "ratio"),
            (&[("radius_m", -1.0)], "radius_m"),
            (&[("mass_kg", 0.0)], "mass_kg"),
            (&[("rim_radius_m", 0.01)], "rim_radius_m"),
            (&[(DRAFT, 44.0)], DRAFT),
            (&[("rim_radius_m", 1e-3), (DRAFT, 5.0)], DRAFT),
            (&[(CENTRE, 0.6)], CENTRE),
            (&[(CENTRE, 0.1), (DRAFT, 5.0)], CENTRE),
            (&[(CENTRE, 0.3)], CENTRE),
            (&[(axial, 1.1e-6)], axial),
            (&[(transverse, 7e-7)], transverse),
        ];
        for (entries, key) in cases {
            let error = read(entries).expect_err("an impossible coin");
            assert_eq!(error.path().collect::<Vec<_>>(), [key], "{entries:?}");
        }
    }

    /// A uniform cylinder with H/R = 1.2 has I_t = 3.7e-7 kg m², less than half of 8e-7 and more than any body
    /// without axial moment: m H²/4 = 3.6e-7.
    #[test]
    fn an_axial_moment_is_to_blame_that_rules_out_the_uniform_transverse_one() {
        let axial = "axial_moment_kg_m2";
        for alone in [8e-7, 1e-10] {
            let error = read(&[(axial, alone)]).expect_err("no such coin");
            assert_eq!(error.path().collect::<Vec<_>>(), [axial]);
        }
        let transverse = ("transverse_moment_kg_m2", 3.7e-7);
        let error = read(&[(axial, 8e-7), transverse]).expect_err("no such coin");
        assert_eq!(error.path().collect::<Vec<_>>(), [transverse.0]);
    }

    #[test]
    fn a_config_may_have_each_key_that_is_read() {
        let schema = Coin::schema();
        let matter = ["mass_kg", "rim_radius_m", DRAFT, CENTRE];
        let moments = ["axial_moment_kg_m2", "transverse_moment_kg_m2"];
        let lengths = Coin::HEIGHTS
            .iter()
            .chain(&Coin::RADII)
            .map(|(key, _)| *key);
        let pairs = EXCLUSIVE.as_flattened().iter().copied();
        for key in lengths.chain(pairs).chain(matter).chain(moments) {
            assert!(schema.field(key).is_some(), "{key}");
        }
        let (mut names, fields) = (Vec::new(), schema.fields.len());
        names.extend(schema.fields.iter().map(|field| field.name));
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), fields, "each key once");
    }
}
