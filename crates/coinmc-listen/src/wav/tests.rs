use super::*;
use coinmc_core::Philox4x64;
use hound::{SampleFormat, WavReader};

const RATE_HZ: u32 = 8000;
/// Tag, bytes of a sample, and bits.
const KINDS: [(u16, u16, u16); 7] = [
    (WHOLE, 1, 8),
    (WHOLE, 2, 16),
    (WHOLE, 3, 24),
    (WHOLE, 4, 24),
    (WHOLE, 4, 32),
    (FLOAT, 4, 32),
    (FLOAT, 8, 64),
];

/// A file of two channels, with the stated length of its samples.
fn file((tag, bytes, bits): (u16, u16, u16), length: u32, samples: &[u8]) -> Vec<u8> {
    let frame = 2 * bytes;
    let mut file = b"RIFF\xff\xff\xff\xffWAVEfmt \x10\0\0\0".to_vec();
    file.extend([tag, 2].map(u16::to_le_bytes).concat());
    file.extend(
        [RATE_HZ, RATE_HZ * u32::from(frame)]
            .map(u32::to_le_bytes)
            .concat(),
    );
    file.extend([frame, bits].map(u16::to_le_bytes).concat());
    file.extend(b"data");
    file.extend(length.to_le_bytes());
    file.extend(samples);
    file
}

/// Bytes of any samples; those of floats are of a size that sounds have.
fn any((tag, bytes, _): (u16, u16, u16), frames: usize) -> Vec<u8> {
    let stream = Philox4x64::new([7, 8]);
    let of = |n: usize| {
        let word = stream.block([n as u64, 0, 0, 0])[0];
        let level = 2.0 * coinmc_core::unit_interval(word) - 1.0;
        match (tag, bytes) {
            #[allow(clippy::cast_possible_truncation)]
            (FLOAT, 4) => (level as f32).to_le_bytes().to_vec(),
            (FLOAT, _) => level.to_le_bytes().to_vec(),
            _ => word.to_le_bytes()[..usize::from(bytes)].to_vec(),
        }
    };
    (0..2 * frames).flat_map(of).collect()
}

fn whole(bytes: &[u8]) -> u32 {
    u32::try_from(bytes.len()).unwrap()
}

/// Of what hound reads every sample is the same to the bit.
#[test]
fn samples_are_those_that_a_library_reads() {
    for kind in &KINDS[..6] {
        let samples = any(*kind, 300);
        let bytes = file(*kind, whole(&samples), &samples);
        let ours = Wav::read(bytes.as_slice()).unwrap();
        let mut reader = WavReader::new(bytes.as_slice()).unwrap();
        let spec = reader.spec();
        let theirs: Vec<f32> = if spec.sample_format == SampleFormat::Float {
            reader.samples::<f32>().map(Result::unwrap).collect()
        } else {
            let scale = libm::exp2(1.0 - f64::from(spec.bits_per_sample));
            #[allow(clippy::cast_possible_truncation)]
            let level = |sample: hound::Result<i32>| (f64::from(sample.unwrap()) * scale) as f32;
            reader.samples::<i32>().map(level).collect()
        };
        assert_eq!(
            (ours.rate_hz, ours.channels, ours.bits),
            (RATE_HZ, 2, kind.2)
        );
        for (channel, levels) in ours.levels.iter().enumerate() {
            let theirs: Vec<f32> = theirs.iter().skip(channel).step_by(2).copied().collect();
            assert_eq!(*levels, theirs, "{kind:?}");
        }
    }
}

#[test]
fn floats_of_64_bits_are_read() {
    let kind = KINDS[6];
    let samples: Vec<u8> = [0.25, -0.5, 1.0, 0.0].map(f64::to_le_bytes).concat();
    let read = Wav::read(file(kind, whole(&samples), &samples).as_slice()).unwrap();
    assert_eq!(read.levels, [[0.25, 1.0], [-0.5, 0.0]]);
}

/// A program that wrote to a pipe did not know the length: all that follows are samples, but for the rest of a last
/// frame.
#[test]
fn a_file_of_unknown_length_is_read_to_its_end() {
    for kind in KINDS {
        let samples = any(kind, 300);
        let known = Wav::read(file(kind, whole(&samples), &samples).as_slice()).unwrap();
        for length in [u32::MAX, 0, 0x7fff_ffff, 0x7fff_f000] {
            let more = [&samples[..], &[1]].concat();
            let read = Wav::read(file(kind, length, &more).as_slice()).unwrap();
            assert_eq!(read.levels, known.levels, "{kind:?} {length}");
        }
    }
    for length in [u32::MAX, 0] {
        let none = Wav::read(file(KINDS[1], length, &[]).as_slice());
        assert!(matches!(none, Err(RecordingError::Empty)), "{none:?}");
    }
}

/// A header that promises more than is there is not believed, and one that promises nothing has its end, too.
#[test]
fn what_is_kept_is_bounded() {
    let kind = KINDS[0];
    let endless = file(kind, u32::MAX, &[]);
    let read = Wav::read(endless.as_slice().chain(io::repeat(128)));
    assert!(
        matches!(read, Err(RecordingError::Endless { .. })),
        "{read:?}"
    );
    let long = Wav::read(file(kind, 1 << 24, &[]).as_slice());
    let Err(RecordingError::TooLong {
        found: 0x80_0000, ..
    }) = long
    else {
        panic!("{long:?}");
    };
    let cut = Wav::read(file(KINDS[1], 400, &[0; 101]).as_slice());
    let Err(RecordingError::CutOff {
        found: 50,
        promised: 200,
    }) = cut
    else {
        panic!("{cut:?}");
    };
}

/// Floats that are whole numbers not scaled are a recording; those whose squares are beyond all numbers are told.
#[test]
fn floats_far_beyond_the_full_scale_are_told() {
    let kind = KINDS[5];
    let of = |level: f32| {
        let samples: Vec<u8> = [0.5, 0.5, 0.5, level].map(f32::to_le_bytes).concat();
        Wav::read(file(kind, whole(&samples), &samples).as_slice())
    };
    assert_eq!(of(-32_768.0).unwrap().levels[1], [0.5, -32_768.0]);
    let error = of(7e29).unwrap_err();
    assert!(matches!(
        error,
        RecordingError::BeyondScale { place: 3, .. }
    ));
    assert!(error.to_string().contains("7.0e29"), "{error}");
    assert!(matches!(of(f32::NAN), Err(RecordingError::NotFinite(3))));
    // a float of 64 bits that is none of 32
    let samples: Vec<u8> = [0.5, 1e300].map(f64::to_le_bytes).concat();
    let read = Wav::read(file(KINDS[6], whole(&samples), &samples).as_slice());
    assert!(
        matches!(read, Err(RecordingError::BeyondScale { .. })),
        "{read:?}"
    );
}

/// Other chunks are passed over, odd ones with the byte that follows them.
#[test]
fn other_chunks_are_passed_over() {
    let samples = any(KINDS[1], 10);
    let plain = file(KINDS[1], whole(&samples), &samples);
    let with = |chunk: &[u8]| [&plain[..12], chunk, &plain[12..]].concat();
    let read = Wav::read(with(b"LIST\x03\0\0\0abc\0").as_slice()).unwrap();
    assert_eq!(read.levels, Wav::read(plain.as_slice()).unwrap().levels);
    let beyond = Wav::read(with(b"LIST\xff\xff\xff\xff").as_slice());
    assert!(matches!(
        beyond,
        Err(RecordingError::NotWav("it ends in its header"))
    ));
}

/// The tag of an extensible format stands farther on; of 32 bits of which 24 are valid those are the upper ones.
#[test]
fn extensible_formats_are_read() {
    let samples = 0x4000_0000_u32.to_le_bytes().repeat(2);
    let plain = file(KINDS[4], whole(&samples), &samples);
    let mut extensible = plain[..36].to_vec();
    extensible[16] = 40;
    extensible[20..22].copy_from_slice(&EXTENSIBLE.to_le_bytes());
    extensible.extend([22_u16, 24, 0, 0, WHOLE].map(u16::to_le_bytes).concat());
    extensible.extend(AFTER_TAG);
    extensible.extend(&plain[36..]);
    let read = Wav::read(extensible.as_slice()).unwrap();
    assert_eq!((read.bits, read.levels), (24, vec![vec![0.5]; 2]));
    extensible[50] = 1;
    let other = Wav::read(extensible.as_slice());
    assert!(
        matches!(other, Err(RecordingError::Unsupported)),
        "{other:?}"
    );
}
