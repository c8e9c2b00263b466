//! Bad files: all problems are reported at once, each with its position, and nothing panics.

use coinmc_film::text::{Choice, MAX_BYTES, MAX_COLUMNS, MAX_LINE, Problem, bytes_of, read};

fn problems(bytes: &[u8]) -> Vec<Problem> {
    let found = read("bad.txt", bytes, &Choice::default()).expect_err("bad");
    assert!(!found.render(true).is_empty() && !found.to_string().is_empty());
    found.problems().to_vec()
}

#[test]
fn every_problem_is_reported_with_its_position() {
    let text = "coin\nt\ty\t\u{3b8}\n0\t0.2\t1\n0.1\tO.19\t2\n\n# remark\n0.1\t0.18\t3\n\
                0.05\t0.17\t4\n0.3\t0.16\t5\t6\n\t0.15\t7\n0.4\t0,14\t8\n";
    let found = problems(text.as_bytes());
    let places: Vec<_> = found.iter().map(|p| (p.line, p.column)).collect();
    assert_eq!(places, [(4, 5), (8, 1), (9, 12), (10, 1), (11, 5)]);
    let says = |i: usize, what: &str| assert!(found[i].message.contains(what), "{:?}", found[i]);
    says(0, "`O.19` is not a number");
    says(1, "times must increase");
    says(2, "4 cells, but 3 columns");
    says(3, "the time is missing");
    says(4, "a decimal comma");
}

#[test]
fn headers_are_explained() {
    for (text, what) in [
        ("", "no line names columns"),
        ("1\t2\t3\n", "no line names columns"),
        ("t\tx\n0\t1\n", "there is no column for y"),
        (
            "t\ty (pixel)\t\u{3b8}\n0\t1\t2\n",
            "the unit `pixel` is not known",
        ),
        ("t\ty\t\u{3b8}\n", "no numbers below"),
        ("t\ty\t\u{3b8}\n0\t0.2\t1\n", "one frame is no film"),
    ] {
        let found = problems(text.as_bytes());
        assert!(found[0].message.contains(what), "{text:?}: {found:?}");
        assert!(
            found[0].help.is_some() || ["no numbers below", "one frame is no film"].contains(&what)
        );
    }
}

#[test]
fn decimal_commas_between_commas_are_recognised() {
    let found = problems(b"t,y,angle\n0,1,0,2,1\n");
    assert!(found[0].help.as_ref().unwrap().contains("semicolons"));
}

#[test]
fn sizes_are_bounded_and_foreign_bytes_are_harmless() {
    let long = ["t\ty\tangle\n0\t1\t", &"1".repeat(MAX_LINE), "\n"].concat();
    assert!(
        problems(long.as_bytes())[0]
            .message
            .contains("a line has at most")
    );
    assert!(
        problems(&vec![b'\n'; MAX_BYTES + 1])[0]
            .message
            .contains("bytes")
    );
    let utf16: Vec<u8> = "t\ty".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(problems(&utf16)[0].message.contains("not text"));
    let many = ["t\ty\tangle\n", &"x\ty\tz\n".repeat(1000)].concat();
    assert_eq!(problems(many.as_bytes()).len(), 50);
    problems("t\ty\tangle\n0\t1e999\t1\n".as_bytes());
    let endless = problems(b"t (min)\ty\tangle\n0\t1\t1\n1\t1\t1\n1e307\t1\t1\n");
    assert_eq!(endless[0].line, 4);
    assert!(endless[0].message.contains("far out of range"));
    problems("t\ty\tangle\n0\t\u{1b}[31m\t1\n".as_bytes());
}

/// A cell that is not a number is marked where it stands, and one that is missing at the end of its line.
#[test]
fn a_wrong_cell_is_marked_alone() {
    let found = problems(b"t\ty\tangle\n0\t12x4\t1\n0.1\t2\t3\n");
    let text = found[0].message.clone();
    assert_eq!(
        (found[0].line, found[0].column, text.as_str()),
        (2, 3, "`12x4` is not a number")
    );
    let quote = format!("{:?}", found[0]);
    assert!(quote.contains("2..6"), "{quote}");
    let found = problems(b"t\ty\tangle\n0\t1\t2\t345\t6\n0.1\t2\t3\n");
    let quote = format!("{:?}", found[0]);
    assert!(found[0].column == 7 && quote.contains("6..9"), "{quote}");
}

/// Up to the limits and no further: of bytes, of a line, of columns.
#[test]
fn the_limits_themselves_are_allowed() {
    let table = |columns: usize| {
        let names: Vec<String> = (3..columns).map(|i| format!("c{i}")).collect();
        let header = [&["t".into(), "y".into(), "angle".into()], &names[..]]
            .concat()
            .join("\t");
        let line = |t: &str| {
            [&[t, "1", "2"], &vec!["0"; columns - 3][..]]
                .concat()
                .join("\t")
        };
        [header, line("0"), line("1"), String::new()].join("\n")
    };
    assert!(read("wide", table(MAX_COLUMNS).as_bytes(), &Choice::default()).is_ok());
    assert!(
        problems(table(MAX_COLUMNS + 1).as_bytes())[0]
            .message
            .contains("columns")
    );
    let long = |length: usize| {
        let end = "1\t2\n1\t1\t2\n";
        ["t\ty\tangle\n0", &" ".repeat(length - 5), "\t", end].concat()
    };
    assert!(read("long", long(MAX_LINE).as_bytes(), &Choice::default()).is_ok());
    assert!(
        problems(long(MAX_LINE + 1).as_bytes())[0]
            .message
            .contains("bytes")
    );
    let mut full = table(3).into_bytes();
    let remark = ["#".repeat(MAX_LINE - 1), "\n".to_owned()].concat();
    full.extend(remark.bytes().cycle().take(MAX_BYTES - full.len()));
    assert!(read("full", &full, &Choice::default()).is_ok());
}

/// A file that is too long is not read to its end, but far enough to tell.
#[test]
fn no_more_of_a_file_is_read_than_tells_that_it_is_too_long() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("bytes_of.txt");
    for (written, read) in [
        (10, 10),
        (MAX_BYTES, MAX_BYTES),
        (MAX_BYTES + 5, MAX_BYTES + 1),
    ] {
        std::fs::write(&path, vec![b'a'; written]).unwrap();
        let bytes = bytes_of(&path).unwrap();
        assert!(bytes.len() == read && bytes.iter().all(|byte| *byte == b'a'));
    }
    std::fs::remove_file(&path).unwrap();
    let error = bytes_of(folder).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::IsADirectory);
}

/// A column whose unit is not known is marked with its name and unit.
#[test]
fn a_wrong_unit_is_marked() {
    let found = problems(b"t\ty (pixel)\tangle\n0\t1\t2\n");
    assert_eq!((found[0].line, found[0].column), (1, 3));
    let quote = format!("{:?}", found[0]);
    assert!(quote.contains("2..11"), "{quote}");
}

/// Spaces do not show which cell is missing; other delimiters leave it out at the end.
#[test]
fn missing_cells_need_delimiters() {
    let found = problems(b"t y angle x\n0 1 2 3\n0.1 1 2\n");
    assert!(
        found[0].message.contains("3 cells, but 4 columns"),
        "{found:?}"
    );
    let fine = read(
        "short",
        b"t\ty\tangle\tx\n0\t1\t2\t3\n0.1\t1\t2\n",
        &Choice::default(),
    );
    assert_eq!(fine.unwrap().drop.frames[1].seen[0], None);
}
