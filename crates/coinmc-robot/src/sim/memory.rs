//! The simulated robot's EEPROM: in memory, or in a file that outlives the simulation.

use crate::files::{read_text, replace_file};
use coinmc_link::{Record, State};
use std::io;
use std::path::PathBuf;

/// Keeps the newest record.
#[derive(Debug)]
pub(super) struct Memory {
    file: Option<PathBuf>,
    record: Option<Record>,
}

impl Memory {
    /// Memory in a file, or in this process if there is none.
    pub(super) fn new(file: Option<PathBuf>) -> io::Result<Self> {
        let mut record = None;
        if let Some(path) = &file {
            match read_text(path, 256) {
                Ok(text) => record = Some(read(&text).ok_or(io::ErrorKind::InvalidData)?),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Self { file, record })
    }

    /// Forgets everything.
    pub(super) fn erase(&mut self) {
        self.record = None;
    }

    pub(super) fn load(&self) -> Option<Record> {
        self.record
    }

    /// The last record stored.
    pub(super) fn store(&mut self, record: Record) -> bool {
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
        true
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
        let mut memory = Memory::new(Some(path.clone())).unwrap();
        assert_eq!(memory.load(), None);
        let record = Record {
            throw_id: 7,
            experiment: 9,
            boot: 65_535,
            phase: State::Driving,
        };
        assert!(memory.store(record));
        assert_eq!(
            Memory::new(Some(path.clone())).unwrap().load(),
            Some(record)
        );
        fs::write(&path, "7 8").unwrap();
        assert!(Memory::new(Some(path)).is_err());
    }
}
