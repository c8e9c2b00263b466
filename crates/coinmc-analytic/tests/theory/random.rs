//! A small generator with a fixed seed. `SplitMix64`: Steele, Lea and Flood, OOPSLA 2014.

pub(crate) struct SplitMix(pub(crate) u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform on `[from, to)`.
    pub(crate) fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * ((self.next() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Uniform on the unit sphere: a point of the cube that lies in the ball, scaled.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let v: [f64; 3] = std::array::from_fn(|_| self.uniform(-1.0, 1.0));
            let square: f64 = v.iter().map(|c| c * c).sum();
            if (0.01..1.0).contains(&square) {
                return v.map(|c| c / square.sqrt());
            }
        }
    }
}

/// Asserts that `hits` of `n` agree with probability `p` within 4.9 standard deviations: a correct
/// rule would fail for one seed in a million.
pub(crate) fn assert_share(hits: u32, n: u32, p: f64, what: &str) {
    let n = f64::from(n);
    let z = (f64::from(hits) - n * p) / (n * p * (1.0 - p)).sqrt();
    assert!(
        z.abs() < 4.9,
        "{what}: {hits} of {n}, expected {p}, {z:.1} standard deviations off"
    );
}
