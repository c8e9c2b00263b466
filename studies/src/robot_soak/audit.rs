//! The books against what happened: nothing that the host believes is taken for true.

use super::bench::Bench;
use anyhow::{Context, bail, ensure};
use coinmc_core::Face;
use coinmc_robot::journal::{History, Journal, Resolution};
use coinmc_robot::sim::{Truth, read_truths};
use coinmc_robot::{Directory, Experiment};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;

impl Bench {
    /// Compares the journal with the truth.
    pub(super) fn audit(&self, throws: u64) -> anyhow::Result<Audit> {
        let directory = Directory::at(&self.day());
        let experiment = directory.experiment()?;
        let (_, history) = Journal::read(&directory.journal())?;
        let truths = read_truths(&self.truth())?;
        let released = once_each(&truths)?;
        ensure!(
            history.throws().len() as u64 == throws,
            "{} throws in the journal, {throws} planned",
            history.throws().len()
        );
        let (mut done, mut voids) = ([0_u64; 3], BTreeMap::new());
        let (mut last, mut pictures) = (0, HashSet::new());
        for (number, throw) in (0_u32..).zip(history.throws()) {
            ensure!(throw.id > last, "throw {} follows {last}", throw.id);
            last = throw.id;
            ensure!(
                throw.setting == experiment.setting(number),
                "throw {} has another setting than planned",
                throw.id
            );
            match (throw.resolution, &throw.reading) {
                (Some(Resolution::Done), Some((reading, _))) => {
                    let picture = fs::read(directory.photos().join(reading.image.as_str()))?;
                    ensure!(
                        pictures.insert(picture),
                        "throw {}: an old picture",
                        throw.id
                    );
                    let truth = released.get(&throw.id).copied();
                    let lay = truth.and_then(Truth::face);
                    let model = experiment.model_face(number, throw.setting)?;
                    ensure!(
                        lay == Some(reading.face) && model == lay,
                        "throw {}: read {:?}, lay {lay:?}, engine {model:?}",
                        throw.id,
                        reading.face
                    );
                    let face = Face::ALL.iter().position(|face| *face == reading.face);
                    done[face.context("one of three")?] += 1;
                }
                (Some(Resolution::Void(reason)), _) => {
                    *voids.entry(reason.to_string()).or_insert(0_u64) += 1;
                }
                _ => bail!("throw {} is unresolved", throw.id),
            }
        }
        for truth in &truths {
            let at_most = u32::try_from(throws)?;
            ensure!(
                (1..=at_most).contains(&truth.throw_id),
                "a release without a throw"
            );
        }
        Ok(Audit {
            experiment,
            history,
            faces: done,
            voids,
        })
    }
}

/// Books that agree with what happened.
pub(super) struct Audit {
    experiment: Experiment,
    history: History,
    faces: [u64; 3],
    /// Void throws, by reason.
    pub(super) voids: BTreeMap<String, u64>,
}

impl Audit {
    /// Throws with a result.
    pub(super) fn done(&self) -> u64 {
        self.faces.iter().sum()
    }

    /// Frequencies of the faces against those of the engine.
    pub(super) fn frequencies(&self) -> anyhow::Result<Vec<(String, String)>> {
        frequencies(&self.experiment, &self.history, self.faces)
    }
}

/// The release of each throw; an error if one was released twice.
fn once_each(truths: &[Truth]) -> anyhow::Result<HashMap<u32, &Truth>> {
    let mut released = HashMap::new();
    for truth in truths {
        let before = released.insert(truth.throw_id, truth);
        ensure!(
            before.is_none(),
            "throw {} was released twice",
            truth.throw_id
        );
    }
    Ok(released)
}

/// Frequencies of the done throws against those of the engine for all planned ones.
fn frequencies(
    experiment: &Experiment,
    history: &History,
    done: [u64; 3],
) -> anyhow::Result<Vec<(String, String)>> {
    let mut engine = [0_u64; 3];
    for (number, throw) in (0..).zip(history.throws()) {
        if let Some(face) = experiment.model_face(number, throw.setting)? {
            engine[Face::ALL
                .iter()
                .position(|f| *f == face)
                .context("one of three")?] += 1;
        }
    }
    let n = done.iter().sum::<u64>() as f64;
    let planned = engine.iter().sum::<u64>() as f64;
    let mut rows = Vec::new();
    for (index, face) in Face::ALL.iter().enumerate() {
        let p = engine[index] as f64 / planned;
        let share = done[index] as f64 / n;
        let z = (share - p) / (p * (1.0 - p) / n).sqrt();
        ensure!(
            z.abs() < 3.0,
            "{}: {share} done, {p} by the engine",
            face.name()
        );
        rows.push((format!("p_{}", face.name()), format!("{share:.4}")));
        rows.push((format!("p_{}_engine", face.name()), format!("{p:.4}")));
        rows.push((format!("z_{}", face.name()), format!("{z:.2}")));
    }
    Ok(rows)
}
