//! The engine on random grounds of the same slope and wavelength.

use clap::Args;
use coinmc_bench::number;
use coinmc_core::{Engine, Face, Launch, Roughness, Scene};
use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};

/// How many coins the engine follows beside the oracle.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Beside {
    /// Coins of each scene that the engine follows
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    engine_coins: u64,
}

impl Beside {
    pub(super) const COLUMNS: [&str; 4] = [
        "engine_coins",
        "engine_on_side",
        "engine_undecided",
        "engine_p_side",
    ];

    /// The engine's columns, for the coins that `launch` launches.
    pub(super) fn cells(
        self,
        scene: &Scene,
        (slope, wavelength_mm): (f64, f64),
        launch: impl Fn(u64) -> Launch,
    ) -> Vec<String> {
        let roughness =
            Roughness::new(slope, 1e-3 * wavelength_mm).expect("the study's slopes are in range");
        let mut scene = *scene;
        scene.surface = scene.surface.with_roughness(Some(roughness));
        let engine =
            VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        let (mut side, mut undecided) = (0_u64, 0_u64);
        for coin in 0..self.engine_coins {
            let outcome = engine.toss(&mut engine.workspace(), &launch(coin), &mut ());
            side += u64::from(outcome.face() == Some(Face::Side));
            undecided += u64::from(outcome.face().is_none());
        }
        vec![
            self.engine_coins.to_string(),
            side.to_string(),
            undecided.to_string(),
            format!("{:.4}", side as f64 / self.engine_coins as f64),
        ]
    }
}
