//! The connection over a line that fails at every call in every way: the experiment goes on, no throw is
//! made twice or misrecorded, and none is void for it.

mod world;

use coinmc_robot::Clock;
use coinmc_robot::cycle::{Cycle, Photo, Shown, Step};
use coinmc_robot::journal::{Digest, Entry, Resolution, parse};
use coinmc_robot::port::{Connection, Line, Opener, PortError, RequestOutcome};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;
use world::{MAX_STEPS, PROGRAM, World, rules, setting, true_face};

/// How much faster than life the host's clock runs.
const SPEED: f64 = 1e3;

/// How a call fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Failure {
    Error,
    /// Of a write: after everything was sent.
    LateError,
    /// Of a read: the end of the file; of a write: nothing is taken.
    Nothing,
    /// One byte only.
    Short,
    Interrupted,
    TimedOut,
}

const FAILURES: [Failure; 6] = [
    Failure::Error,
    Failure::LateError,
    Failure::Nothing,
    Failure::Short,
    Failure::Interrupted,
    Failure::TimedOut,
];

/// The robot at the other end, and what is on its way from there.
struct Far {
    world: World,
    arriving: VecDeque<u8>,
    calls: u32,
    failures: Vec<(u32, Failure)>,
    injected: u32,
}

#[derive(Clone)]
struct Cable(Arc<Mutex<Far>>);

impl std::fmt::Debug for Cable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Cable")
    }
}

impl Cable {
    fn far(&self) -> MutexGuard<'_, Far> {
        self.0.lock().unwrap()
    }

    fn call(&self) -> io::Result<Option<Failure>> {
        let mut far = self.far();
        far.calls += 1;
        let calls = far.calls;
        let failure = far.failures.iter().find(|(at, _)| *at == calls);
        let failure = failure.map(|(_, failure)| *failure);
        far.injected += u32::from(failure.is_some());
        match failure {
            Some(Failure::Error) => Err(io::Error::from_raw_os_error(5)),
            Some(Failure::Interrupted) => Err(io::ErrorKind::Interrupted.into()),
            Some(Failure::TimedOut) => Err(io::ErrorKind::TimedOut.into()),
            other => Ok(other),
        }
    }
}

impl Read for Cable {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let failure = self.call()?;
        let mut far = self.far();
        if failure == Some(Failure::Nothing) {
            return Ok(0);
        }
        if far.arriving.is_empty() {
            far.world.pass(10);
            drop(far);
            std::thread::sleep(Duration::from_micros(20));
            return Err(io::ErrorKind::TimedOut.into());
        }
        let most = if failure == Some(Failure::Short) {
            1
        } else {
            buffer.len()
        };
        let count = far.arriving.len().min(most);
        for (to, byte) in buffer.iter_mut().zip(far.arriving.drain(..count)) {
            *to = byte;
        }
        Ok(count)
    }
}

impl Write for Cable {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let failure = self.call()?;
        if failure == Some(Failure::Nothing) {
            return Ok(0);
        }
        let most = if failure == Some(Failure::Short) {
            1
        } else {
            bytes.len()
        };
        let mut far = self.far();
        let now = world::chip_ms(far.world.now_ms);
        for byte in &bytes[..most] {
            let answer = far.world.device().receive(*byte, now).map(<[u8]>::to_vec);
            far.arriving.extend(answer.unwrap_or_default());
        }
        if failure == Some(Failure::LateError) {
            return Err(io::Error::from_raw_os_error(5));
        }
        Ok(most)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Line for Cable {
    fn set_patience(&mut self, _: Duration) -> io::Result<()> {
        self.call().map(drop)
    }
}

impl Opener for Cable {
    fn open(&mut self) -> Result<Box<dyn Line>, PortError> {
        let path = || "cable".into();
        match self.call() {
            Err(error) => Err(PortError::Io {
                path: path(),
                error,
            }),
            Ok(Some(Failure::Nothing)) => Err(PortError::Missing { path: path() }),
            Ok(_) => {
                self.far().arriving.clear();
                Ok(Box::new(self.clone()))
            }
        }
    }
}

/// An experiment to its end; the number of calls of the line, and of failures.
fn experiment(failures: Vec<(u32, Failure)>) -> (u32, u32) {
    let cable = Cable(Arc::new(Mutex::new(Far {
        world: World::new(Vec::new()),
        arriving: VecDeque::new(),
        calls: 0,
        failures,
        injected: 0,
    })));
    let opened = Connection::over(
        Box::new(cable.clone()),
        Path::new("cable"),
        Clock::new(SPEED),
        None,
        &|| false,
    );
    let Ok(mut connection) = opened else {
        return (0, cable.far().injected); // reported at once: nothing was done
    };
    let (mut cycle, parsed) = (
        Cycle::new(rules(false), PROGRAM),
        parse(&cable.far().world.file),
    );
    let parsed = parsed.unwrap();
    let (mut history, mut checksum) = (parsed.history, parsed.checksum);
    for steps in 0.. {
        assert!(steps < MAX_STEPS, "the host goes on and on");
        let entry = match cycle.step(&history, 7) {
            Step::Request(request) => {
                let outcome = connection.request(&request, &|| false, &mut |_| {});
                match outcome.unwrap() {
                    RequestOutcome::Reply(reply) => cycle.replied(&request, &reply),
                    RequestOutcome::Connected { greeting, .. } => cycle.connected(&greeting),
                    RequestOutcome::GivenUp => unreachable!(),
                }
                continue;
            }
            Step::Wait => {
                cable.far().world.pass(100);
                cycle.waited();
                continue;
            }
            Step::Photograph { id, attempt } => {
                let face = true_face(cable.far().world.device().hardware());
                let image = format!("{id:06}-{attempt}.png").parse().unwrap();
                let digest = Digest(u64::from(id));
                cycle.photographing(id, attempt);
                let shown = Shown::Face {
                    face,
                    image,
                    digest,
                };
                cycle.photographed(Photo { id, attempt, shown });
                continue;
            }
            Step::Announce { throw, id } => Entry::Announced {
                id,
                setting: setting(throw),
                at_ms: 7,
            },
            Step::Write(entry) => entry,
            Step::Finished => break,
            Step::Halt(halt) => panic!("{halt}"),
        };
        let mut far = cable.far();
        assert!(
            far.world
                .append(&mut history, &mut checksum, &entry)
                .is_ok()
        );
        cycle.written(&entry);
    }
    let mut far = cable.far();
    far.world.audit();
    let done = |of: &&coinmc_robot::journal::Throw| of.resolution == Some(Resolution::Done);
    assert_eq!(history.throws().iter().filter(done).count(), 6);
    (far.calls, far.injected)
}

#[test]
fn no_error_of_the_line_costs_or_doubles_a_throw() {
    let (calls, _) = experiment(Vec::new());
    assert!(calls > 100, "{calls}");
    let mut injected = 0;
    for call in 1..=calls {
        for (number, failure) in FAILURES.into_iter().enumerate() {
            // alone, or with another one soon after
            let mut failures = vec![(call, failure)];
            if (call as usize + number).is_multiple_of(3) {
                let other = FAILURES[(call as usize / 3 + number) % 6];
                failures.push((call + 1 + call % 4, other));
            }
            injected += experiment(failures).1;
        }
    }
    assert!(injected > 6 * calls, "{injected}");
    println!("{injected} failures of {calls} calls");
}
