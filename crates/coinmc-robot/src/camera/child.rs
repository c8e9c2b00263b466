//! One camera process: starting it, sending requests, ending it.

use super::protocol::{CameraReply, LONGEST_LINE, Request};
use rustix::process::{Pid, Signal, kill_process_group};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;
use thiserror::Error;

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
    /// The photo does not exist, is not a file or cannot be synced to disk.
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
    child: Child,
    input: ChildStdin,
    lines: Receiver<Result<Vec<u8>, CameraError>>,
}

impl CameraChild {
    /// Starts a shell command, with its standard error redirected to `log`.
    pub(super) fn start(command: &str, log: Option<File>) -> Result<Self, CameraError> {
        let mut child = Command::new("sh")
            .args(["-c", command])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(log.map_or_else(Stdio::null, Stdio::from))
            // only the host handles Ctrl-C: it ends the camera once the throw is finished
            .process_group(0)
            .spawn()
            .map_err(CameraError::Start)?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(CameraError::Ended);
        };
        let (sender, lines) = mpsc::sync_channel(1);
        thread::spawn(move || read_lines(output, |line| sender.send(line).is_ok()));
        Ok(Self {
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
        if let Ok(line) = self.lines.try_recv() {
            line?;
            return Err(CameraError::CameraReply(
                "a line without a request".to_owned(),
            ));
        }
        let mut line = serde_json::to_vec(request)
            .map_err(|error| CameraError::CameraReply(format!("nothing: {error}")))?;
        line.push(b'\n');
        self.input
            .write_all(&line)
            .and_then(|()| self.input.flush())
            .map_err(|_| CameraError::Ended)?;
        match self.lines.recv_timeout(timeout) {
            Ok(line) => CameraReply::read(&line?).map_err(CameraError::CameraReply),
            Err(RecvTimeoutError::Timeout) => Err(CameraError::Silent(timeout)),
            Err(RecvTimeoutError::Disconnected) => Err(CameraError::Ended),
        }
    }
}

impl Drop for CameraChild {
    /// Kills the whole process group, because otherwise a child of the shell would keep the camera.
    fn drop(&mut self) {
        let group = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw);
        if let Some(group) = group {
            // it may have ended already
            let _ = kill_process_group(group, Signal::KILL);
        }
        let _ = self.child.wait();
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
