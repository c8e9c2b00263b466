//! Philox4x64-10, the counter-based generator.
//!
//! Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC'11,
//! doi:10.1145/2063384.2063405. Ten rounds pass all of TestU01's BigCrush.

const MULTIPLIERS: [u64; 2] = [0xD2E7_470E_E14C_6C93, 0xCA5A_8263_9512_1157];
/// Weyl increments of the key: the golden ratio and sqrt(3) − 1.
const WEYL: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xBB67_AE85_84CA_A73B];
const ROUNDS: usize = 10;

/// A keyed bijection of 256-bit counters to 256-bit blocks.
///
/// # Example
/// ```
/// use coinmc_core::Philox4x64;
/// // Random123's known answer for the zero key and counter.
/// let block = Philox4x64::new([0, 0]).block([0, 0, 0, 0]);
/// assert_eq!(block[0], 0x16554d9eca36314c);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Philox4x64 {
    key: [u64; 2],
}

impl Philox4x64 {
    /// A generator with this key.
    pub fn new(key: [u64; 2]) -> Self {
        Self { key }
    }

    /// The four random words of a counter.
    #[inline]
    pub fn block(&self, counter: [u64; 4]) -> [u64; 4] {
        let mut words = counter;
        let mut key = self.key;
        for _ in 0..ROUNDS {
            words = round(words, key);
            key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
        }
        words
    }
}

#[inline]
fn round(w: [u64; 4], key: [u64; 2]) -> [u64; 4] {
    let (high0, low0) = widening_mul(MULTIPLIERS[0], w[0]);
    let (high1, low1) = widening_mul(MULTIPLIERS[1], w[2]);
    [high1 ^ w[1] ^ key[0], low1, high0 ^ w[3] ^ key[1], low0]
}

/// (high, low) halves of the 128-bit product.
#[inline]
#[allow(clippy::cast_possible_truncation)] // the halves are what is wanted
fn widening_mul(a: u64, b: u64) -> (u64, u64) {
    let product = u128::from(a) * u128::from(b);
    ((product >> 64) as u64, product as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random123's kat_vectors: zero, all ones, digits of π.
    #[test]
    fn known_answers() {
        let cases = [
            (
                [0; 4],
                [0; 2],
                [
                    0x1655_4d9e_ca36_314c,
                    0xdb20_fe9d_672d_0fdc,
                    0xd7e7_72ce_e186_176b,
                    0x7e68_b68a_ec7b_a23b,
                ],
            ),
            (
                [u64::MAX; 4],
                [u64::MAX; 2],
                [
                    0x87b0_92c3_013f_e90b,
                    0x438c_3c67_be8d_0224,
                    0x9cc7_d7c6_9cd7_77b6,
                    0xa09c_aebf_594f_0ba0,
                ],
            ),
            (
                [
                    0x243f_6a88_85a3_08d3,
                    0x1319_8a2e_0370_7344,
                    0xa409_3822_299f_31d0,
                    0x082e_fa98_ec4e_6c89,
                ],
                [0x4528_21e6_38d0_1377, 0xbe54_66cf_34e9_0c6c],
                [
                    0xa528_f454_03e6_1d95,
                    0x38c7_2dbd_566e_9788,
                    0xa5a1_610e_72fd_18b5,
                    0x57bd_43b5_e52b_7fe6,
                ],
            ),
        ];
        for (counter, key, expected) in cases {
            assert_eq!(Philox4x64::new(key).block(counter), expected);
        }
    }
}
