//! Settings of the attack: each kind alone, and several together.

use super::RobotSoak;
use coinmc_bench::{Report, Table};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// A setting of the attack: shares as in the arguments, and, per 100 throws, how often what happens.
#[derive(Debug, Clone, Copy)]
struct Setting {
    noise: f64,
    hostile: f64,
    forged: f64,
    vice: f64,
    failing: f64,
    resets: u32,
    cuts: u32,
    unplugs: u32,
    kills: u32,
    pauses: u32,
    erasures: u32,
    swaps: u32,
}

/// Peace.
const NOTHING: Setting = Setting {
    noise: 0.0,
    hostile: 0.0,
    forged: 0.0,
    vice: 0.0,
    failing: 0.0,
    resets: 0,
    cuts: 0,
    unplugs: 0,
    kills: 0,
    pauses: 0,
    erasures: 0,
    swaps: 0,
};

macro_rules! settings {
    ($({ $($name:ident: $value:literal),* })*) => {
        [$(Setting { $($name: $value,)* ..NOTHING }),*]
    };
}

#[rustfmt::skip] // a table
const SETTINGS: [Setting; 32] = settings! {
    {}
    { noise: 0.01 }
    { noise: 0.03 }
    { hostile: 0.05 }
    { hostile: 0.2 }
    { noise: 0.01, hostile: 0.1 }
    { forged: 0.002 }
    { forged: 0.01 }
    { forged: 0.002, hostile: 0.05 }
    { vice: 0.1 }
    { vice: 0.4 }
    { vice: 0.2, hostile: 0.05 }
    { failing: 0.05 }
    { failing: 0.03, vice: 0.2 }
    { resets: 5 }
    { cuts: 5 }
    { unplugs: 5 }
    { kills: 5 }
    { pauses: 5 }
    { erasures: 2 }
    { swaps: 2 }
    { noise: 0.01, resets: 2, unplugs: 2, kills: 2 }
    { cuts: 3, kills: 3 }
    { forged: 0.002, cuts: 2, kills: 2 }
    { hostile: 0.05, resets: 2, unplugs: 2, kills: 2, pauses: 2 }
    { vice: 0.2, resets: 2, kills: 2 }
    { vice: 0.2, erasures: 1, swaps: 1 }
    { hostile: 0.05, kills: 2, erasures: 1, swaps: 1 }
    { noise: 0.01, hostile: 0.05, vice: 0.1, resets: 1, unplugs: 1, kills: 1, pauses: 1 }
    { noise: 0.01, hostile: 0.05, vice: 0.1, cuts: 1, unplugs: 1, kills: 1, erasures: 1, swaps: 1 }
    { noise: 0.02, hostile: 0.1, vice: 0.2, resets: 2, cuts: 2, unplugs: 2, kills: 2, pauses: 2 }
    { noise: 0.01, hostile: 0.1, forged: 0.001, vice: 0.3, failing: 0.01, resets: 2, cuts: 2, kills: 3 }
};

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
                "forged",
                "vice",
                "failing",
                "resets",
                "cuts",
                "unpluggings",
                "kills",
                "pauses",
                "strangers",
                "halts",
                "done",
                "void",
                "wall_s",
            ],
        );
        let range = self.first..=self.last.unwrap_or(SETTINGS.len());
        let chosen = (1..)
            .zip(SETTINGS)
            .filter(|(number, _)| range.contains(number));
        let chosen: Vec<(usize, Setting)> = chosen.collect();
        let throws = (self.throws / chosen.len().max(1) as u64).max(1);
        for (number, setting) in chosen {
            let share = |per_hundred: u32| {
                u32::try_from(throws * u64::from(per_hundred) / 100).unwrap_or(u32::MAX)
            };
            let Setting {
                noise,
                hostile,
                forged,
                vice,
                failing,
                ..
            } = setting;
            let soak = Self {
                throws,
                noise,
                hostile,
                forged,
                vice,
                failing,
                resets: share(setting.resets),
                cuts: share(setting.cuts),
                unplugs: share(setting.unplugs),
                kills: share(setting.kills),
                pauses: share(setting.pauses),
                erasures: share(setting.erasures),
                swaps: share(setting.swaps),
                ..self.clone()
            };
            let place = dir.join(number.to_string());
            fs::create_dir(&place)?;
            let bench = soak.bench(program.to_owned(), place, seed + number as u64);
            let begun = Instant::now();
            let met = soak.endure(&bench)?;
            let audit = bench.audit(throws)?;
            let void: u64 = audit.voids.values().sum();
            let row = [
                number.to_string(),
                throws.to_string(),
                noise.to_string(),
                hostile.to_string(),
                forged.to_string(),
                vice.to_string(),
                failing.to_string(),
                met.resets.to_string(),
                met.cuts.to_string(),
                met.unplugs.to_string(),
                met.kills.to_string(),
                met.pauses.to_string(),
                met.strangers.to_string(),
                met.halts.to_string(),
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
