//! The methods, and which of them a scene has.

use crate::axis::axial_factor;
use crate::conditional::Conditional;
use crate::passage::Passage;
use crate::sobol::DIMENSIONS;
use crate::variable::{Variable, planar_tilt, upright, variable, without};
use coinmc_core::{Landing, LaunchDistribution, Marginal, Orientation, Scene, Spin, UniformSource};
use std::f64::consts::TAU;

/// The launch dimension of an isotropic axis's azimuth.
const AZIMUTH: u32 = 1;

/// The largest number of random dimensions of a launch for which tosses at Sobol points beat random
/// tosses. The face is a step function of them, and the gain for a step falls with the dimensions
/// (measured in docs/methods/sampling.md: about 30 fold with two that matter, at most 5 fold with
/// four).
const MAX_TOSSED_DIMENSIONS: usize = 3;

/// How the probabilities of an adhesive scene are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// The zone rule: the axis is isotropic when the centre passes D. Exact.
    Zone,
    /// The arc rule: the tilt is uniform over whole turns when the centre passes D. Exact.
    Arc,
    /// One quantity is integrated out in closed form, the others by Sobol points.
    Over(Variable),
    /// Tosses at Sobol points.
    Tossed,
}

impl Method {
    /// Every method.
    pub const ALL: [Self; 8] = [
        Self::Zone,
        Self::Arc,
        Self::Over(Variable::Azimuth),
        Self::Over(Variable::Tilt),
        Self::Over(Variable::Rate),
        Self::Over(Variable::Velocity),
        Self::Over(Variable::Height),
        Self::Tossed,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Zone => "zone",
            Self::Arc => "arc",
            Self::Over(Variable::Azimuth) => "over-azimuth",
            Self::Over(Variable::Tilt) => "over-tilt",
            Self::Over(Variable::Rate) => "over-rate",
            Self::Over(Variable::Velocity) => "over-velocity",
            Self::Over(Variable::Height) => "over-height",
            Self::Tossed => "tossed",
        }
    }

    /// The number of launch dimensions that Sobol points integrate; with 0 the result is exact.
    pub fn dimensions_left(self, launches: &LaunchDistribution) -> usize {
        self.dimensions(launches).len()
    }

    /// The best method for a scene; `None` where random tosses are as good, as for every coin that
    /// bounces. `time_limit_s` is the simulated time, s, at which the engine gives up a toss.
    pub fn of(scene: &Scene, launches: &LaunchDistribution, time_limit_s: f64) -> Option<Self> {
        let table = scene.surface.table_radius_m();
        if scene.surface.landing() != Landing::Adhesive
            || scene.coin.rim_radius_m() > 0.0
            || !scene.coin.has_like_faces()
            || table.is_some()
        {
            return None;
        }
        let tossed = Self::Tossed.dimensions_left(launches) <= MAX_TOSSED_DIMENSIONS;
        let tossed = tossed.then_some(Self::Tossed);
        let passage = Passage::new(scene);
        if time_limit_s != f64::INFINITY && !passage.ends_before(time_limit_s, launches) {
            // tosses without a face have to be counted by reason
            return None;
        }
        if !passage.is_always_reached(launches) {
            return tossed;
        }
        if is_rotation_invariant(scene, launches) {
            return Some(Self::Zone);
        }
        if is_whole_turns(launches) {
            return Some(Self::Arc);
        }
        let Some(variable) = variable(launches) else {
            return tossed;
        };
        let over = Self::Over(variable);
        let last = over.dimensions_left(launches) == 0;
        if last && !Conditional::new(scene, launches, variable).is_integrable() {
            // the quantity would be drawn, and nothing would be left to integrate over
            return tossed;
        }
        Some(over)
    }

    /// The launch dimensions that Sobol points integrate.
    pub(crate) fn dimensions(self, launches: &LaunchDistribution) -> Vec<u32> {
        match self {
            Self::Zone | Self::Arc => vec![],
            Self::Over(variable) => {
                let mut used = dimensions_used(&without(launches, variable));
                // an isotropic axis takes its height on the sphere from the dimension before
                used.retain(|&dimension| variable != Variable::Azimuth || dimension != AZIMUTH);
                used
            }
            Self::Tossed => dimensions_used(&upright(launches)),
        }
    }
}

/// Whether the joint distribution of axis and spin is invariant under rotation, or the coin turns
/// by a rotation that does not depend on its isotropic axis: in both cases the axis is isotropic at
/// any time.
fn is_rotation_invariant(scene: &Scene, launches: &LaunchDistribution) -> bool {
    if launches.orientation != Orientation::Isotropic {
        return false;
    }
    match &launches.spin {
        // at a uniform azimuth about the axis
        Spin::Precessing { .. } => true,
        Spin::About { rate_rad_s, .. } => {
            axial_factor(scene) == 1.0 || *rate_rad_s == Marginal::Constant(0.0)
        }
        Spin::Components(components) => axial_factor(scene) == 1.0 || is_isotropic(components),
    }
}

/// Whether a vector of these components is isotropic: equal normal components about 0 (no other
/// independent ones are: Maxwell 1860), or zero.
fn is_isotropic(components: &[Marginal; 3]) -> bool {
    let [x, y, z] = components;
    let centred = match x {
        Marginal::Constant(value) => *value == 0.0,
        Marginal::Normal { mean, .. } => *mean == 0.0,
        Marginal::Uniform { .. } => false,
    };
    centred && x == y && y == z
}

/// Whether the coin turns in the plane from a tilt that is uniform over whole turns.
fn is_whole_turns(launches: &LaunchDistribution) -> bool {
    // 360 degrees are a whole turn to rounding
    const ROUNDING: f64 = 1e-13;
    let Some(Marginal::Uniform { from, to }) = planar_tilt(launches) else {
        return false;
    };
    let turns = (to - from) / TAU;
    turns >= 1.0 - ROUNDING && (turns - turns.round()).abs() <= ROUNDING * turns
}

/// The dimensions that launches of a distribution use.
fn dimensions_used(launches: &LaunchDistribution) -> Vec<u32> {
    struct Recorder(Vec<u32>);
    impl UniformSource for Recorder {
        fn uniform(&mut self, dimension: u32) -> f64 {
            self.0.push(dimension);
            0.5
        }
    }
    // the dimensions do not depend on the coin
    let coin = coinmc_core::Coin::cylinder(1.0, 1.0).expect("a coin");
    let mut used = Recorder(vec![]);
    launches.launch(&coin, &mut used);
    assert!(used.0.len() <= DIMENSIONS);
    used.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Preset, Surface};
    use nalgebra::Vector3;

    fn scene() -> Scene {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let surface = Surface::new(0.0, 0.0).unwrap();
        Scene::new(
            coin,
            surface
                .with_landing(Landing::Adhesive)
                .expect("a level surface"),
            9.81,
        )
        .unwrap()
    }

    fn of(launches: &LaunchDistribution) -> Option<Method> {
        Method::of(&scene(), launches, f64::INFINITY)
    }

    #[test]
    fn every_preset_has_the_expected_method() {
        let expected = [
            (Preset::Robot, Method::Over(Variable::Tilt), 1),
            (Preset::Table1, Method::Over(Variable::Velocity), 6),
            (Preset::Clean, Method::Zone, 0),
            (Preset::CleanFlat, Method::Arc, 0),
            (Preset::Hand, Method::Over(Variable::Rate), 3),
            (Preset::Drop, Method::Zone, 0),
        ];
        let mut bounces = scene();
        bounces.surface = bounces
            .surface
            .with_landing(Landing::Bouncing)
            .expect("a level surface");
        for (preset, method, left) in expected {
            let launches = preset.distribution();
            assert_eq!(of(&launches), Some(method), "{preset}");
            assert_eq!(Method::of(&bounces, &launches, f64::INFINITY), None);
            assert_eq!(method.dimensions(&launches).len(), left, "{preset}");
        }
    }

    #[test]
    fn an_anisotropic_spin_is_not_the_zone_rule() {
        let clean = Preset::Clean.distribution();
        let normal = |mean, sd| Marginal::Normal { mean, sd };
        let spins = [
            [normal(0.0, 20.0), normal(0.0, 20.0), normal(0.0, 19.0)],
            [normal(1.0, 20.0), normal(1.0, 20.0), normal(1.0, 20.0)],
            [Marginal::Uniform {
                from: -1.0,
                to: 1.0,
            }; 3],
            [Marginal::Constant(1.0); 3],
        ];
        for spin in spins {
            let launches = LaunchDistribution {
                spin: Spin::Components(spin),
                ..clean
            };
            assert_eq!(of(&launches), Some(Method::Over(Variable::Azimuth)));
            // without gyroscopic torque every one of them is isotropic
            let fixed = scene().with_gyroscopic_torque(false);
            assert_eq!(
                Method::of(&fixed, &launches, f64::INFINITY),
                Some(Method::Zone)
            );
        }
        let about = Spin::About {
            axis: Vector3::x_axis(),
            rate_rad_s: normal(0.0, 1.0),
        };
        let launches = LaunchDistribution {
            spin: about,
            ..clean
        };
        assert_eq!(of(&launches), Some(Method::Over(Variable::Azimuth)));
    }

    #[test]
    fn low_launches_are_tossed_and_short_time_limits_have_no_method() {
        let mut launches = Preset::Robot.distribution();
        assert_eq!(Method::of(&scene(), &launches, 0.1), None);
        launches.height_m = Marginal::Uniform {
            from: 0.011,
            to: 0.5,
        };
        assert_eq!(of(&launches), Some(Method::Tossed)); // D = 11.2 mm
        launches.height_m = Marginal::Uniform {
            from: 0.012,
            to: 0.5,
        };
        assert_eq!(of(&launches), Some(Method::Over(Variable::Tilt)));
        // a coin whose centre passes D within the limit, but that does not touch
        let slow = LaunchDistribution {
            height_m: Marginal::Constant(0.012),
            velocity_m_s: [Marginal::Constant(0.0); 3],
            ..launches
        };
        assert_eq!(
            Method::of(&scene(), &slow, 0.03),
            None,
            "D after 13 ms, the ground after 49 ms"
        );
        // a step function of seven random numbers
        let low = LaunchDistribution {
            height_m: Marginal::Constant(0.001),
            ..Preset::Table1.distribution()
        };
        assert_eq!(of(&low), None);
    }

    /// A single random quantity that spreads the phase over too many turns cannot be integrated
    /// out.
    #[test]
    fn a_quantity_of_many_turns_is_tossed() {
        let uniform = |from, to| Marginal::Uniform { from, to };
        let still = [Marginal::Constant(0.0); 3];
        let of = |rate_rad_s, height_m, up| {
            let mut velocity_m_s = still;
            velocity_m_s[2] = up;
            of(&LaunchDistribution {
                height_m,
                velocity_m_s,
                orientation: Orientation::Tilt(Marginal::Constant(0.3)),
                spin: Spin::About {
                    axis: Vector3::y_axis(),
                    rate_rad_s,
                },
            })
        };
        let (one, none) = (Marginal::Constant(1.0), Marginal::Constant(0.0));
        for (rate, over) in [(1e2, true), (1e5, false)] {
            let fixed = Marginal::Constant(rate);
            for (method, variable) in [
                (of(uniform(-rate, rate), one, none), Variable::Rate),
                (of(fixed, uniform(1.0, 2.0), none), Variable::Height),
                (of(fixed, one, uniform(0.0, 1.0)), Variable::Velocity),
            ] {
                let expected = if over {
                    Method::Over(variable)
                } else {
                    Method::Tossed
                };
                assert_eq!(method, Some(expected), "{rate} {variable:?}");
            }
        }
    }

    #[test]
    fn half_turns_are_not_whole_turns() {
        let mut launches = Preset::CleanFlat.distribution();
        for (turns, whole) in [(0.5, false), (1.0, true), (1.5, false), (3.0, true)] {
            let to = 1.0 + turns * TAU;
            launches.orientation = Orientation::Tilt(Marginal::Uniform { from: 1.0, to });
            assert_eq!(of(&launches) == Some(Method::Arc), whole, "{turns}");
        }
    }

    #[test]
    fn names_are_those_of_files() {
        let names = [
            "zone",
            "arc",
            "over-azimuth",
            "over-tilt",
            "over-rate",
            "over-velocity",
            "over-height",
            "tossed",
        ];
        assert_eq!(Method::ALL.map(Method::name), names);
    }

    /// Over the azimuth nothing but that dimension goes: the height of an isotropic axis stays.
    #[test]
    fn the_azimuth_is_the_dimension_that_is_integrated() {
        let mut launches = Preset::Clean.distribution();
        launches.spin = Spin::Components(
            [Marginal::Uniform {
                from: -1.0,
                to: 1.0,
            }; 3],
        );
        let mut expected = dimensions_used(&launches);
        expected.retain(|dimension| *dimension != 1);
        assert_eq!(expected[0], 0);
        let over = Method::Over(Variable::Azimuth);
        assert_eq!(over.dimensions(&launches), expected);
        assert_eq!(over.dimensions_left(&launches), expected.len());
    }

    /// A coin that does not turn keeps its isotropic axis, whatever its moments are.
    #[test]
    fn no_spin_is_the_zone_rule() {
        let mut launches = Preset::Clean.distribution();
        launches.spin = Spin::About {
            axis: Vector3::x_axis(),
            rate_rad_s: Marginal::Constant(0.0),
        };
        assert_eq!(of(&launches), Some(Method::Zone));
    }

    /// Millions of turns from any tilt are whole ones to rounding.
    #[test]
    fn rounding_of_many_turns_is_forgiven() {
        let mut launches = Preset::CleanFlat.distribution();
        for turns in [1.0, 7.0, 3000.0, 12_345_678.0] {
            for from in (0..100).map(|i| 0.137 * f64::from(i) - 5.0) {
                let to = from + turns * TAU;
                launches.orientation = Orientation::Tilt(Marginal::Uniform { from, to });
                assert_eq!(of(&launches), Some(Method::Arc), "{from} {turns}");
            }
        }
    }

    /// A rounded rim touches before D is passed, and a limit of time matters where a toss may reach it.
    #[test]
    fn rounded_rims_and_short_limits_have_no_closed_form() {
        let launches = Preset::CleanFlat.distribution();
        assert_eq!(Method::of(&scene(), &launches, 1e3), Some(Method::Arc));
        assert_eq!(Method::of(&scene(), &launches, 1e-3), None);
        let mut rounded = scene();
        rounded.coin = rounded.coin.with_rim_radius(1e-3).unwrap();
        assert_eq!(Method::of(&rounded, &launches, f64::INFINITY), None);
    }
}
