//! The one prior: who tosses, and onto what, where a source does not say.
//!
//! A draw is an imagined person at an imagined table. The table is one of the everyday scenes, each as likely
//! as any other but for the one whose edge coins leave; each of its numbers, and of the hand's, lies anywhere in the
//! range that the scene states for it (evenly, or evenly in the logarithm where the range spans more than a factor
//! of 10). Nothing is fitted, and the same draws predict every data set.

use coinmc_core::{Domain, Stream, UniformSource};
use coinmc_questions::Unknown;
use coinmc_questions::scenes::EverydayScene;

/// The streams of the numbers: other ones than any question uses.
const STREAM: u64 = 23;

/// An imagined person at an imagined table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Draw {
    pub(crate) index: u64,
    pub(crate) scene: EverydayScene,
    /// Its numbers, by their keys in configs.
    pub(crate) numbers: Vec<(&'static str, f64)>,
}

/// The tables of the prior.
pub(crate) fn tables() -> impl Iterator<Item = EverydayScene> {
    EverydayScene::ALL
        .into_iter()
        .filter(|scene| scene.table_radius_m.is_none())
}

/// The first draws.
pub(crate) fn draws(seed: u64, number: u64) -> Vec<Draw> {
    let tables: Vec<_> = tables().collect();
    let stream = Stream::new(seed, Domain::Parameters, STREAM);
    (0..number)
        .map(|index| {
            let mut uniforms = stream.toss(index);
            // every table in turn: as likely, and no more often by chance
            let place = usize::try_from(index).expect("few draws") % tables.len();
            let scene = tables[place];
            let numbers = scene.assumptions().into_iter().zip(0..);
            let numbers = numbers.map(|(assumption, dimension)| {
                let key = assumption.key;
                (
                    key,
                    Unknown::from(assumption).at(uniforms.uniform(dimension)),
                )
            });
            Draw {
                index,
                scene,
                numbers: numbers.collect(),
            }
        })
        .collect()
}

impl Draw {
    /// Its number under a key.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        let found = self.numbers.iter().find(|(there, _)| *there == key);
        found.map(|(_, number)| *number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every table is met as often, every number lies in its range, and more draws begin with the same ones.
    #[test]
    fn draws_are_people_at_the_tables_of_everyday_scenes() {
        let some = draws(1, 16);
        assert_eq!(some[..], draws(1, 40)[..16]);
        assert_ne!(some, draws(2, 16));
        for scene in tables() {
            let there = some.iter().filter(|draw| draw.scene == scene).count();
            assert_eq!(there, 2, "{}", scene.name);
        }
        for draw in &some {
            for assumption in draw.scene.assumptions() {
                let number = draw.number(assumption.key).expect("every number");
                assert!(assumption.low <= number && number <= assumption.high);
            }
        }
    }
}
