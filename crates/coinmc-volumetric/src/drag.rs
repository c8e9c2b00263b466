//! Linear drag of the surrounding air, in the kernel's units.

/// Rates at which drag slows the centre and the rotation, in sqrt(g/D).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drag {
    pub(crate) linear: f64,
    pub(crate) angular: f64,
}

impl Drag {
    const NONE: Self = Self {
        linear: 0.0,
        angular: 0.0,
    };

    /// The same drag, with the case "no drag" known to the compiler: `ACTS` is whether it
    /// [`acts`](Self::acts).
    #[inline(always)]
    pub(crate) fn known<const ACTS: bool>(self) -> Self {
        if ACTS { self } else { Self::NONE }
    }

    pub(crate) fn acts(self) -> bool {
        self.linear != 0.0 || self.angular != 0.0
    }
}
