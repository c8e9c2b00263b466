//! The journal as a log in NOR flash, as most microcontrollers have it.
//!
//! Flash is erased by pages, to ones; programming a word can only clear bits. A log over a few pages
//! spreads the wear: records are appended, and when a page is full the next one, the oldest, is
//! erased. A record is valid by its CRC, so one that a loss of power cuts short is skipped, and the
//! record before it, which is never in the page being erased, is the newest.

use crate::device::Record;
use crate::message::State;
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// Flash memory, by words of 32 bits.
pub trait Flash {
    /// Pages of the log, at least 2.
    const PAGES: usize;
    /// Words of a page, at least 5.
    const PAGE_WORDS: usize;

    /// Reads a word; the words are numbered from 0 through all pages.
    fn read(&self, word: usize) -> u32;

    /// Clears the bits that are 0 in `value`; returns when that is done.
    fn program(&mut self, word: usize, value: u32);

    /// Sets all bits of a page to 1; returns when that is done.
    fn erase(&mut self, page: usize);
}

/// Serial number, throw, experiment, boot and phase, CRC.
type Words = [u32; RECORD_WORDS];

const RECORD_WORDS: usize = 5;
const BLANK: u32 = u32::MAX;
/// Places tried for one record: cells that can no longer be programmed are skipped.
const TRIES: u32 = 4;
const CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The log.
#[derive(Debug)]
pub struct FlashLog<F> {
    flash: F,
    serial: u32,
    /// The place after the newest record.
    next: usize,
    newest: Option<Record>,
}

impl<F: Flash> FlashLog<F> {
    const PLACES_A_PAGE: usize = F::PAGE_WORDS / RECORD_WORDS;
    const PLACES: usize = F::PAGES.saturating_mul(Self::PLACES_A_PAGE);

    /// Finds the newest record.
    pub fn open(flash: F) -> Self {
        let mut log = Self {
            flash,
            serial: 0,
            next: 0,
            newest: None,
        };
        for place in 0..Self::PLACES {
            let words = log.words(place);
            if let Some(record) = record(words)
                && words[0] >= log.serial
            {
                log.serial = words[0];
                log.next = Self::after(place);
                log.newest = Some(record);
            }
        }
        log
    }

    /// The newest record.
    pub fn newest(&self) -> Option<Record> {
        self.newest
    }

    /// The flash memory, which is all that survives a loss of power.
    pub fn into_flash(self) -> F {
        self.flash
    }

    /// Appends a record; whether it is safe.
    pub fn store(&mut self, record: &Record) -> bool {
        let serial = self.serial.wrapping_add(1);
        let words = words(serial, record);
        for _ in 0..TRIES {
            let place = self.next;
            self.next = Self::after(place);
            if place.checked_rem(Self::PLACES_A_PAGE) == Some(0) {
                let page = place.checked_div(Self::PLACES_A_PAGE).unwrap_or(0);
                self.flash.erase(page);
            }
            if self.words(place) != [BLANK; RECORD_WORDS] {
                continue; // cut short by a loss of power
            }
            let first = Self::first_word(place);
            for (word, value) in (first..).zip(words) {
                self.flash.program(word, value);
            }
            if self.words(place) == words {
                self.serial = serial;
                self.newest = Some(*record);
                return true;
            }
        }
        false
    }

    fn after(place: usize) -> usize {
        let next = place.wrapping_add(1);
        if next < Self::PLACES { next } else { 0 }
    }

    fn first_word(place: usize) -> usize {
        let page = place.checked_div(Self::PLACES_A_PAGE).unwrap_or(0);
        let in_page = place.checked_rem(Self::PLACES_A_PAGE).unwrap_or(0);
        let page_start = page.wrapping_mul(F::PAGE_WORDS);
        page_start.wrapping_add(in_page.wrapping_mul(RECORD_WORDS))
    }

    fn words(&self, place: usize) -> Words {
        let mut word = Self::first_word(place);
        [(); RECORD_WORDS].map(|()| {
            let value = self.flash.read(word);
            word = word.wrapping_add(1);
            value
        })
    }
}

fn words(serial: u32, record: &Record) -> Words {
    let boot_phase = u32::from(record.boot) << 8 | u32::from(record.phase.number());
    let [a, b, c, d] = [serial, record.throw_id, record.experiment, boot_phase];
    [a, b, c, d, checksum([a, b, c, d])]
}

/// The record in these words, if they are intact.
fn record(words: Words) -> Option<Record> {
    let [serial, throw_id, experiment, boot_phase, crc] = words;
    let [phase, low, high, _] = boot_phase.to_le_bytes();
    let intact = crc == checksum([serial, throw_id, experiment, boot_phase]);
    let phase = State::from_number(phase)?;
    intact.then_some(Record {
        throw_id,
        experiment,
        boot: u16::from_le_bytes([low, high]),
        phase,
    })
}

fn checksum(content: [u32; 4]) -> u32 {
    let mut digest = CHECKSUM.digest();
    for word in content {
        digest.update(&word.to_le_bytes());
    }
    // so that neither all zeros nor all ones are a record
    digest.finalize() ^ 0x636F_696E
}
