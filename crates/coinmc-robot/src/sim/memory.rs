//! The simulated robot's EEPROM: in memory, or in a file that outlives the simulation. As in a real one
//! every byte takes its time, and a reset in between leaves the record before.

use crate::files::{read_text, replace_file};
use coinmc_link::{Record, State};
use std::io;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// Bytes of a record, and how long each takes, by the data sheet of the ATmega328P.
pub(super) const RECORD_BYTES: u32 = 17;
const BYTE: Duration = Duration::from_micros(3_400);

/// Keeps the newest record.
#[derive(Debug)]
pub(super) struct Memory {
    file: Option<PathBuf>,
    record: Option<Record>,
    /// How much faster than life it is.
    speed: f64,
    /// A reset comes after so many bytes of the next record.
    cut_after: Option<u32>,
    /// It has come: nothing happens until the robot starts again.
    cut: bool,
}

impl Memory {
    /// Memory in a file, or in this process if there is none.
    pub(super) fn new(file: Option<PathBuf>, speed: f64) -> io::Result<Self> {
        let mut record = None;
        if let Some(path) = &file {
            match read_text(path, 256) {
                Ok(text) => record = Some(read(&text).ok_or(io::ErrorKind::InvalidData)?),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Self {
            file,
            record,
            speed,
            cut_after: None,
            cut: false,
        })
    }

    /// Forgets everything.
    pub(super) fn erase(&mut self) {
        self.record = None;
    }

    /// Lets a reset come after so many bytes of the next record.
    pub(super) fn cut_after(&mut self, bytes: u32) {
        self.cut_after = Some(bytes);
    }

    /// Whether a reset has come while a record was written.
    pub(super) fn is_cut(&self) -> bool {
        self.cut
    }

    /// The robot starts.
    pub(super) fn power_on(&mut self) {
        self.cut = false;
    }

    pub(super) fn load(&self) -> Option<Record> {
        self.record
    }

    /// Stores a record; whether the robot still runs then and has it.
    pub(super) fn store(&mut self, record: Record) -> bool {
        if self.cut {
            return false;
        }
        let bytes = self.cut_after.take();
        let written = bytes.unwrap_or(RECORD_BYTES).min(RECORD_BYTES);
        thread::sleep((BYTE * written).div_f64(self.speed));
        self.cut = bytes.is_some();
        if written < RECORD_BYTES {
            // its checksum is wrong: the record before is the newest
            return false;
        }
        if let Some(path) = &self.file {
            let Record {
                throw_id,
                experiment,
                boot,
                phase,
            } = record;
            let text = format!("{throw_id} {experiment} {boot} {}\n", phase.number());
            if replace_file(path, |to| to.write_all(text.as_bytes())).is_err() {
                return false;
            }
        }
        self.record = Some(record);
        !self.cut
    }
}

fn read(text: &str) -> Option<Record> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let [throw_id, experiment, boot, phase] = words[..] else {
        return None;
    };
    Some(Record {
        throw_id: throw_id.parse().ok()?,
        experiment: experiment.parse().ok()?,
        boot: boot.parse().ok()?,
        phase: State::from_number(phase.parse().ok()?)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_outlives_the_simulation() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("eeprom");
        let mut memory = Memory::new(Some(path.clone()), 1e3).unwrap();
        assert_eq!(memory.load(), None);
        let record = Record {
            throw_id: 7,
            experiment: 9,
            boot: 65_535,
            phase: State::Driving,
        };
        assert!(memory.store(record));
        assert_eq!(
            Memory::new(Some(path.clone()), 1e3).unwrap().load(),
            Some(record)
        );
        // a reset after any byte but the last leaves it as it was
        let next = Record {
            phase: State::AtCoin,
            ..record
        };
        for (bytes, found) in [(0, record), (16, record), (17, next)] {
            memory.cut_after(bytes);
            assert!(!memory.store(next) && memory.is_cut());
            memory.power_on();
            assert_eq!(memory.load(), Some(found), "{bytes} bytes");
        }
        fs::write(&path, "7 8").unwrap();
        assert!(Memory::new(Some(path), 1e3).is_err());
    }
}
