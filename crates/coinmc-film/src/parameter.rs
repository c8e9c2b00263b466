//! The parameters shared by all drops of a fit.

use coinmc_core::Coin;
use coinmc_flat::{Law, LineContact, Materials, PulseTime};

/// A parameter shared by all drops of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Coefficient of restitution e; √k of Gaek & Sukhov's law.
    Restitution,
    /// Coefficient of Coulomb friction μ.
    Friction,
    /// η of Gaek & Sukhov's law, N s.
    Eta,
    /// Duration τ of the half sine, s.
    PulseTime,
    /// Peak N_max of the half sine, N, if the law has one.
    Peak,
    /// Stiffness K of the line contact relative to that of the given materials.
    Stiffness,
    /// Height of the surface in the film's coordinates, m, because the origin is never placed
    /// exactly.
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

    /// The range of its values.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Restitution => (0.0, 1.0),
            // above this no impact of a coin slides
            Self::Friction => (0.0, 10.0),
            Self::Eta => (0.0, 1e6),
            Self::PulseTime => (1e-7, 1.0),
            Self::Peak => (1e-9, 1e9),
            Self::Stiffness => (1e-6, 1e6),
            Self::Floor => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// Initial values of a search, in units of the scale; empty: the given value.
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

    /// The unit of the search.
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

/// The parameters of a law, including the floor, which all laws have.
pub fn parameters(law: Law) -> &'static [Parameter] {
    use Parameter::{Eta, Floor, Friction, Peak, Restitution, Stiffness};
    match law {
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
        // parameters of its own are fitted once they are a [`Parameter`]
        _ => &[Restitution, Friction, Floor],
    }
}

/// A value for every parameter. A law's own parameters (η, τ, N_max, K) start from the values of
/// its model; those of other laws are ignored.
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
    /// Duration of the half sine, s.
    pub time_s: f64,
    /// Peak of the half sine, N.
    pub peak_n: f64,
    /// Stiffness of the contact relative to that of the given materials.
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

    /// A copy with another value of a parameter.
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

    /// A copy with every parameter clamped to its range.
    pub(crate) fn clamped(self) -> Self {
        Parameter::ALL.into_iter().fold(self, |shared, parameter| {
            let (low, high) = parameter.range();
            shared.with(parameter, shared.get(parameter).clamp(low, high))
        })
    }

    /// A copy with the law's own parameters.
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
            _ => {}
        }
        self
    }

    /// The law with its own parameters replaced by these.
    pub(crate) fn applied(&self, law: Law) -> Law {
        let stiffer = |materials: Materials| Materials {
            // K is proportional to the combined modulus of both materials
            coin_young_pa: materials.coin_young_pa * self.stiffness,
            surface_young_pa: materials.surface_young_pa * self.stiffness,
            ..materials
        };
        match law {
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
            _ => law,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_flat::{GaekSukhov, HalfSine, Lever};

    /// The stiffness of a contact is proportional to both moduli together, whatever Poisson's ratios are.
    #[test]
    fn stiffness_multiplies_the_modulus_of_both_materials() {
        let given = Materials {
            coin_young_pa: 3e9,
            coin_poisson: 0.35,
            surface_young_pa: 1e10,
            surface_poisson: 0.3,
            length_m: 0.02,
        };
        let stiffer = Materials {
            coin_young_pa: 7.5e9,
            surface_young_pa: 2.5e10,
            ..given
        };
        let laws = |materials| {
            let line = LineContact {
                materials,
                tangential: LineContact::mindlin(0.35),
            };
            let pulse = HalfSine {
                time: PulseTime::Contact(materials),
                peak_n: None,
            };
            [Law::LineContact(line), Law::HalfSine(pulse)]
        };
        let shared = Shared {
            stiffness: 2.5,
            ..Shared::default()
        };
        assert_eq!(laws(given).map(|law| shared.applied(law)), laws(stiffer));
    }

    /// Units of the search: g, the distance d of the rim from the centre and the mass make a momentum, a time and a weight.
    #[test]
    fn units_of_the_search_are_made_of_the_coin_and_gravity() {
        let coin = Coin::cylinder(1.0, 0.02)
            .and_then(|coin| coin.with_mass(0.05))
            .unwrap();
        let d = (0.02_f64 * 0.02 + 0.01 * 0.01).sqrt();
        for (parameter, unit) in [
            (Parameter::Restitution, 1.0),
            (Parameter::Friction, 1.0),
            (Parameter::Stiffness, 1.0),
            (Parameter::Eta, 0.05 * (9.0 * d).sqrt()),
            (Parameter::PulseTime, (d / 9.0).sqrt()),
            (Parameter::Peak, 100.0 * 0.05 * 9.0),
            (Parameter::Floor, d),
        ] {
            let found = parameter.scale(&coin, 9.0);
            assert!((found / unit - 1.0).abs() < 1e-12, "{parameter:?} {found}");
        }
    }

    /// What a search begins with lies within the range, whatever the unit is.
    #[test]
    fn values_that_make_no_sense_are_clamped() {
        let wild = Parameter::ALL
            .into_iter()
            .fold(Shared::default(), |shared, one| shared.with(one, -1e9));
        let clamped = wild.clamped();
        let of = Parameter::ALL.map(|one| clamped.get(one));
        assert_eq!(of, [0.0, 0.0, 0.0, 1e-7, 1e-9, 1e-6, -1e9]);
        let wild = Parameter::ALL
            .into_iter()
            .fold(Shared::default(), |shared, one| shared.with(one, 1e12));
        let clamped = wild.clamped();
        let of = Parameter::ALL.map(|one| clamped.get(one));
        assert_eq!(of, [1.0, 10.0, 1e6, 1.0, 1e9, 1e6, 1e12]);
    }

    /// A law's own numbers are where the fit begins; those that it does not have stay.
    #[test]
    fn a_law_brings_its_own_parameters() {
        let given = Shared {
            eta_n_s: 7.0,
            time_s: 0.25,
            peak_n: 3.0,
            stiffness: 5.0,
            ..Shared::default()
        };
        let own = |law| {
            let shared = given.of(law);
            [
                shared.eta_n_s,
                shared.time_s,
                shared.peak_n,
                shared.stiffness,
            ]
        };
        let pulse = |time, peak_n| Law::HalfSine(HalfSine { time, peak_n });
        assert_eq!(own(Law::Moreau), [7.0, 0.25, 3.0, 1.0]);
        assert_eq!(
            own(pulse(PulseTime::Given(0.5), None)),
            [7.0, 0.5, 3.0, 1.0]
        );
        assert_eq!(
            own(pulse(PulseTime::Given(0.5), Some(9.0))),
            [7.0, 0.5, 9.0, 1.0]
        );
        let law = GaekSukhov {
            eta_n_s: 2.0,
            lever: Lever::Height,
        };
        assert_eq!(own(Law::GaekSukhov(law)), [2.0, 0.25, 3.0, 1.0]);
        // and they go back into the law
        let applied = given.applied(pulse(PulseTime::Given(0.5), Some(9.0)));
        assert_eq!(applied, pulse(PulseTime::Given(0.25), Some(3.0)));
        assert_eq!(
            given.applied(pulse(PulseTime::Given(0.5), None)),
            pulse(PulseTime::Given(0.25), None)
        );
        let applied = given.applied(Law::GaekSukhov(law));
        assert_eq!(
            applied,
            Law::GaekSukhov(GaekSukhov {
                eta_n_s: 7.0,
                lever: Lever::Height
            })
        );
        assert_eq!(given.applied(Law::Moreau), Law::Moreau);
    }

    /// Each law has the parameters that it hangs on, and every law a floor.
    #[test]
    fn laws_have_their_parameters() {
        use Parameter::{Eta, Floor, Friction, Peak, PulseTime as Time, Restitution, Stiffness};
        let materials = Materials {
            coin_young_pa: 3e9,
            coin_poisson: 0.35,
            surface_young_pa: 1e10,
            surface_poisson: 0.3,
            length_m: 0.02,
        };
        let pulse = |time, peak_n| parameters(Law::HalfSine(HalfSine { time, peak_n }));
        let (given, contact) = (PulseTime::Given(1e-3), PulseTime::Contact(materials));
        assert_eq!(parameters(Law::Moreau), [Restitution, Friction, Floor]);
        assert_eq!(pulse(given, None), [Restitution, Friction, Time, Floor]);
        assert_eq!(
            pulse(given, Some(1.0)),
            [Restitution, Friction, Time, Peak, Floor]
        );
        assert_eq!(
            pulse(contact, None),
            [Restitution, Friction, Stiffness, Floor]
        );
        assert_eq!(
            pulse(contact, Some(1.0)),
            [Restitution, Friction, Peak, Stiffness, Floor]
        );
        let law = GaekSukhov {
            eta_n_s: 2.0,
            lever: Lever::Height,
        };
        assert_eq!(parameters(Law::GaekSukhov(law)), [Restitution, Eta, Floor]);
    }
}
