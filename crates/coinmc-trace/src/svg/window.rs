//! The part of space and of the toss that a panel shows.

use super::view::Shot;

/// A rectangle in the plane of the picture, m, and the shots drawn in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    /// Index of the first shot.
    pub(super) first: usize,
}

impl Window {
    /// The whole toss with a margin of a coin's width; `None` without shots.
    pub(super) fn around(shots: &[Shot], size_m: f64) -> Option<Self> {
        Self::of(shots, 0, size_m)
    }

    fn of(shots: &[Shot], first: usize, size_m: f64) -> Option<Self> {
        let seen = shots.get(first..).filter(|seen| !seen.is_empty())?;
        let low = |of: fn(&Shot) -> f64| seen.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = |of: fn(&Shot) -> f64| seen.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        // at least a few coins wide, so that a vertical drop has some ground
        let (left, right) = (low(|shot| shot.x), high(|shot| shot.x));
        let spare = (2.5 * size_m - 0.5 * (right - left)).max(0.9 * size_m);
        Some(Self {
            left: left - spare,
            right: right + spare,
            top: high(|shot| shot.z) + 0.75 * size_m,
            first,
        })
    }

    /// The end of the toss, as far back as it stays within `width` along the ground and two thirds
    /// of it in height.
    pub(super) fn last(shots: &[Shot], width: f64, size_m: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let outside = shots.iter().rposition(|shot| {
            (low, high) = (low.min(shot.x), high.max(shot.x));
            high - low > width - 2.0 * size_m || shot.z > width / 1.5
        });
        // start with the shot that enters the window
        let first = outside.map_or(0, |index| (index + 1).min(shots.len() - 1));
        let Some(mut window) = Self::of(shots, first, size_m) else {
            return Self {
                left: -0.5 * width,
                right: 0.5 * width,
                top: 0.5 * width,
                first,
            };
        };
        let spare = 0.5 * (width - window.width()).max(0.0);
        (window.left, window.right) = (window.left - spare, window.right + spare);
        window.top = window.top.max(0.2 * width);
        window
    }

    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.top
    }
}
