//! The journal in flash: whatever a loss of power interrupts, and whichever cells wear out, the newest
//! record that was safe is found, and never an older one.

mod support;

use coinmc_link::{Flash, FlashLog, Record, State};
use support::Random;

const PAGES: usize = 3;
const PAGE_WORDS: usize = 32;

/// Flash that loses power after a number of operations, in the middle of the last.
#[derive(Debug, Clone)]
struct Nor {
    words: Vec<u32>,
    /// Operations until the loss of power; none: never.
    left: Option<u32>,
    random: Random,
    /// Cells that can no longer be programmed or erased.
    dead: Vec<usize>,
}

impl Nor {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        Self {
            // as delivered, or with anything in it
            words: (0..PAGES * PAGE_WORDS)
                .map(|_| {
                    if seed.is_multiple_of(2) {
                        u32::MAX
                    } else {
                        random.below(u32::MAX)
                    }
                })
                .collect(),
            left: None,
            random,
            dead: Vec::new(),
        }
    }

    /// Bits that an operation reaches: all, some in the moment of the loss of power, none after it.
    fn reached(&mut self, word: usize) -> u32 {
        if self.dead.contains(&word) {
            return 0;
        }
        match self.left {
            Some(0) => 0,
            Some(1) => self.random.below(u32::MAX),
            None | Some(_) => u32::MAX,
        }
    }

    fn operated(&mut self) {
        self.left = self.left.map(|left| left.saturating_sub(1));
    }
}

impl Flash for Nor {
    const PAGES: usize = PAGES;
    const PAGE_WORDS: usize = PAGE_WORDS;

    fn read(&self, word: usize) -> u32 {
        self.words[word]
    }

    /// Many microcontrollers (STM32, for one) refuse to program a word that is not erased.
    fn program(&mut self, word: usize, value: u32) {
        assert_eq!(self.words[word], u32::MAX, "word {word} is not erased");
        let reached = self.reached(word);
        self.words[word] &= value | !reached;
        self.operated();
    }

    fn erase(&mut self, page: usize) {
        for word in page * PAGE_WORDS..(page + 1) * PAGE_WORDS {
            self.words[word] |= self.reached(word);
        }
        self.operated();
    }
}

fn record(number: u32) -> Record {
    Record {
        throw_id: number,
        experiment: number ^ 0x5555,
        boot: u16::try_from(number % 65_536).unwrap(),
        phase: State::ALL[number as usize % 8],
    }
}

#[test]
fn every_record_is_found_again() {
    let mut flash = Nor::new(0);
    assert_eq!(FlashLog::open(flash.clone()).newest(), None);
    for number in 0..500 {
        let mut log = FlashLog::open(flash);
        assert!(log.store(&record(number)));
        flash = log.into_flash();
        assert_eq!(FlashLog::open(flash.clone()).newest(), Some(record(number)));
    }
}

/// Words that another program may read: serial number, throw, experiment, boot and phase, and the CRC-32 of their
/// bytes (by zlib) xor "coin".
#[test]
fn a_record_is_these_words() {
    let mut log = FlashLog::open(Nor::new(0));
    let stored = log.store(&Record {
        throw_id: 7,
        experiment: 9,
        boot: 0x0203,
        phase: State::Driving,
    });
    assert!(stored);
    let words = [1, 7, 9, 0x0002_0304, 0xF579_0A82];
    assert_eq!(log.into_flash().words[..5], words);
}

/// A loss of power at every operation of every store, again and again on the same memory.
#[test]
fn a_loss_of_power_costs_at_most_the_record_being_written() {
    for seed in 0..300 {
        let mut flash = Nor::new(seed);
        let mut safe = None;
        for number in 0..120 {
            flash.left = Some(flash.random.below(8));
            let mut log = FlashLog::open(flash);
            assert_eq!(log.newest(), safe, "seed {seed}, record {number}");
            let stored = log.store(&record(number));
            flash = log.into_flash();
            flash.left = None;
            let found = FlashLog::open(flash.clone()).newest();
            assert!(
                found == safe || found == Some(record(number)),
                "seed {seed}"
            );
            assert!(!stored || found == Some(record(number)));
            safe = found;
        }
    }
}

#[test]
fn dead_cells_are_skipped_and_their_old_records_stay_old() {
    for seed in 0..100 {
        let mut flash = Nor::new(2 * seed);
        let mut log = FlashLog::open(flash);
        for number in 0..40 {
            assert!(log.store(&record(number)));
        }
        flash = log.into_flash();
        flash.dead = (0..3).map(|_| flash.random.below(90) as usize).collect();
        let mut log = FlashLog::open(flash);
        // many times around: a record that cannot be erased never looks new again
        for number in 40..400 {
            assert!(log.store(&record(number)), "seed {seed}");
            let again = FlashLog::open(log.into_flash());
            assert_eq!(again.newest(), Some(record(number)), "seed {seed}");
            log = again;
        }
    }
}
