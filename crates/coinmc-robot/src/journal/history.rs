//! The throws that a journal's entries describe, and the valid order of entries.

use super::{Digest, Entry, Reading, RobotName, VoidReason};
use crate::Setting;
use thiserror::Error;

/// One throw according to the journal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Throw {
    /// Id on the link.
    pub id: u32,
    /// Setting of the throw.
    pub setting: Setting,
    /// Time of the announcement, ms since 1970.
    pub announced_ms: u64,
    /// The reading and its time.
    pub reading: Option<(Reading, u64)>,
    /// How it ended.
    pub resolution: Option<Resolution>,
}

/// How a throw ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// With a reading.
    Done,
    /// Without a result.
    Void(VoidReason),
}

/// State of the last throw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pending {
    /// All throws are resolved.
    Nothing,
    /// Announced; only the robot knows whether it was thrown.
    Announced {
        /// Its id.
        id: u32,
        /// Setting of the throw.
        setting: Setting,
    },
    /// Read; only the robot knows whether the coin was collected.
    Read {
        /// Its id.
        id: u32,
    },
}

/// All throws so far, in the order of the plan.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct History {
    throws: Vec<Throw>,
    /// The last id in use.
    last_id: u32,
    /// The robot of the last session.
    robot: Option<RobotName>,
    /// Throws were announced for this robot: from then on it must know the experiment.
    claimed: bool,
}

/// Why an entry cannot follow the ones before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum OrderError {
    /// A throw is announced while another is open.
    #[error("a throw is announced while throw {0} is unresolved")]
    StillOpen(u32),
    /// Ids increase by one.
    #[error("throw {found} is announced, but {expected} is next")]
    WrongNumber {
        /// The id in the entry.
        found: u32,
        /// The next id.
        expected: u32,
    },
    /// An entry for a throw that is not open.
    #[error("throw {0} is read or resolved, but it is not open")]
    NotOpen(u32),
    /// A second reading, or a void after a reading.
    #[error("throw {0} has a reading already")]
    AlreadyRead(u32),
    /// Done without a reading.
    #[error("throw {0} is done but has no reading")]
    Unread(u32),
}

impl History {
    /// All throws announced so far.
    pub fn throws(&self) -> &[Throw] {
        &self.throws
    }

    /// Number of throws announced so far, which is also the number of the next throw in the plan.
    pub fn announced(&self) -> u32 {
        u32::try_from(self.throws.len()).unwrap_or(u32::MAX)
    }

    /// The last id in use on the link; 0 before the first throw.
    pub fn last_id(&self) -> u32 {
        self.last_id
    }

    /// State of the last throw.
    pub fn pending(&self) -> Pending {
        match self.throws.last() {
            Some(throw) if throw.resolution.is_none() => match throw.reading {
                None => Pending::Announced {
                    id: throw.id,
                    setting: throw.setting,
                },
                Some(_) => Pending::Read { id: throw.id },
            },
            _ => Pending::Nothing,
        }
    }

    /// The robot of the last session; none before the first one of format 2.
    pub fn robot(&self) -> Option<RobotName> {
        self.robot
    }

    /// Whether throws were announced for this robot since it was taken over: then it must know the
    /// experiment, or it is not the same.
    pub fn is_claimed(&self) -> bool {
        self.claimed
    }

    /// The least id that a robot which made these throws can be at.
    pub fn least_id(&self) -> u32 {
        match self.pending() {
            Pending::Announced { id, .. } => {
                let before = self.throws.iter().rev().nth(1).map_or(0, |throw| throw.id);
                // ids before an adopted counter are not those of throws
                before.min(id.saturating_sub(1))
            }
            Pending::Nothing | Pending::Read { .. } => self.throws.last().map_or(0, |t| t.id),
        }
    }

    /// What tells the photos of all readings from others.
    pub fn digests(&self) -> impl Iterator<Item = Digest> {
        let readings = self.throws.iter().filter_map(|t| t.reading.as_ref());
        readings.filter_map(|(reading, _)| reading.digest)
    }

    /// Number of consecutive void throws at the end.
    pub fn consecutive_voids(&self) -> usize {
        let resolved = self.throws.iter().rev().filter_map(|t| t.resolution);
        resolved.take_while(|how| *how != Resolution::Done).count()
    }

    /// Checks whether an entry can follow.
    ///
    /// # Errors
    /// [`OrderError`] if it cannot.
    pub fn check(&self, entry: &Entry) -> Result<(), OrderError> {
        let open = self.open();
        match entry {
            // a host that starts again finds the throw open
            Entry::Session { .. } => Ok(()),
            Entry::Announced { id, .. } if open.is_none() && Some(*id) != self.next_id() => {
                Err(OrderError::WrongNumber {
                    found: *id,
                    expected: self.next_id().unwrap_or(u32::MAX),
                })
            }
            Entry::Adopted { .. } | Entry::Announced { .. } => {
                open.map_or(Ok(()), |open| Err(OrderError::StillOpen(open.id)))
            }
            Entry::Read { id, .. } | Entry::Done { id } | Entry::Void { id, .. } => {
                let open = open.filter(|open| open.id == *id);
                let read = open.ok_or(OrderError::NotOpen(*id))?.reading.is_some();
                match (entry, read) {
                    (Entry::Done { .. }, false) => Err(OrderError::Unread(*id)),
                    (Entry::Read { .. } | Entry::Void { .. }, true) => {
                        Err(OrderError::AlreadyRead(*id))
                    }
                    _ => Ok(()),
                }
            }
        }
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// [`OrderError`] if it cannot follow; nothing is changed then.
    pub fn add(&mut self, entry: &Entry) -> Result<(), OrderError> {
        self.check(entry)?;
        match entry {
            Entry::Adopted { counter } => {
                self.last_id = self.last_id.max(*counter);
                self.claimed = false;
            }
            Entry::Session { robot, .. } => self.robot = Some(*robot),
            Entry::Announced { id, setting, at_ms } => {
                self.last_id = *id;
                self.claimed = self.robot.is_some();
                self.throws.push(Throw {
                    id: *id,
                    setting: *setting,
                    announced_ms: *at_ms,
                    reading: None,
                    resolution: None,
                });
            }
            Entry::Read { reading, at_ms, .. } => {
                self.open_mut().reading = Some((reading.clone(), *at_ms));
            }
            Entry::Done { .. } => self.open_mut().resolution = Some(Resolution::Done),
            Entry::Void { reason, .. } => {
                self.open_mut().resolution = Some(Resolution::Void(*reason));
            }
        }
        Ok(())
    }

    /// Id of the next throw, if the link has one left.
    pub fn next_id(&self) -> Option<u32> {
        self.last_id.checked_add(1)
    }

    fn open(&self) -> Option<&Throw> {
        self.throws.last().filter(|t| t.resolution.is_none())
    }

    fn open_mut(&mut self) -> &mut Throw {
        self.throws.last_mut().expect("`check` found an open throw")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Face;
    use crate::journal::{ImageName, Measured};

    fn announced(id: u32) -> Entry {
        Entry::Announced {
            id,
            setting: Setting::new(2500, 100).expect("a setting"),
            at_ms: 5,
        }
    }

    fn read(id: u32) -> Entry {
        let image: ImageName = "a.jpg".parse().expect("a name");
        let reading = Reading {
            face: Face::Heads,
            measured: Measured {
                spin_mrev_s: 2500,
                angle_cdeg: 100,
            },
            boot: 1,
            image,
            digest: None,
        };
        Entry::Read {
            id,
            reading,
            at_ms: 6,
        }
    }

    fn void(id: u32) -> Entry {
        Entry::Void {
            id,
            reason: VoidReason::Lost,
        }
    }

    fn after(entries: &[Entry]) -> History {
        let mut history = History::default();
        for entry in entries {
            history.add(entry).expect("an entry that can follow");
        }
        history
    }

    /// A result is read once and stays: it is neither read again nor made void. It is final once the robot is ready.
    #[test]
    fn a_reading_stays() {
        let history = after(&[announced(1), read(1)]);
        for again in [read(1), void(1)] {
            assert_eq!(history.check(&again), Err(OrderError::AlreadyRead(1)));
        }
        assert_eq!(history.check(&Entry::Done { id: 1 }), Ok(()));
        let history = after(&[announced(1)]);
        assert_eq!(
            history.check(&Entry::Done { id: 1 }),
            Err(OrderError::Unread(1))
        );
        assert_eq!(
            [history.check(&read(1)), history.check(&void(1))],
            [Ok(()); 2]
        );
        for other in [read(2), void(2), Entry::Done { id: 2 }] {
            assert_eq!(history.check(&other), Err(OrderError::NotOpen(2)));
        }
        assert_eq!(history.check(&announced(2)), Err(OrderError::StillOpen(1)));
        assert_eq!(
            history.check(&Entry::Adopted { counter: 9 }),
            Err(OrderError::StillOpen(1))
        );
    }

    /// Void throws count from the last one with a result on; one that is open does not count.
    #[test]
    fn voids_in_a_row_are_counted_from_the_end() {
        let mut entries = vec![];
        let count = |entries: &[Entry]| after(entries).consecutive_voids();
        assert_eq!(count(&entries), 0);
        for id in 1..=2 {
            entries.extend([announced(id), void(id)]);
            assert_eq!(count(&entries), id as usize);
        }
        entries.push(announced(3));
        assert_eq!(count(&entries), 2);
        entries.extend([read(3), Entry::Done { id: 3 }]);
        assert_eq!(count(&entries), 0);
        entries.extend([announced(4), void(4)]);
        assert_eq!(count(&entries), 1);
    }
}
