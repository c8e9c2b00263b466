//! The journal, in memory that survives a reset.
//!
//! REPLACE THIS FILE for a real robot with EEPROM, FRAM or a log in flash: this stand-in is for the
//! simulator, where there are resets but no loss of power. Two slots alternate, so that one record
//! is always intact.

use coinmc_link::{Record, State};
use core::mem::MaybeUninit;
use core::ptr::{addr_of_mut, read_volatile, write_volatile};
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// Serial number, throw, boot and phase, CRC.
type Slot = [u32; 4];

const CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

#[unsafe(link_section = ".uninit.journal")]
static mut SLOTS: [MaybeUninit<Slot>; 2] = [MaybeUninit::uninit(); 2];

/// The newest intact record.
pub fn load() -> Option<Record> {
    let [serial_phase, throw_id, boot, _] = newest()?;
    Some(Record {
        throw_id,
        boot: u16::try_from(boot).ok()?,
        phase: State::from_number(serial_phase.to_le_bytes()[0])?,
    })
}

/// Stores a record over the older one.
pub fn store(record: &Record) -> bool {
    let serial = newest().map_or(0, |slot| slot[0] >> 8).wrapping_add(1) & 0x00FF_FFFF;
    let serial_phase = serial << 8 | u32::from(record.phase.number());
    let content = [serial_phase, record.throw_id, u32::from(record.boot)];
    let [a, b, c] = content;
    let slot = [a, b, c, checksum(content)];
    let odd = serial & 1 == 1;
    // SAFETY: one core, no interrupt uses it, and the pointer is to a static.
    unsafe { write_volatile(address(odd), slot) };
    read(odd) == Some(slot)
}

fn newest() -> Option<Slot> {
    match (read(false), read(true)) {
        (Some(even), Some(odd)) => {
            let ahead = (odd[0] >> 8).wrapping_sub(even[0] >> 8) & 0x00FF_FFFF;
            Some(if ahead == 1 { odd } else { even })
        }
        (even, odd) => even.or(odd),
    }
}

/// The content of the slot, if it is intact.
fn read(odd: bool) -> Option<Slot> {
    // SAFETY: one core, no interrupt uses it; any bits are a valid array of numbers, and those of
    // memory after power-on do not pass the CRC.
    let slot: Slot = unsafe { read_volatile(address(odd)) };
    let [a, b, c, crc] = slot;
    (crc == checksum([a, b, c])).then_some(slot)
}

fn address(odd: bool) -> *mut Slot {
    if odd {
        // SAFETY: within the static.
        unsafe { addr_of_mut!(SLOTS).cast::<Slot>().add(1) }
    } else {
        addr_of_mut!(SLOTS).cast()
    }
}

fn checksum(content: [u32; 3]) -> u32 {
    let mut digest = CHECKSUM.digest();
    for word in content {
        digest.update(&word.to_le_bytes());
    }
    // so that all zeros are not a valid record
    digest.finalize() ^ 0x636F_696E
}
