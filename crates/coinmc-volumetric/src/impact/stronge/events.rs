//! The first event on a piece of path.

use super::path::{Path, Step};
use coinmc_lanes::{Lane, Mask};

/// What ended a piece of path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Event {
    /// Only its length.
    End,
    /// u_z = 0: compression is over.
    Turn,
    /// All the work that comes back has come back.
    Over,
    /// ω_x = 0, or what holds it there has reached its limit.
    Roll,
    /// ω_z = 0, or what holds it there has reached its limit.
    Pivot,
}

impl Event {
    #[inline(always)]
    pub(super) fn code<L: Lane>(self) -> L {
        L::splat(f64::from(self as u8))
    }
}

/// The end of a piece, cut by one event after another.
pub(super) struct Cut<L> {
    pub(super) at: L,
    pub(super) event: L,
}

/// Evaluations of the bracketing secant; a third of them halve, which alone would be enough.
const MAX_STEPS: u32 = 200;

impl<L: Lane> Cut<L> {
    #[inline(always)]
    pub(super) fn new(path: &Path<L>) -> Self {
        Self {
            at: path.end,
            event: Event::End.code(),
        }
    }

    /// Cuts the piece where `distance` falls below 0, in the lanes of `on`.
    #[inline(always)]
    pub(super) fn by(
        &mut self,
        path: &Path<L>,
        on: L::Mask,
        event: Event,
        distance: impl Fn(&Step<L>) -> L,
    ) {
        let end = distance(&path.step(self.at));
        let crossed = on & end.lt(L::splat(0.0));
        if crossed.any() {
            let root = first_root(path, self.at, end, crossed, distance);
            self.at = L::select(crossed, root, self.at);
            self.event = L::select(crossed, event.code(), self.event);
        }
    }

    /// As [`Cut::by`], for a distance that may come back within the piece: looks halfway first.
    #[inline(always)]
    pub(super) fn by_bent(
        &mut self,
        path: &Path<L>,
        on: L::Mask,
        event: Event,
        distance: impl Fn(&Step<L>) -> L,
    ) {
        let half = self.at * L::splat(0.5);
        let there = distance(&path.step(half));
        let crossed = on & there.lt(L::splat(0.0));
        if crossed.any() {
            let root = first_root(path, half, there, crossed, &distance);
            self.at = L::select(crossed, root, self.at);
            self.event = L::select(crossed, event.code(), self.event);
        }
        self.by(path, on & !crossed, event, distance);
    }

    #[inline(always)]
    pub(super) fn is(&self, event: Event) -> L::Mask {
        let code = event.code::<L>();
        self.event.le(code) & code.le(self.event)
    }
}

/// A root of `distance` between 0 and `high`, where it is `end` < 0: regula falsi with the Illinois
/// modification, halving where that does not shrink the bracket.
#[inline(always)]
fn first_root<L: Lane>(
    path: &Path<L>,
    mut high: L,
    end: L,
    mut active: L::Mask,
    distance: impl Fn(&Step<L>) -> L,
) -> L {
    let (zero, half) = (L::splat(0.0), L::splat(0.5));
    let mut low = zero;
    let mut at_low = distance(&path.step(zero));
    let mut at_high = end;
    let mut root = L::select(zero.lt(at_low), high, zero);
    active = active & zero.lt(at_low);
    for count in 0..MAX_STEPS {
        if !active.any() {
            break;
        }
        let width = high - low;
        let secant = low + width * (at_low / (at_low - at_high));
        // every third step halves, so that the bracket shrinks whatever the function
        let halving = <L::Mask as Mask>::splat(count % 3 == 2);
        let inside = low.lt(secant) & secant.lt(high) & !halving;
        let next = L::select(inside, secant, low + half * width);
        let value = distance(&path.step(next));
        let positive = zero.lt(value);
        root = L::select(active, next, root);
        let narrow = (high - low).le(L::splat(2.0 * f64::EPSILON) * high);
        // the end that stays counts half, so that the next secant overshoots
        at_high = L::select(active & positive, at_high * half, at_high);
        at_low = L::select(active & !positive, at_low * half, at_low);
        low = L::select(active & positive, next, low);
        at_low = L::select(active & positive, value, at_low);
        high = L::select(active & !positive, next, high);
        at_high = L::select(active & !positive, value, at_high);
        active = active & !narrow & !value.abs().le(zero);
    }
    root
}
