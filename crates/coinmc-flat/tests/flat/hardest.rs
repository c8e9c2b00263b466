//! The tosses out of 1e9 from a huge box of scenes that came closest to an error (`coinmc-studies
//! stability`): largest residual, gain and depth.

use coinmc_core::{Coin, Engine, Launch, Scene, Surface};
use coinmc_flat::{FlatEngine, Lanes, Moreau, Settings};
use coinmc_testkit::{Extremes, batch_outcomes};
use nalgebra::{UnitVector3, Vector3};

/// H/R, R m, e, μ, height m, u_x, u_z, spin rad/s.
const HARDEST: [[f64; 8]; 7] = [
    [
        3.612_064_956_978_947_4,
        0.006_980_883_114_680_167_5,
        1.0,
        1.841_402_970_666_857_8,
        1.490_139_789_324_683_9e-5,
        0.915_151_723_938_093_7,
        0.403_109_565_965_799_3,
        78_434.942_602_359_66,
    ],
    [
        0.225_210_813_440_544_42,
        40.509_132_786_437_31,
        1.0,
        0.444_970_785_609_364_87,
        645.400_977_081_207_7,
        -0.990_223_636_886_355_7,
        0.139_488_884_688_202_78,
        16_101.515_924_453_975,
    ],
    [
        544.584_800_268_503_5,
        10.952_804_837_565_221,
        0.642_774_273_825_840_4,
        0.003_213_981_547_156_951_6,
        0.291_892_961_852_384_5,
        0.987_241_186_008_209,
        -0.159_232_033_991_609_26,
        2_130.250_459_197_224_2,
    ],
    [
        7_146.509_810_562_575,
        45.770_444_179_327_05,
        0.277_483_706_213_977_55,
        0.008_709_866_797_676_625,
        3_659.052_584_442_696,
        -0.785_741_077_921_114_6,
        0.618_555_541_942_164_7,
        -52_079.288_847_444_88,
    ],
    [
        1.532_232_462_260_490_1,
        0.293_231_230_791_462_74,
        1.0,
        0.0,
        0.171_467_162_124_944_67,
        -0.775_415_091_618_103_6,
        0.631_451_847_483_944_5,
        87_737.710_729_492_36,
    ],
    [
        0.000_144_244_234_318_934_2,
        4.284_617_700_626_470_5e-6,
        0.620_788_125_415_238_1,
        1.981_806_793_597_114_2,
        2.397_394_130_642_973e-7,
        0.999_409_126_057_581_1,
        0.034_371_481_679_174_046,
        -354.258_799_051_725_76,
    ],
    [
        1_488.919_382_144_217_5,
        18.679_232_111_475_745,
        1.0,
        0.676_375_141_313_717_8,
        1.861_604_889_975_336_4,
        -0.866_558_903_826_935_7,
        0.499_074_810_222_134_57,
        37_891.742_070_363_1,
    ],
];

fn scene_and_launch(numbers: &[f64; 8]) -> (Scene, Launch) {
    let [ratio, radius, e, mu, height_m, x, z, spin] = *numbers;
    let coin = Coin::cylinder(ratio, radius).expect("a good coin");
    let surface = Surface::new(e, mu).expect("a good surface");
    let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("good gravity");
    let launch = Launch {
        height_m,
        velocity_m_s: Vector3::zeros(),
        axis: UnitVector3::new_unchecked(Vector3::new(x, 0.0, z)),
        spin_rad_s: Vector3::new(0.0, spin, 0.0),
    };
    (scene, launch)
}

/// A phase ωt of up to 1e6 radians per unit of time and a height of up to 1e6 D have a relative
/// error of about eight roundings of ε, from ω, t, the velocity and their products. The energy has
/// no such error.
#[test]
fn the_hardest_tosses_gain_no_energy_and_touch_the_surface() {
    for numbers in &HARDEST {
        let (scene, launch) = scene_and_launch(numbers);
        let settings = Settings {
            max_impacts: 300,
            ..Settings::default()
        };
        let engine = FlatEngine::new(&scene, &settings, Moreau).expect("good settings");
        let mut worst = Extremes::new(&scene);
        let expected = engine.toss(&mut (), &launch, &mut worst);
        assert!(worst.gain < 1e-14, "{numbers:?}: {:e}", worst.gain);
        assert!(worst.gap_in_roundings < 8.0, "{numbers:?}: {worst:?}");
        for lanes in Lanes::ALL {
            let Ok(engine) = engine.clone().with_lanes(lanes) else {
                continue;
            };
            let outcomes = batch_outcomes(&engine, &[launch; 9]);
            assert_eq!(outcomes, [expected; 9], "{lanes} {numbers:?}");
        }
    }
}
