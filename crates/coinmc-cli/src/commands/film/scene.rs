//! The coin, and the parameters that are not fitted.

use super::law::{LawArguments, LawName};
use crate::exit::Failure;
use anyhow::anyhow;
use clap::Args;
use coinmc::config;
use coinmc_core::{Coin, Scene};
use coinmc_film::{Model, Options, Shared};
use std::path::PathBuf;

/// The coin, and initial or fixed values of the parameters.
#[derive(Debug, Args)]
#[command(next_help_heading = "Coin and surface")]
pub(super) struct SceneArguments {
    /// A config whose first point gives coin, gravity, restitution and friction
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,

    /// H/R of the coin
    #[arg(long, value_name = "H/R", required_unless_present = "config")]
    ratio: Option<f64>,

    /// R of the coin, m
    #[arg(long, value_name = "M", required_unless_present = "config")]
    radius_m: Option<f64>,

    /// Mass of the coin, kg, for laws that involve forces [default: 0.01]
    #[arg(long, value_name = "KG")]
    mass_kg: Option<f64>,

    /// Acceleration of gravity, m/s² [default: 9.81]
    #[arg(long, value_name = "M/S2")]
    gravity: Option<f64>,

    /// Restitution, if it is not fitted [default: 0.5]
    #[arg(long, value_name = "E")]
    restitution: Option<f64>,

    /// Friction, if it is not fitted [default: 0.3]
    #[arg(long, value_name = "MU")]
    friction: Option<f64>,

    /// Height of the surface in the film, m, if it is not fitted
    #[arg(
        long,
        value_name = "M",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    floor_m: f64,

    #[command(flatten)]
    laws: LawArguments,
}

impl SceneArguments {
    /// The model of a law, and the parameters of all laws.
    pub(super) fn model(&self, name: LawName) -> Result<(Model, Shared), Failure> {
        let point = match &self.config {
            Some(path) => config::load(path, &[])?.points.get(0).cloned(),
            None => None,
        };
        let scene = point.as_ref().map(|point| point.scene);
        let input = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{error}"));
        let mut coin = match scene.map(|scene| scene.coin) {
            Some(coin) => coin,
            None => self.coin(self.ratio.unwrap_or(1.0), self.radius_m.unwrap_or(0.01))?,
        };
        if self.config.is_some() && (self.ratio.is_some() || self.radius_m.is_some()) {
            let ratio = self.ratio.unwrap_or(coin.ratio());
            coin = self.coin(ratio, self.radius_m.unwrap_or(coin.radius_m()))?;
        }
        if let Some(mass_kg) = self.mass_kg {
            coin = coin.with_mass(mass_kg).map_err(|error| input(&error))?;
        }
        let law = self
            .laws
            .law(name, &coin, point.as_ref().map(|point| &point.engine));
        let usual = Options::default().shared;
        let surface = scene.map(|scene| scene.surface);
        let given = |argument: Option<f64>, in_config: Option<f64>, usual: f64| {
            argument.or(in_config).unwrap_or(usual)
        };
        let shared = Shared {
            restitution: given(
                self.restitution,
                surface.map(|s| s.restitution()),
                usual.restitution,
            ),
            friction: given(self.friction, surface.map(|s| s.friction()), usual.friction),
            floor_m: self.floor_m,
            ..usual
        };
        let gravity_m_s2 = given(
            self.gravity,
            scene.map(|scene| scene.gravity_m_s2()),
            Scene::STANDARD_GRAVITY_M_S2,
        );
        let model = Model {
            law,
            coin,
            gravity_m_s2,
        };
        let surface = coinmc_core::Surface::new(shared.restitution, shared.friction)
            .map_err(|error| input(&error))?;
        Scene::new(coin, surface, gravity_m_s2).map_err(|error| input(&error))?;
        model.validate().map_err(|error| input(&error))?;
        if !shared.floor_m.is_finite() {
            return Err(Failure::Input(anyhow!("--floor-m must be finite")));
        }
        Ok((model, shared))
    }

    #[allow(clippy::unused_self)] // belongs to the arguments it checks
    fn coin(&self, ratio: f64, radius_m: f64) -> Result<Coin, Failure> {
        Coin::cylinder(ratio, radius_m).map_err(|error| Failure::Input(error.into()))
    }
}
