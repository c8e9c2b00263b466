//! A recording: one channel of a WAV file, read with bounds.

use crate::error::RecordingError;
use crate::wav::Wav;
use hound::{SampleFormat, WavSpec, WavWriter};
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufReader, Cursor, Read};
use std::path::Path;

/// Most samples of a channel: a minute and a half at 44 100 a second.
pub const MAX_SAMPLES: u64 = 1 << 22;
/// Most samples a second that are listened to: above half of that there is hardly anything of a coin, and noise.
const MOST_HZ: f64 = 96_000.0;
/// Shortest recording, s.
const SHORTEST_S: f64 = 0.1;
/// A recording whose peak is beyond this reaches the full scale: what is near its peak …
const FULL_SCALE: f32 = 0.98;
const FLAT: f32 = 0.999;
/// … is clipped if so many samples follow each other: a single one may be a peak that just fits.
const CLIPPED_RUN: usize = 4;
/// Bits of the samples that are written.
const BITS: u16 = 16;
/// The peak below which nothing is clipped.
const QUIET: f32 = 0.05;

/// One channel of a recording, on a scale of ±1.
///
/// # Example
/// ```
/// use coinmc_listen::Recording;
/// assert!(Recording::from_bytes("noise.wav", b"not a recording").is_err());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Name in messages.
    pub name: String,
    /// Samples a second.
    pub rate_hz: f64,
    /// The samples, from −1 to 1.
    pub samples: Vec<f32>,
    /// Which channel it is, from 1, and of how many: the one with the most energy.
    pub channel: [u16; 2],
    /// Share of clipped samples.
    pub clipped: f64,
    /// Bits of a sample.
    pub bits: u16,
}

impl Recording {
    /// Reads a WAV file.
    ///
    /// # Errors
    /// [`RecordingError`] if it is none, has no usable samples or too many.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        // before it is opened: a pipe would wait for a writer
        let kind = fs::metadata(path).map_err(RecordingError::Io)?;
        if !kind.is_file() {
            let why = io::Error::other("it is not a plain file");
            return Err(RecordingError::Io(why));
        }
        let file = File::open(path).map_err(RecordingError::Io)?;
        Self::from_reader(&path.display().to_string(), BufReader::new(file))
    }

    /// Reads a WAV file that is in memory.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, RecordingError> {
        Self::from_reader(name, bytes)
    }

    fn from_reader(name: &str, reader: impl Read) -> Result<Self, RecordingError> {
        let wav = Wav::read(reader)?;
        let frames = wav.levels.first().map_or(0, Vec::len);
        let seconds = frames as f64 / f64::from(wav.rate_hz);
        if seconds < SHORTEST_S {
            return Err(RecordingError::TooShort(seconds));
        }
        let energy = |samples: &[f32]| -> f64 {
            let squares = samples.iter().map(|x| f64::from(*x) * f64::from(*x));
            squares.sum()
        };
        let mut loudest = 0;
        for (place, samples) in wav.levels.iter().enumerate() {
            if energy(samples) > energy(&wav.levels[loudest]) {
                loudest = place;
            }
        }
        let number = u16::try_from(loudest + 1).unwrap_or(1);
        let samples = wav.levels.into_iter().nth(loudest).unwrap_or_default();
        Ok(Self {
            name: name.to_owned(),
            rate_hz: f64::from(wav.rate_hz),
            clipped: clipped(&samples, wav.bits),
            samples,
            channel: [number, wav.channels],
            bits: wav.bits,
        })
    }

    /// A recording of 16-bit samples from −1 to 1, as a phone makes.
    pub fn of_samples(name: &str, rate_hz: f64, samples: Vec<f32>) -> Self {
        Self {
            name: name.to_owned(),
            rate_hz,
            clipped: clipped(&samples, BITS),
            samples,
            channel: [1, 1],
            bits: BITS,
        }
    }

    /// The recording as a WAV file of 16 bits.
    ///
    /// # Errors
    /// [`RecordingError::TooLong`] if a WAV file cannot hold it.
    pub fn to_bytes(&self) -> Result<Vec<u8>, RecordingError> {
        let found = self.samples.len() as u64;
        let too_long = |_| RecordingError::TooLong {
            found,
            most: MAX_SAMPLES,
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        // whole and below 384 000
        let spec = WavSpec {
            channels: 1,
            sample_rate: self.rate_hz as u32,
            bits_per_sample: BITS,
            sample_format: SampleFormat::Int,
        };
        let mut bytes = Cursor::new(vec![]);
        let mut writer = WavWriter::new(&mut bytes, spec).map_err(too_long)?;
        for sample in &self.samples {
            #[allow(clippy::cast_possible_truncation)] // clamped
            let number = (sample * f32::from(i16::MAX)).clamp(-32_767.0, 32_767.0) as i16;
            writer.write_sample(number).map_err(too_long)?;
        }
        writer.finalize().map_err(too_long)?;
        Ok(bytes.into_inner())
    }

    /// Length, s.
    pub fn seconds(&self) -> f64 {
        self.samples.len() as f64 / self.rate_hz
    }

    /// The recording as it is listened to: with 96 000 samples a second at most, each the mean of a whole number of its
    /// own. From one sample to the next a sound changes the less the more there are, and noise does not: the onset of a
    /// sound would drown in it. The times of the means are late by less than 4 µs.
    pub(crate) fn slowed(&self) -> Cow<'_, Self> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // positive; a NaN is 0
        let together = (self.rate_hz / MOST_HZ).ceil() as usize;
        if together < 2 {
            return Cow::Borrowed(self);
        }
        let mean = |part: &[f32]| part.iter().sum::<f32>() / part.len() as f32;
        Cow::Owned(Self {
            name: self.name.clone(),
            rate_hz: self.rate_hz / together as f64,
            samples: self.samples.chunks(together).map(mean).collect(),
            ..*self
        })
    }
}

/// Share of samples in runs at the greatest level: near the full scale, or exactly flat below it, as a recorder
/// with a limiter of its own cuts them. (Coarse samples are flat without having been cut.)
fn clipped(samples: &[f32], bits: u16) -> f64 {
    let peak = samples.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    let limit = if peak >= FULL_SCALE {
        FLAT * peak
    } else if bits >= 16 && peak > QUIET {
        peak
    } else {
        return 0.0;
    };
    let (mut run, mut count) = (0, 0_usize);
    for x in samples.iter().chain(&[0.0]) {
        if x.abs() >= limit {
            run += 1;
        } else {
            if run >= CLIPPED_RUN {
                count += run;
            }
            run = 0;
        }
    }
    count as f64 / samples.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wav(bits: u16, channels: u16, float: bool, samples: &[f32]) -> Vec<u8> {
        let spec = WavSpec {
            channels,
            sample_rate: 8000,
            bits_per_sample: bits,
            sample_format: if float {
                SampleFormat::Float
            } else {
                SampleFormat::Int
            },
        };
        let mut bytes = Cursor::new(vec![]);
        let mut writer = WavWriter::new(&mut bytes, spec).unwrap();
        for sample in samples {
            if float {
                writer.write_sample(*sample).unwrap();
            } else {
                let scale = libm::exp2(f64::from(bits) - 1.0) - 1.0;
                #[allow(clippy::cast_possible_truncation)]
                writer
                    .write_sample((f64::from(*sample) * scale) as i32)
                    .unwrap();
            }
        }
        writer.finalize().unwrap();
        bytes.into_inner()
    }

    fn ramp() -> Vec<f32> {
        (0..1000_u16)
            .map(|k| f32::from(k % 100) / 200.0 - 0.25)
            .collect()
    }

    #[test]
    fn all_kinds_of_samples_are_read_on_one_scale() {
        for (bits, float) in [
            (8, false),
            (16, false),
            (24, false),
            (32, false),
            (32, true),
        ] {
            let read = Recording::from_bytes("x", &wav(bits, 1, float, &ramp())).unwrap();
            assert_eq!(
                (read.samples.len(), read.bits, read.channel),
                (1000, bits, [1, 1])
            );
            let far = read.samples.iter().zip(ramp()).map(|(a, b)| (a - b).abs());
            assert!(far.fold(0.0, f32::max) < 0.01, "{bits} {float}");
        }
    }

    #[test]
    fn the_louder_channel_is_taken() {
        let stereo: Vec<f32> = ramp().iter().flat_map(|x| [0.1 * x, *x]).collect();
        let read = Recording::from_bytes("x", &wav(16, 2, false, &stereo)).unwrap();
        assert_eq!((read.channel, read.samples.len()), ([2, 2], 1000));
        assert!((read.samples[99] - 0.245).abs() < 1e-3);
    }

    #[test]
    fn clipping_is_told() {
        let tone: Vec<f32> = (0..2000_u16)
            .map(|k| 2.0 * libm::sinf(f32::from(k) * 0.1))
            .collect();
        let clip = |most: f32| {
            tone.iter()
                .map(|x| x.clamp(-most, most))
                .collect::<Vec<_>>()
        };
        for most in [1.0, 0.5] {
            let read = Recording::from_bytes("x", &wav(16, 1, false, &clip(most))).unwrap();
            assert!(read.clipped > 0.3, "{most}: {}", read.clipped);
        }
        let whole = Recording::from_bytes("x", &wav(16, 1, false, &ramp())).unwrap();
        assert_eq!(whole.clipped, 0.0);
    }

    #[test]
    fn damaged_files_are_errors_and_never_panics() {
        let whole = wav(16, 1, false, &ramp());
        for cut in 0..whole.len() {
            assert!(Recording::from_bytes("x", &whole[..cut]).is_err(), "{cut}");
        }
        let cut = Recording::from_bytes("x", &whole[..whole.len() - 600]);
        let Err(RecordingError::CutOff {
            found: 700,
            promised: 1000,
        }) = cut
        else {
            panic!("{cut:?}");
        };
        for place in 0..60.min(whole.len()) {
            for byte in [0, 1, 0x7f, 0x80, 0xff] {
                let mut damaged = whole.clone();
                damaged[place] = byte;
                drop(Recording::from_bytes("x", &damaged));
            }
        }
        let quiet = Recording::from_bytes("x", &wav(32, 1, true, &[f32::NAN; 1000]));
        assert!(matches!(quiet, Err(RecordingError::NotFinite(0))));
    }
}
