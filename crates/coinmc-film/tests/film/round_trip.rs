//! Files written in any dialect read back the same.

use coinmc_film::text::{AngleOf, Choice, Delimiter, Dialect, Encoding, read, write};
use coinmc_film::{FilmedDrop, Frame};
use proptest::prelude::*;

fn dialects() -> impl Strategy<Value = Dialect> {
    let delimiters = prop::sample::select(vec![
        Delimiter::Tab,
        Delimiter::Semicolon,
        Delimiter::Comma,
        Delimiter::Blank,
    ]);
    let encodings =
        prop::sample::select(vec![Encoding::Utf8, Encoding::Utf8Mark, Encoding::Latin1]);
    (delimiters, any::<bool>(), any::<bool>(), encodings).prop_map(
        |(delimiter, decimal_comma, crlf, encoding)| Dialect {
            delimiter,
            decimal_comma: decimal_comma && delimiter != Delimiter::Comma,
            crlf,
            encoding,
        },
    )
}

/// Numbers with fractions, so that the decimal mark can be recognised.
fn drops() -> impl Strategy<Value = FilmedDrop> {
    let value = |range| prop::option::weighted(0.8, range);
    let frame = (value(-9.5..9.5), value(-9.5..9.5), value(-3.1..3.1));
    prop::collection::vec(frame, 1..40).prop_map(|rows| {
        let whole = [Some(0.125), Some(0.25), Some(0.5)];
        let seen = rows.into_iter().map(|(x, z, theta)| [x, z, theta]);
        let seen = std::iter::once(whole).chain(seen).chain([whole]);
        let frame = |(i, seen)| Frame {
            time_s: 0.5 + i as f64 / 240.0,
            seen,
        };
        FilmedDrop {
            name: "test".into(),
            frames: seen.enumerate().map(frame).collect(),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Times and positions are bit-identical; angles, which are converted, agree to rounding.
    #[test]
    fn written_drops_read_the_same(
        drop in drops(),
        dialect in dialects(),
        angle_of in prop::sample::select(vec![AngleOf::Face, AngleOf::Axis, AngleOf::Tilt]),
    ) {
        let bytes = write(&drop, "mass A", angle_of, &dialect, None);
        let choice = Choice { angle_of, ..Choice::default() };
        let footage = read("test", &bytes, &choice)
            .map_err(|problems| TestCaseError::fail(problems.to_string()))?;
        prop_assert_eq!(footage.dialect.delimiter, dialect.delimiter);
        prop_assert_eq!(footage.dialect.decimal_comma, dialect.decimal_comma);
        prop_assert_eq!(footage.drop.frames.len(), drop.frames.len());
        for (a, b) in footage.drop.frames.iter().zip(&drop.frames) {
            prop_assert_eq!((a.time_s, a.seen[0], a.seen[1]), (b.time_s, b.seen[0], b.seen[1]));
            match (a.seen[2], b.seen[2]) {
                (Some(a), Some(b)) => {
                    let apart = libm::remainder(a - b, std::f64::consts::TAU);
                    prop_assert!(apart.abs() < 1e-14);
                }
                (a, b) => prop_assert_eq!(a, b),
            }
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read("test", &bytes, &Choice::default());
    }

    /// Text that resembles a table reaches deeper into the parser than random bytes.
    #[test]
    fn no_table_makes_the_reader_panic(rest in "[t,;\t #xyθ0-9.,eE°\\-\n]{0,200}") {
        let text = format!("t\tx\ty\tθ\n{rest}");
        let _ = read("test", text.as_bytes(), &Choice::default());
        let _ = read("test", rest.as_bytes(), &Choice::default());
    }
}
