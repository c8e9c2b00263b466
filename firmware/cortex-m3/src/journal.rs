//! The journal: a log in the last 8 KiB of flash, by the chip's own flash controller.
//!
//! With the feature `simulator` the same log lies in memory that survives a reset and behaves like
//! flash: QEMU does not have this controller.

use coinmc_link::{Flash, FlashLog, Record};

/// The log of this board.
pub type Journal = FlashLog<LogFlash>;

/// Opens the log. Call it once.
pub fn open() -> Journal {
    FlashLog::open(LogFlash::begin())
}

/// The newest record.
pub fn load(journal: &Journal) -> Option<Record> {
    journal.newest()
}

/// Pages and words of a page: 8 pages of 1 KiB, 51 records each. With 10,000 cycles a page lasts for
/// 4 million records: 680,000 throws of six.
const PAGES: usize = 8;
const PAGE_WORDS: usize = 256;

#[cfg(not(feature = "simulator"))]
pub use controller::LogFlash;
#[cfg(feature = "simulator")]
pub use simulated::LogFlash;

#[cfg(not(feature = "simulator"))]
mod controller {
    use super::{Flash, PAGE_WORDS, PAGES};
    use crate::register::{get, set};

    /// `memory.x` leaves it free.
    const START: usize = 0x0003_E000;
    const ADDRESS: usize = 0x400F_D000;
    const DATA: usize = 0x400F_D004;
    const CONTROL: usize = 0x400F_D008;
    const KEY: u32 = 0xA442_0000;
    const WRITE: u32 = 1;
    const ERASE: u32 = 2;
    /// Timing of the controller: the clock in MHz, less one.
    const MICROSECOND: usize = 0x400F_E140;
    /// Longer than any operation: then the watchdog ends it.
    const PATIENCE: u32 = 12_000_000;

    /// The flash controller of the LM3S.
    pub struct LogFlash(());

    impl LogFlash {
        /// Sets its timing.
        pub fn begin() -> Self {
            set(MICROSECOND, crate::clock::HERTZ / 1_000_000 - 1);
            Self(())
        }
    }

    fn operate(address: usize, what: u32) {
        // 18 bits: the whole flash
        set(ADDRESS, u32::try_from(address).unwrap_or(0));
        set(CONTROL, KEY | what);
        for _ in 0..PATIENCE {
            if get(CONTROL) & what == 0 {
                return;
            }
        }
    }

    impl Flash for LogFlash {
        const PAGES: usize = PAGES;
        const PAGE_WORDS: usize = PAGE_WORDS;

        fn read(&self, word: usize) -> u32 {
            get(START + 4 * word)
        }

        fn program(&mut self, word: usize, value: u32) {
            set(DATA, value);
            operate(START + 4 * word, WRITE);
        }

        fn erase(&mut self, page: usize) {
            operate(START + 4 * PAGE_WORDS * page, ERASE);
        }
    }
}

#[cfg(feature = "simulator")]
mod simulated {
    use super::{Flash, PAGE_WORDS, PAGES};
    use core::mem::MaybeUninit;
    use core::ptr::{addr_of, addr_of_mut, read_volatile, write_volatile};

    #[unsafe(link_section = ".uninit.journal")]
    static mut WORDS: MaybeUninit<[u32; PAGES * PAGE_WORDS]> = MaybeUninit::uninit();

    /// Memory that only clears bits, except for whole pages.
    pub struct LogFlash(());

    impl LogFlash {
        /// Takes the memory.
        pub fn begin() -> Self {
            Self(())
        }
    }

    fn inside(word: usize) -> bool {
        word < PAGES * PAGE_WORDS
    }

    fn write(word: usize, value: u32) {
        if inside(word) {
            // SAFETY: within the static; one core, and no interrupt uses it.
            unsafe { write_volatile(addr_of_mut!(WORDS).cast::<u32>().add(word), value) };
        }
    }

    impl Flash for LogFlash {
        const PAGES: usize = PAGES;
        const PAGE_WORDS: usize = PAGE_WORDS;

        fn read(&self, word: usize) -> u32 {
            if !inside(word) {
                return 0;
            }
            // SAFETY: as above; any bits are a number.
            unsafe { read_volatile(addr_of!(WORDS).cast::<u32>().add(word)) }
        }

        fn program(&mut self, word: usize, value: u32) {
            let before = self.read(word);
            write(word, before & value);
        }

        fn erase(&mut self, page: usize) {
            for word in 0..PAGE_WORDS {
                write(page * PAGE_WORDS + word, u32::MAX);
            }
        }
    }
}
