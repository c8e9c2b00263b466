//! The same question answered by tosses.

use crate::{Atlas, AtlasError, Launch, Place};
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc_questions::{QuestionError, Workers};

/// Counts of tosses at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Heads, tails and side.
    pub faces: [u64; 3],
    /// Tosses that showed none.
    pub undecided: u64,
}

impl Counts {
    /// All tosses.
    pub fn tosses(&self) -> u64 {
        self.faces.iter().sum::<u64>() + self.undecided
    }
}

/// The config of a launch of the atlas at a place, which `coinmc run` tosses.
///
/// # Errors
/// [`AtlasError::Outside`].
pub fn scene(
    atlas: &Atlas,
    launch: Launch,
    place: &Place,
    tosses: u64,
) -> Result<Plan, AtlasError> {
    place.inputs(atlas.axes(), atlas.radius_m())?;
    let key = |name: &str| match name {
        "ratio" => "coin.ratio".to_owned(),
        other => format!("surface.{other}"),
    };
    let mut sets: Vec<String> = place
        .named()
        .map(|(name, value)| format!("{}={value:?}", key(name)))
        .collect();
    sets.push("sweep.mode=grid".to_owned());
    sets.push(format!("stop.tosses={tosses}"));
    let overrides: Result<Vec<Override>, _> = sets.iter().map(|set| set.parse()).collect();
    let overrides = overrides.map_err(QuestionError::Key)?;
    let plan = config::parse(launch.name(), launch.design(), &overrides);
    plan.map_err(|problems| QuestionError::Config(problems).into())
}

/// Tosses a coin of the atlas.
///
/// # Errors
/// [`AtlasError`].
pub fn toss(plan: &Plan, tosses: u64, workers: &Workers<'_>) -> Result<Counts, AtlasError> {
    let [heads, tails, side, undecided, left] = workers.count_first(plan, 0..tosses)?;
    Ok(Counts {
        faces: [heads, tails, side],
        undecided: undecided + left,
    })
}
