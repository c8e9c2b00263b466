//! The same question answered by tosses.

use crate::{Atlas, AtlasError, Launch, Place};
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc::run::stream;
use coinmc_core::Face;
use coinmc_questions::{QuestionError, Workers};

/// Tosses of one piece of work.
const PIECE: u64 = 256;

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
    place.coordinates(atlas.axes())?;
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
    let point = plan.points.at(0);
    let launches = stream(plan, 0);
    let pieces = usize::try_from(tosses.div_ceil(PIECE)).unwrap_or(usize::MAX);
    let counted = workers.each(pieces, &|index| {
        let first = index as u64 * PIECE;
        let mut counts = Counts::default();
        let range = first..(first + PIECE).min(tosses);
        workers.outcomes(
            &point,
            &launches,
            range,
            &mut |_, outcome| match outcome.face() {
                Some(face) => counts.faces[face as usize] += 1,
                None => counts.undecided += 1,
            },
        )?;
        Ok::<_, QuestionError>(counts)
    })?;
    let mut sum = Counts::default();
    for counts in counted {
        for face in Face::ALL {
            sum.faces[face as usize] += counts.faces[face as usize];
        }
        sum.undecided += counts.undecided;
    }
    Ok(sum)
}
