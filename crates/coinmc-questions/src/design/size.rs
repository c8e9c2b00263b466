//! How wide a coin to print is, where nobody says so.

use crate::scenes::EverydayScene;
use crate::{QuestionError, Template};
use coinmc::config::Override;
use coinmc_core::Coin;

/// Diameter of a coin to print where nothing says another, m. An everyday scene's own coin is of metal, and a
/// print is no euro.
pub const PRINTED_DIAMETER_M: f64 = 0.024;

/// The diameter that the config or an override gives, m; `None` for an everyday scene as it is.
///
/// # Errors
/// [`QuestionError::Config`]; [`QuestionError::Swept`] if the config has coins of several diameters.
///
/// # Example
/// ```
/// use coinmc_questions::{Template, diameter_told};
/// let text = "coin.radius_m = 0.005\nsurface.material = 'wood'\nlaunch.preset = 'hand'\nengine.volumetric = {}";
/// assert_eq!(diameter_told(&Template::new("inline", text, &[]), None, &[])?, Some(0.01));
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn diameter_told(
    template: &Template,
    scene: Option<EverydayScene>,
    overrides: &[Override],
) -> Result<Option<f64>, QuestionError> {
    if scene.is_some() && !overrides.iter().any(gives_a_size) {
        return Ok(None);
    }
    let plan = template.plan(&[("coin.ratio", "1.0".to_owned())])?;
    let radius_m = plan.points[0].scene.coin.radius_m();
    let mut points = plan.points.each();
    if points.any(|point| point.scene.coin.radius_m() != radius_m) {
        return Err(QuestionError::Swept(plan.axes.join(", ")));
    }
    Ok(Some(2.0 * radius_m))
}

fn gives_a_size(set: &Override) -> bool {
    let mut keys = Coin::RADII.iter();
    keys.any(|(key, _)| set.is_about(&format!("coin.{key}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diameter(
        scene: Option<EverydayScene>,
        config: &str,
        set: &[&str],
    ) -> Result<Option<f64>, String> {
        let set: Vec<Override> = set.iter().map(|set| set.parse().expect("a key")).collect();
        let template = match scene {
            Some(scene) => scene.template(&set),
            None => Template::new("inline", config, &set),
        };
        diameter_told(&template, scene, &set).map_err(|error| error.to_string())
    }

    #[test]
    fn the_config_gives_the_diameter_that_is_not_asked_for() {
        let text = |coin: &str| {
            format!(
                "coin = {{ {coin} }}\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
                 engine.volumetric = {{}}"
            )
        };
        let of = |coin: &str, set: &[&str]| diameter(None, &text(coin), set);
        assert_eq!(of("ratio = 1.2, radius_m = 0.012", &[]), Ok(Some(0.024)));
        assert_eq!(of("ratio = [1, 2], diameter_mm = 30", &[]), Ok(Some(0.03)));
        assert_eq!(
            of("diameter_mm = 30", &["coin.radius_m=0.005"]),
            Ok(Some(0.01))
        );
        let swept = of("radius_m = [0.005, 0.01]", &[]).expect_err("two diameters");
        assert!(swept.contains("sweeps radius"), "{swept}");
    }

    #[test]
    fn a_scene_gives_none_unless_it_is_told() {
        let felt = EverydayScene::named("felt").ok();
        assert_eq!(diameter(felt, "", &["surface.friction=0.2"]), Ok(None));
        assert_eq!(diameter(felt, "", &["coin.diameter_mm=30"]), Ok(Some(0.03)));
    }
}
