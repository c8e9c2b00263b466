//! The engines: the one list that configs, plans, runs and reports ask.
//!
//! An engine is its crate and a line here; what is known of it is its [`EngineDescriptor`]. The
//! walk-through is docs/developer/add-an-engine.md.

mod analytic;

pub use analytic::ClosedForm;
pub use coinmc_core::{EngineChoice, EngineDescriptor, EngineError, EngineKind};

use coinmc_analytic::Rule;

/// Every engine, in the order of the reference.
pub const ENGINES: [&EngineDescriptor; 4] = [
    &coinmc_flat::ENGINE,
    &coinmc_volumetric::ENGINE,
    &coinmc_rapier::ENGINE,
    &analytic::ENGINE,
];

/// The engine that configs and results call so.
///
/// # Example
/// ```
/// use coinmc::engines::{EngineKind, engine};
/// assert_eq!(engine("flat").map(|flat| flat.kind), Some(EngineKind::Planar));
/// assert!(engine("round").is_none());
/// ```
pub fn engine(name: &str) -> Option<&'static EngineDescriptor> {
    ENGINES.into_iter().find(|engine| engine.name == name)
}

/// The closed form that the tosses of an engine of this name tend to where nothing bounces; `None` if
/// it makes none, or there is no such engine.
///
/// # Example
/// ```
/// use coinmc::engines::no_bounce_rule;
/// assert_eq!(no_bounce_rule("volumetric").map(|rule| rule.name()), Some("zone"));
/// ```
pub fn no_bounce_rule(name: &str) -> Option<Rule> {
    match engine(name)?.kind {
        EngineKind::Planar => Some(Rule::Arc),
        EngineKind::Spatial => Some(Rule::Zone),
        EngineKind::ClosedForm => None,
    }
}

/// An engine that makes no tosses.
pub(crate) const WITHOUT_TOSSES: &EngineDescriptor = &analytic::ENGINE;
