//! Long work: done on other threads without the interpreter's lock, while this thread looks after
//! signals (Ctrl-C) and progress.

use crate::errors;
use coinmc::run::{Progress, ProgressSink};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Thread};
use std::time::Duration;

/// How often signals are looked at: Ctrl-C is heard after this, and work stops at the next toss.
const POLL: Duration = Duration::from_millis(40);

/// Where work and supervisor meet.
#[derive(Default)]
pub(crate) struct Desk {
    /// Set by the supervisor: stop.
    pub(crate) stop: AtomicBool,
    /// Tosses done.
    pub(crate) done: AtomicU64,
    /// Tosses to do.
    pub(crate) planned: AtomicU64,
    finished: AtomicBool,
    warnings: Mutex<Vec<String>>,
}

impl Desk {
    /// Whether work may go on.
    pub(crate) fn go_on(&self) -> bool {
        !self.stop.load(Relaxed)
    }

    /// What went wrong and was dealt with.
    pub(crate) fn take_warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *warnings)
    }
}

impl ProgressSink for Desk {
    fn progress(&self, progress: &Progress) {
        self.done.store(progress.tosses_done, Relaxed);
        self.planned.store(progress.tosses_planned, Relaxed);
    }

    fn warning(&self, message: &str) {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        warnings.push(message.to_owned());
    }
}

/// Wakes the supervisor when work ends, also by a panic.
struct Bell<'a> {
    desk: &'a Desk,
    supervisor: Thread,
}

impl Drop for Bell<'_> {
    fn drop(&mut self) {
        self.desk.finished.store(true, Relaxed);
        self.supervisor.unpark();
    }
}

/// Does `job` on another thread and gives what it returns; meanwhile calls `progress(done,
/// planned)`, and raises what that or a signal handler raises once the job has stopped.
pub(crate) fn supervise<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    job: impl FnOnce(&Desk) -> T + Send,
) -> PyResult<(T, Vec<String>)> {
    let desk = Desk::default();
    let (made, raised) = py.detach(|| {
        let supervisor = thread::current();
        thread::scope(|scope| {
            let desk = &desk;
            let worker = scope.spawn(move || {
                let _bell = Bell { desk, supervisor };
                job(desk)
            });
            let mut raised = Ok(());
            while !desk.finished.load(Relaxed) {
                thread::park_timeout(POLL);
                if raised.is_ok() {
                    raised = Python::attach(|py| attend(py, desk, progress.as_ref()));
                    desk.stop.store(raised.is_err(), Relaxed);
                }
            }
            (worker.join(), raised)
        })
    });
    raised?;
    let made = made.unwrap_or_else(|panic| resume_unwind(panic));
    Ok((made, desk.take_warnings()))
}

/// Does a `job` that cannot be told to stop, and gives what it returns. If a signal handler raises
/// meanwhile the job is left alone: nobody waits for it, and what it finds is thrown away.
pub(crate) fn wait_for<T: Send + 'static>(
    py: Python<'_>,
    job: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = sync_channel(1);
    let worker = thread::Builder::new().spawn(move || {
        // nobody may be waiting any more
        let _ = sender.send(job());
    });
    let worker =
        worker.map_err(|error| errors::value(format!("cannot start a thread: {error}")))?;
    let made: PyResult<Option<T>> = py.detach(move || {
        loop {
            match receiver.recv_timeout(POLL) {
                Ok(made) => return Ok(Some(made)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => Python::attach(signals)?,
            }
        }
    });
    match made? {
        Some(made) => Ok(made),
        // it ended without an answer
        None => match worker.join() {
            Err(panic) => resume_unwind(panic),
            Ok(()) => unreachable!("a job that returns has sent what it made"),
        },
    }
}

fn signals(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}

fn attend(py: Python<'_>, desk: &Desk, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    signals(py)?;
    if let Some(progress) = progress {
        let (done, planned) = (desk.done.load(Relaxed), desk.planned.load(Relaxed));
        progress.call1(py, (done, planned))?;
    }
    Ok(())
}

/// The threads asked for, or one a core.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    asked
        .or_else(|| thread::available_parallelism().ok())
        .unwrap_or(NonZeroUsize::MIN)
}
