//! Sobol points, plain and scrambled.
//!
//! I. M. Sobol', USSR Comput. Math. Math. Phys. 7 (1967) 86, in the order of Antonov & Saleev
//! (1979), with the direction numbers of S. Joe & F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635,
//! file new-joe-kuo-6.21201. Scrambled by J. Matoušek's random linear matrices with a random
//! digital shift, J. Complexity 14 (1998) 527: every scrambled point is uniform, and every prefix
//! of 2^m points keeps the equidistribution of the plain ones.
//!
//! All 52 binary digits of a uniform number are used, so that neither 2^16 nor 2^32 points exhaust
//! them.

use coinmc_core::TossUniforms;

/// The largest number of dimensions of a point: the dimensions of a launch.
pub const DIMENSIONS: usize = 10;

/// Binary digits of a coordinate; at most 2^DIGITS points are distinct.
const DIGITS: usize = 52;

/// Degree s and inner coefficients a of a primitive polynomial over GF(2), and initial numbers m
/// of its recurrence.
type Polynomial = (u32, u32, &'static [u64]);

/// Dimensions 2 to 10 of new-joe-kuo-6.21201.
const POLYNOMIALS: [Polynomial; DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
];

/// Direction numbers of one dimension, the first binary digit in the highest bit.
type Directions = [u64; DIGITS];

/// A Sobol sequence in some number of dimensions, scrambled or not.
///
/// # Example
/// ```
/// use coinmc_quadrature::Sobol;
/// let words: Vec<u64> = Sobol::plain(1).points(0..4).map(|point| point[0] >> 62).collect();
/// assert_eq!(words, [0, 2, 3, 1]); // 0, ½, ¾, ¼
/// ```
#[derive(Debug, Clone)]
pub struct Sobol {
    directions: Vec<Directions>,
    shift: Vec<u64>,
}

impl Sobol {
    /// The plain sequence, which starts at the origin.
    ///
    /// # Panics
    /// If there are more than [`DIMENSIONS`].
    pub fn plain(dimensions: usize) -> Self {
        Self {
            directions: (0..dimensions).map(directions).collect(),
            shift: vec![0; dimensions],
        }
    }

    /// The sequence with a scramble made of these random words.
    ///
    /// # Panics
    /// If there are more than [`DIMENSIONS`].
    pub fn scrambled(dimensions: usize, words: &mut TossUniforms) -> Self {
        let mut sobol = Self::plain(dimensions);
        let mut drawn = 0;
        let mut word = || {
            drawn += 1;
            words.word(drawn - 1)
        };
        for (directions, shift) in sobol.directions.iter_mut().zip(&mut sobol.shift) {
            let rows: Vec<u64> = (0..DIGITS).map(|digit| row(digit, word())).collect();
            for number in directions {
                *number = times(&rows, *number);
            }
            *shift = word();
        }
        sobol
    }

    /// Points number `range.start .. range.end`, as words whose upper 52 bits are the digits.
    pub fn points(&self, range: std::ops::Range<u64>) -> Points<'_> {
        let gray = range.start ^ (range.start >> 1);
        let mut words = [0; DIMENSIONS];
        for ((word, directions), shift) in words.iter_mut().zip(&self.directions).zip(&self.shift) {
            let digits = directions.iter().enumerate();
            let chosen = digits.filter(|(digit, _)| gray >> digit & 1 == 1);
            *word = chosen.fold(*shift, |word, (_, number)| word ^ number);
        }
        Points {
            sobol: self,
            words,
            range,
        }
    }
}

/// Points of a sequence, in order.
#[derive(Debug, Clone)]
pub struct Points<'a> {
    sobol: &'a Sobol,
    words: [u64; DIMENSIONS],
    range: std::ops::Range<u64>,
}

impl Iterator for Points<'_> {
    type Item = [u64; DIMENSIONS];

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let index = self.range.next()?;
        let point = self.words;
        // after the last digit the sequence repeats
        let digit = ((index + 1).trailing_zeros() as usize).min(DIGITS - 1);
        for (word, directions) in self.words.iter_mut().zip(&self.sobol.directions) {
            *word ^= directions[digit];
        }
        Some(point)
    }
}

/// The direction numbers of a dimension, numbered from 0.
fn directions(dimension: usize) -> Directions {
    let mut m = [1_u64; DIGITS];
    if dimension > 0 {
        let (degree, inner, initial) = POLYNOMIALS[dimension - 1];
        let s = degree as usize;
        m[..s].copy_from_slice(initial);
        for k in s..DIGITS {
            m[k] = m[k - s] ^ (m[k - s] << s);
            for i in 1..s {
                m[k] ^= (u64::from(inner) >> (s - 1 - i) & 1) * (m[k - i] << i);
            }
        }
    }
    // m_k is odd and below 2^k: its k digits follow the binary point
    std::array::from_fn(|k| m[k] << (63 - k))
}

/// Row `digit` of a random lower triangular matrix with ones on its diagonal.
fn row(digit: usize, random: u64) -> u64 {
    let diagonal = 1 << (63 - digit);
    diagonal | (random & !(diagonal | (diagonal - 1)))
}

/// A matrix, row by row, times a column of binary digits.
fn times(rows: &[u64], column: u64) -> u64 {
    let digits = rows.iter().enumerate();
    digits.fold(0, |product, (digit, row)| {
        product | u64::from((row & column).count_ones() & 1) << (63 - digit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All 2^52 points are different; the next ones are the first ones again.
    #[test]
    fn after_the_last_point_comes_the_first() {
        let sobol = Sobol::plain(3);
        let last = 1_u64 << DIGITS;
        let around: Vec<_> = sobol.points(last - 1..last + 1).collect();
        let last_digit: Vec<_> = around[0][..3].iter().map(|word| word >> 12).collect();
        assert!(last_digit.iter().all(|word| *word != 0));
        assert_eq!(around[1], [0; DIMENSIONS]);
    }
}
