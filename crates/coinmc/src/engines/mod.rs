//! The engines: the list used by configs, plans, runs and reports.
//!
//! An engine is a crate and a line here; its properties are in its [`EngineDescriptor`]. See
//! docs/developer/add-an-engine.md for a tutorial.

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

/// The engine with this name in configs and results.
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

/// The closed form for the tosses of an engine without bounces; `None` if the engine makes no
/// tosses, or if there is no engine with this name.
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
