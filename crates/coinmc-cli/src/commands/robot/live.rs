//! How a session goes, on standard error.

use crate::terminal::progress::{bar, note_above};
use crate::terminal::{Colors, Style, duration, grouped};
use coinmc_link::State;
use coinmc_robot::{Live, ProgressSink, fault, name};
use indicatif::ProgressBar;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// A line that changes on a terminal, nothing elsewhere; notes and warnings everywhere.
pub(super) struct LiveLine {
    bar: ProgressBar,
    style: Style,
    quiet: bool,
    begun: Instant,
    last: Cell<Option<Instant>>,
}

/// Two looks at the line are at least this far apart.
const REDRAW: Duration = Duration::from_millis(50);

impl LiveLine {
    pub(super) fn new(style: Style, quiet: bool) -> Self {
        Self {
            bar: bar(style, quiet),
            style,
            quiet,
            begun: Instant::now(),
            last: Cell::new(None),
        }
    }

    pub(super) fn say(&self, text: &str) {
        note_above(&self.bar, text);
    }

    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl ProgressSink for LiveLine {
    fn live(&self, live: &Live) {
        let too_soon = self.last.get().is_some_and(|last| last.elapsed() < REDRAW);
        if self.bar.is_hidden() || too_soon {
            return;
        }
        self.last.set(Some(Instant::now()));
        self.bar.set_length(u64::from(live.planned.max(1)));
        self.bar.set_position(u64::from(live.resolved()));
        self.bar.set_message(message(live, self.begun.elapsed()));
    }

    fn note(&self, text: &str) {
        if !self.quiet {
            self.say(text);
        }
    }

    fn warning(&self, text: &str) {
        let title = self.style.paint(Colors::Warning, "warning:");
        self.say(&format!("{title} {text}"));
    }
}

/// `throw 1 234 at the coin  612 heads 598 tails 20 side 4 void  11 h left`
fn message(live: &Live, elapsed: Duration) -> String {
    let mut parts = Vec::new();
    parts.push(match &live.status {
        None => "robot out of reach".to_owned(),
        Some(status) if status.state == State::Fault => fault(status.fault),
        Some(status) => format!(
            "throw {} {}",
            grouped(u64::from(status.throw_id)),
            name(status.state)
        ),
    });
    let [heads, tails, side] = live.faces.map(|count| grouped(u64::from(count)));
    let mut counts = format!("{heads} heads {tails} tails {side} side");
    if live.voids > 0 {
        counts += &format!(" {} void", grouped(u64::from(live.voids)));
    }
    parts.push(counts);
    if live.here > 0 {
        let left = f64::from(live.planned.saturating_sub(live.resolved()));
        let each = elapsed.as_secs_f64() / f64::from(live.here);
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
    fn the_line_says_where_the_robot_is_and_how_it_stands() {
        let mut live = Live {
            status: Some(Status {
                state: State::AtCoin,
                throw_id: 1234,
                ..Status::default()
            }),
            planned: 2000,
            faces: [612, 598, 20],
            voids: 4,
            here: 100,
            losses: 0,
        };
        let line = message(&live, Duration::from_secs(1000));
        assert_eq!(
            line,
            "throw 1 234 at the coin  612 heads 598 tails 20 side 4 void  2 h 07 min left"
        );
        live.status = None;
        assert!(message(&live, Duration::ZERO).starts_with("robot out of reach"));
        live.status = Some(Status {
            state: State::Fault,
            fault: 103,
            ..Status::default()
        });
        let line = message(&live, Duration::ZERO);
        assert!(line.starts_with("fault 103 (reset while flying)"), "{line}");
    }
}
