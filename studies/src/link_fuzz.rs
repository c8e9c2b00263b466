//! Any bytes on the robot's link: the properties of the fuzz targets, without their toolchain.
//!
//! Inputs are mixed and spoiled pieces of the kept corpus: input k depends on the seed and k alone,
//! so a finding can be made again. It is blind where the fuzz targets steer by coverage, and makes
//! up for it by number.

use crate::survey::survey;
use anyhow::Context;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::Philox4x64;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Instant;

#[path = "../../fuzz/properties/link.rs"]
mod properties;

/// Inputs that a thread makes at a time.
const BATCH: u64 = 1 << 14;
/// Findings that are shown.
const SHOWN: usize = 20;
/// Longest input, bytes.
const LONGEST: usize = 512;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct LinkFuzz {
    /// Inputs, half of them bytes for the decoder, half courses of events for the device
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    executions: u64,

    /// Where the kept corpus lies
    #[arg(long, default_value = "fuzz/corpus", value_name = "DIR")]
    corpus: PathBuf,
}

/// A property and the inputs to begin from.
struct Target {
    name: &'static str,
    property: fn(&[u8]),
    corpus: Vec<Vec<u8>>,
}

/// An input that broke a property.
struct Finding {
    number: u64,
    why: String,
    input: Vec<u8>,
}

impl LinkFuzz {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let targets = [
            self.target("link_decoder", properties::decoder)?,
            self.target("link_device", properties::device)?,
        ];
        let columns = [
            "target",
            "executions",
            "executions_a_second",
            "bytes",
            "findings",
        ];
        let mut record = Table::new("Targets", &columns);
        let mut found = Table::new("Findings", &["target", "number", "why", "input"]);
        let mut findings = 0;
        for (domain, target) in (0..).zip(&targets) {
            let executions = (self.executions + 1 - domain) / 2;
            let start = Instant::now();
            let (bytes, list) = target.execute([seed, domain], executions);
            let rate = executions as f64 / start.elapsed().as_secs_f64();
            record.push(vec![
                target.name.to_owned(),
                executions.to_string(),
                format!("{rate:.0}"),
                bytes.to_string(),
                list.len().to_string(),
            ]);
            findings += list.len();
            for finding in list.iter().take(SHOWN) {
                found.push(vec![
                    target.name.to_owned(),
                    finding.number.to_string(),
                    finding.why.clone(),
                    hex(&finding.input),
                ]);
            }
        }
        let mut report = Report::new(record.clone());
        report.show(record);
        if findings > 0 {
            report.show(found);
        }
        report.remark(format!(
            "{findings} findings in {} executions",
            self.executions
        ));
        Ok(report)
    }

    fn target(&self, name: &'static str, property: fn(&[u8])) -> anyhow::Result<Target> {
        let dir = self.corpus.join(name);
        let context = || format!("cannot read the corpus {}", dir.display());
        let mut paths: Vec<PathBuf> = fs::read_dir(&dir)
            .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect())
            .with_context(context)?;
        paths.sort();
        let corpus: Vec<Vec<u8>> = paths
            .iter()
            .map(fs::read)
            .collect::<Result<_, _>>()
            .with_context(context)?;
        anyhow::ensure!(!corpus.is_empty(), "the corpus {} is empty", dir.display());
        Ok(Target {
            name,
            property,
            corpus,
        })
    }
}

impl Target {
    /// Bytes put in, and what was found.
    fn execute(&self, key: [u64; 2], executions: u64) -> (u64, Vec<Finding>) {
        let batches: Vec<u64> = (0..executions.div_ceil(BATCH)).collect();
        let batches = survey(&batches, |batch| {
            let numbers = batch * BATCH..((batch + 1) * BATCH).min(executions);
            self.batch(key, numbers)
        });
        let bytes = batches.iter().map(|(bytes, _)| bytes).sum();
        let findings = batches.into_iter().flat_map(|(_, found)| found).collect();
        (bytes, findings)
    }

    fn batch(&self, key: [u64; 2], numbers: std::ops::Range<u64>) -> (u64, Vec<Finding>) {
        let (mut bytes, mut findings) = (0, Vec::new());
        let mut input = Vec::new();
        for number in numbers {
            Mutator::new(key, number).write(&self.corpus, &mut input);
            bytes += input.len() as u64;
            let run = catch_unwind(AssertUnwindSafe(|| (self.property)(&input)));
            if let Err(panic) = run {
                findings.push(Finding {
                    number,
                    why: words(panic.as_ref()),
                    input: input.clone(),
                });
            }
        }
        (bytes, findings)
    }
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic".to_owned())
}

fn hex(bytes: &[u8]) -> String {
    bytes
        .iter()
        .fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

/// Makes the input of one number.
struct Mutator {
    generator: Philox4x64,
    number: u64,
    block: u64,
    words: Vec<u32>,
}

impl Mutator {
    fn new(key: [u64; 2], number: u64) -> Self {
        Self {
            generator: Philox4x64::new(key),
            number,
            block: 0,
            words: Vec::with_capacity(8),
        }
    }

    /// From 0 to `end` − 1, or 0.
    #[allow(clippy::cast_possible_truncation)] // halves of a word are wanted
    fn below(&mut self, end: usize) -> usize {
        if self.words.is_empty() {
            let block = self.generator.block([self.block, self.number, 0, 0]);
            self.block += 1;
            self.words.extend(
                block
                    .iter()
                    .flat_map(|word| [*word as u32, (word >> 32) as u32]),
            );
        }
        let word = u64::from(self.words.pop().unwrap_or(0));
        ((word * end as u64) >> 32) as usize
    }

    fn byte(&mut self) -> u8 {
        u8::try_from(self.below(256)).unwrap_or(0)
    }

    /// One to four pieces of the corpus, spoiled up to eight times.
    fn write(mut self, corpus: &[Vec<u8>], input: &mut Vec<u8>) {
        input.clear();
        for _ in 0..=self.below(4) {
            let piece = &corpus[self.below(corpus.len())];
            if self.below(4) == 0 {
                let (start, end) = self.span(piece.len());
                input.extend(&piece[start..end]);
            } else {
                input.extend(piece);
            }
        }
        input.truncate(LONGEST);
        for _ in 0..self.below(9) {
            self.spoil(input);
        }
    }

    fn span(&mut self, length: usize) -> (usize, usize) {
        let start = self.below(length);
        (start, start + self.below(length - start + 1))
    }

    fn spoil(&mut self, input: &mut Vec<u8>) {
        let (at, byte) = (self.below(input.len()), self.byte());
        let (start, end) = self.span(input.len());
        match self.below(6) {
            0 if at < input.len() => input[at] ^= 1 << (byte % 8),
            1 if at < input.len() => input[at] = byte,
            2 if at < input.len() => drop(input.remove(at)),
            3 => input.copy_within(start..end, start.min(at)),
            4 if input.len() < LONGEST => {
                let piece = input[start..end].to_vec();
                input.splice(at..at, piece);
            }
            _ => input.insert(at, byte),
        }
    }
}
