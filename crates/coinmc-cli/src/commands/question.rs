//! What all questions share: the scene they are about, and tosses with progress that can be stopped.

use crate::exit::Failure;
use crate::interrupt;
use crate::output::Console;
use crate::terminal::progress::Progress;
use anyhow::Context;
use coinmc::config::{self, Override};
use coinmc_questions::scenes::EverydayScene;
use coinmc_questions::{QuestionError, Template, Workers};
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// The scene of a config, or the everyday scene of a name; the first of them without either.
pub(super) fn template(
    config: Option<&Path>,
    scene: Option<&str>,
    overrides: &[Override],
) -> Result<(Option<EverydayScene>, Template), Failure> {
    if let Some(path) = config {
        let text = config::read_text(path)?;
        let name = path.display().to_string();
        return Ok((None, Template::new(name, text, overrides)));
    }
    let scene = EverydayScene::named(scene.unwrap_or(EverydayScene::ALL[0].name))?;
    Ok((Some(scene), scene.template(overrides)))
}

/// Asks, with progress on standard error; `None` if Ctrl-C stopped it.
pub(super) fn ask<T>(
    console: &Console,
    quiet: bool,
    threads: Option<u16>,
    question: impl FnOnce(&Workers<'_>) -> Result<T, QuestionError>,
) -> Result<Option<T>, Failure> {
    let progress = Progress::new(*console.stderr(), quiet);
    let told = progress.clone();
    let cancel =
        interrupt::listen(move || told.note("stopping; press Ctrl-C again to stop at once"))
            .context("cannot listen for signals")
            .map_err(Failure::Runtime)?;
    let made = AtomicU64::new(0);
    let answer = question(&Workers {
        threads: threads.and_then(|n| NonZeroUsize::new(n.into())),
        cancel,
        made: &|tosses| progress.tossed(made.fetch_add(tosses, Ordering::Relaxed) + tosses),
    });
    progress.finish();
    match answer {
        Err(QuestionError::Stopped) => Ok(None),
        answer => Ok(Some(answer?)),
    }
}
