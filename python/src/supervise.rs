//! Supervision of long work: it runs on other threads without the interpreter lock, while this
//! thread handles signals (Ctrl-C) and progress.

use crate::errors;
use coinmc::run::{Latest, Progress, ProgressSink};
use coinmc_core::Estimate;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};
use std::time::Duration;

/// Interval at which signals are polled. Ctrl-C takes effect after this, at the next toss.
const POLL: Duration = Duration::from_millis(40);

/// State shared by the work and its supervisor.
#[derive(Default)]
pub(crate) struct Supervision {
    /// Set by the supervisor to stop the work.
    pub(crate) stop: AtomicBool,
    /// Tosses done.
    pub(crate) done: AtomicU64,
    /// Tosses planned.
    pub(crate) planned: AtomicU64,
    /// What a point has shown, since it was last told.
    latest: Mutex<Option<Latest>>,
    finished: AtomicBool,
    warnings: Mutex<Vec<String>>,
}

impl Supervision {
    /// Whether the work may continue.
    pub(crate) fn may_continue(&self) -> bool {
        !self.stop.load(Relaxed)
    }

    /// Takes the warnings reported so far.
    pub(crate) fn take_warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *warnings)
    }

    fn latest(&self) -> MutexGuard<'_, Option<Latest>> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ProgressSink for Supervision {
    fn progress(&self, progress: &Progress) {
        self.done.store(progress.tosses_done, Relaxed);
        self.planned.store(progress.tosses_planned, Relaxed);
        *self.latest() = progress.latest;
    }

    fn warning(&self, message: &str) {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        warnings.push(message.to_owned());
    }
}

/// Wakes the supervisor when the work ends, also by a panic.
struct FinishGuard<'a> {
    supervision: &'a Supervision,
    supervisor: Thread,
}

impl Drop for FinishGuard<'_> {
    fn drop(&mut self) {
        self.supervision.finished.store(true, Relaxed);
        self.supervisor.unpark();
    }
}

/// Runs `job` on another thread and returns its result and warnings; meanwhile calls
/// `progress(done, planned)`, and its `so_far(face, p, lo, hi)` if it has one. An exception from that or from a signal handler stops the job and is
/// then raised.
pub(crate) fn supervise<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    job: impl FnOnce(&Supervision) -> T + Send,
) -> PyResult<(T, Vec<String>)> {
    let supervision = Supervision::default();
    let (result, raised) = py.detach(|| {
        let supervisor = thread::current();
        thread::scope(|scope| {
            let supervision = &supervision;
            let worker = scope.spawn(move || {
                let _guard = FinishGuard {
                    supervision,
                    supervisor,
                };
                job(supervision)
            });
            let mut raised = Ok(());
            while !supervision.finished.load(Relaxed) {
                thread::park_timeout(POLL);
                if raised.is_ok() {
                    raised = Python::attach(|py| poll(py, supervision, progress.as_ref()));
                    supervision.stop.store(raised.is_err(), Relaxed);
                }
            }
            (worker.join(), raised)
        })
    });
    raised?;
    let result = result.unwrap_or_else(|panic| resume_unwind(panic));
    Ok((result, supervision.take_warnings()))
}

/// Runs a `job` that cannot be stopped and returns its result. If a signal handler raises
/// meanwhile, the job is abandoned: it runs on, and its result is discarded.
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
    let result: PyResult<Option<T>> = py.detach(move || {
        loop {
            match receiver.recv_timeout(POLL) {
                Ok(result) => return Ok(Some(result)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => Python::attach(signals)?,
            }
        }
    });
    match result? {
        Some(result) => Ok(result),
        // it ended without a result
        None => match worker.join() {
            Err(panic) => resume_unwind(panic),
            Ok(()) => unreachable!("a job that returns has sent its result"),
        },
    }
}

fn signals(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}

fn poll(py: Python<'_>, supervision: &Supervision, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    signals(py)?;
    if let Some(progress) = progress {
        let (done, planned) = (
            supervision.done.load(Relaxed),
            supervision.planned.load(Relaxed),
        );
        progress.call1(py, (done, planned))?;
        let latest = supervision.latest().take();
        if let Some(latest) = latest
            && let Some(so_far) = progress.bind(py).getattr_opt("so_far")?
        {
            let Estimate { p, lo, hi, .. } = latest.estimate;
            so_far.call1((latest.face.name(), p, lo, hi))?;
        }
    }
    Ok(())
}

/// The requested number of threads, or one per core.
pub(crate) fn threads(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    asked
        .or_else(|| thread::available_parallelism().ok())
        .unwrap_or(NonZeroUsize::MIN)
}
