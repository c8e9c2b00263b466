//! `coinmc trace recover`: recovering a recording after a crash.

use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::count;
use clap::Args;
use coinmc_recording::Recovered;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Copy what is readable in a damaged or unfinished MCAP recording to a new one
///
/// Works for traces and for recordings of the robot. The damaged file is only read.
#[derive(Debug, Args)]
pub(super) struct Recover {
    /// The damaged recording
    file: PathBuf,

    /// The new recording [default: FILE with .recovered before its extension]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Recover {
    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let out = self.out.clone().unwrap_or_else(|| beside(&self.file));
        let recovered = coinmc_recording::recover(&self.file, &out)?;
        match console.format() {
            Format::Json => output::print_json(&to_json(&recovered, &out)),
            Format::Table => output::print(&to_text(&recovered, &out)),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

/// `session.mcap` becomes `session.recovered.mcap`.
fn beside(file: &Path) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default();
    let mut name = stem.to_owned();
    name.push(".recovered.mcap");
    file.with_file_name(name)
}

fn to_text(recovered: &Recovered, out: &Path) -> String {
    let mut text = format!(
        "Recovered {} of {}, {} and {}.\n",
        count(recovered.messages, "message"),
        count(recovered.channels as u64, "channel"),
        count(recovered.attachments, "attachment"),
        count(recovered.metadata, "metadata record"),
    );
    if recovered.was_whole() {
        text += "The recording was not damaged.\n";
    } else {
        if !recovered.had_end {
            text += "The recording has no end: it was cut off or never finished.\n";
        }
        text += &format!(
            "Damaged: {} and {} in total; {} on unknown channels lost.\n",
            count(recovered.lost_bytes, "byte"),
            count(recovered.lost_chunks, "chunk"),
            count(recovered.lost_messages, "message"),
        );
    }
    if recovered.unknown_compression > 0 {
        text += &format!(
            "{} compressed in an unsupported format: coinmc reads LZ4.\n",
            match recovered.unknown_compression {
                1 => "1 chunk is".to_owned(),
                n => format!("{n} chunks are"),
            }
        );
    }
    text + &format!("\nRecording: {}\n", out.display())
}

fn to_json(recovered: &Recovered, out: &Path) -> Value {
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "recovered",
        "out": out.to_string_lossy(),
        "messages": recovered.messages,
        "channels": recovered.channels,
        "attachments": recovered.attachments,
        "metadata": recovered.metadata,
        "had_end": recovered.had_end,
        "lost_bytes": recovered.lost_bytes,
        "lost_chunks": recovered.lost_chunks,
        "unknown_compression": recovered.unknown_compression,
        "lost_messages": recovered.lost_messages,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_new_file_is_next_to_the_old_one() {
        assert_eq!(
            beside(Path::new("a/b.mcap")),
            Path::new("a/b.recovered.mcap")
        );
        assert_eq!(beside(Path::new("b")), Path::new("b.recovered.mcap"));
    }
}
