//! Sine and cosine in lanes, bit-identical to libm.
//!
//! Launches are drawn with libm's functions, and the bits of a launch never change. The kernels'
//! own function ([`coinmc_lanes::sin_cos`]) rounds differently.

use coinmc_lanes::{COSINE, Lane, Mask, SINE};

/// (sin x, cos x), x in rad, bit-identical to `libm::sincos`.
#[inline(always)]
pub(super) fn sin_cos<L: Lane>(x: L) -> (L, L) {
    if L::COUNT == 1 {
        let (sin, cos) = libm::sincos(x.lane(0));
        return (L::splat(sin), L::splat(cos));
    }
    let size = x.abs();
    let (quadrant, usual) = quadrant(size);
    let (sin, cos) = reduced(size, quadrant);
    let negative = x.lt(L::splat(0.0));
    let sin = L::select(negative, -sin, sin);
    if !(!usual).any() {
        return (sin, cos);
    }
    let (of_one, cos_of_one) = (
        x.map_where(!usual, |x| libm::sincos(x).0),
        x.map_where(!usual, |x| libm::sincos(x).1),
    );
    (
        L::select(usual, sin, of_one),
        L::select(usual, cos, cos_of_one),
    )
}

/// The number with this high word and low word 0: libm compares high words.
const fn word(higher: u64) -> f64 {
    f64::from_bits(higher << 32)
}

/// Where libm starts to subtract the next multiple of π/2: just above π/4, 3π/4, 5π/4 and 7π/4.
const ENDS: [f64; 4] = [
    word(0x3fe9_21fc),
    word(0x4002_d97d),
    word(0x400f_6a7b),
    word(0x4015_fdbd),
];
/// High words of π/2, π, 3π/2 and 2π, near which libm subtracts them with more digits.
const MULTIPLES: [u64; 4] = [0x3ff9_21fb, 0x4009_21fb, 0x4012_d97c, 0x4019_21fb];
/// Below this, the sine equals its argument.
const TINY: f64 = word(0x3e46_a09e);
/// Just above 9π/4, where libm starts to divide.
const LAST: f64 = word(0x401c_463c);

/// How many times π/2 is subtracted, 0 to 4, and whether libm does exactly that.
#[inline(always)]
fn quadrant<L: Lane>(size: L) -> (L, L::Mask) {
    let (one, mut quadrant) = (L::splat(1.0), L::splat(0.0));
    for end in ENDS {
        let beyond = L::splat(end).le(size);
        quadrant = L::select(beyond, quadrant + one, quadrant);
    }
    let mut usual = L::splat(TINY).le(size) & size.lt(L::splat(LAST));
    for multiple in MULTIPLES {
        let (from, to) = (L::splat(word(multiple)), L::splat(word(multiple + 1)));
        usual = usual & !(from.le(size) & size.lt(to));
    }
    (quadrant, usual)
}

/// Sine and cosine of a number, 0 or more, from which `quadrant` times π/2 is subtracted: FreeBSD's
/// msun, `e_rem_pio2.c`, `k_sin.c` and `k_cos.c` (Sun Microsystems 1993), operation by operation.
#[inline(always)]
fn reduced<L: Lane>(size: L, quadrant: L) -> (L, L) {
    /// The first 33 bits of π/2, and the rest.
    const HEAD: f64 = 1.570_796_326_734_125_6;
    const TAIL: f64 = 6.077_100_506_506_192e-11;
    let k = L::splat;
    let tail = quadrant * k(TAIL);
    let rough = size - quadrant * k(HEAD);
    let y = rough - tail;
    let rest = (rough - y) - tail;

    let (z, [s1, s2, s3, s4, s5, s6]) = (y * y, SINE);
    let w = z * z;
    let r = k(s2) + z * (k(s3) + z * k(s4)) + z * w * (k(s5) + z * k(s6));
    let v = z * y;
    let whole = y + v * (k(s1) + z * r);
    let with_rest = y - ((z * (k(0.5) * rest - v * r) - rest) - v * k(s1));
    let sin = L::select(quadrant.lt(k(1.0)), whole, with_rest);

    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let r = z * (k(c1) + z * (k(c2) + z * k(c3))) + w * w * (k(c4) + z * (k(c5) + z * k(c6)));
    let half = k(0.5) * z;
    let head = k(1.0) - half;
    let cos = head + (((k(1.0) - head) - half) + (z * r - y * rest));

    let (one, two, three) = (k(1.0), k(2.0), k(3.0));
    let above = [one.le(quadrant), two.le(quadrant), three.le(quadrant)];
    let full = k(4.0).le(quadrant);
    // 1: (c, −s), 2: (−s, −c), 3: (−c, s), 4: (s, c)
    let swapped = (above[0] & !above[1]) | (above[2] & !full);
    let sine_turns = above[1] & !full;
    let cosine_turns = above[0] & !above[2];
    let (first, second) = (L::select(swapped, cos, sin), L::select(swapped, sin, cos));
    (
        L::select(sine_turns, -first, first),
        L::select(cosine_turns, -second, second),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Stream, UniformSource};
    use coinmc_lanes::{Block, Lanes, WIDTH, Wide, Work};
    use std::f64::consts::{FRAC_PI_4, PI, TAU};

    struct Both(Block);

    impl Work for Both {
        type Output = [Block; 2];

        #[inline(always)]
        fn run<L: Wide>(self) -> [Block; 2] {
            let (sin, cos) = sin_cos(L::load(&self.0));
            [sin.store(), cos.store()]
        }
    }

    fn agree(block: Block) {
        for lanes in Lanes::wide() {
            let [sin, cos] = lanes.enter(Both(block));
            for (i, x) in block.into_iter().enumerate() {
                let (one, other) = libm::sincos(x);
                let found = [sin[i], cos[i]].map(f64::to_bits);
                assert_eq!(found, [one, other].map(f64::to_bits), "{lanes} {x:e}");
            }
        }
    }

    #[test]
    fn all_lanes_have_the_bits_of_libm() {
        let stream = Stream::new(13, Domain::Launch, 0);
        for toss in 0..100_000 {
            let mut uniforms = stream.toss(toss);
            agree(std::array::from_fn(|i| {
                let turns = 2.0 * uniforms.uniform(u32::try_from(i).expect("few lanes")) - 1.0;
                // launches draw from one turn, sometimes from up to four
                TAU * turns * if toss % 4 == 0 { 4.0 } else { 1.0 }
            }));
        }
    }

    #[test]
    fn and_at_every_border_and_beyond() {
        let mut numbers = vec![0.0, 5e-324, 1e-300, 1e-8, 1e5, 1e9, 1e300];
        numbers.extend((1..=18_u32).map(|i| FRAC_PI_4 * f64::from(i)));
        let words = MULTIPLES.into_iter().flat_map(|word| [word, word + 1]);
        numbers.extend(words.map(word).chain(ENDS).chain([TINY, LAST]));
        for number in numbers.clone() {
            let step = f64::from_bits(number.to_bits() + 1) - number;
            numbers.extend((-40..=40).map(|i| number + f64::from(i) * step));
        }
        for of in numbers.chunks(WIDTH / 2) {
            agree(std::array::from_fn(|i| {
                let number = of[i / 2 % of.len()];
                if i % 2 == 0 { number } else { -number }
            }));
        }
    }

    /// Away from multiples of π/2 libm subtracts them by Cody and Waite's method, as here; at them it
    /// takes more digits, beyond 9π/4 it divides, and a tiny number is its own sine.
    #[test]
    fn most_angles_need_no_call_of_libm() {
        for (size, times) in [(0.5, 0.0), (1.0, 1.0), (3.0, 2.0), (5.0, 3.0), (6.0, 4.0)] {
            assert_eq!(quadrant(size), (times, true), "{size}");
        }
        for size in [1e-9, PI / 2.0, PI, 1.5 * PI, TAU, 7.5] {
            assert!(!quadrant(size).1, "{size}");
        }
    }
}
