//! The closed forms that depend on the ratio alone, under their names in configs and on the command
//! line.

use crate::{FaceProbabilities, arc, cross_section, surface_area, well_depth, zone};
use std::{error, fmt, str};

/// A closed form for P(side) as a function of the ratio `H/R`.
///
/// ```
/// use coinmc_analytic::Rule;
/// let rule: Rule = "zone".parse()?;
/// assert_eq!(rule, Rule::Zone);
/// assert!((rule.p_side(1.5) - 0.6).abs() < 1e-15);
/// # Ok::<(), coinmc_analytic::UnknownRule>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// `arc`: flat spin, adhesive landing; see [`arc`].
    Arc,
    /// `zone`: any orientation in space, adhesive landing; see [`zone`].
    Zone,
    /// `surface-area`: share of the surface; see [`surface_area`].
    SurfaceArea,
    /// `cross-section`: share of the outline of the axial section; see [`cross_section`].
    CrossSection,
    /// `well-depth-flat`: depth × angle of the wells of energy; see [`well_depth::flat`].
    WellDepthFlat,
    /// `well-depth-solid`: depth × solid angle, a heuristic; see [`well_depth::solid`].
    WellDepthSolid,
}

impl Rule {
    /// Every rule, in the order in which tables show them.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert_eq!(Rule::ALL.map(Rule::name)[0], "arc");
    /// ```
    pub const ALL: [Self; 6] = [
        Self::Arc,
        Self::Zone,
        Self::SurfaceArea,
        Self::CrossSection,
        Self::WellDepthFlat,
        Self::WellDepthSolid,
    ];

    /// The name in configs and on the command line; [`str::parse`] reads it back.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert_eq!(Rule::SurfaceArea.name(), "surface-area");
    /// ```
    pub const fn name(self) -> &'static str {
        match self {
            Self::Arc => "arc",
            Self::Zone => "zone",
            Self::SurfaceArea => "surface-area",
            Self::CrossSection => "cross-section",
            Self::WellDepthFlat => "well-depth-flat",
            Self::WellDepthSolid => "well-depth-solid",
        }
    }

    /// P(side) as text, in terms of `x = H/R`.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert_eq!(Rule::CrossSection.formula(), "x/(2 + x)");
    /// ```
    pub const fn formula(self) -> &'static str {
        match self {
            Self::Arc => "(2/π)·atan(x/2)",
            Self::Zone => "x/sqrt(x² + 4)",
            Self::SurfaceArea => "x/(1 + x)",
            Self::CrossSection => "x/(2 + x)",
            Self::WellDepthFlat => "w/(1 + w), w = [(l − R)/(l − H/2)]·[α/(π/2 − α)]",
            Self::WellDepthSolid => "w/(1 + w), w = [(l − R)/(l − H/2)]·[sin α/(1 − sin α)]",
        }
    }

    /// The assumption of the rule, in one line.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert!(Rule::WellDepthSolid.assumption().contains("heuristic"));
    /// ```
    pub const fn assumption(self) -> &'static str {
        match self {
            Self::Arc => "spin about a horizontal diameter, uniform landing angle, no bounce",
            Self::Zone => "uniform orientation in space, no bounce",
            Self::SurfaceArea => "no mechanics: share of the surface",
            Self::CrossSection => "no mechanics: share of the outline of the axial section",
            Self::WellDepthFlat => "spin about a horizontal diameter, many bounces",
            Self::WellDepthSolid => "many bounces in space; heuristic, not derived",
        }
    }

    /// The source to cite.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert!(Rule::WellDepthFlat.source().contains("1407.6307"));
    /// ```
    pub const fn source(self) -> &'static str {
        match self {
            Self::Arc => "Yong & Mahadevan, Am. J. Phys. 79, 1195 (2011), vigorous toss",
            Self::Zone => "Mosteller, Fifty Challenging Problems in Probability, no. 38 (1965)",
            Self::SurfaceArea | Self::CrossSection => "folklore",
            Self::WellDepthFlat => "Pender & Uhrin, arXiv:1407.6307 (2014)",
            Self::WellDepthSolid => "unpublished analogue in space of arXiv:1407.6307",
        }
    }

    /// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`; NaN elsewhere.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// let p = Rule::SurfaceArea.probabilities(1.0);
    /// assert_eq!((p.heads, p.tails, p.side), (0.25, 0.25, 0.5));
    /// ```
    pub fn probabilities(self, ratio: f64) -> FaceProbabilities {
        match self {
            Self::Arc => arc::probabilities(ratio),
            Self::Zone => zone::probabilities(ratio),
            Self::SurfaceArea => surface_area::probabilities(ratio),
            Self::CrossSection => cross_section::probabilities(ratio),
            Self::WellDepthFlat => well_depth::flat::probabilities(ratio),
            Self::WellDepthSolid => well_depth::solid::probabilities(ratio),
        }
    }

    /// Probability of the side for `ratio = H/R` in `[0, +∞]`; NaN elsewhere.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert_eq!(Rule::Arc.p_side(2.0), 0.5);
    /// ```
    pub fn p_side(self, ratio: f64) -> f64 {
        self.probabilities(ratio).side
    }

    /// Ratio `H/R` at which P(side) is `target`, in `[0, 1]` (a third makes all three outcomes
    /// equally likely); NaN elsewhere. Each rule rises strictly from 0 to 1, so there is exactly
    /// one solution.
    ///
    /// ```
    /// use coinmc_analytic::Rule;
    /// assert!((Rule::CrossSection.fair_ratio(1.0 / 3.0) - 1.0).abs() < 1e-15);
    /// ```
    pub fn fair_ratio(self, target: f64) -> f64 {
        match self {
            Self::Arc => arc::fair_ratio(target),
            Self::Zone => zone::fair_ratio(target),
            Self::SurfaceArea => surface_area::fair_ratio(target),
            Self::CrossSection => cross_section::fair_ratio(target),
            Self::WellDepthFlat => well_depth::flat::fair_ratio(target),
            Self::WellDepthSolid => well_depth::solid::fair_ratio(target),
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl str::FromStr for Rule {
    type Err = UnknownRule;

    fn from_str(name: &str) -> Result<Self, UnknownRule> {
        Self::ALL
            .into_iter()
            .find(|rule| rule.name() == name)
            .ok_or_else(|| UnknownRule {
                name: name.to_owned(),
            })
    }
}

/// No rule has this name. The message lists the known names.
///
/// ```
/// use coinmc_analytic::Rule;
/// let error = "arcs".parse::<Rule>().unwrap_err();
/// assert!(error.to_string().starts_with("no rule is called `arcs`; there are arc, zone, "));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownRule {
    name: String,
}

impl fmt::Display for UnknownRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no rule is called `{}`; there are {}",
            self.name,
            Rule::ALL.map(Rule::name).join(", ")
        )
    }
}

impl error::Error for UnknownRule {}
