//! Everyday scenes: where people toss coins, for questions without a config.
//!
//! A scene is a config with the numbers of a [`Material`] and a launch, and an [`Assumption`] for
//! each number: from where to where it may be in life, and where it comes from. All of them are
//! metal coins of the size of a euro unless the question says otherwise.

use crate::{QuestionError, Template};
use coinmc::config::Override;
use coinmc_core::{Material, Preset, Sourced};

/// An everyday scene.
///
/// # Example
/// ```
/// use coinmc_questions::scenes::EverydayScene;
/// let table = EverydayScene::named("table")?;
/// assert!(table.config().contains("material = \"laminate\""));
/// assert!(EverydayScene::named("tabel").unwrap_err().to_string().contains("`table`"));
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EverydayScene {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// The name of the material.
    pub material: &'static str,
    /// Height of the hand above the surface, m.
    pub height_m: f64,
    /// Radius of a round table, m; `None` where no coin comes to the edge.
    pub table_radius_m: Option<f64>,
}

/// A number that a scene assumes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assumption {
    /// Its key in configs.
    pub key: &'static str,
    /// What it is, in words.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// The least that it may be in life.
    pub low: f64,
    /// The most.
    pub high: f64,
    /// Where the number comes from.
    pub source: &'static str,
}

/// Radius of a 1 euro coin, m: 23.25 mm in diameter.
const EURO_RADIUS_M: f64 = 0.011_625;

/// Mean spin of a toss by hand, rad/s, and its mean angle of the angular momentum to the axis: those of the preset `hand`,
/// spelled out so that each can be varied.
const HAND_RATE_RAD_S: f64 = 238.6;
const HAND_PSI_DEG: f64 = 81.0;

/// The one number of a scene's surface that is not its material's.
const TABLE_RADIUS: &str = "surface.table_radius_m";

impl EverydayScene {
    /// All scenes; the first is taken if none is named.
    pub const ALL: [Self; 9] = [
        Self::of(
            "table",
            "a kitchen table or a desk, of laminate",
            "laminate",
            0.3,
        ),
        Self::of("wood", "a finished table top of solid wood", "wood", 0.3),
        Self::of("glass", "a pane of glass on a firm base", "glass", 0.3),
        Self::of("steel", "a plate of steel", "steel", 0.3),
        Self::of("felt", "a table covered with loose felt", "felt", 0.3),
        Self {
            table_radius_m: Some(0.2),
            ..Self::of(
                "tray",
                "a flat round tray, lined with felt, without a rim (a coin that leaves it shows no face)",
                "felt",
                0.3,
            )
        },
        Self::of("billiards", "billiard cloth over slate", "cloth", 0.3),
        Self::of(
            "floor",
            "a floor of laminate, tossed while standing",
            "laminate",
            1.0,
        ),
        Self::of(
            "carpet",
            "a short-pile carpet, tossed while standing",
            "carpet",
            1.0,
        ),
    ];

    const fn of(
        name: &'static str,
        doc: &'static str,
        material: &'static str,
        height_m: f64,
    ) -> Self {
        Self {
            name,
            doc,
            material,
            height_m,
            table_radius_m: None,
        }
    }

    /// The scene of this name.
    ///
    /// # Errors
    /// [`QuestionError::NoScene`] with the nearest name.
    pub fn named(name: &str) -> Result<Self, QuestionError> {
        let found = Self::ALL.into_iter().find(|scene| scene.name == name);
        found.ok_or_else(|| {
            let names = Self::ALL.map(|scene| scene.name);
            QuestionError::NoScene {
                name: name.chars().take(60).collect(),
                nearest: coinmc::config::nearest(name, names),
                known: names.join(", "),
            }
        })
    }

    /// Its config.
    pub fn config(&self) -> String {
        let edge = self.table_radius_m.map_or(String::new(), |radius_m| {
            format!("table_radius_m = {radius_m:?}\n")
        });
        format!(
            "# {}: {}, tossed by hand from {} m above it.\n\
             [coin]\nratio = 1.0\nradius_m = {EURO_RADIUS_M}\n\n\
             [surface]\nmaterial = \"{}\"\n{edge}\n\
             [launch]\npreset = \"hand\"\nheight_m = {:?}\n\
             spin.precessing.rate_rad_s.normal = {{ mean = {HAND_RATE_RAD_S}, sd = 23.86 }}\n\
             spin.precessing.psi_deg.normal = {{ mean = {HAND_PSI_DEG}, sd = 5.0 }}\n\n\
             [engine.volumetric]\n\n[stop]\ntosses = 100_000\n",
            self.name, self.doc, self.height_m, self.material, self.height_m
        )
    }

    /// Its template.
    pub fn template(&self, overrides: &[Override]) -> Template {
        Template::new(format!("scene {}", self.name), self.config(), overrides)
    }

    fn material(&self) -> Material {
        self.material.parse().expect("a scene's material exists")
    }

    /// In words, with what `overrides` change of it.
    pub fn described(&self, overrides: &[Override]) -> String {
        format!(
            "{}; a coin of metal, tossed by hand from {:?} m above it{}",
            self.doc,
            self.height_m,
            but_with(overrides)
        )
    }

    /// What it assumes and `overrides` do not say otherwise, by whatever key: what is left of its own numbers in
    /// its config, and is not given there. (A material gives all of its numbers.)
    pub fn assumed(&self, overrides: &[Override]) -> Vec<Assumption> {
        let plan = self.template(overrides).plan(&[]);
        let given = |key: &str| {
            let of_material = key.starts_with("surface.") && key != TABLE_RADIUS;
            overrides
                .iter()
                .any(|set| set.is_about(key) || of_material && set.is_about("surface.material"))
        };
        let is_left = |assumed: &Assumption| {
            let now = plan.as_ref().ok().and_then(|plan| plan.number(assumed.key));
            now == Some(assumed.value) && !given(assumed.key)
        };
        self.assumptions().into_iter().filter(is_left).collect()
    }

    /// What it assumes, and within which limits.
    pub fn assumptions(&self) -> Vec<Assumption> {
        let material = self.material();
        let number = |(key, name), sourced: Sourced, low: f64, high: f64| Assumption {
            key,
            name,
            value: sourced.value,
            low,
            high,
            source: sourced.source,
        };
        // an estimate may be wrong by a factor of 3 where nothing bounds it
        let factor = |named, sourced: Sourced| {
            number(named, sourced, sourced.value / 3.0, sourced.value * 3.0)
        };
        let (e, mu) = (material.restitution, material.friction);
        let slope = material.roughness_slope;
        let mut assumptions = vec![
            number(
                ("surface.restitution", "coefficient of restitution"),
                e,
                (e.value - 0.15).max(0.05),
                (e.value + 0.15).min(0.9),
            ),
            number(
                ("surface.friction", "coefficient of friction"),
                mu,
                0.6 * mu.value,
                1.6 * mu.value,
            ),
            factor(
                ("surface.rolling_friction_m", "rolling friction length, m"),
                material.rolling_friction_m,
            ),
            factor(
                ("surface.contact_patch_m", "radius of the contact patch, m"),
                material.contact_patch_m,
            ),
            number(
                ("surface.roughness_slope", "slope of the ground"),
                slope,
                slope.value / 3.0,
                (slope.value * 3.0).min(0.15),
            ),
            factor(
                (
                    "surface.roughness_wavelength_m",
                    "wavelength of the ground, m",
                ),
                material.roughness_wavelength_m,
            ),
            Assumption {
                key: "launch.height_m",
                name: "height of the hand, m",
                value: self.height_m,
                low: 0.5 * self.height_m,
                high: 2.0 * self.height_m,
                source: "ours: the hand of somebody at the table, or standing",
            },
            Assumption {
                key: "launch.spin.precessing.rate_rad_s.normal.mean",
                name: "spin, rad/s",
                value: HAND_RATE_RAD_S,
                low: 80.0,
                high: 300.0,
                source: Preset::Hand.source(),
            },
            Assumption {
                key: "launch.spin.precessing.psi_deg.normal.mean",
                name: "angle between angular momentum and axis, degrees",
                value: HAND_PSI_DEG,
                low: 60.0,
                high: 90.0,
                source: Preset::Hand.source(),
            },
            Assumption {
                key: "coin.radius_m",
                name: "radius of the coin, m",
                value: EURO_RADIUS_M,
                low: 0.5 * EURO_RADIUS_M,
                high: 2.0 * EURO_RADIUS_M,
                source: "a 1 euro coin, 23.25 mm in diameter",
            },
        ];
        assumptions.extend(self.table_radius_m.map(|radius_m| Assumption {
            key: TABLE_RADIUS,
            name: "radius of the table, m",
            value: radius_m,
            low: 0.5 * radius_m,
            high: 2.0 * radius_m,
            source: "ours: a tray that somebody carries",
        }));
        assumptions
    }
}

/// "; but with …", as it was typed, where anything is changed of a scene.
pub fn but_with(overrides: &[Override]) -> String {
    if overrides.is_empty() {
        String::new()
    } else {
        format!("; but with {}", changed(overrides))
    }
}

/// What is changed of a scene, as it was typed.
pub(crate) fn changed(overrides: &[Override]) -> String {
    let changes: Vec<_> = overrides.iter().map(Override::text).collect();
    changes.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(overrides: &[&str]) -> Vec<&'static str> {
        let felt = EverydayScene::named("felt").expect("a scene");
        let overrides: Vec<Override> = overrides
            .iter()
            .map(|set| set.parse().expect("an override"))
            .collect();
        let assumed = felt.assumed(&overrides).into_iter();
        assumed.map(|assumed| assumed.key).collect()
    }

    /// Whatever gives a number, it is no assumption any more: its own key, another that means the same, a material, another
    /// preset; the value that it had, too.
    #[test]
    fn what_is_given_is_not_assumed() {
        let all = keys(&[]);
        let left_out = |overrides: &[&str]| {
            let left = keys(overrides);
            let out = all.iter().filter(|key| !left.contains(key)).copied();
            out.collect::<Vec<_>>()
        };
        assert_eq!(all.len(), 10);
        for (set, out) in [
            ("surface.friction=0.4", "surface.friction"),
            ("surface.friction=[0.3, 0.4]", "surface.friction"),
            ("coin.diameter_mm=30", "coin.radius_m"),
            (
                "surface.pivoting_friction_m=0.001",
                "surface.contact_patch_m",
            ),
            (
                "surface.rolling_friction_over_radius=0.01",
                "surface.rolling_friction_m",
            ),
            ("launch.height_m=0.1", "launch.height_m"),
        ] {
            assert_eq!(left_out(&[set]), [out], "{set}");
        }
        for material in ["wood", "felt"] {
            let out = left_out(&[&format!("surface.material={material}")]);
            assert_eq!(out.len(), 6);
            assert!(out.iter().all(|key| key.starts_with("surface.")));
        }
        let out = left_out(&["launch={ preset = 'drop', height_m = 0.3 }"]);
        assert!(out.iter().all(|key| key.starts_with("launch.")) && out.len() == 3);
    }

    #[test]
    fn a_scene_is_described_with_what_was_changed() {
        let felt = EverydayScene::named("felt").expect("a scene");
        let plain =
            "a table covered with loose felt; a coin of metal, tossed by hand from 0.3 m above it";
        assert_eq!(felt.described(&[]), plain);
        let sets = ["surface.material=wood", "launch.height_m=1"];
        let sets = sets.map(|set| set.parse().expect("an override"));
        assert_eq!(
            felt.described(&sets),
            format!("{plain}; but with surface.material=wood, launch.height_m=1")
        );
    }

    /// The launch spelled out is that of the preset but for its height, and every assumption is a
    /// number of the config.
    #[test]
    fn a_scene_assumes_what_its_config_says() {
        for scene in EverydayScene::ALL {
            let plan = scene.template(&[]).plan(&[]).expect("a valid config");
            let mut hand = Preset::Hand.distribution();
            hand.height_m = coinmc_core::Marginal::Constant(scene.height_m);
            assert_eq!(plan.points[0].launches, hand, "{}", scene.name);
            for assumption in scene.assumptions() {
                assert!(assumption.low < assumption.value && assumption.value < assumption.high);
                let number = plan.number(assumption.key);
                assert_eq!(number, Some(assumption.value), "{}", assumption.key);
            }
        }
    }
}
