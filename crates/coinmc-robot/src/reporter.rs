//! What a session tells the user, its log and its recording.

use crate::Face;
use crate::clock::unix_ms;
use crate::journal::{Journal, Resolution};
use crate::port::LinkEvent;
use crate::recording::SessionRecorder;
use crate::words::state_name;
use coinmc_link::{Seen, Status};
use coinmc_recording::foxglove::LogLevel;
use std::time::Duration;

/// Receives the progress of a session.
pub trait ProgressSink {
    /// The progress changed.
    fn progress(&self, progress: &Progress);
    /// Information for the user.
    fn note(&self, text: &str);
    /// A warning for the user.
    fn warning(&self, text: &str);
}

/// Progress of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// The robot's last status; `None` while it is disconnected.
    pub status: Option<Status>,
    /// Throws planned.
    pub planned: u32,
    /// Throws done, by face in the order of [`Face::ALL`].
    pub faces: [u32; 3],
    /// Void throws.
    pub voids: u32,
    /// Throws resolved in this session.
    pub this_session: u32,
    /// Losses of the connection in this session.
    pub losses: u32,
}

impl Progress {
    /// Throws resolved.
    pub fn resolved(&self) -> u32 {
        self.faces.iter().sum::<u32>() + self.voids
    }
}

/// Statistics of round-trip times, wall time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoundTrips {
    /// Number of requests with a reply.
    pub count: u64,
    /// Sum of their times.
    pub sum: Duration,
    /// The longest time.
    pub longest: Duration,
}

/// Reports to the sink, the log and the recording.
pub(crate) struct Reporter<'a> {
    pub(crate) sink: &'a dyn ProgressSink,
    pub(crate) recorder: Option<SessionRecorder>,
    pub(crate) progress: Progress,
    pub(crate) round_trips: RoundTrips,
}

impl Reporter<'_> {
    pub(crate) fn note(&mut self, text: &str) {
        self.sink.note(text);
        self.record(|to, now| to.log(LogLevel::Info, text, now));
    }

    pub(crate) fn warning(&mut self, text: &str) {
        self.sink.warning(text);
        self.record(|to, now| to.log(LogLevel::Warning, text, now));
    }

    /// Records until recording fails; throws then continue without, because the journal is what
    /// counts.
    pub(crate) fn record(
        &mut self,
        what: impl FnOnce(&mut SessionRecorder, u64) -> Result<(), coinmc_recording::Error>,
    ) {
        let Some(recorder) = &mut self.recorder else {
            return;
        };
        if let Err(error) = what(recorder, unix_ms().saturating_mul(1_000_000)) {
            self.recorder = None;
            self.sink.warning(&format!(
                "{error}. The session continues without a recording; the journal is complete"
            ));
        }
    }

    pub(crate) fn link_event(&mut self, event: &LinkEvent<'_>) {
        match event {
            LinkEvent::Exchanged {
                request,
                reply,
                took,
            } => {
                self.count(*took);
                self.record(|to, now| to.exchange(request, reply, *took, now));
            }
            LinkEvent::Opened(_) => {}
            LinkEvent::Lost { why, .. } => {
                // every failed attempt to reconnect is another event; report only the first
                if self.progress.status.take().is_some() {
                    self.progress.losses += 1;
                    self.note(&format!(
                        "the connection to the robot is lost ({why}); trying again"
                    ));
                    self.sink.progress(&self.progress);
                }
            }
            LinkEvent::Connected { greeting, seen } => {
                let state = format!("boot {}, {}", greeting.boot, state_name(greeting.state));
                match seen {
                    Seen::First => self.note(&format!("connected to the robot ({state})")),
                    Seen::Same => self.note(&format!("reconnected ({state})")),
                    Seen::NewBoot => {
                        self.note(&format!("reconnected; the robot was reset ({state})"));
                    }
                    Seen::Taken => {
                        self.warning("another program uses the same robot; end it");
                    }
                }
            }
        }
    }

    fn count(&mut self, took: Duration) {
        let trips = &mut self.round_trips;
        trips.count += 1;
        trips.sum += took;
        trips.longest = trips.longest.max(took);
    }
}

/// Progress according to the journal.
pub(crate) fn journal_progress(journal: &Journal, planned: u32) -> Progress {
    let mut progress = Progress {
        planned,
        ..Progress::default()
    };
    for throw in journal.history().throws() {
        match (throw.resolution, &throw.reading) {
            (Some(Resolution::Void(_)), _) => progress.voids += 1,
            (Some(Resolution::Done), Some((reading, _))) => {
                progress.faces[index(reading.face)] += 1;
            }
            _ => {}
        }
    }
    progress
}

pub(crate) fn index(face: Face) -> usize {
    match face {
        Face::Heads => 0,
        Face::Tails => 1,
        Face::Side => 2,
    }
}
