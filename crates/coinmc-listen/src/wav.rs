//! The samples of a WAV file, read with bounds.
//!
//! Recorders write more than the library that writes ours reads: floats of 64 bits, and files that went through a pipe, so
//! that their header does not say how long they are. All bytes are untrusted. What is kept of them is bounded by
//! [`MAX_SAMPLES`], whatever the header promises.

use crate::error::RecordingError;
use crate::recording::MAX_SAMPLES;
use std::io::{self, Read};

/// Channels that are looked at; the others of a file are passed over.
const CHANNELS: usize = 2;
/// Least and greatest number of samples a second.
const RATES: [u32; 2] = [8000, 384_000];
/// From this length on, bytes, a program did not know it: those that write to a pipe state the greatest number of 31
/// or 32 bits, or a little less, or 0.
const UNKNOWN: u32 = 0x7fff_0000;
/// The full scale of whole numbers of 32 bits.
const FULL_32: f64 = 2_147_483_648.0;
/// The greatest sample of a float file, in units of the full scale: that of whole numbers that were not scaled. How loud
/// a recording is does not matter, but the squares of much greater samples are beyond all numbers.
const GREATEST: f64 = FULL_32;

/// Length of the longest form of the format's chunk, bytes.
const LONGEST_FORMAT: usize = 40;
/// Tags of formats: whole numbers, floats, and one that has the tag farther on, before this.
const WHOLE: u16 = 1;
const FLOAT: u16 = 3;
const EXTENSIBLE: u16 = 0xfffe;
const AFTER_TAG: [u8; 14] = [0, 0, 0, 0, 16, 0, 128, 0, 0, 170, 0, 56, 155, 113];

/// What is read of a WAV file.
#[derive(Debug)]
pub(crate) struct Wav {
    /// Samples a second.
    pub(crate) rate_hz: u32,
    /// How many channels there are.
    pub(crate) channels: u16,
    /// Bits of a sample.
    pub(crate) bits: u16,
    /// The samples of the first channels, in units of the full scale.
    pub(crate) levels: Vec<Vec<f32>>,
}

impl Wav {
    /// Reads a file from its beginning.
    pub(crate) fn read(mut reader: impl Read) -> Result<Self, RecordingError> {
        let (format, length) = header(&mut reader)?;
        if !(RATES[0]..=RATES[1]).contains(&format.rate_hz) {
            return Err(RecordingError::Rate(format.rate_hz));
        }
        Ok(Self {
            rate_hz: format.rate_hz,
            channels: format.channels,
            bits: format.bits,
            levels: format.levels(reader, length)?,
        })
    }
}

/// How samples are written.
struct Format {
    number: Number,
    channels: u16,
    rate_hz: u32,
    /// Bytes of a sample of each channel together.
    frame: u16,
    bits: u16,
}

/// Reads until the first sample: the format, and the length of the samples in bytes if it is known.
fn header(reader: &mut impl Read) -> Result<(Format, Option<u32>), RecordingError> {
    if &four(reader)? != b"RIFF" {
        return Err(RecordingError::NotWav("no RIFF tag found"));
    }
    // the length of the whole file, which a pipe does not know either
    four(reader)?;
    if &four(reader)? != b"WAVE" {
        return Err(RecordingError::NotWav("no WAVE tag found"));
    }
    let mut format = None;
    loop {
        let name = four(reader)?;
        let length = u32::from_le_bytes(four(reader)?);
        match &name {
            b"fmt " => format = Some(Format::read(reader, length)?),
            b"data" => {
                let format = format.ok_or(RecordingError::NotWav("missing fmt chunk"))?;
                let is_known = length > 0 && length < UNKNOWN;
                return Ok((format, is_known.then_some(length)));
            }
            _ => skip(reader, padded(length))?,
        }
    }
}

impl Format {
    /// Reads the chunk of the format, of so many bytes.
    fn read(reader: &mut impl Read, length: u32) -> Result<Self, RecordingError> {
        let mut bytes = [0; LONGEST_FORMAT];
        let kept = LONGEST_FORMAT.min(usize::try_from(length).unwrap_or(LONGEST_FORMAT));
        if kept < 16 {
            return Err(RecordingError::NotWav("invalid fmt chunk size"));
        }
        if fill(reader, &mut bytes[..kept])? < kept {
            return Err(ENDS);
        }
        skip(reader, padded(length) - kept as u64)?;
        Self::of(&bytes, kept)
    }

    /// Of the bytes of the chunk, of which so many were there.
    fn of(bytes: &[u8; LONGEST_FORMAT], kept: usize) -> Result<Self, RecordingError> {
        let word = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let long = |at: usize| u32::from(word(at)) | u32::from(word(at + 2)) << 16;
        let [channels, frame, bits] = [2, 12, 14].map(word);
        let [rate_hz, a_second] = [4, 8].map(long);
        if channels == 0 {
            return Err(RecordingError::NotWav("file contains zero channels"));
        }
        if u64::from(a_second) != u64::from(frame) * u64::from(rate_hz) {
            return Err(RecordingError::NotWav("inconsistent fmt chunk"));
        }
        let (mut tag, mut valid) = (word(0), bits);
        if tag == EXTENSIBLE {
            if kept < LONGEST_FORMAT || bytes[26..] != AFTER_TAG {
                return Err(RecordingError::Unsupported);
            }
            (tag, valid) = (word(24), word(18));
        }
        let number = Number::of(tag, frame, channels, bits).ok_or(RecordingError::Unsupported)?;
        Ok(Self {
            number,
            channels,
            rate_hz,
            frame,
            bits: if (1..bits).contains(&valid) {
                valid
            } else {
                bits
            },
        })
    }

    /// The samples of the first channels, of a length in bytes; of an unknown one, to the end of the file.
    fn levels(
        &self,
        mut reader: impl Read,
        length: Option<u32>,
    ) -> Result<Vec<Vec<f32>>, RecordingError> {
        let frames = length.map(|length| self.frames(length)).transpose()?;
        let channels = u64::from(self.channels);
        let mut levels = vec![vec![]; usize::from(self.channels).min(CHANNELS)];
        let mut frame = vec![0; usize::from(self.frame)];
        let each = frame.len() / usize::from(self.channels);
        let mut number = 0_u64;
        while frames.is_none_or(|frames| number < frames) {
            let found = fill(&mut reader, &mut frame)?;
            if found < frame.len() {
                let Some(frames) = frames else { break };
                return Err(RecordingError::CutOff {
                    found: number * channels + (found / each) as u64,
                    promised: frames * channels,
                });
            }
            if number == MAX_SAMPLES {
                return Err(RecordingError::Endless { most: MAX_SAMPLES });
            }
            let samples = (number * channels..).zip(frame.chunks_exact(each));
            for (levels, (place, sample)) in levels.iter_mut().zip(samples) {
                levels.push(within(self.number.level(sample), place)?);
            }
            number += 1;
        }
        if number == 0 {
            return Err(RecordingError::Empty);
        }
        Ok(levels)
    }

    /// How many samples of each channel are in so many bytes.
    fn frames(&self, length: u32) -> Result<u64, RecordingError> {
        let frame = u32::from(self.frame);
        if !length.is_multiple_of(frame) {
            return Err(RecordingError::NotWav(
                "data chunk length is not a multiple of sample size",
            ));
        }
        let found = u64::from(length / frame);
        if found > MAX_SAMPLES {
            return Err(RecordingError::TooLong {
                found,
                most: MAX_SAMPLES,
            });
        }
        Ok(found)
    }
}

/// A sample that can be squared.
fn within(level: f64, place: u64) -> Result<f32, RecordingError> {
    if !level.is_finite() {
        return Err(RecordingError::NotFinite(place));
    }
    if level.abs() > GREATEST {
        return Err(RecordingError::BeyondScale { place, level });
    }
    #[allow(clippy::cast_possible_truncation)] // 24 bits are enough
    let level = level as f32;
    Ok(level)
}

/// How a sample is written, the least byte first.
#[derive(Debug, Clone, Copy)]
enum Number {
    /// A whole number of 8 bits, of which 128 is silence.
    Byte,
    /// Whole numbers of so many bits with a sign, those of 24 bits also with a byte more that says nothing.
    Whole16,
    Whole24,
    Whole32,
    /// Floats.
    Float32,
    Float64,
}

impl Number {
    fn of(tag: u16, frame: u16, channels: u16, bits: u16) -> Option<Self> {
        if !frame.is_multiple_of(channels) {
            return None;
        }
        Some(match (tag, frame / channels, bits) {
            (WHOLE, 1, 8) => Self::Byte,
            (WHOLE, 2, 16) => Self::Whole16,
            (WHOLE, 3 | 4, 24) => Self::Whole24,
            (WHOLE, 4, 32) => Self::Whole32,
            (FLOAT, 4, 32) => Self::Float32,
            (FLOAT, 8, 64) => Self::Float64,
            _ => return None,
        })
    }

    /// The sample that these bytes are, in units of the full scale.
    fn level(self, bytes: &[u8]) -> f64 {
        let of_32 = |bytes| f64::from(i32::from_le_bytes(bytes)) / FULL_32;
        match self {
            Self::Byte => (f64::from(u8::from_le_bytes(first(bytes))) - 128.0) / 128.0,
            Self::Whole16 => f64::from(i16::from_le_bytes(first(bytes))) / 32_768.0,
            Self::Whole24 => {
                let [low, middle, high] = first(bytes);
                of_32([0, low, middle, high])
            }
            Self::Whole32 => of_32(first(bytes)),
            Self::Float32 => f64::from(f32::from_le_bytes(first(bytes))),
            Self::Float64 => f64::from_le_bytes(first(bytes)),
        }
    }
}

/// The first bytes of a sample, which has as many: [`Number::of`] looked.
fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.first_chunk().copied().unwrap_or([0; N])
}

/// What is said of a file that has no samples yet when it ends.
const ENDS: RecordingError = RecordingError::NotWav("it ends in its header");

fn four(reader: &mut impl Read) -> Result<[u8; 4], RecordingError> {
    let mut bytes = [0; 4];
    if fill(reader, &mut bytes)? < bytes.len() {
        return Err(ENDS);
    }
    Ok(bytes)
}

/// The length of a chunk in the file: a byte is added to an odd one.
fn padded(length: u32) -> u64 {
    u64::from(length).next_multiple_of(2)
}

fn skip(reader: &mut impl Read, bytes: u64) -> Result<(), RecordingError> {
    let skipped = io::copy(&mut reader.take(bytes), &mut io::sink());
    if skipped.map_err(RecordingError::Io)? < bytes {
        return Err(ENDS);
    }
    Ok(())
}

/// Reads until the buffer is full or the file ends; how many bytes were read.
fn fill(reader: &mut impl Read, buffer: &mut [u8]) -> Result<usize, RecordingError> {
    let mut filled = 0;
    while filled < buffer.len() {
        match reader.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(more) => filled += more,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(RecordingError::Io(error)),
        }
    }
    Ok(filled)
}

#[cfg(test)]
mod tests;
