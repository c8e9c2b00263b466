//! A run to report.

use crate::history::{self, Step};
use coinmc::plan::Plan;
use coinmc::run::{ProgressSink, Provenance, Report, RunError, provenance, stored_report};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Most points of a run that a page shows; of more it shows a part, and says so.
pub const MAX_POINTS: usize = 20_000;
/// Largest manifest that is shown, bytes.
const MAX_MANIFEST: u64 = 64 << 10;

/// A run to report: its plan, its results so far, and what its directory tells about it.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) name: String,
    pub(crate) plan: Plan,
    pub(crate) report: Report,
    /// The fields of `manifest.json`: builds, machines.
    pub(crate) manifest: Value,
    /// Who made its chunks.
    pub(crate) provenance: Provenance,
    /// How the counts of points grew.
    pub(crate) history: Vec<(usize, Vec<Step>)>,
}

impl Run {
    /// Reads a run directory, finished or not. It is not changed; the sink is warned of rejected tallies.
    ///
    /// # Errors
    /// Those of [`stored_report`]: no run directory, one of another version, or one that cannot be read.
    ///
    /// # Example
    /// ```no_run
    /// # fn example() -> Result<(), Box<dyn std::error::Error>> {
    /// use coinmc_report::{Run, Samples, report};
    /// let run = Run::open("runs/first".as_ref(), &())?;
    /// std::fs::write("report.html", report(&[run], None, &Samples::default())?)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn open(dir: &Path, sink: &dyn ProgressSink) -> Result<Self, RunError> {
        let (plan, report) = stored_report(dir, sink)?;
        let mut run = Self::in_memory(&dir.display().to_string(), plan, report);
        run.manifest = manifest(dir);
        run.provenance = provenance(dir, &run.plan)?;
        run.history = history::read(dir, &run.plan, &run.report)?;
        Ok(run)
    }

    /// A run of which no directory tells anything.
    pub fn in_memory(name: &str, plan: Plan, report: Report) -> Self {
        Self {
            name: name.to_owned(),
            plan,
            report,
            manifest: Value::Null,
            provenance: Provenance::default(),
            history: Vec::new(),
        }
    }
}

/// The manifest as it stands there. It has been read before, by the library; whatever a version adds to it
/// is shown, too.
fn manifest(dir: &Path) -> Value {
    let path = dir.join("manifest.json");
    let is_short = fs::metadata(&path).is_ok_and(|found| found.len() <= MAX_MANIFEST);
    let text = if is_short {
        fs::read_to_string(path).ok()
    } else {
        None
    };
    text.and_then(|text| serde_json::from_str(&text).ok())
        .unwrap_or(Value::Null)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::run::{Options, Part, run};
    use coinmc_core::Tally;
    use std::sync::atomic::AtomicBool;

    fn opened(stop: &str) -> Run {
        let config = format!(
            "coin.ratio = [1.0, 2.0]\nsurface = {{ restitution = 0.5, friction = 0 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\n{stop}"
        );
        let plan = coinmc::config::parse("test", &config, &[]).unwrap_or_else(|e| panic!("{e}"));
        let dir = tempfile::tempdir().unwrap();
        let cancel = AtomicBool::new(false);
        let options = Options {
            out: dir.path(),
            build: "test",
            part: Part::WHOLE,
            threads: None,
            cancel: &cancel,
            sink: &(),
        };
        run(&plan, &options).unwrap();
        Run::open(dir.path(), &()).unwrap()
    }

    /// Of runs with a fixed number of tosses, and of runs that stop at targets, whose pilots do not count.
    #[test]
    fn the_history_of_a_point_grows_to_its_counts() {
        for stop in [
            "stop.tosses = 60000",
            "stop = { half_width = 0.004, max_tosses = 1e6 }",
        ] {
            let run = opened(stop);
            assert_eq!(run.history.len(), 2, "{stop}");
            for (point, steps) in &run.history {
                assert!(steps.len() > 1, "{stop}: {}", steps.len());
                assert!(steps.windows(2).all(|w| w[0].tosses() < w[1].tosses()));
                let last: &Tally = steps.last().unwrap();
                assert_eq!(*last, run.report.results.rows[*point].tally, "{stop}");
            }
            assert_eq!(run.manifest["builds"][0], "test");
            let [made] = &run.provenance.contributions[..] else {
                panic!("{:?}", run.provenance);
            };
            assert_eq!(made.maker.build, "test");
        }
    }
}
