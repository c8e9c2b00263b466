//! Progress on standard error: a bar at a terminal, now and then a line elsewhere.

mod lines;
mod message;

use super::{Style, compact, grouped, harmless};
use coinmc::plan::Plan;
use coinmc::run::{Progress as Counts, ProgressSink};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lines::Lines;
use message::{Made, message};
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Columns of a bar and the space behind it.
const BAR: usize = 13;

/// Tosses this run found done when it began, and when that was.
#[derive(Debug, Clone, Copy)]
struct Start {
    tosses: u64,
    /// Of them, those that an earlier run had counted.
    reused: u64,
    at: Instant,
}

/// A bar on a terminal, of runs a line now and then elsewhere; warnings everywhere. Clones share the bar.
#[derive(Debug, Clone)]
pub(crate) struct Progress {
    bar: ProgressBar,
    style: Style,
    quiet: bool,
    start: Arc<OnceLock<Start>>,
    /// Tosses of an earlier run that are counted so far.
    reused: Arc<AtomicU64>,
    /// The plan whose points are named.
    plan: Option<Arc<Plan>>,
    /// When to print a line where there is no bar.
    lines: Arc<Lines>,
}

/// A bar on standard error, hidden if that is no terminal or `quiet`.
pub(crate) fn bar(style: Style, quiet: bool) -> ProgressBar {
    let target = if !quiet && io::stderr().is_terminal() {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(None, target);
    let template = if style.color {
        "{bar:12.cyan/dim} {wide_msg}"
    } else {
        "{bar:12} {wide_msg}"
    };
    let characters = if style.unicode { "━╸─" } else { "=>-" };
    let look = ProgressStyle::with_template(template).expect("the template is valid");
    bar.set_style(look.progress_chars(characters));
    bar
}

/// A line of text above a bar, on standard error.
pub(crate) fn note_above(bar: &ProgressBar, text: &str) {
    bar.suspend(|| {
        // a failure to write cannot be reported anywhere
        let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
    });
}

impl Progress {
    /// A bar for standard error, hidden if that is no terminal or `quiet`.
    pub(crate) fn new(style: Style, quiet: bool) -> Self {
        Self {
            bar: bar(style, quiet),
            style,
            quiet,
            start: Arc::default(),
            reused: Arc::default(),
            plan: None,
            lines: Arc::new(Lines::new(quiet || io::stderr().is_terminal())),
        }
    }

    /// The same for a run, whose points it names.
    pub(crate) fn of(plan: &Plan, style: Style, quiet: bool) -> Self {
        Self {
            plan: Some(Arc::new(plan.clone())),
            ..Self::new(style, quiet)
        }
    }

    /// A line of text above the bar, on standard error.
    pub(crate) fn note(&self, text: &str) {
        note_above(&self.bar, text);
    }

    /// Shows that so many tosses of at most `limit` have been searched.
    pub(crate) fn searched(&self, tosses: u64, limit: u64) {
        let start = self.start.get_or_init(|| Start {
            tosses: 0,
            reused: 0,
            at: Instant::now(),
        });
        self.bar.set_length(limit.max(1));
        self.bar.set_position(tosses.min(limit));
        if !self.bar.is_hidden() {
            let rate = tosses as f64 / start.at.elapsed().as_secs_f64();
            let message = format!(
                "searched {} tosses  {}/s",
                grouped(tosses),
                with_prefix(rate)
            );
            self.bar.set_message(message);
        }
    }

    /// Shows that so many tosses have been made, of nobody knows how many.
    pub(crate) fn tossed(&self, tosses: u64) {
        let start = self.start.get_or_init(|| Start {
            tosses: 0,
            reused: 0,
            at: Instant::now(),
        });
        if !self.bar.is_hidden() {
            let rate = tosses as f64 / start.at.elapsed().as_secs_f64();
            self.bar.set_message(format!(
                "{} tosses  {}/s",
                grouped(tosses),
                with_prefix(rate)
            ));
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Tosses made by this process and the time they took.
    pub(crate) fn made(&self, tosses_done: u64) -> (u64, Duration) {
        self.start.get().map_or((0, Duration::ZERO), |start| {
            let reused = self.reused.load(Relaxed).saturating_sub(start.reused);
            let earlier = start.tosses.saturating_add(reused);
            (tosses_done.saturating_sub(earlier), start.at.elapsed())
        })
    }
}

impl ProgressSink for Progress {
    fn progress(&self, counts: &Counts) {
        self.start.get_or_init(|| Start {
            tosses: counts.tosses_done,
            reused: counts.tosses_reused,
            at: Instant::now(),
        });
        self.reused.store(counts.tosses_reused, Relaxed);
        self.bar.set_length(counts.tosses_planned.max(1));
        self.bar
            .set_position(counts.tosses_done.min(counts.tosses_planned));
        let (tosses, time) = self.made(counts.tosses_done);
        let made = Made { tosses, time };
        if !self.bar.is_hidden() {
            let room = self.style.width.saturating_sub(BAR);
            let text = message(counts, made, self.plan.as_deref(), room, &self.style);
            self.bar.set_message(text);
        } else if self.plan.is_some()
            && counts.points_done < counts.points
            && self.lines.is_due(time)
        {
            let text = message(counts, made, self.plan.as_deref(), usize::MAX, &self.style);
            self.note(&format!("coinmc: {text}"));
        }
    }

    fn warning(&self, message: &str) {
        let title = self.style.paint(super::Colors::Warning, "warning:");
        self.note(&format!("{title} {message}"));
    }

    fn note(&self, message: &str) {
        if !self.quiet {
            Self::note(self, &format!("note: {message}"));
        }
    }
}

/// Three digits with k, M or G.
pub(crate) fn with_prefix(x: f64) -> String {
    for (least, prefix) in [(1e9, " G"), (1e6, " M"), (1e3, " k")] {
        if x >= least {
            return format!("{:.*}{prefix}", decimals(x / least), x / least);
        }
    }
    compact(libm::round(x))
}

fn decimals(x: f64) -> usize {
    if x < 10.0 { 2 } else { usize::from(x < 100.0) }
}

#[cfg(test)]
mod tests {
    use super::message::counts;
    use super::*;

    #[test]
    fn rates_have_three_digits() {
        for (x, text) in [
            (999.4, "999"),
            (1_234.0, "1.23 k"),
            (812_000.0, "812 k"),
            (45_600_000.0, "45.6 M"),
            (2e9, "2.00 G"),
        ] {
            assert_eq!(with_prefix(x), text);
        }
    }

    #[test]
    fn time_and_tosses_count_from_the_first_report() {
        let progress = Progress::new(Style::plain(80), true);
        assert_eq!(progress.made(5), (0, Duration::ZERO));
        progress.progress(&counts());
        assert_eq!(progress.made(1_234_667).0, 100);
        // tosses of an earlier run may be counted later
        progress.progress(&Counts {
            tosses_reused: 234_607,
            ..counts()
        });
        assert_eq!(progress.made(1_234_667).0, 60);
    }
}
