//! Which build of the program, on which kind of processor, computes chunks.

use crate::plan::Plan;
use coinmc_core::{Engine, Lanes};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::sync::OnceLock;

/// Longest name of a processor that is kept, characters.
const MAX_NAME: usize = 128;

/// A build of the program on a kind of processor. No host, user or date is in it: two equal machines are the
/// same maker.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Maker {
    /// The build as `coinmc --version` names it: version, commit and its date.
    pub build: String,
    /// Optional parts of the library that are compiled in, sorted.
    pub features: Vec<String>,
    /// Architecture, system and vector instructions compiled in, as `x86_64-linux+avx2+fma`.
    pub target: String,
    /// The processor as its system names it; `unknown` where it does not.
    pub cpu: String,
    /// The lanes in which the engine computes tosses: `scalar`, `portable`, `avx2` or `avx512`; `none` where
    /// nothing is tossed.
    pub lanes: String,
}

impl Maker {
    /// This process, computing chunks of `plan`.
    pub(crate) fn this(plan: &Plan, build: &str) -> Self {
        Self {
            build: build.to_owned(),
            features: features(),
            target: target(),
            cpu: cpu(),
            lanes: lanes(plan).map_or_else(|| "none".to_owned(), |lanes| lanes.to_string()),
        }
    }

    /// Sixteen hexadecimal digits that stand for it in a file.
    pub(super) fn id(&self) -> String {
        let text = serde_json::to_vec(self).expect("plain fields are always JSON");
        let hash = Sha256::digest(text);
        let (first, _) = hash.split_first_chunk().expect("it has 32 bytes");
        format!("{:016x}", u64::from_be_bytes(*first))
    }
}

fn features() -> Vec<String> {
    let all = [
        ("parquet", cfg!(feature = "parquet")),
        ("rapier", cfg!(feature = "rapier")),
    ];
    let on = all.into_iter().filter(|(_, is_on)| *is_on);
    on.map(|(name, _)| name.to_owned()).collect()
}

/// The lanes of the engine, which all points share.
fn lanes(plan: &Plan) -> Option<Lanes> {
    let first = (!plan.points.is_empty()).then(|| plan.points.at(0))?;
    Some(first.build_engine().ok()??.lanes())
}

/// The kind of this machine and the vector instructions that this program was compiled for.
pub(crate) fn target() -> String {
    let features = [
        ("sse4.2", cfg!(target_feature = "sse4.2")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
    ];
    let features = features
        .iter()
        .filter(|(_, used)| *used)
        .map(|(name, _)| format!("+{name}"));
    format!(
        "{}-{}{}",
        std::env::consts::ARCH,
        std::env::consts::OS,
        features.collect::<String>()
    )
}

/// The processor, as Linux names it.
fn cpu() -> String {
    // it does not change, and Linux takes a while to tell it
    static CPU: OnceLock<String> = OnceLock::new();
    let read = || {
        let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        named(&told).unwrap_or_else(|| "unknown".to_owned())
    };
    CPU.get_or_init(read).clone()
}

/// The first processor of a `/proc/cpuinfo`: its name, or on ARM the numbers of its maker and its kind.
fn named(cpuinfo: &str) -> Option<String> {
    let value = |key: &str| {
        let mut pairs = cpuinfo.lines().filter_map(|line| line.split_once(':'));
        let (_, value) = pairs.find(|(name, _)| name.trim() == key)?;
        let value: String = value.trim().chars().take(MAX_NAME).collect();
        (!value.is_empty()).then_some(value)
    };
    value("model name").or_else(|| {
        let (implementer, part) = (value("CPU implementer")?, value("CPU part")?);
        Some(format!("ARM implementer {implementer} part {part}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_named_as_linux_names_it() {
        let x86 = "processor\t: 0\nmodel\t\t: 17\nmodel name\t: AMD EPYC 9B14\nflags : a b\n";
        assert_eq!(named(x86).as_deref(), Some("AMD EPYC 9B14"));
        let arm = "processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd40\n";
        assert_eq!(named(arm).unwrap(), "ARM implementer 0x41 part 0xd40");
        let long = format!("model name: {}\n", "x".repeat(1000));
        assert_eq!(named(&long).unwrap().len(), MAX_NAME);
        assert_eq!(named("model name\t:\n"), None);
    }
}
