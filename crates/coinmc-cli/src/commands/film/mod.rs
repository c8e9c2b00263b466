//! `coinmc film`: filmed drops.

mod files;
mod fit;
mod law;
mod read;
mod report;
mod scene;
mod synthesise;

use crate::exit::{Failure, Outcome};
use crate::output::{Console, Format};
use clap::{Args, Subcommand};
use fit::Fit;
use read::Read;
use synthesise::Synthesise;

const EXAMPLES: &str = "\
Examples:
  coinmc film read examples/drop-film.txt                      show how a file is interpreted
  coinmc film fit examples/drop-film.txt --ratio 1 --radius-m 0.01
  coinmc film fit a.txt b.txt --config toss.toml --law moreau,chatterjee-ruina -o fit.json
  coinmc film synthesise drop.txt --ratio 1 --radius-m 0.01    a drop filmed in the computer";

/// Fit impact laws to filmed coins
///
/// Reads the text that Tracker (Open Source Physics) exports: a time, x and y of the coin's centre
/// and an angle for each frame. docs/guide/film.md leads from a video to a fitted law.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, arg_required_else_help = true)]
pub(crate) struct Film {
    #[command(subcommand)]
    verb: Verb,
}

/// The help of each verb is with its arguments.
#[derive(Debug, Subcommand)]
enum Verb {
    Read(Read),
    Fit(Box<Fit>),
    Synthesise(Synthesise),
}

impl Film {
    pub(crate) fn format(&self) -> Format {
        match &self.verb {
            Verb::Read(read) => read.format(),
            Verb::Fit(fit) => fit.format(),
            Verb::Synthesise(synthesise) => synthesise.format(),
        }
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        match &self.verb {
            Verb::Read(read) => read.execute(console),
            Verb::Fit(fit) => fit.execute(console),
            Verb::Synthesise(synthesise) => synthesise.execute(console),
        }
    }
}
