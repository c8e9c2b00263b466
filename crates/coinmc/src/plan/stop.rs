//! When a point has enough tosses.

use coinmc_core::{Estimate, Face};

/// When a point has enough tosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// After this many.
    Tosses(u64),
    /// When it meets all targets: see [`Looks`](super::Looks).
    Targets(Targets),
}

/// What a point is to reach. Targets that are not given count as met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Targets {
    /// Longest arm allowed of any face's interval.
    pub half_width: Option<f64>,
    /// The same as a share of the face's probability.
    pub relative_error: Option<f64>,
    /// Least number of tosses that show each face.
    pub events: Option<u64>,
    /// The face that they are of; `None` for each.
    pub face: Option<Face>,
    /// Tosses at which the point stops short of them.
    pub max_tosses: u64,
    /// Tosses of all points together at which the run stops short of them.
    pub total_tosses: Option<u64>,
    /// Computing time, in seconds of one core, at which the point stops short of them.
    pub max_core_seconds: Option<f64>,
    /// Computing time of all points together, in seconds of one core, at which the run stops short of them.
    pub total_core_seconds: Option<f64>,
}

/// The rule that ended a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StoppedBy {
    /// It has the tosses asked for.
    Tosses,
    /// It meets its targets.
    Targets,
    /// Nothing was to be tossed: a closed form.
    ClosedForm,
    /// The limit of tosses of a point.
    MaxTosses,
    /// The limit of tosses of the run.
    TotalTosses,
    /// The limit of computing time of a point.
    MaxCoreSeconds,
    /// The limit of computing time of the run.
    TotalCoreSeconds,
    /// The limit of evaluations of an integral.
    Evaluations,
    /// Tosses without a face: they alone are more than the targets allow, however many tosses are made.
    Undecided,
    /// None yet: more tosses are to come.
    Unfinished,
}

impl StoppedBy {
    /// All of them, in the order of their numbers.
    pub(crate) const ALL: [Self; 10] = [
        Self::Tosses,
        Self::Targets,
        Self::ClosedForm,
        Self::MaxTosses,
        Self::TotalTosses,
        Self::MaxCoreSeconds,
        Self::TotalCoreSeconds,
        Self::Evaluations,
        Self::Undecided,
        Self::Unfinished,
    ];

    /// The name used in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tosses => "tosses",
            Self::Targets => "targets",
            Self::ClosedForm => "closed-form",
            Self::MaxTosses => "max_tosses",
            Self::TotalTosses => "total_tosses",
            Self::MaxCoreSeconds => "max_core_seconds",
            Self::TotalCoreSeconds => "total_core_seconds",
            Self::Evaluations => "evaluations",
            Self::Undecided => "undecided",
            Self::Unfinished => "unfinished",
        }
    }

    /// The rule of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name)
    }

    /// Whether the point has what was asked for.
    pub fn is_reached(self) -> bool {
        matches!(self, Self::Tosses | Self::Targets | Self::ClosedForm)
    }
}

impl Targets {
    /// Whether computing time is limited, so that counts depend on the speed of the machine.
    pub fn is_timed(&self) -> bool {
        self.max_core_seconds.is_some() || self.total_core_seconds.is_some()
    }

    /// The faces that the targets are of.
    pub fn faces(&self) -> impl Iterator<Item = Face> + use<> {
        let face = self.face;
        let wanted = move |&one: &Face| face.is_none_or(|face| face == one);
        Face::ALL.into_iter().filter(wanted)
    }

    /// Whether the estimates of heads, tails and side meet the targets.
    pub fn are_met(&self, faces: &[Estimate; 3]) -> bool {
        let excess = |face| self.excess(std::slice::from_ref(&faces[face as usize]));
        self.faces().all(|face| excess(face) <= 1.0)
    }

    /// By which factor there are too few tosses, as intervals shrink like 1/√n: 1 or less if the targets
    /// are met, infinite if a face that was not seen yet must be.
    pub(crate) fn excess(&self, faces: &[Estimate]) -> f64 {
        let of = |face: &Estimate| {
            let arm = face.half_width();
            let absolute = self.half_width.map_or(0.0, |target| arm / target);
            // without tosses, or without the face, p is not above 0
            let relative = self.relative_error.map_or(0.0, |target| {
                if face.p > 0.0 {
                    arm / face.p / target
                } else {
                    f64::INFINITY
                }
            });
            // as counts, p n is within rounding of a whole number
            let seen = libm::round(face.p * face.n as f64);
            let events = self
                .events
                .map_or(0.0, |least| least as f64 / seen.max(0.0));
            (absolute * absolute).max(relative * relative).max(events)
        };
        faces.iter().map(of).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::IntervalMethod::Wilson;

    const NONE: Targets = Targets {
        half_width: None,
        relative_error: None,
        events: None,
        face: None,
        max_tosses: 100,
        total_tosses: None,
        max_core_seconds: None,
        total_core_seconds: None,
    };

    fn faces(counts: [u64; 3]) -> [Estimate; 3] {
        let n = counts.iter().sum();
        counts.map(|count| Estimate::new(count, 0, n, 0.95, Wilson))
    }

    #[test]
    fn every_target_must_be_met_by_every_face() {
        let seen = faces([4500, 4500, 1000]);
        let arm = seen.each_ref().map(Estimate::half_width);
        let longest = arm[0].max(arm[2]);
        let half_width = |half_width| Targets {
            half_width: Some(half_width),
            ..NONE
        };
        assert!(half_width(longest).are_met(&seen));
        assert!(!half_width(0.99 * longest).are_met(&seen));
        // the side is the least known for its size
        let relative = |share| Targets {
            relative_error: Some(share),
            ..NONE
        };
        assert!(relative(10.0 * arm[2]).are_met(&seen));
        assert!(!relative(9.9 * arm[2]).are_met(&seen));
        let events = |least| Targets {
            events: Some(least),
            ..NONE
        };
        assert!(events(1000).are_met(&seen) && !events(1001).are_met(&seen));
        let both = Targets {
            events: Some(1001),
            ..half_width(longest)
        };
        assert!(!both.are_met(&seen));
    }

    #[test]
    fn targets_may_be_of_one_face() {
        let seen = faces([4500, 4500, 1000]);
        let arm = seen[2].half_width();
        let all = Targets {
            half_width: Some(arm),
            ..NONE
        };
        let of_side = Targets {
            face: Some(Face::Side),
            ..all
        };
        assert!(!all.are_met(&seen) && of_side.are_met(&seen));
        let of_heads = Targets {
            face: Some(Face::Heads),
            ..all
        };
        assert!(!of_heads.are_met(&seen));
    }

    #[test]
    fn only_limits_of_computing_time_depend_on_the_speed_of_a_machine() {
        let counts = Targets {
            half_width: Some(0.01),
            total_tosses: Some(1000),
            ..NONE
        };
        assert!(!NONE.is_timed() && !counts.is_timed());
        let of_a_point = Targets {
            max_core_seconds: Some(1.0),
            ..counts
        };
        let of_the_run = Targets {
            total_core_seconds: Some(1.0),
            ..counts
        };
        assert!(of_a_point.is_timed() && of_the_run.is_timed());
    }

    #[test]
    fn rules_are_found_by_their_names() {
        for rule in StoppedBy::ALL {
            assert_eq!(StoppedBy::named(rule.name()), Some(rule));
        }
    }

    /// Four times the tosses halve an interval, and show a face four times as often.
    #[test]
    fn the_excess_forecasts_the_tosses() {
        let seen = faces([4500, 4500, 1000]);
        let targets = Targets {
            half_width: Some(0.5 * seen[0].half_width()),
            ..NONE
        };
        assert!((targets.excess(&seen) - 4.0).abs() < 1e-12);
        let targets = Targets {
            events: Some(4000),
            ..NONE
        };
        assert!((targets.excess(&seen) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_face_that_was_never_seen_has_no_relative_error() {
        let never = faces([50, 50, 0]);
        let targets = Targets {
            relative_error: Some(0.5),
            ..NONE
        };
        assert!(!targets.are_met(&never) && targets.excess(&never).is_infinite());
        let targets = Targets {
            events: Some(1),
            ..NONE
        };
        assert!(!targets.are_met(&never) && targets.excess(&never).is_infinite());
    }
}
