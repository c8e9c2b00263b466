//! What the tests of the whole program share: finding the binary, running it, comparing
//! transcripts.
//!
//! | test | what it holds the program to |
//! |---|---|
//! | `transcripts` | every verb and every class of error, as in `transcripts/*.md` |
//! | `documents` | README and docs: commands print what is shown, configs are valid |
//! | `resume` | a run killed anywhere ends in the same bytes |
//! | `parts` | parts, merged, and any number of threads make the same bytes |
//! | `streams` | standard output holds results only; pipes may break |
//! | `version` | `--version` names the commit, and run directories remember it |

mod program;
mod transcript;
mod tree;

pub use program::{coinmc, command, root};
pub use transcript::{Block, Shown, blocks, replay};
pub use tree::{copy, snapshot};
