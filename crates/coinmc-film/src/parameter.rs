//! The numbers that all drops of a fit share.

use coinmc_core::Coin;
use coinmc_flat::{Law, LineContact, Materials, PulseTime};

/// A number that all drops of a fit share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Coefficient of restitution e; of Gaek & Sukhov's law √k.
    Restitution,
    /// Coefficient of Coulomb friction μ.
    Friction,
    /// η of Gaek & Sukhov's law, N s.
    Eta,
    /// Length τ of the half sine, s.
    PulseTime,
    /// Its height N_max, N, where the law has one.
    Peak,
    /// Stiffness K of the line contact over that of the materials given.
    Stiffness,
    /// Height of the surface in the film's coordinates, m: nobody places the origin exactly.
    Floor,
}

impl Parameter {
    /// All parameters, in the order of every table.
    pub const ALL: [Self; 7] = [
        Self::Restitution,
        Self::Friction,
        Self::Eta,
        Self::PulseTime,
        Self::Peak,
        Self::Stiffness,
        Self::Floor,
    ];

    /// The name used on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::Friction => "friction",
            Self::Eta => "eta_n_s",
            Self::PulseTime => "time_s",
            Self::Peak => "peak_n",
            Self::Stiffness => "stiffness",
            Self::Floor => "floor_m",
        }
    }

    /// The values it may take.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Restitution => (0.0, 1.0),
            // beyond this no impact of a coin slides
            Self::Friction => (0.0, 10.0),
            Self::Eta => (0.0, 1e6),
            Self::PulseTime => (1e-7, 1.0),
            Self::Peak => (1e-9, 1e9),
            Self::Stiffness => (1e-6, 1e6),
            Self::Floor => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// Where a search begins, in units of its scale; empty: at the value given.
    pub(crate) fn grid(self) -> &'static [f64] {
        match self {
            Self::Restitution => &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
            Self::Friction => &[
                0.02, 0.05, 0.08, 0.12, 0.16, 0.21, 0.27, 0.35, 0.45, 0.6, 0.9,
            ],
            // a coin dropped from 20 cm has a momentum of 6
            Self::Eta => &[0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0, 1.6, 2.5, 4.0],
            Self::PulseTime => &[1e-3, 5e-3, 2e-2, 6e-2],
            Self::Peak | Self::Stiffness | Self::Floor => &[],
        }
    }

    /// What a change by one means: the unit of the search.
    pub(crate) fn scale(self, coin: &Coin, gravity_m_s2: f64) -> f64 {
        let (mass, d) = (coin.mass_kg(), coin.rim_distance_m());
        match self {
            Self::Restitution | Self::Friction | Self::Stiffness => 1.0,
            Self::Eta => mass * (gravity_m_s2 * d).sqrt(),
            Self::PulseTime => (d / gravity_m_s2).sqrt(),
            Self::Peak => 100.0 * mass * gravity_m_s2,
            Self::Floor => d,
        }
    }
}

/// The parameters a law depends on, and the floor on which all do.
pub fn parameters(law: Law) -> &'static [Parameter] {
    use Parameter::{Eta, Floor, Friction, Peak, Restitution, Stiffness};
    match law {
        Law::Moreau | Law::ChatterjeeRuina => &[Restitution, Friction, Floor],
        // Gaek & Sukhov's law has no friction
        Law::GaekSukhov(_) => &[Restitution, Eta, Floor],
        Law::HalfSine(pulse) => match (pulse.time, pulse.peak_n) {
            (PulseTime::Given(_), None) => &[Restitution, Friction, Parameter::PulseTime, Floor],
            (PulseTime::Given(_), Some(_)) => {
                &[Restitution, Friction, Parameter::PulseTime, Peak, Floor]
            }
            (PulseTime::Contact(_), None) => &[Restitution, Friction, Stiffness, Floor],
            (PulseTime::Contact(_), Some(_)) => &[Restitution, Friction, Peak, Stiffness, Floor],
        },
        Law::LineContact(_) => &[Restitution, Friction, Stiffness, Floor],
    }
}

/// A value for every parameter. A fit begins with a law's own numbers (η, τ, N_max, K) as its model
/// has them; those of other laws mean nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shared {
    /// Coefficient of restitution e.
    pub restitution: f64,
    /// Coefficient of Coulomb friction μ.
    pub friction: f64,
    /// Height of the surface in the film's coordinates, m.
    pub floor_m: f64,
    /// η of Gaek & Sukhov's law, N s.
    pub eta_n_s: f64,
    /// Length of the half sine, s.
    pub time_s: f64,
    /// Height of the half sine, N.
    pub peak_n: f64,
    /// Stiffness of the contact over that of the materials given.
    pub stiffness: f64,
}

impl Default for Shared {
    /// e = 0.5 and μ = 0.3 on a floor at 0.
    fn default() -> Self {
        Self {
            restitution: 0.5,
            friction: 0.3,
            floor_m: 0.0,
            eta_n_s: 0.0,
            time_s: 1e-3,
            peak_n: 1.0,
            stiffness: 1.0,
        }
    }
}

impl Shared {
    /// The value of a parameter.
    pub fn get(&self, parameter: Parameter) -> f64 {
        let mut shared = *self;
        *shared.slot(parameter)
    }

    /// The same with another value of a parameter.
    pub fn with(mut self, parameter: Parameter, value: f64) -> Self {
        *self.slot(parameter) = value;
        self
    }

    fn slot(&mut self, parameter: Parameter) -> &mut f64 {
        match parameter {
            Parameter::Restitution => &mut self.restitution,
            Parameter::Friction => &mut self.friction,
            Parameter::Eta => &mut self.eta_n_s,
            Parameter::PulseTime => &mut self.time_s,
            Parameter::Peak => &mut self.peak_n,
            Parameter::Stiffness => &mut self.stiffness,
            Parameter::Floor => &mut self.floor_m,
        }
    }

    /// The same with every parameter within its range.
    pub(crate) fn clamped(self) -> Self {
        Parameter::ALL.into_iter().fold(self, |shared, parameter| {
            let (low, high) = parameter.range();
            shared.with(parameter, shared.get(parameter).clamp(low, high))
        })
    }

    /// The same with the law's own numbers.
    pub(crate) fn of(mut self, law: Law) -> Self {
        self.stiffness = 1.0;
        match law {
            Law::GaekSukhov(gaek_sukhov) => self.eta_n_s = gaek_sukhov.eta_n_s,
            Law::HalfSine(pulse) => {
                if let PulseTime::Given(time) = pulse.time {
                    self.time_s = time;
                }
                self.peak_n = pulse.peak_n.unwrap_or(self.peak_n);
            }
            Law::Moreau | Law::ChatterjeeRuina | Law::LineContact(_) => {}
        }
        self
    }

    /// The law with these numbers as its own.
    pub(crate) fn applied(&self, law: Law) -> Law {
        let stiffer = |materials: Materials| Materials {
            // K is proportional to the modulus that both of them make
            coin_young_pa: materials.coin_young_pa * self.stiffness,
            surface_young_pa: materials.surface_young_pa * self.stiffness,
            ..materials
        };
        match law {
            Law::Moreau | Law::ChatterjeeRuina => law,
            Law::GaekSukhov(mut gaek_sukhov) => {
                gaek_sukhov.eta_n_s = self.eta_n_s;
                Law::GaekSukhov(gaek_sukhov)
            }
            Law::HalfSine(mut pulse) => {
                pulse.time = match pulse.time {
                    PulseTime::Given(_) => PulseTime::Given(self.time_s),
                    PulseTime::Contact(materials) => PulseTime::Contact(stiffer(materials)),
                };
                pulse.peak_n = pulse.peak_n.map(|_| self.peak_n);
                Law::HalfSine(pulse)
            }
            Law::LineContact(line) => Law::LineContact(LineContact {
                materials: stiffer(line.materials),
                ..line
            }),
        }
    }
}
