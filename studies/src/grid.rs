//! The grid of scenes that several studies share.

use crate::survey::{EventDriven, FRICTION};
use clap::Args;
use coinmc_bench::Case;
use coinmc_core::Preset;

/// H/R × restitution × friction lengths, with μ = 0.3 and the preset clean.
#[derive(Debug, Clone, Args)]
pub(crate) struct Grid {
    /// H/R of the scenes
    #[arg(long, value_delimiter = ',', value_parser = positive, value_name = "X,…",
          default_values_t = [0.25, 0.85, 2.0])]
    ratios: Vec<f64>,

    /// Coefficients of restitution of the scenes
    #[arg(long, value_delimiter = ',', value_parser = share, value_name = "E,…",
          default_values_t = [0.0, 0.3, 0.5, 0.8])]
    restitutions: Vec<f64>,

    /// Rolling and pivoting friction lengths of the scenes in space, in radii
    #[arg(long, value_delimiter = ',', value_parser = share, value_name = "RHO,…",
          default_values_t = [0.0, 0.003, 0.01, 0.03])]
    rhos: Vec<f64>,
}

impl Grid {
    /// The scenes of a study of this engine: in the plane coins fall with the preset clean-flat on
    /// surfaces of several frictions and no friction lengths.
    pub(crate) fn cases_of(&self, engine: EventDriven) -> Vec<Case> {
        let frictions = [0.0, FRICTION, 1.0];
        match engine {
            EventDriven::Flat => {
                let presets = [Preset::CleanFlat];
                Case::grid(&presets, &self.restitutions, &frictions, &self.ratios)
            }
            EventDriven::Volumetric => self.cases(),
        }
    }

    /// Every combination in space, the friction length varying fastest.
    pub(crate) fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::new();
        for &ratio in &self.ratios {
            for &e in &self.restitutions {
                let case = Case::new(Preset::Clean, 0.01, ratio, e, FRICTION);
                cases.extend(self.rhos.iter().map(|&rho| case.rolling(rho)));
            }
        }
        cases
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("not a positive number".to_owned()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
        _ => Err("not a number from 0 to 1".to_owned()),
    }
}
