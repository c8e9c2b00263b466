//! Files as Tracker writes them.

use coinmc_film::text::{AngleOf, Choice, Delimiter, Encoding, Footage, read};

fn understood(bytes: &[u8]) -> Footage {
    read("test", bytes, &Choice::default()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn z(footage: &Footage) -> Vec<Option<f64>> {
    footage
        .drop
        .frames
        .iter()
        .map(|frame| frame.seen[1])
        .collect()
}

/// The layout that Tracker 4 and 5 export for one point mass, with Java's number format.
#[test]
fn one_track_with_javas_numbers() {
    let text = "mass_A\nt\tx\ty\t\u{3b8}\n0.0\t-1.25E-3\t2.0E-1\t0.0\n4.0E-3\t0\t1.9E-1\t1.5\n";
    let footage = understood(text.as_bytes());
    assert_eq!(footage.columns[1].track, "mass_A");
    assert_eq!(z(&footage), [Some(0.2), Some(0.19)]);
    assert_eq!(footage.drop.frames[0].seen[0], Some(-1.25e-3));
    assert!((footage.drop.rate_hz() - 250.0).abs() < 1e-9);
    // a line along the face that rises to the right tilts the axis to the left
    assert!((footage.drop.frames[1].seen[2].unwrap() + 1.5_f64.to_radians()).abs() < 1e-15);
}

/// `#multi:` of Tracker 6: names above the first column of each track, delimiters at line ends.
#[test]
fn several_tracks_in_one_file() {
    let text = "#multi:\n\tmass A\t\t\tprotractor B\t\n\
                t\tframe\tx\ty\t\u{3b8} (\u{b0})\t\n\
                0.0\t0\t0.1\t0.2\t10\t\n0.1\t1\t0.1\t\t11\t\n";
    let footage = understood(text.as_bytes());
    assert_eq!(
        footage.used,
        ["mass A.x", "mass A.y", "protractor B.\u{3b8}"]
    );
    assert_eq!(z(&footage), [Some(0.2), None]);
    assert_eq!(footage.missing, [0, 1, 0]);
}

#[test]
fn two_points_make_a_centre_and_an_angle() {
    let text = "#multi:\n;A;;B;;\nt;x;y;x;y;\n0,0;0;0,1;0,02;0,1;\n0,1;0;0,1;0;0,12;\n0,2;;;1;1;\n";
    let choice = Choice {
        ends: Some(("a".into(), "B".into())),
        angle_of: AngleOf::Axis,
        ..Choice::default()
    };
    let footage = read("test", text.as_bytes(), &choice).unwrap();
    let [first, second] = [footage.drop.frames[0].seen, footage.drop.frames[1].seen];
    assert_eq!((first[0], first[1]), (Some(0.01), Some(0.1)));
    // from A to B to the right is an axis on its side; upwards it is heads up
    assert!((first[2].unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    assert!(second[2].unwrap().abs() < 1e-12);
    assert_eq!(
        footage.drop.frames.len(),
        2,
        "frames without a mark at the end are skipped"
    );
}

/// Carriage returns alone end lines, too.
#[test]
fn lines_of_old_macs_are_read() {
    let text = "t,y,angle\n0,0.25,1\n0.5,0.2,2\n";
    let of = |text: &str| read("f", text.as_bytes(), &Choice::default()).unwrap();
    assert_eq!(of(&text.replace('\n', "\r")), of(text));
}

#[test]
fn commas_semicolons_blanks_marks_and_latin_1() {
    let point = "t,y,angle\n0,0.25,1\n0.5,,2\n";
    let comma = "t;y;angle\r\n0;0,25;1\r\n0,5;NaN;2\r\n";
    let blank = "coin\nt  y  angle\n0  0.25  1\n0.5  NaN  2\n";
    let marked = ["\u{feff}", point].concat();
    let latin: Vec<u8> =
        "# Filmaufnahme f\u{fc}r H\u{f6}he\nt\ty\tangle\n0\t0.25\t1\u{b0}\n0.5\t\t2\u{b0}\n"
            .chars()
            .map(|c| u8::try_from(u32::from(c)).unwrap())
            .collect();
    let same: [(&[u8], Delimiter, Encoding); 5] = [
        (point.as_bytes(), Delimiter::Comma, Encoding::Utf8),
        (comma.as_bytes(), Delimiter::Semicolon, Encoding::Utf8),
        (blank.as_bytes(), Delimiter::Blank, Encoding::Utf8),
        (marked.as_bytes(), Delimiter::Comma, Encoding::Utf8Mark),
        (&latin, Delimiter::Tab, Encoding::Latin1),
    ];
    let frames = understood(point.as_bytes()).drop.frames;
    for (bytes, delimiter, encoding) in same {
        let footage = understood(bytes);
        assert_eq!(footage.drop.frames, frames, "{delimiter:?} {encoding:?}");
        assert_eq!(
            (footage.dialect.delimiter, footage.dialect.encoding),
            (delimiter, encoding)
        );
    }
}

#[test]
fn units_come_from_the_header_or_from_the_choice() {
    let text = "t (ms)\tx [cm]\ty (mm)\ttheta (rad)\n0\t1\t200\t0.5\n5\t1\t199\t0.5\n";
    let footage = understood(text.as_bytes());
    let frame = footage.drop.frames[1];
    assert_eq!(
        (frame.time_s, frame.seen),
        (0.005, [Some(0.01), Some(0.199), Some(-0.5)])
    );
    let choice = Choice {
        length_m: Some(0.1),
        angle_of: AngleOf::Tilt,
        ..Choice::default()
    };
    let footage = read("test", text.as_bytes(), &choice).unwrap();
    assert_eq!(
        footage.drop.frames[0].seen,
        [Some(0.1), Some(20.0), Some(0.5)]
    );
}

/// Excerpt of a public student project's export (tests/data/README.md names it): five decimals,
/// tabs, no angle.
#[test]
fn a_real_export_without_an_angle_is_rejected_only_for_that() {
    let bytes = include_bytes!("../data/tracker-mass-a.txt");
    let problems = read("real", bytes, &Choice::default()).unwrap_err();
    assert_eq!(problems.problems().len(), 1);
    assert!(
        problems.problems()[0]
            .message
            .contains("there is no column for the angle")
    );
    let choice = Choice {
        angle: Some("x".into()),
        ..Choice::default()
    };
    let footage = read("real", bytes, &choice).unwrap();
    assert_eq!(z(&footage)[..2], [Some(0.37844), Some(0.37846)]);
    assert!((footage.drop.rate_hz() - 100.0).abs() < 1e-6);
}

/// The names by which results tell how a file was read.
#[test]
fn dialects_have_names() {
    let delimiters = [
        Delimiter::Tab,
        Delimiter::Semicolon,
        Delimiter::Comma,
        Delimiter::Blank,
    ];
    assert_eq!(
        delimiters.map(Delimiter::name),
        ["tab", "semicolon", "comma", "blank"]
    );
    let encodings = [Encoding::Utf8, Encoding::Utf8Mark, Encoding::Latin1];
    let names = ["UTF-8", "UTF-8 with byte order mark", "Latin-1"];
    assert_eq!(encodings.map(Encoding::name), names);
}

/// Columns that are chosen are those of their track; what is not chosen is looked for in the same track first.
#[test]
fn columns_are_chosen_by_name() {
    let text =
        "#multi:\n\tA\t\tmass_B\t\t\nt\tx\ty\tx\ty\tangle\n0\t1\t2\t3\t4\t5\n1\t1\t2\t3\t4\t5\n";
    let place = |x: Option<&str>, y: Option<&str>| {
        let choice = Choice {
            x: x.map(str::to_owned),
            y: y.map(str::to_owned),
            ..Choice::default()
        };
        let footage = read("two", text.as_bytes(), &choice);
        footage.map(|footage| [0, 1].map(|c: usize| footage.drop.frames[0].seen[c].unwrap()))
    };
    assert_eq!(place(None, None), Ok([1.0, 2.0]));
    assert_eq!(place(None, Some("mass B.y")), Ok([3.0, 4.0]));
    assert_eq!(place(Some("a.x"), Some("mass_B.y")), Ok([1.0, 4.0]));
    assert_eq!(place(Some("mass B.x"), None), Ok([3.0, 2.0]));
    let problems = place(None, Some("C.y")).unwrap_err();
    assert!(problems.to_string().contains("there is no column `C.y`"));
}

/// The decimal mark is that of the numbers, not of the names above them.
#[test]
fn names_do_not_tell_the_decimal_mark() {
    let choice = Choice {
        y: Some("y.1".to_owned()),
        ..Choice::default()
    };
    let text = "t;y.1;angle\n0;0,25;1\n1;1;1\n";
    let footage = read("named", text.as_bytes(), &choice).unwrap();
    assert_eq!(z(&footage), [Some(0.25), Some(1.0)]);
}

/// The centre lies between both points, and the angle is that of the line from the first to the second.
#[test]
fn oblique_points_have_the_angle_of_their_line() {
    let text = "#multi:\n\tA\t\tB\t\nt\tx\ty\tx\ty\n0\t0.01\t0.1\t0.04\t0.14\n1\t0\t0\t1\t1\n";
    let choice = Choice {
        ends: Some(("A".into(), "B".into())),
        ..Choice::default()
    };
    let seen = read("test", text.as_bytes(), &choice).unwrap().drop.frames[0].seen;
    let expected = [0.025, 0.12, -libm::atan2(0.04, 0.03)];
    assert!(
        seen.iter()
            .zip(expected)
            .all(|(a, b)| (a.unwrap() - b).abs() < 1e-15),
        "{seen:?}"
    );
}

/// Whole numbers have no decimal mark at all.
#[test]
fn whole_numbers_are_read_with_points() {
    assert!(
        !understood(b"t;y;angle\n0;1;1\n1;2;1\n")
            .dialect
            .decimal_comma
    );
    assert!(
        understood(b"t;y;angle\n0;1;1,5\n1;2;1\n")
            .dialect
            .decimal_comma
    );
}
