//! Colours in an order that everybody sees.

/// The map viridis (N. Smith & S. van der Walt, 2015, in Matplotlib) at tenths: its lightness rises
/// evenly, also for colour-blind readers and in print without colours.
const VIRIDIS: [[u8; 3]; 11] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x24, 0x75],
    [0x41, 0x44, 0x87],
    [0x35, 0x5f, 0x8d],
    [0x2a, 0x78, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x22, 0xa8, 0x84],
    [0x44, 0xbf, 0x70],
    [0x7a, 0xd1, 0x51],
    [0xbd, 0xdf, 0x26],
    [0xfd, 0xe7, 0x25],
];

/// The colour at a share of the scale, 0 to 1, as `#rrggbb`: linear between tenths.
pub(super) fn viridis(share: f64) -> String {
    let [red, green, blue] = channels(share);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn channels(share: f64) -> [u8; 3] {
    let place = 10.0 * share.clamp(0.0, 1.0);
    let below = (0..10).rev().find(|&i| i as f64 <= place).unwrap_or(0);
    let rest = place - below as f64;
    let mixed = |channel: usize| {
        let [low, high] = [below, below + 1].map(|i| f64::from(VIRIDIS[i][channel]));
        // between two bytes
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let byte = (low + rest * (high - low)).round() as u8;
        byte
    };
    [mixed(0), mixed(1), mixed(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The relative luminance of WCAG 2 (sRGB primaries), which follows the lightness, rises
    /// strictly.
    #[test]
    fn a_higher_share_is_lighter() {
        let linear = |byte: u8| libm::pow(f64::from(byte) / 255.0, 2.2);
        let luminance = |share| {
            let [red, green, blue] = channels(share).map(linear);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        let shares: Vec<f64> = (0..=40).map(|i| luminance(f64::from(i) / 40.0)).collect();
        assert!(
            shares.windows(2).all(|pair| pair[0] < pair[1]),
            "{shares:?}"
        );
    }

    #[test]
    fn ends_and_middles_are_exact() {
        assert_eq!(viridis(0.0), "#440154");
        assert_eq!(viridis(1.0), "#fde725");
        assert_eq!(viridis(0.5), "#21918c");
        // half way between the first two
        assert_eq!(viridis(0.05), "#461365");
        assert_eq!(viridis(1.5), "#fde725");
    }
}
