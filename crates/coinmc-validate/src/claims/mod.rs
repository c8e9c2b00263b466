//! Claims, and how each is checked: one entry each.

mod bounces;
mod closed_forms;
mod dependences;
mod engines;
mod fair_ratios;
mod relative_error;
mod scenes;

use crate::tosser::Tosser;
use crate::{Finding, ValidateError};

/// Whose claim it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Gaek & Sukhov's.
    Paper,
    /// That two ways to compute the same toss agree.
    Engines,
}

impl Family {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Engines => "engines",
        }
    }
}

/// A claim.
#[derive(Debug, Clone, Copy)]
pub struct Claim {
    /// Its name.
    pub name: &'static str,
    /// Whose it is.
    pub family: Family,
    /// What it says.
    pub statement: &'static str,
    pub(crate) check: Check,
}

impl PartialEq for Claim {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// A claim and what was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// The claim.
    pub claim: &'static Claim,
    /// What was found.
    pub finding: Finding,
}

/// How a claim is checked.
type Check = fn(&Tosser<'_>) -> Result<Finding, ValidateError>;

const fn paper(name: &'static str, statement: &'static str, check: Check) -> Claim {
    of(Family::Paper, name, statement, check)
}

const fn engines(name: &'static str, statement: &'static str, check: Check) -> Claim {
    of(Family::Engines, name, statement, check)
}

const fn of(family: Family, name: &'static str, statement: &'static str, check: Check) -> Claim {
    Claim {
        name,
        family,
        statement,
        check,
    }
}

/// All claims.
pub(crate) static CLAIMS: [Claim; 22] = [
    paper(
        "arc-rule",
        "a flat toss that does not bounce follows the arc rule",
        closed_forms::arc_rule,
    ),
    paper(
        "arc-shift",
        "bounces shift P(side) away from the arc rule",
        closed_forms::arc_shift,
    ),
    paper(
        "robot-shift",
        "the robot's throws are shifted from the arc rule by as much as the model",
        closed_forms::robot_shift,
    ),
    paper(
        "zone-rule",
        "a volumetric toss that does not bounce follows the zone rule",
        closed_forms::zone_rule,
    ),
    paper(
        "mass",
        "P(side) does not depend on the mass",
        dependences::mass,
    ),
    paper(
        "restitution",
        "P(side) falls with the restitution k",
        dependences::restitution,
    ),
    paper(
        "friction",
        "P(side) falls with the friction μ",
        dependences::friction,
    ),
    paper(
        "height",
        "P(side) does not depend on the height of the launch",
        dependences::height,
    ),
    paper("spin", "how P(side) depends on the spin", dependences::spin),
    paper(
        "fair-flat",
        "a flat coin is fair at H/R = 1.5 ± 0.05",
        fair_ratios::flat,
    ),
    paper(
        "fair-space",
        "a volumetric coin is fair at H/R = 0.8 ± 0.05",
        fair_ratios::space,
    ),
    paper(
        "unity-figure",
        "Unity's P(side) of table 1 is that of its scene",
        fair_ratios::unity,
    ),
    paper(
        "energy-law",
        "the law of impact with k and η has a solution at every impact",
        bounces::energy_law,
    ),
    paper(
        "half-sine",
        "the force of an impact is half a sine; its shape does not matter for P(side)",
        bounces::half_sine,
    ),
    paper(
        "contact-time",
        "an impact lasts about 1 ms",
        bounces::contact_time,
    ),
    paper(
        "stopping-rule",
        "a toss is decided once a hundredth of its energy is left",
        bounces::stopping_rule,
    ),
    paper(
        "error-formula",
        "ΔP/P = 1/√N",
        relative_error::rule_of_thumb,
    ),
    engines(
        "plane-space",
        "a flat launch ends alike in the plane and in space",
        engines::plane_space,
    ),
    engines(
        "plane-laws",
        "the planar laws of impact give the same P(side)",
        engines::plane_laws,
    ),
    engines(
        "space-laws",
        "the laws of impact in space give the same P(side)",
        engines::space_laws,
    ),
    engines(
        "decisions",
        "the quick decision and the rigorous one give the same P(side)",
        engines::decisions,
    ),
    engines(
        "rapier",
        "tosses in time steps on Rapier give the same P(side)",
        engines::rapier,
    ),
];
