//! Progress of a session on standard error.

use crate::terminal::progress::{bar, note_above};
use crate::terminal::{Colors, Style, duration, grouped};
use coinmc_link::State;
use coinmc_robot::{Progress, ProgressSink, fault_text, state_name};
use indicatif::ProgressBar;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// A status line on terminals; notes and warnings everywhere.
pub(super) struct ProgressLine {
    bar: ProgressBar,
    style: Style,
    quiet: bool,
    started: Instant,
    last: Cell<Option<Instant>>,
}

/// Shortest time between two updates of the line.
const REDRAW: Duration = Duration::from_millis(50);

impl ProgressLine {
    pub(super) fn new(style: Style, quiet: bool) -> Self {
        Self {
            bar: bar(style, quiet),
            style,
            quiet,
            started: Instant::now(),
            last: Cell::new(None),
        }
    }

    pub(super) fn print(&self, text: &str) {
        note_above(&self.bar, text);
    }

    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl ProgressSink for ProgressLine {
    fn progress(&self, progress: &Progress) {
        let too_soon = self.last.get().is_some_and(|last| last.elapsed() < REDRAW);
        if self.bar.is_hidden() || too_soon {
            return;
        }
        self.last.set(Some(Instant::now()));
        self.bar.set_length(u64::from(progress.planned.max(1)));
        self.bar.set_position(u64::from(progress.resolved()));
        self.bar
            .set_message(message(progress, self.started.elapsed()));
    }

    fn note(&self, text: &str) {
        if !self.quiet {
            self.print(text);
        }
    }

    fn warning(&self, text: &str) {
        let title = self.style.paint(Colors::Warning, "warning:");
        self.print(&format!("{title} {text}"));
    }
}

/// `throw 1 234 at the coin  612 heads 598 tails 20 side 4 void  11 h left`
fn message(progress: &Progress, elapsed: Duration) -> String {
    let mut parts = Vec::new();
    parts.push(match &progress.status {
        None => "robot disconnected".to_owned(),
        Some(status) if status.state == State::Fault => fault_text(status.fault),
        Some(status) => format!(
            "throw {} {}",
            grouped(u64::from(status.throw_id)),
            state_name(status.state)
        ),
    });
    let [heads, tails, side] = progress.faces.map(|count| grouped(u64::from(count)));
    let mut counts = format!("{heads} heads {tails} tails {side} side");
    if progress.voids > 0 {
        counts += &format!(" {} void", grouped(u64::from(progress.voids)));
    }
    parts.push(counts);
    if progress.this_session > 0 {
        let left = f64::from(progress.planned.saturating_sub(progress.resolved()));
        let each = elapsed.as_secs_f64() / f64::from(progress.this_session);
        let left = Duration::try_from_secs_f64(left * each).unwrap_or(Duration::MAX);
        parts.push(format!("{} left", duration(left)));
    }
    parts.join("  ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_link::Status;

    #[test]
    fn the_line_shows_the_robots_state_and_the_counts() {
        let mut progress = Progress {
            status: Some(Status {
                state: State::AtCoin,
                throw_id: 1234,
                ..Status::default()
            }),
            planned: 2000,
            faces: [612, 598, 20],
            voids: 4,
            this_session: 100,
            losses: 0,
        };
        let line = message(&progress, Duration::from_secs(1000));
        assert_eq!(
            line,
            "throw 1 234 at the coin  612 heads 598 tails 20 side 4 void  2 h 07 min left"
        );
        progress.status = None;
        assert!(message(&progress, Duration::ZERO).starts_with("robot disconnected"));
        progress.status = Some(Status {
            state: State::Fault,
            fault: 103,
            ..Status::default()
        });
        let line = message(&progress, Duration::ZERO);
        assert!(line.starts_with("fault 103 (reset while flying)"), "{line}");
    }
}
