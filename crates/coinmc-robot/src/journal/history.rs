//! What the entries of a journal come to, and which entry may follow which.

use super::{Entry, Reading, VoidReason};
use crate::Setting;
use thiserror::Error;

/// One throw as the journal knows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Throw {
    /// Its number on the link.
    pub id: u32,
    /// What the robot was told.
    pub setting: Setting,
    /// When it was announced, ms since 1970.
    pub announced_ms: u64,
    /// What was read, and when.
    pub reading: Option<(Reading, u64)>,
    /// How it ended.
    pub resolution: Option<Resolution>,
}

/// How a throw ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// With its reading.
    Done,
    /// Without a result.
    Void(VoidReason),
}

/// How far the last throw is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pending {
    /// All throws are resolved.
    Nothing,
    /// Announced; whether it was thrown only the robot knows.
    Announced {
        /// Its number.
        id: u32,
        /// What the robot was or is to be told.
        setting: Setting,
    },
    /// Read; whether the coin was collected only the robot knows.
    Read {
        /// Its number.
        id: u32,
    },
}

/// All throws so far, in order: throw k of the plan is the k-th.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct History {
    throws: Vec<Throw>,
    /// The last number that is taken.
    last_id: u32,
}

/// An entry that cannot follow what was written before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Order {
    /// A throw is announced while another is open.
    #[error("a throw is announced while throw {0} is unresolved")]
    StillOpen(u32),
    /// Numbers go up by one.
    #[error("throw {found} is announced where {expected} is next")]
    WrongNumber {
        /// The number in the entry.
        found: u32,
        /// The next number.
        expected: u32,
    },
    /// An entry about a throw that is not the open one.
    #[error("throw {0} is resolved or read, and it is not open")]
    NotOpen(u32),
    /// A second reading, or a void after a reading.
    #[error("throw {0} has a reading already")]
    AlreadyRead(u32),
    /// Done without a reading.
    #[error("throw {0} is done without a reading")]
    Unread(u32),
    /// A counter that is not ahead.
    #[error("a counter of {0} is adopted, and it is not ahead")]
    NotAhead(u32),
}

impl History {
    /// All throws announced so far.
    pub fn throws(&self) -> &[Throw] {
        &self.throws
    }

    /// Throws announced so far: the number, from 0, of the next in the plan.
    pub fn announced(&self) -> u32 {
        u32::try_from(self.throws.len()).unwrap_or(u32::MAX)
    }

    /// The last number on the link that is taken; 0 before the first throw.
    pub fn last_id(&self) -> u32 {
        self.last_id
    }

    /// How far the last throw is.
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

    /// Void throws at the end, without a done one between.
    pub fn voids_in_a_row(&self) -> usize {
        let resolved = self.throws.iter().rev().filter_map(|t| t.resolution);
        resolved.take_while(|how| *how != Resolution::Done).count()
    }

    /// Whether an entry can follow.
    ///
    /// # Errors
    /// [`Order`] if it cannot.
    pub fn check(&self, entry: &Entry) -> Result<(), Order> {
        let open = self.open();
        match entry {
            Entry::Adopted { counter } if *counter <= self.last_id => {
                Err(Order::NotAhead(*counter))
            }
            Entry::Announced { id, .. } if open.is_none() && Some(*id) != self.next_id() => {
                Err(Order::WrongNumber {
                    found: *id,
                    expected: self.next_id().unwrap_or(u32::MAX),
                })
            }
            Entry::Adopted { .. } | Entry::Announced { .. } => {
                open.map_or(Ok(()), |open| Err(Order::StillOpen(open.id)))
            }
            Entry::Read { id, .. } | Entry::Done { id } | Entry::Void { id, .. } => {
                let open = open.filter(|open| open.id == *id);
                let read = open.ok_or(Order::NotOpen(*id))?.reading.is_some();
                match (entry, read) {
                    (Entry::Done { .. }, false) => Err(Order::Unread(*id)),
                    (Entry::Read { .. } | Entry::Void { .. }, true) => Err(Order::AlreadyRead(*id)),
                    _ => Ok(()),
                }
            }
        }
    }

    /// Takes an entry in.
    ///
    /// # Errors
    /// [`Order`] if it cannot follow; nothing is changed then.
    pub fn add(&mut self, entry: &Entry) -> Result<(), Order> {
        self.check(entry)?;
        match entry {
            Entry::Adopted { counter } => self.last_id = *counter,
            Entry::Announced { id, setting, at_ms } => {
                self.last_id = *id;
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

    /// The number of the next throw, if the link has one left.
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
