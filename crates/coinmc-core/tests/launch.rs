//! Launch distributions: what comes out has the distribution asked for.

use coinmc_core::{
    Coin, Domain, Lanes, Launch, LaunchDistribution, Marginal, Orientation, Preset, Spin, Stream,
    UniformSource,
};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const N: u64 = 100_000;
/// Kolmogorov's limit for D·sqrt(n) at a false-alarm rate of 1e-6 a test: sqrt(ln(2e6)/2).
const KOLMOGOROV: f64 = 2.694;

fn launches(distribution: &LaunchDistribution, coin: &Coin) -> Vec<Launch> {
    distribution.validate().unwrap();
    let stream = Stream::new(11, Domain::Launch, 3);
    (0..N)
        .map(|toss| distribution.launch(coin, &mut stream.toss(toss)))
        .collect()
}

/// Kolmogorov–Smirnov distance of the sample from a CDF, times sqrt(n).
fn distance(mut sample: Vec<f64>, cdf: impl Fn(f64) -> f64) -> f64 {
    sample.sort_by(f64::total_cmp);
    let n = sample.len() as f64;
    let worst = sample
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let p = cdf(*x);
            (p - i as f64 / n).abs().max(((i + 1) as f64 / n - p).abs())
        })
        .fold(0.0, f64::max);
    worst * n.sqrt()
}

fn coin() -> Coin {
    Coin::cylinder(1.5, 0.01).unwrap()
}

fn with(orientation: Orientation, spin: Spin) -> LaunchDistribution {
    LaunchDistribution {
        height_m: Marginal::Normal { mean: 1.0, sd: 0.1 },
        velocity_m_s: [
            Marginal::Constant(0.25),
            Marginal::Constant(0.0),
            Marginal::Uniform { from: 1.0, to: 2.0 },
        ],
        orientation,
        spin,
    }
}

fn at_rest() -> Spin {
    Spin::Components([Marginal::Constant(0.0); 3])
}

/// Each number of a launch, alone, may be no distribution.
#[test]
fn a_distribution_with_any_bad_part_is_refused() {
    let (bad, good) = (Marginal::Constant(f64::NAN), Marginal::Constant(1.0));
    let axis = Vector3::y_axis();
    let sound = with(Orientation::Tilt(good), at_rest());
    sound.validate().unwrap();
    let mut refused = vec![
        LaunchDistribution {
            height_m: bad,
            ..sound
        },
        LaunchDistribution {
            orientation: Orientation::Tilt(bad),
            ..sound
        },
    ];
    for i in 0..3 {
        let mut velocity_m_s = [good; 3];
        velocity_m_s[i] = bad;
        refused.push(LaunchDistribution {
            velocity_m_s,
            ..sound
        });
    }
    let precessing = |rate_rad_s, psi_rad| Spin::Precessing {
        rate_rad_s,
        psi_rad,
    };
    for spin in [
        Spin::Components([good, good, bad]),
        Spin::About {
            axis,
            rate_rad_s: bad,
        },
        precessing(bad, good),
        precessing(good, bad),
    ] {
        refused.push(LaunchDistribution { spin, ..sound });
    }
    for (number, distribution) in refused.iter().enumerate() {
        assert!(
            distribution.validate().is_err(),
            "{number}: {distribution:?}"
        );
    }
}

/// A distribution calls itself planar where all of its launches stay in the xz plane, and only there.
#[test]
fn planar_are_those_whose_launches_stay_in_the_plane() {
    let (none, some) = (Marginal::Constant(0.0), Marginal::Constant(1.5));
    let unit = |x, y, z| UnitVector3::new_normalize(Vector3::new(x, y, z));
    let orientations = [
        Orientation::Fixed(unit(0.6, 0.0, 0.8)),
        Orientation::Fixed(unit(0.6, 0.1, 0.8)),
        Orientation::Isotropic,
        Orientation::EulerAngles,
        Orientation::Tilt(some),
    ];
    let about = |axis| Spin::About {
        axis,
        rate_rad_s: some,
    };
    let spins = [
        Spin::Components([none, some, none]),
        Spin::Components([some, none, none]),
        Spin::Components([none, none, some]),
        about(unit(0.0, 1.0, 0.0)),
        about(unit(1.0, 1.0, 0.0)),
        about(unit(0.0, 1.0, 1.0)),
        Spin::Precessing {
            rate_rad_s: some,
            psi_rad: some,
        },
    ];
    let stream = Stream::new(12, Domain::Launch, 3);
    for orientation in orientations {
        for spin in spins {
            for vy in [none, some] {
                let distribution = LaunchDistribution {
                    velocity_m_s: [some, vy, some],
                    ..with(orientation, spin)
                };
                let stays = (0..20).all(|toss| {
                    let launch = distribution.launch(&coin(), &mut stream.toss(toss));
                    let (v, u, w) = (launch.velocity_m_s, launch.axis, launch.spin_rad_s);
                    [v.y, u.y, w.x, w.z] == [0.0; 4]
                });
                assert_eq!(distribution.is_planar(), stays, "{distribution:?}");
            }
        }
    }
}

#[test]
fn marginals_follow_their_distributions() {
    let all = launches(&with(Orientation::Isotropic, at_rest()), &coin());
    let heights = all.iter().map(|l| l.height_m).collect();
    let normal = |x: f64| 0.5 * libm::erfc((1.0 - x) / 0.1 / std::f64::consts::SQRT_2);
    assert!(distance(heights, normal) < KOLMOGOROV);
    let speeds = all.iter().map(|l| l.velocity_m_s.z).collect();
    assert!(distance(speeds, |v| v - 1.0) < KOLMOGOROV);
    assert!(
        all.iter()
            .all(|l| l.velocity_m_s.x == 0.25 && l.spin_rad_s == Vector3::zeros())
    );
}

#[test]
fn isotropic_axes_are_uniform_on_the_sphere() {
    let all = launches(&with(Orientation::Isotropic, at_rest()), &coin());
    for i in 0..3 {
        // Archimedes: every component is uniform in (−1, 1)
        let component = all.iter().map(|l| l.axis[i]).collect();
        assert!(
            distance(component, |c| f64::midpoint(c, 1.0)) < KOLMOGOROV,
            "component {i}"
        );
    }
    assert!(all.iter().all(|l| (l.axis.norm() - 1.0).abs() < 4e-16));
}

#[test]
fn euler_angles_are_not_isotropic_but_follow_their_own_law() {
    let all = launches(&with(Orientation::EulerAngles, at_rest()), &coin());
    let vertical: Vec<f64> = all.iter().map(|l| l.axis.z).collect();
    assert!(distance(vertical.clone(), |c| f64::midpoint(c, 1.0)) > 5.0 * KOLMOGOROV);
    // u_z = cos a cos b: E u_z² = 1/4 (1/3 if isotropic), E u_z⁴ = 9/64
    let mean = |power: i32| vertical.iter().map(|z| z.powi(power)).sum::<f64>() / N as f64;
    // sd of z² is sqrt(9/64 − 1/16) = 0.28: 5 sd of the mean = 0.0044
    assert!((mean(2) - 0.25).abs() < 0.0045 && mean(1).abs() < 0.008);
    let azimuth = all
        .iter()
        .map(|l| libm::atan2(l.axis.y, l.axis.x))
        .collect();
    assert!(distance(azimuth, |a| (a + PI) / TAU) < KOLMOGOROV);
    assert!(all.iter().all(|l| (l.axis.norm() - 1.0).abs() < 1e-15));
}

#[test]
fn the_robot_throws_as_published() {
    let all = launches(&Preset::Robot.distribution(), &coin());
    let tilt = all
        .iter()
        .map(|l| libm::atan2(l.axis.x, l.axis.z))
        .collect();
    assert!(distance(tilt, |angle| angle / PI) < KOLMOGOROV);
    let spin = all.iter().map(|l| l.spin_rad_s.y).collect();
    assert!(distance(spin, |w| w / (5.0 * TAU)) < KOLMOGOROV);
    assert!(
        all.iter()
            .all(|l| l.axis.y == 0.0 && l.spin_rad_s.x == 0.0 && l.spin_rad_s.z == 0.0)
    );
}

/// The angular momentum makes the angle ψ with the axis, has the stated size, any azimuth.
#[test]
fn precession_has_the_angle_asked_for() {
    let coin = coin();
    let spin = Spin::Precessing {
        rate_rad_s: Marginal::Constant(30.0),
        psi_rad: Marginal::Uniform {
            from: 0.3,
            to: FRAC_PI_2,
        },
    };
    let (axial, transverse) = (coin.axial_gyration_m2(), coin.transverse_gyration_m2());
    let mut psis = Vec::new();
    let mut azimuths = Vec::new();
    for launch in launches(&with(Orientation::Isotropic, spin), &coin) {
        let along = launch.spin_rad_s.dot(&launch.axis);
        let across = launch.spin_rad_s - launch.axis.into_inner() * along;
        let momentum = launch.axis.into_inner() * (axial * along) + across * transverse;
        assert!((momentum.norm() / transverse - 30.0).abs() < 1e-12 * 30.0);
        psis.push(momentum.angle(&launch.axis));
        let horizontal = launch.axis.cross(&Vector3::z()).normalize();
        let third = launch.axis.cross(&horizontal);
        azimuths.push(libm::atan2(across.dot(&third), across.dot(&horizontal)));
    }
    assert!(distance(psis, |psi| (psi - 0.3) / (FRAC_PI_2 - 0.3)) < KOLMOGOROV);
    assert!(distance(azimuths, |a| (a + PI) / TAU) < KOLMOGOROV);
}

/// Each quantity owns its dimensions: making one random leaves the draws of the others alone.
#[test]
fn distributions_that_differ_in_one_quantity_share_the_others() {
    let fixed = Preset::CleanFlat.distribution();
    let varied = LaunchDistribution {
        height_m: Marginal::Uniform { from: 0.5, to: 1.5 },
        ..fixed
    };
    for (a, b) in launches(&fixed, &coin())
        .iter()
        .zip(launches(&varied, &coin()))
    {
        assert_eq!((a.axis, a.spin_rad_s), (b.axis, b.spin_rad_s));
    }
}

#[test]
fn every_preset_is_valid_and_found_by_its_name() {
    for preset in Preset::ALL {
        assert_eq!(preset.name().parse(), Ok(preset));
        preset.distribution().validate().unwrap();
    }
    assert!("robots".parse::<Preset>().is_err());
}

#[test]
fn every_preset_cites_its_paper_or_says_that_it_is_ours() {
    for preset in Preset::ALL {
        let cited = match preset {
            Preset::Robot | Preset::Table1 => "arXiv 2401.03557",
            Preset::Hand => "Amer. Math. Monthly 93",
            Preset::Clean | Preset::CleanFlat | Preset::Drop => "Ours",
        };
        assert!(preset.source().contains(cited), "{preset}");
    }
}

/// 3.5 rad/s about an axis with three different components.
#[test]
fn a_spin_about_an_axis_is_its_rate_along_the_axis() {
    let axis = UnitVector3::new_normalize(Vector3::new(1.0, -2.0, 3.0));
    let spin = Spin::About {
        axis,
        rate_rad_s: Marginal::Constant(3.5),
    };
    let stream = Stream::new(11, Domain::Launch, 3);
    let omega = spin.angular_velocity(&coin(), &Vector3::z_axis(), &mut stream.toss(0));
    assert_eq!(omega, 3.5 * *axis);
}

/// The axis may point anywhere, the poles included, and stay orthogonal to what completes it.
#[test]
fn precession_about_any_axis_keeps_its_rate() {
    struct Zeros;
    impl UniformSource for Zeros {
        fn uniform(&mut self, _: u32) -> f64 {
            0.25
        }
    }
    let coin = coin();
    let spin = Spin::Precessing {
        rate_rad_s: Marginal::Constant(1.0),
        psi_rad: Marginal::Constant(FRAC_PI_2),
    };
    for axis in [
        Vector3::z_axis(),
        -Vector3::z_axis(),
        Vector3::x_axis(),
        -Vector3::y_axis(),
    ] {
        let omega = spin.angular_velocity(&coin, &axis, &mut Zeros);
        assert!((omega.norm() - 1.0).abs() < 1e-15 && omega.dot(&axis).abs() < 1e-15);
    }
}

/// All numbers of a launch, to the bit.
fn bits(launch: &Launch) -> Vec<u64> {
    let vectors = [launch.velocity_m_s, *launch.axis, launch.spin_rad_s];
    let numbers = vectors.iter().flat_map(|vector| vector.iter());
    let numbers = numbers.chain([&launch.height_m]);
    numbers.map(|number| number.to_bits()).collect()
}

/// Every kind of orientation with every kind of spin, and the presets.
fn distributions() -> Vec<LaunchDistribution> {
    let uniform = |from, to| Marginal::Uniform { from, to };
    let normal = Marginal::Normal {
        mean: 0.3,
        sd: 20.0,
    };
    let axis = UnitVector3::new_normalize(Vector3::new(0.3, -0.2, 0.7));
    let orientations = [
        Orientation::Fixed(axis),
        Orientation::Isotropic,
        Orientation::EulerAngles,
        Orientation::Tilt(uniform(-9.0, 12.0)),
        Orientation::Tilt(normal),
    ];
    let spins = [
        at_rest(),
        Spin::Components([normal, uniform(-3.0, 3.0), Marginal::Constant(1.0)]),
        Spin::About {
            axis,
            rate_rad_s: normal,
        },
        Spin::Precessing {
            rate_rad_s: normal,
            psi_rad: uniform(0.0, PI),
        },
    ];
    let each = |orientation| spins.map(|spin| with(orientation, spin));
    let presets = Preset::ALL.map(Preset::distribution);
    orientations
        .into_iter()
        .flat_map(each)
        .chain(presets)
        .collect()
}

#[test]
fn launches_know_how_many_are_left() {
    let stream = Stream::new(11, Domain::Launch, 3);
    let mut launches =
        Preset::Clean
            .distribution()
            .launches(&coin(), &stream, 3..21, Lanes::Scalar);
    for left in (0..=18).rev() {
        assert_eq!(launches.size_hint(), (left, Some(left)));
        assert_eq!(launches.next().is_some(), left > 0);
    }
}

#[test]
fn launches_in_lanes_are_bit_identical_to_the_scalar_path() {
    let coin = coin();
    let stream = Stream::new(11, Domain::Launch, 3);
    for distribution in distributions() {
        // of any number of tosses from any on, and up to the last there is
        for tosses in [0..2000, 3..21, 8..9, u64::MAX - 5..u64::MAX, 7..7] {
            for lanes in Lanes::ALL.into_iter().filter(|lanes| lanes.is_available()) {
                let mut many = distribution.launches(&coin, &stream, tosses.clone(), lanes);
                for toss in tosses.clone() {
                    let alone = distribution.launch(&coin, &mut stream.toss(toss));
                    let beside = many.next().expect("as many launches as tosses");
                    assert_eq!(
                        bits(&beside),
                        bits(&alone),
                        "{lanes} {toss} {distribution:?}"
                    );
                }
                assert_eq!(many.next(), None);
            }
        }
    }
}
