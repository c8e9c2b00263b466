//! Files that cannot be configs, and sizes that must not hurt.

use coinmc::config::{self, MAX_BYTES};
use std::time::{Duration, Instant};

#[test]
fn unreadable_files_give_one_problem() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    for (path, line, column, message) in [
        (folder.path().to_owned(), 0, 0, "this is a directory"),
        (
            folder.path().join("none.toml"),
            0,
            0,
            "there is no such file",
        ),
        (
            file("latin1.toml", b"seed = 1\n# \xc2\xb5 \xb5\n"),
            2,
            5,
            "this is no UTF-8 text",
        ),
        (
            file("large.toml", &vec![b'#'; MAX_BYTES + 1]),
            0,
            0,
            "at most 1048576 bytes",
        ),
    ] {
        let diagnostics = config::load(&path, &[]).unwrap_err();
        let [problem] = diagnostics.problems() else {
            panic!("one problem: {diagnostics}")
        };
        assert_eq!(
            (problem.line, problem.column),
            (line, column),
            "{diagnostics}"
        );
        assert!(problem.message.contains(message), "{diagnostics}");
        assert!(
            diagnostics
                .to_string()
                .contains(&path.display().to_string()),
            "{diagnostics}"
        );
    }
}

#[test]
fn byte_order_mark_and_windows_line_ends_are_accepted() {
    let text = "\u{feff}coin.ratio = 1\r\n[engine.analytic]\r\nrule = 'arc'\r\n";
    config::parse("dos.toml", text, &[]).unwrap();
    let bad = config::parse("dos.toml", &text.replace("arc", "ark"), &[]).unwrap_err();
    assert_eq!((bad.problems()[0].line, bad.problems()[0].column), (3, 8));
}

/// Far less than the seconds that enumerating even 1e9 points would take.
const AT_ONCE: Duration = Duration::from_millis(500);

#[test]
fn huge_sweeps_are_rejected_before_they_are_expanded() {
    let range = "{ from = 0.1, to = 1, steps = 1000000 }";
    let many = (0..3).map(|_| range).collect::<Vec<_>>().join(", ");
    for (text, count) in [
        (
            format!("coin.ratio = {range}\ncoin.radius_m = {range}\n"),
            "1000000000000",
        ),
        (
            format!(
                "coin = {{ ratio = {range}, radius_m = {range}, mass_kg = {range} }}\n\
                 launch = {{ preset = 'robot', velocity_m_s = [{many}] }}\n"
            ),
            "more than 10^19",
        ),
    ] {
        let start = Instant::now();
        let text = text + "[engine.analytic]\nrule = 'arc'";
        let diagnostics = config::parse("huge.toml", &text, &[]).unwrap_err();
        let message = &diagnostics.problems()[0].message;
        assert!(
            message.contains(&format!("the sweep has {count} points")),
            "{message}"
        );
        assert!(start.elapsed() < AT_ONCE, "{:?}", start.elapsed());
    }
}

#[test]
fn deep_nesting_is_rejected() {
    for text in [
        format!("a = {}1{}", "[".repeat(100_000), "]".repeat(100_000)),
        format!("a = {}1{}", "{a=".repeat(100_000), "}".repeat(100_000)),
        format!("{}a = 1", "a.".repeat(500_000)),
        format!("[{}a]", "a.".repeat(500_000)),
    ] {
        assert!(config::parse("deep.toml", &text, &[]).is_err());
    }
}

#[test]
fn a_config_too_long_when_resolved_is_rejected() {
    // "9e6" becomes "9000000.0": three times as long
    let list = (1..=100_000)
        .map(|i| format!("{i}e6"))
        .collect::<Vec<_>>()
        .join(",");
    let text = format!("coin.ratio = [{list},7]\nengine.analytic.rule = 'arc'");
    assert!(text.len() < MAX_BYTES);
    let diagnostics = config::parse("long.toml", &text, &[])
        .map(drop)
        .unwrap_err();
    assert!(
        diagnostics.problems()[0].message.contains("spelled out"),
        "{diagnostics}"
    );
}
