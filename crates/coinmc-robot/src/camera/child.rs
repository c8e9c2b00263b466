//! One camera process: starting it, sending requests, ending it.

use super::log::Log;
use super::protocol::{CameraReply, LONGEST_LINE, Request};
use rustix::process::{Pid, Signal, kill_process_group};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// Ends its process group when its standard input ends: when the host has ended, however it ended.
const GUARD: &str = "while read -r _; do :; done; kill -KILL 0";

/// After a reply nothing more may come for this time: a camera that answers before it is asked has not
/// looked.
const QUIET: Duration = Duration::from_millis(5);

/// Why a photo failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// It cannot be started.
    #[error("the camera cannot be started: {0}")]
    Start(io::Error),
    /// It did not reply in time.
    #[error("the camera has not replied within {} s", .0.as_secs_f64())]
    Silent(Duration),
    /// It ended.
    #[error("the camera program ended")]
    Ended,
    /// Its line is too long.
    #[error("the camera sent a line of more than {LONGEST_LINE} bytes")]
    TooLong,
    /// It sent something else than a valid reply.
    #[error("the camera sent {0}")]
    CameraReply(String),
    /// The photo shows no face.
    #[error("no face can be read in the photo")]
    NoFace,
    /// The photo does not exist, is not a new picture or cannot be synced to disk.
    #[error("photo {name}: {error}")]
    Photo {
        /// Its name.
        name: String,
        /// The system's error.
        error: io::Error,
    },
}

/// A running camera.
#[derive(Debug)]
pub(super) struct CameraChild {
    /// Leads the process group.
    guard: Child,
    child: Child,
    input: ChildStdin,
    lines: Receiver<Result<Vec<u8>, CameraError>>,
}

impl CameraChild {
    /// Starts a shell command, whose standard error goes to `log`.
    pub(super) fn start(command: &str, log: &Log) -> Result<Self, CameraError> {
        let shell = |script: &str, group: i32| {
            let mut shell = Command::new("sh");
            // only the host handles Ctrl-C: it ends the camera once the throw is finished
            shell.args(["-c", script]).process_group(group);
            shell
        };
        let guard = shell(GUARD, 0)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(CameraError::Start)?;
        let group = i32::try_from(guard.id()).unwrap_or(0);
        let started = shell(command, group)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = match started {
            Ok(child) => child,
            Err(error) => {
                end(guard);
                return Err(CameraError::Start(error));
            }
        };
        let streams = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(input), Some(output), Some(errors)) = streams else {
            end(guard);
            return Err(CameraError::Ended);
        };
        log.follow(errors);
        let (sender, lines) = mpsc::sync_channel(1);
        thread::spawn(move || read_lines(output, |line| sender.send(line).is_ok()));
        Ok(Self {
            guard,
            child,
            input,
            lines,
        })
    }

    /// Sends a request and waits for the reply.
    pub(super) fn request(
        &mut self,
        request: &Request,
        timeout: Duration,
    ) -> Result<CameraReply, CameraError> {
        // An unsolicited line would be taken for the reply, and all replies would be one too late.
        self.expect_quiet(Duration::ZERO)?;
        let mut line = serde_json::to_vec(request)
            .map_err(|error| CameraError::CameraReply(format!("nothing: {error}")))?;
        line.push(b'\n');
        self.input
            .write_all(&line)
            .and_then(|()| self.input.flush())
            .map_err(|_| CameraError::Ended)?;
        let reply = match self.lines.recv_timeout(timeout) {
            Ok(line) => {
                CameraReply::read(&line?, request.about()).map_err(CameraError::CameraReply)?
            }
            Err(RecvTimeoutError::Timeout) => return Err(CameraError::Silent(timeout)),
            Err(RecvTimeoutError::Disconnected) => return Err(CameraError::Ended),
        };
        self.expect_quiet(QUIET)?;
        Ok(reply)
    }

    fn expect_quiet(&self, wait: Duration) -> Result<(), CameraError> {
        match self.lines.recv_timeout(wait) {
            Ok(line) => {
                line?;
                Err(CameraError::CameraReply(
                    "a line without a request".to_owned(),
                ))
            }
            // if it has ended, the next request finds out
            Err(_) => Ok(()),
        }
    }
}

impl Drop for CameraChild {
    /// Kills the whole process group, because otherwise a child of the shell would keep the camera.
    fn drop(&mut self) {
        kill_group(&self.guard);
        let _ = self.guard.wait();
        let _ = self.child.wait();
    }
}

fn end(mut guard: Child) {
    kill_group(&guard);
    let _ = guard.wait();
}

fn kill_group(guard: &Child) {
    let group = i32::try_from(guard.id()).ok().and_then(Pid::from_raw);
    if let Some(group) = group {
        // it may have ended already
        let _ = kill_process_group(group, Signal::KILL);
    }
}

/// Passes on lines until the output ends or the receiver is gone.
fn read_lines(output: ChildStdout, mut send: impl FnMut(Result<Vec<u8>, CameraError>) -> bool) {
    let mut output = BufReader::new(output);
    loop {
        let mut line = Vec::new();
        let read = output
            .by_ref()
            .take(LONGEST_LINE as u64)
            .read_until(b'\n', &mut line);
        let line = match read {
            Ok(0) | Err(_) => return,
            Ok(_) if line.ends_with(b"\n") => Ok(line),
            Ok(LONGEST_LINE) => Err(CameraError::TooLong),
            Ok(_) => return,
        };
        if !send(line) {
            return;
        }
    }
}
