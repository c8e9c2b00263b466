//! Impact laws with their parameters.

use clap::{Args, ValueEnum};
use coinmc::plan::EngineChoice;
use coinmc_core::Coin;
use coinmc_film::{GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, Settings};

/// PLA on wood.
const COIN_YOUNG_PA: f64 = 3e9;
const SURFACE_YOUNG_PA: f64 = 1e10;
const POISSON: f64 = 0.35;

/// The name of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum LawName {
    /// Newton's restitution, Coulomb friction opposing the final slip
    Moreau,
    /// Chatterjee and Ruina's law with tangential restitution 0
    ChatterjeeRuina,
    /// Gaek and Sukhov's law: restitution √k, no friction, and --eta
    GaekSukhov,
    /// A half-sine force pulse: --pulse-s, --peak-n
    HalfSine,
    /// Elastic line contact resolved in time: --coin-young-pa, --surface-young-pa. Takes minutes
    LineContact,
}

impl LawName {
    /// The laws fitted by default: two that need only e and μ.
    pub(super) const DEFAULT: [Self; 2] = [Self::Moreau, Self::ChatterjeeRuina];
}

/// Parameters of the laws that have some.
#[derive(Debug, Args)]
#[command(next_help_heading = "Parameters of the laws")]
pub(super) struct LawArguments {
    /// η of Gaek & Sukhov's law, N s; the initial value if it is fitted [default: 0.001]
    #[arg(long, value_name = "NS")]
    eta: Option<f64>,

    /// Lever of Gaek & Sukhov's law [default: height]
    #[arg(long, value_enum, value_name = "NAME")]
    lever: Option<LeverName>,

    /// Duration of the half sine, s [default: 0.001]
    #[arg(long, value_name = "S")]
    pulse_s: Option<f64>,

    /// Peak of the half sine, N [default: determined by the restitution]
    #[arg(long, value_name = "N")]
    peak_n: Option<f64>,

    /// Young's modulus of the coin in line contact, Pa [default: 3e9, PLA]
    #[arg(long, value_name = "PA")]
    coin_young_pa: Option<f64>,

    /// Young's modulus of the surface, Pa [default: 1e10, wood]
    #[arg(long, value_name = "PA")]
    surface_young_pa: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LeverName {
    /// H cos θ
    Height,
    /// 2R cos θ
    Diameter,
    /// That of the touching corner
    Corner,
}

impl LawArguments {
    /// The law of this name, with its parameters from the arguments, or from a config with the same
    /// law, or else the default ones.
    pub(super) fn law(&self, name: LawName, coin: &Coin, configured: Option<&EngineChoice>) -> Law {
        let configured = configured.and_then(|engine| Some(engine.settings::<Settings>()?.law));
        match name {
            LawName::Moreau => Law::Moreau,
            LawName::ChatterjeeRuina => Law::ChatterjeeRuina,
            LawName::GaekSukhov => self.gaek_sukhov(configured),
            LawName::HalfSine => self.half_sine(configured),
            LawName::LineContact => self.line_contact(coin, configured),
        }
    }

    fn gaek_sukhov(&self, configured: Option<Law>) -> Law {
        let mut gaek_sukhov = match configured {
            Some(Law::GaekSukhov(gaek_sukhov)) => gaek_sukhov,
            _ => GaekSukhov {
                eta_n_s: 1e-3,
                lever: Lever::default(),
            },
        };
        gaek_sukhov.eta_n_s = self.eta.unwrap_or(gaek_sukhov.eta_n_s);
        gaek_sukhov.lever = self.lever.map_or(gaek_sukhov.lever, |lever| match lever {
            LeverName::Height => Lever::Height,
            LeverName::Diameter => Lever::Diameter,
            LeverName::Corner => Lever::Corner,
        });
        Law::GaekSukhov(gaek_sukhov)
    }

    fn half_sine(&self, configured: Option<Law>) -> Law {
        let mut pulse = match configured {
            Some(Law::HalfSine(pulse)) => pulse,
            _ => HalfSine {
                time: PulseTime::Given(1e-3),
                peak_n: None,
            },
        };
        pulse.time = self.pulse_s.map_or(pulse.time, PulseTime::Given);
        pulse.peak_n = self.peak_n.or(pulse.peak_n);
        Law::HalfSine(pulse)
    }

    fn line_contact(&self, coin: &Coin, configured: Option<Law>) -> Law {
        let mut line = match configured {
            Some(Law::LineContact(line)) => line,
            _ => LineContact {
                materials: Materials {
                    coin_young_pa: COIN_YOUNG_PA,
                    coin_poisson: POISSON,
                    surface_young_pa: SURFACE_YOUNG_PA,
                    surface_poisson: POISSON,
                    length_m: 2.0 * coin.radius_m(),
                },
                tangential: LineContact::mindlin(POISSON),
            },
        };
        let materials = &mut line.materials;
        materials.coin_young_pa = self.coin_young_pa.unwrap_or(materials.coin_young_pa);
        materials.surface_young_pa = self.surface_young_pa.unwrap_or(materials.surface_young_pa);
        Law::LineContact(line)
    }
}
