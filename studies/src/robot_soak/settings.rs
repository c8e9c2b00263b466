//! Settings of the attack: each kind alone, and several together.

use super::RobotSoak;
use coinmc_bench::{Report, Table};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Noise, attacked frames and vices of the camera, as shares; then, per 100 throws, resets,
/// unpluggings, kills, pauses, erasures and swaps.
type Setting = (f64, f64, f64, [u32; 6]);

const SETTINGS: [Setting; 24] = [
    (0.0, 0.0, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.01, 0.0, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.03, 0.0, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.05, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.2, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.01, 0.1, 0.0, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.0, 0.1, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.0, 0.4, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.05, 0.2, [0, 0, 0, 0, 0, 0]),
    (0.0, 0.0, 0.0, [5, 0, 0, 0, 0, 0]),
    (0.0, 0.0, 0.0, [0, 5, 0, 0, 0, 0]),
    (0.0, 0.0, 0.0, [0, 0, 5, 0, 0, 0]),
    (0.0, 0.0, 0.0, [0, 0, 0, 5, 0, 0]),
    (0.0, 0.0, 0.0, [0, 0, 0, 0, 2, 0]),
    (0.0, 0.0, 0.0, [0, 0, 0, 0, 0, 2]),
    (0.01, 0.0, 0.0, [2, 2, 2, 0, 0, 0]),
    (0.0, 0.05, 0.0, [2, 2, 2, 2, 0, 0]),
    (0.0, 0.0, 0.2, [2, 0, 2, 0, 0, 0]),
    (0.0, 0.0, 0.2, [0, 0, 0, 0, 1, 1]),
    (0.0, 0.05, 0.0, [0, 0, 2, 0, 1, 1]),
    (0.01, 0.05, 0.1, [1, 1, 1, 1, 0, 0]),
    (0.01, 0.05, 0.1, [1, 1, 1, 1, 1, 1]),
    (0.02, 0.1, 0.2, [2, 2, 2, 2, 0, 0]),
    (0.01, 0.1, 0.3, [3, 1, 3, 1, 1, 1]),
];

impl RobotSoak {
    /// An experiment in each setting; the first book that does not agree ends it.
    pub(super) fn through_settings(
        &self,
        program: &Path,
        dir: &Path,
        seed: u64,
    ) -> anyhow::Result<Report> {
        let mut table = Table::new(
            "robot soak by setting",
            &[
                "setting",
                "throws",
                "noise",
                "hostile",
                "vice",
                "resets",
                "unpluggings",
                "kills",
                "pauses",
                "strangers",
                "done",
                "void",
                "wall_s",
            ],
        );
        let throws = (self.throws / SETTINGS.len() as u64).max(1);
        for (number, setting) in (1_u64..).zip(SETTINGS) {
            let (noise, hostile, vice, mishaps) = setting;
            let share = |per_hundred: u32| {
                u32::try_from(throws * u64::from(per_hundred) / 100).unwrap_or(u32::MAX)
            };
            let [resets, unplugs, kills, pauses, erasures, swaps] = mishaps.map(share);
            let soak = Self {
                throws,
                noise,
                hostile,
                vice,
                pauses,
                erasures,
                swaps,
                resets,
                unplugs,
                kills,
                ..self.clone()
            };
            let place = dir.join(number.to_string());
            fs::create_dir(&place)?;
            let bench = soak.bench(program.to_owned(), place, seed + number);
            let begun = Instant::now();
            let met = soak.endure(&bench)?;
            let audit = bench.audit(throws)?;
            let void: u64 = audit.voids.values().sum();
            let row = [
                number.to_string(),
                throws.to_string(),
                noise.to_string(),
                hostile.to_string(),
                vice.to_string(),
                met.resets.to_string(),
                met.unplugs.to_string(),
                met.kills.to_string(),
                met.pauses.to_string(),
                met.strangers.to_string(),
                audit.done().to_string(),
                void.to_string(),
                format!("{:.1}", begun.elapsed().as_secs_f64()),
            ];
            eprintln!("{}", row.join(" "));
            table.push(row.to_vec());
        }
        let mut report = Report::new(table.clone());
        report.show(table);
        report.remark(
            "In every setting the books agree: no throw lost, doubled, or with another's face.",
        );
        Ok(report)
    }
}
