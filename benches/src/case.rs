//! A scene and a launch distribution: all of a toss but its number and the seed.

use coinmc_core::{
    Coin, Domain, Drag, DynEngine, Landing, Launch, LaunchDistribution, Material, Preset,
    Roughness, Scene, Stream, Surface,
};
use coinmc_flat::Settings;
use std::fmt;

/// A scene and how the coin is let go.
///
/// All cases share their random numbers: toss k of a seed has the same uniforms in each, so
/// (case, seed, k) names a toss, and differences between cases are paired.
///
/// # Example
/// ```
/// use coinmc_bench::Case;
/// use coinmc_core::Preset;
/// let case = Case::new(Preset::Robot, 0.01, 1.5, 0.5, 0.3);
/// assert_eq!(case.to_string(), "robot R=0.01 x=1.5 e=0.5 mu=0.3");
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// How the coin is let go.
    pub preset: Preset,
    /// Coin, surface, gravity.
    pub scene: Scene,
}

impl Case {
    /// A uniform cylinder on a bouncing surface.
    ///
    /// # Panics
    /// If a parameter is out of range: cases are written into the code.
    pub fn new(preset: Preset, radius_m: f64, ratio: f64, restitution: f64, friction: f64) -> Self {
        let coin = Coin::cylinder(ratio, radius_m).expect("radius and ratio are positive");
        let surface = Surface::new(restitution, friction).expect("0 <= e <= 1 and mu >= 0");
        let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2);
        Self {
            preset,
            scene: scene.expect("gravity is positive"),
        }
    }

    /// Every combination, the last axis varying fastest, with R = 1 cm.
    pub fn grid(
        presets: &[Preset],
        restitutions: &[f64],
        frictions: &[f64],
        ratios: &[f64],
    ) -> Vec<Self> {
        let mut cases = Vec::new();
        for &preset in presets {
            for &e in restitutions {
                for &mu in frictions {
                    cases.extend(ratios.iter().map(|&x| Self::new(preset, 0.01, x, e, mu)));
                }
            }
        }
        cases
    }

    /// The same with the first contact deciding.
    ///
    /// # Panics
    /// Never: no case has a tilted table.
    pub fn adhesive(mut self) -> Self {
        self.scene.surface = self
            .scene
            .surface
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        self
    }

    /// A uniform cylinder of the size of a 1 euro coin, tossed by hand, on a material. Pivoting friction is
    /// left out.
    ///
    /// # Panics
    /// If `ratio` is not positive.
    pub fn by_hand(ratio: f64, material: &Material) -> Self {
        let (e, mu) = (material.restitution.value, material.friction.value);
        let mut case = Self::new(Preset::Hand, 0.0116, ratio, e, mu);
        let rolling = material.rolling_friction_m.value;
        let surface = case.scene.surface.with_friction_lengths(rolling, 0.0);
        let (slope, wave) = (material.roughness_slope, material.roughness_wavelength_m);
        let roughness = Roughness::new(slope.value, wave.value);
        let surface = surface.expect("a material's friction is in range");
        case.scene.surface =
            surface.with_roughness(Some(roughness.expect("a material's ground is in range")));
        case
    }

    /// The same with contour and pivoting friction lengths of `rho` radii each.
    ///
    /// # Panics
    /// If `rho` is negative or not finite.
    pub fn rolling(mut self, rho: f64) -> Self {
        let length = rho * self.scene.coin.radius_m();
        let surface = self.scene.surface.with_friction_lengths(length, length);
        self.scene.surface = surface.expect("rho >= 0");
        self
    }

    /// The contour friction length in radii, to nine decimals: what was asked for.
    pub fn rho_over_r(&self) -> f64 {
        let ratio = self.scene.surface.rolling_friction_m() / self.scene.coin.radius_m();
        (1e9 * ratio).round() / 1e9
    }

    /// The Unity (PhysX) scene of Gaek & Sukhov, arXiv 2401.03557, table 1, as
    /// `examples/table1.toml` has it.
    ///
    /// # Panics
    /// If `ratio` is not positive.
    pub fn table1(ratio: f64) -> Self {
        let mut case = Self::new(Preset::Table1, 0.5, ratio, 0.3, 10.0);
        let threshold = case.scene.surface.with_restitution_threshold(2.0);
        case.scene.surface = threshold.expect("2 m/s is positive");
        let drag = Drag::new(1.0, 0.05).expect("rates are positive");
        case.scene = case.scene.with_drag(drag).with_gyroscopic_torque(false);
        case
    }

    /// The same with the moment of inertia of a rectangular plate 2R × H instead of the
    /// cylinder's: I_t = m (4R² + H²)/12. Planar physics engines give a rectangle that one.
    ///
    /// # Panics
    /// If H/R < 0.71: no cylinder of revolution has such a moment.
    pub fn with_rectangle_inertia(mut self) -> Self {
        let coin = self.scene.coin;
        let (r, h) = (coin.radius_m(), coin.height_m());
        let moment = coin.mass_kg() * (4.0 * r * r + h * h) / 12.0;
        self.scene.coin = coin
            .with_moments(None, Some(moment))
            .expect("H/R is at least 0.71");
        self
    }

    /// The launch distribution.
    pub fn launches(&self) -> LaunchDistribution {
        self.preset.distribution()
    }

    /// The launch of a toss: the same for every engine.
    pub fn launch(&self, seed: u64, toss: u64) -> Launch {
        let mut uniforms = Self::stream(seed).toss(toss);
        self.launches().launch(&self.scene.coin, &mut uniforms)
    }

    /// The random numbers of a seed.
    pub fn stream(seed: u64) -> Stream {
        Stream::new(seed, Domain::Launch, 0)
    }

    /// Titles of [`Case::cells`], followed by these.
    pub fn columns(more: &[&'static str]) -> Vec<&'static str> {
        let own = ["preset", "ratio", "restitution", "friction", "rho_over_r"];
        own.iter().chain(more).copied().collect()
    }

    /// The cells that name the case in a table.
    pub fn cells(&self) -> Vec<String> {
        let (coin, surface) = (&self.scene.coin, &self.scene.surface);
        vec![
            self.preset.to_string(),
            coin.ratio().to_string(),
            surface.restitution().to_string(),
            surface.friction().to_string(),
            self.rho_over_r().to_string(),
        ]
    }

    /// The flat engine.
    ///
    /// # Panics
    /// If a setting is out of range.
    pub fn engine(&self, settings: &Settings) -> DynEngine {
        settings.engine(&self.scene).expect("settings are in range")
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (coin, surface) = (&self.scene.coin, &self.scene.surface);
        write!(
            f,
            "{} R={} x={} e={} mu={}",
            self.preset,
            coin.radius_m(),
            coin.ratio(),
            surface.restitution(),
            surface.friction()
        )?;
        if surface.rolling_friction_m() > 0.0 {
            write!(f, " rho={}", self.rho_over_r())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_turns_harder_than_the_cylinder_of_its_section() {
        let case = Case::new(Preset::CleanFlat, 0.01, 1.2, 0.5, 0.0);
        let rectangle = case.with_rectangle_inertia();
        let gyration = |case: &Case| case.scene.coin.transverse_gyration_m2() / 1e-4;
        // (3 + 1.44)/12 and (4 + 1.44)/12 R²
        assert!((gyration(&case) - 4.44 / 12.0).abs() < 1e-15);
        assert!((gyration(&rectangle) - 5.44 / 12.0).abs() < 1e-15);
    }

    #[test]
    fn friction_lengths_are_named_where_there_are_any() {
        let case = Case::new(Preset::Clean, 0.01, 0.85, 0.5, 0.3).rolling(0.003);
        assert_eq!(
            case.to_string(),
            "clean R=0.01 x=0.85 e=0.5 mu=0.3 rho=0.003"
        );
        assert_eq!(case.rho_over_r(), 0.003);
    }

    #[test]
    fn a_grid_holds_every_combination_once() {
        let cases = Case::grid(&Preset::ALL, &[0.0, 0.5], &[0.0, 0.3, 1.0], &[1.0, 2.0]);
        let mut names: Vec<String> = cases.iter().map(Case::to_string).collect();
        assert_eq!(names[1], "robot R=0.01 x=2 e=0 mu=0");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), Preset::ALL.len() * 2 * 3 * 2);
    }
}
