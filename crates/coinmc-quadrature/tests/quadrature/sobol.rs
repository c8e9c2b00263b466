//! The Sobol points.

use crate::common::scrambles;
use coinmc_quadrature::{DIMENSIONS, Sobol};
use std::collections::HashSet;

/// Points of new-joe-kuo-6.21201 as `scipy.stats.qmc.Sobol(10, scramble=False, bits=30)` of SciPy
/// 1.17.1 gives them, times 2^30, by number, on both sides of 2^16.
const PUBLISHED: [(u64, [u64; DIMENSIONS]); 11] = [
    (
        1,
        [
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
            536_870_912,
        ],
    ),
    (
        2,
        [
            805_306_368,
            268_435_456,
            268_435_456,
            268_435_456,
            805_306_368,
            805_306_368,
            268_435_456,
            805_306_368,
            805_306_368,
            805_306_368,
        ],
    ),
    (
        3,
        [
            268_435_456,
            805_306_368,
            805_306_368,
            805_306_368,
            268_435_456,
            268_435_456,
            805_306_368,
            268_435_456,
            268_435_456,
            268_435_456,
        ],
    ),
    (
        5,
        [
            939_524_096,
            939_524_096,
            134_217_728,
            402_653_184,
            939_524_096,
            671_088_640,
            939_524_096,
            402_653_184,
            402_653_184,
            134_217_728,
        ],
    ),
    (
        10,
        [
            1_006_632_960,
            67_108_864,
            738_197_504,
            201_326_592,
            335_544_320,
            603_979_776,
            201_326_592,
            201_326_592,
            201_326_592,
            603_979_776,
        ],
    ),
    (
        100,
        [
            444_596_224,
            276_824_064,
            830_472_192,
            780_140_544,
            947_912_704,
            796_917_760,
            25_165_824,
            511_705_088,
            679_477_248,
            746_586_112,
        ],
    ),
    (
        1000,
        [
            235_929_600,
            103_809_024,
            556_793_856,
            726_663_168,
            300_941_312,
            974_127_104,
            49_283_072,
            965_738_496,
            537_919_488,
            74_448_896,
        ],
    ),
    (
        65_535,
        [
            16_384,
            1_073_725_440,
            605_372_416,
            817_971_200,
            271_499_264,
            586_072_064,
            555_335_680,
            781_336_576,
            961_101_824,
            175_980_544,
        ],
    ),
    (
        65_536,
        [
            24_576,
            536_862_720,
            506_814_464,
            954_376_192,
            412_033_024,
            820_961_280,
            277_340_160,
            672_882_688,
            98_951_168,
            150_200_320,
        ],
    ),
    (
        100_000,
        [
            65_576_960,
            115_515_392,
            1_013_161_984,
            666_591_232,
            650_207_232,
            1_036_886_016,
            65_511_424,
            38_379_520,
            21_897_216,
            826_744_832,
        ],
    ),
    (
        131_071,
        [
            8_192,
            536_879_104,
            975_183_872,
            136_568_832,
            144_826_368,
            301_998_080,
            832_446_464,
            109_649_920,
            1_017_946_112,
            42_901_504,
        ],
    ),
];

#[test]
fn points_agree_with_published_ones() {
    for (number, expected) in PUBLISHED {
        let sobol = Sobol::plain(DIMENSIONS);
        let point = sobol.points(number..number + 1).next().unwrap();
        assert_eq!(point.map(|word| word >> 34), expected, "{number}");
        // and by stepping through the points before
        let walked = sobol.points(number / 2..number + 1).last().unwrap();
        assert_eq!(walked, point);
    }
}

/// Every prefix of 2^k points has one in each of 2^k equal intervals, in every dimension, scrambled
/// or not, up to 2^18.
#[test]
fn every_prefix_is_spread_evenly_in_each_dimension() {
    for sobol in [
        Sobol::plain(DIMENSIONS),
        Sobol::scrambled(DIMENSIONS, &mut scrambles(1).toss(3)),
    ] {
        for k in [1_u32, 4, 10, 18] {
            let mut seen = vec![vec![false; 1 << k]; DIMENSIONS];
            for point in sobol.points(0..1 << k) {
                for (seen, word) in seen.iter_mut().zip(point) {
                    let cell = usize::try_from(word >> (64 - k)).unwrap();
                    assert!(!std::mem::replace(&mut seen[cell], true));
                }
            }
        }
    }
}

/// The first two dimensions are a (0, k, 2)-net: each box of 2^−a by 2^−b, a + b = k, holds one of
/// the first 2^k points. Any other two are a (t, k, 2)-net with t <= 5: each box of 2^(t−k) holds
/// 2^t.
#[test]
fn pairs_of_dimensions_are_nets() {
    const K: u32 = 10;
    let sobol = Sobol::scrambled(DIMENSIONS, &mut scrambles(2).toss(0));
    let points: Vec<_> = sobol.points(0..1 << K).collect();
    for first in 0..DIMENSIONS {
        for second in 0..first {
            let t = if first == 1 { 0 } else { 5 };
            for a in 0..=K - t {
                let b = K - t - a;
                let mut boxes = vec![0; 1 << (K - t)];
                for point in &points {
                    let cell = |word: u64, digits: u32| word.checked_shr(64 - digits).unwrap_or(0);
                    let index = cell(point[first], a) << b | cell(point[second], b);
                    boxes[usize::try_from(index).unwrap()] += 1;
                }
                assert!(boxes.iter().all(|&n| n == 1 << t), "{first} {second} {a}");
            }
        }
    }
}

#[test]
fn points_are_distinct() {
    let sobol = Sobol::scrambled(1, &mut scrambles(5).toss(1));
    let seen: HashSet<u64> = sobol.points(0..1 << 18).map(|point| point[0]).collect();
    assert_eq!(seen.len(), 1 << 18);
}

#[test]
fn scrambles_differ_and_are_reproducible() {
    let first = |seed, replicate| {
        let sobol = Sobol::scrambled(4, &mut scrambles(seed).toss(replicate));
        sobol.points(0..1).next().unwrap()
    };
    let all: HashSet<_> = (0..8)
        .flat_map(|seed| (0..16).map(move |r| first(seed, r)))
        .collect();
    assert_eq!(all.len(), 128);
    assert_eq!(first(1, 1), first(1, 1));
}
