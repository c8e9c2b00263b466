//! Transcripts in Markdown: fenced blocks of commands and what they print.
//!
//! ````text
//! ```console
//! $ coinmc run nothing.toml
//! ? 2
//! error: [..]
//! ...
//! ```
//! ````
//!
//! `$` begins a command (`>` continues it), run by `sh`; `? N` is its exit status where that is not
//! 0; all else is what it prints on both streams. `[..]` stands for any text within a line, a line
//! `...` for any number of lines. Commands of one document share a directory.
//!
//! With `COINMC_BLESS=1` in the environment documents are rewritten to what is printed; lines that
//! match stay as they are.

use crate::program::{coinmc, plain};
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::{env, fs};

/// A fenced block of a Markdown document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// What follows the opening fence: the language and whatever stands behind it.
    pub info: String,
    /// The lines between the fences.
    pub lines: Vec<String>,
    /// Number of the first of these lines, from 1.
    pub first_line: usize,
}

/// The fenced blocks of a document.
pub fn blocks(markdown: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, Block)> = None;
    for (number, line) in markdown.lines().enumerate() {
        let trimmed = line.trim_start();
        match &mut open {
            None if trimmed.starts_with("```") => {
                let info = trimmed.trim_start_matches('`');
                let fence = trimmed[..trimmed.len() - info.len()].to_owned();
                let info = info.trim().to_owned();
                open = Some((
                    fence,
                    Block {
                        info,
                        lines: Vec::new(),
                        first_line: number + 2,
                    },
                ));
            }
            None => {}
            Some((fence, _)) if trimmed.trim_end() == fence => {
                blocks.extend(open.take().map(|(_, block)| block));
            }
            Some((_, block)) => block.lines.push(line.to_owned()),
        }
    }
    blocks
}

/// How much of what a command prints a document has to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// All: where nothing is shown nothing is printed.
    Everything,
    /// All or nothing: where nothing is shown only the exit status counts.
    EverythingOrNothing,
}

/// One command of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Step {
    /// As written, markers included.
    written: Vec<String>,
    command: String,
    status: i32,
    output: Vec<String>,
}

/// Runs the `console` blocks of a document that `wanted` picks, in `dir`.
///
/// # Panics
/// If something else is printed than the document says.
pub fn replay(document: &Path, dir: &Path, shown: Shown, wanted: impl Fn(&Block) -> bool) {
    let text = fs::read_to_string(document)
        .unwrap_or_else(|error| panic!("{}: {error}", document.display()));
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut complaints = String::new();
    let picked = blocks(&text)
        .into_iter()
        .filter(|b| b.info == "console" && wanted(b));
    let runs: Vec<(Block, Vec<String>)> = picked
        .map(|block| {
            let steps = steps(&block);
            let now = steps
                .iter()
                .flat_map(|step| run(step, dir, shown, &mut complaints))
                .collect();
            (block, now)
        })
        .collect();
    if complaints.is_empty() {
        return;
    }
    if env::var_os("COINMC_BLESS").is_some() {
        // From the end, so that numbers of lines before stay true.
        for (block, now) in runs.into_iter().rev() {
            let start = block.first_line - 1;
            lines.splice(start..start + block.lines.len(), now);
        }
        fs::write(document, lines.join("\n") + "\n").expect("the document can be written");
        return;
    }
    panic!(
        "{} (COINMC_BLESS=1 accepts):\n{complaints}",
        document.display()
    );
}

fn steps(block: &Block) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    for line in &block.lines {
        if let Some(command) = line.strip_prefix("$ ") {
            let written = vec![line.clone()];
            let command = command.to_owned();
            steps.push(Step {
                written,
                command,
                status: 0,
                output: Vec::new(),
            });
            continue;
        }
        let Some(step) = steps.last_mut() else {
            continue;
        };
        let is_first = step.output.is_empty();
        if let Some(more) = line.strip_prefix("> ").filter(|_| is_first) {
            step.written.push(line.clone());
            step.command.push('\n');
            step.command.push_str(more);
        } else if let Some(status) = line.strip_prefix("? ").filter(|_| is_first) {
            step.status = status.trim().parse().expect("`? N` gives an exit status");
        } else {
            step.output.push(line.clone());
        }
    }
    steps
}

/// Runs a step and returns it as it should have been written.
fn run(step: &Step, dir: &Path, shown: Shown, complaints: &mut String) -> Vec<String> {
    let binary = coinmc();
    // What users type in the repository; here the program is built already.
    let script = step.command.replace("cargo run --release -- ", "coinmc ");
    let path = format!(
        "{}:{}",
        binary
            .parent()
            .expect("a binary lies in a folder")
            .display(),
        env::var("PATH").unwrap_or_default()
    );
    let mut command = Command::new("sh");
    plain(&mut command, dir);
    let output = command
        .args(["-c", &format!("exec 2>&1\n{script}")])
        .env("PATH", path)
        .stdin(Stdio::null())
        .output()
        .expect("sh starts");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let printed: Vec<&str> = printed.lines().filter(|line| !is_progress(line)).collect();
    let status = output.status.code().unwrap_or(-1);
    let mut now = step.written.clone();
    if status != 0 {
        now.push(format!("? {status}"));
    }
    let unshown = shown == Shown::EverythingOrNothing && step.output.is_empty();
    if status == step.status && (unshown || all_match(&step.output, &printed)) {
        now.extend(step.output.iter().cloned());
        return now;
    }
    let _ = writeln!(complaints, "\n$ {}", step.command);
    if status != step.status {
        let _ = writeln!(complaints, "exit status {status}, expected {}", step.status);
    }
    for (i, line) in printed.iter().enumerate() {
        let expected = step.output.get(i);
        let same = expected.is_some_and(|expected| line_matches(expected, line));
        let _ = writeln!(complaints, "{} {line}", if same { ' ' } else { '!' });
        now.push(if same {
            step.output[i].clone()
        } else {
            (*line).to_owned()
        });
    }
    let _ = writeln!(complaints, "expected:\n  {}", step.output.join("\n  "));
    now
}

fn all_match(expected: &[String], printed: &[&str]) -> bool {
    match expected.split_first() {
        None => printed.is_empty(),
        Some((first, rest)) if first.trim() == "..." => {
            (0..=printed.len()).any(|skipped| all_match(rest, &printed[skipped..]))
        }
        Some((first, rest)) => printed
            .split_first()
            .is_some_and(|(line, after)| line_matches(first, line) && all_match(rest, after)),
    }
}

/// A line of progress, which a slow machine prints after a second.
fn is_progress(line: &str) -> bool {
    line.starts_with("coinmc: ") && line.ends_with(" left") && line.contains(" tosses  ")
}

/// `[..]` matches any text, as short as can be.
fn line_matches(pattern: &str, line: &str) -> bool {
    let mut parts = pattern.trim_end().split("[..]");
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = line.trim_end().strip_prefix(first) else {
        return false;
    };
    let mut parts = parts.peekable();
    if parts.peek().is_none() {
        return rest.is_empty();
    }
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            return rest.ends_with(part);
        }
        let Some(place) = rest.find(part) else {
            return false;
        };
        rest = &rest[place + part.len()..];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wildcards_match_within_and_across_lines() {
        assert!(line_matches("a [..] c", "a b c") && line_matches("[..]", ""));
        assert!(line_matches("x[..]y[..]z", "x1y2z") && !line_matches("x[..]y", "x1z"));
        assert!(!line_matches("a", "ab") && !line_matches("a[..]a", "a"));
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        assert!(all_match(&lines("a\n...\nd"), &["a", "b", "c", "d"]));
        assert!(all_match(&lines("a\n..."), &["a"]) && !all_match(&lines("a"), &["a", "b"]));
    }

    #[test]
    fn blocks_know_their_language_and_place() {
        let found = blocks("text\n```toml\na = 1\n```\n````md\n```\n````\n");
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].info.as_str(), found[0].first_line), ("toml", 3));
        assert_eq!(found[1].lines, ["```"]);
    }

    #[test]
    fn steps_have_commands_statuses_and_output() {
        let text = "```console\n$ a \\\n> b\n? 2\nx\n$ c\n```";
        let [first, second] = &steps(&blocks(text)[0])[..] else {
            panic!("two steps")
        };
        assert_eq!((first.command.as_str(), first.status), ("a \\\nb", 2));
        assert_eq!(first.output, ["x"]);
        assert_eq!((second.command.as_str(), second.status), ("c", 0));
    }
}
