//! How a toss ends.

use crate::SideEnding;

/// The face that is up when the coin is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Face {
    /// The heads face shows: +u points up.
    Heads,
    /// The tails face shows: +u points down.
    Tails,
    /// The coin lies (flat toss: stands on) its side: u is horizontal.
    Side,
}

impl Face {
    /// All faces, in the order of every table.
    pub const ALL: [Self; 3] = [Self::Heads, Self::Tails, Self::Side];

    /// The name used in configs, tables and column names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Heads => "heads",
            Self::Tails => "tails",
            Self::Side => "side",
        }
    }

    /// The face of this name.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Face;
    /// assert_eq!(Face::named("side"), Some(Face::Side));
    /// assert_eq!(Face::named("edge"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.name() == name)
    }
}

/// Why the engine stopped following the toss.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ended {
    /// The face is decided, by the energy that is left or by the stopping rule that the user chose.
    Decided(Face),
    /// The coin left the table over its edge ([`Surface::table_radius_m`](crate::Surface::table_radius_m)).
    Left,
    /// The toss was still undecided at the engine's limit of simulated time.
    TimeLimit,
    /// The coin provably never comes to rest on a face: it stands balanced on its rim, or rolls or
    /// bounces forever without loss.
    NeverSettles,
    /// The toss was still undecided at the engine's limit of impacts or contact phases.
    ImpactLimit,
    /// A number became NaN or infinite. Counted, never classified.
    Failed,
}

/// The result of one toss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// Why it ended, and on which face if decided.
    pub ended: Ended,
    /// Impacts computed.
    pub impacts: u32,
    /// Steps taken in sustained contact (integrator steps and closed-form phases).
    pub contact_steps: u32,
    /// Tangential impacts in a Painlevé configuration (contact that admits no sliding force).
    pub jams: u32,
    /// The user's stopping rule and the energy that is left decide differently.
    pub overruled: bool,
    /// Impacts at which the law of impact broke down and its fallback was used.
    pub breaks: Breaks,
    /// How the coin came to end on its side; `None` if it did not, or the engine does not know.
    pub side_ending: Option<SideEnding>,
}

/// Impacts, by kind, at which a law of impact broke down and its documented fallback was used. All
/// are zero for laws that hold everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Breaks {
    /// The law's energy balance asked for a negative height of rebound.
    pub negative_heights: u32,
    /// The law would have gained energy.
    pub energy_gains: u32,
    /// The law's lever turned the coin the wrong way.
    pub wrong_levers: u32,
    /// After the law's impact the corner would have continued into the surface.
    pub sinkings: u32,
    /// The integration of the contact was given up.
    pub unresolved: u32,
}

impl Outcome {
    /// A decided toss without impacts: closed forms, tests.
    pub fn decided(face: Face) -> Self {
        Self {
            ended: Ended::Decided(face),
            impacts: 0,
            contact_steps: 0,
            jams: 0,
            overruled: false,
            breaks: Breaks::default(),
            side_ending: None,
        }
    }

    /// The face, if decided.
    pub fn face(&self) -> Option<Face> {
        match self.ended {
            Ended::Decided(face) => Some(face),
            _ => None,
        }
    }

    /// Whether it is not known how the toss ends. (A coin that left the table is no such toss.)
    pub fn is_undecided(&self) -> bool {
        !matches!(self.ended, Ended::Decided(_) | Ended::Left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names are part of configs and of files of results.
    #[test]
    fn faces_have_their_names_in_files() {
        assert_eq!(Face::ALL.map(Face::name), ["heads", "tails", "side"]);
        for face in Face::ALL {
            assert_eq!(Face::named(face.name()), Some(face));
        }
        assert!(Face::named("Heads").is_none() && Face::named("").is_none());
    }

    #[test]
    fn only_a_toss_that_was_given_up_is_undecided() {
        let undecided = |ended| {
            let decided = Outcome::decided(Face::Side);
            Outcome { ended, ..decided }.is_undecided()
        };
        for face in Face::ALL {
            assert!(!undecided(Ended::Decided(face)));
        }
        assert!(!undecided(Ended::Left));
        assert!(undecided(Ended::TimeLimit) && undecided(Ended::ImpactLimit));
        assert!(undecided(Ended::NeverSettles) && undecided(Ended::Failed));
    }
}
