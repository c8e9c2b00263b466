//! Which points are tossed, and which are answered without tosses.

use super::{Plan, Stop, Targets, Way};
use coinmc_quadrature::{Goal, Integral, MAX_EVALUATIONS, MIN_EVALUATIONS, Method};

/// How launches are drawn where the first contact decides. Elsewhere they are random.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sampling {
    /// By a closed form or at Sobol points, wherever that is more precise than random tosses: see
    /// [`Method`].
    #[default]
    Auto,
    /// Random tosses.
    Random,
}

impl Sampling {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Auto, Self::Random];

    /// The name used in configs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Random => "random",
        }
    }
}

/// Half width at which an integral ends where the config asks for a number of tosses.
const HALF_WIDTH: f64 = 1e-5;

impl Plan {
    /// Whether point `index` is integrated: answered as one piece of work, without counting tosses.
    ///
    /// # Panics
    /// If there is no such point, as [`makes_tosses`](Self::makes_tosses), [`known`](Self::known) and
    /// [`method`](Self::method).
    pub fn integrates(&self, index: usize) -> bool {
        self.method(index).is_some() && !self.points.way(index).by_rule
    }

    /// Whether tosses of point `index` are counted.
    pub fn makes_tosses(&self, index: usize) -> bool {
        self.points.way(index).makes_tosses && self.method(index).is_none()
    }

    /// The answer of point `index` where no work is needed: a rule in closed form gives it, though an
    /// engine is asked for.
    pub fn known(&self, index: usize) -> Option<Integral> {
        self.method(index)?.by_rule(&self.points.at(index).scene)
    }

    /// How point `index` is answered without counting tosses; `None` if it is not.
    pub fn method(&self, index: usize) -> Option<Method> {
        match self.sampling {
            Sampling::Auto => self.points.way(index).method,
            Sampling::Random => None,
        }
    }

    /// How many points are tossed.
    pub(crate) fn points_tossed(&self) -> u64 {
        let ways = self.points.ways().iter();
        let without = |way: &&Way| self.sampling == Sampling::Auto && way.method.is_some();
        let tossed = ways.filter(|way| way.makes_tosses && !without(way));
        tossed.count() as u64
    }

    /// What an integral is to reach: the half width asked for, with no more evaluations than the
    /// config would have tossed, but for a few thousand at the least and a few million at the most.
    pub fn goal(&self) -> Goal {
        let (half_width, evaluations) = match self.stop {
            Stop::Tosses(tosses) => (HALF_WIDTH, tosses),
            Stop::Targets(Targets {
                half_width,
                max_tosses,
                ..
            }) => (half_width.unwrap_or(HALF_WIDTH), max_tosses),
        };
        Goal {
            confidence: self.confidence,
            half_width,
            evaluations: evaluations.clamp(MIN_EVALUATIONS, MAX_EVALUATIONS),
        }
    }
}
