//! One table in three forms, the same in each, and as documented.

use crate::support::{plan, plan_of, run_whole};
use coinmc::plan::{Plan, StoppedBy};
use coinmc::results::{Kind, Results, Row, columns, write_csv, write_parquet};
use coinmc_core::{Tally, relative_error};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;

/// Rows of all kinds: ordinary, without the side, with undecided tosses, without tosses.
fn example(plan: &Plan) -> Results {
    let tallies = [
        Tally {
            heads: 49,
            tails: 30,
            side: 21,
            impacts: 333,
            contact_steps: 71,
            ..Tally::default()
        },
        Tally {
            heads: 50,
            tails: 50,
            ..Tally::default()
        },
        Tally {
            heads: 5,
            side: 1,
            time_limit: 2,
            never_settles: 5,
            impact_limit: 3,
            failed: 4,
            ..Tally::default()
        },
        Tally::default(),
        Tally {
            side: 1 << 40,
            jams: 7,
            overruled: 8,
            ..Tally::default()
        },
        Tally {
            heads: 1,
            tails: 1,
            side: 1,
            ..Tally::default()
        },
    ];
    let rows = tallies.iter().enumerate().map(|(i, tally)| {
        let by = if i == 3 {
            StoppedBy::Unfinished
        } else {
            StoppedBy::Tosses
        };
        Row::new(plan, i, *tally, by)
    });
    Results::new(plan, rows.collect())
}

fn csv(results: &Results) -> Vec<Vec<String>> {
    let mut bytes = Vec::new();
    write_csv(results, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    text.lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

fn text(cell: &Field) -> String {
    match cell {
        Field::Null => String::new(),
        Field::ULong(count) => count.to_string(),
        Field::Double(number) => format!("{number:?}"),
        Field::Str(text) => text.clone(),
        Field::Bool(flag) => flag.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn csv_parquet_and_json_agree_cell_by_cell() {
    let dir = tempfile::tempdir().unwrap();
    let plan = plan("tosses = 100");
    let results = example(&plan);
    let path = dir.path().join("table.parquet");
    write_parquet(&results, &mut File::create(&path).unwrap()).unwrap();
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    let rows: Vec<_> = rows.map(|row| row.unwrap().into_columns()).collect();
    let json = results.to_json();
    let table = csv(&results);
    let names = results.rows[0].parameters.iter().map(|(name, _)| &**name);
    let columns = columns(names);
    assert_eq!((rows.len(), rows[0].len()), (6, columns.len()));
    for (c, column) in columns.iter().enumerate() {
        assert_eq!(table[0][c], column.name);
        assert_eq!(rows[0][c].0, column.name);
        for r in 0..6 {
            let there = &table[r + 1][c];
            assert_eq!(*there, text(&rows[r][c].1), "{} {r}", column.name);
            let value = &json["points"][r][&column.name];
            let value = match (value.as_str(), value.as_f64()) {
                (Some(text), _) => text.to_owned(),
                (None, Some(number)) if column.kind == Kind::Number => format!("{number:?}"),
                _ if value.is_null() => String::new(),
                _ => value.to_string(),
            };
            assert_eq!(*there, value, "{} {r}", column.name);
        }
    }
}

#[test]
fn cells_match_their_columns() {
    let plan = plan("tosses = 100");
    let table = csv(&example(&plan));
    let cell = |row: usize, name: &str| {
        let column = table[0].iter().position(|there| there == name).unwrap();
        table[row + 1][column].as_str()
    };
    assert_eq!(
        (cell(1, "point"), cell(4, "ratio"), cell(4, "restitution")),
        ("1", "2.0", "0.3")
    );
    assert_eq!(
        (cell(0, "engine"), cell(0, "law"), cell(0, "interval")),
        ("flat", "moreau", "wilson")
    );
    assert_eq!((cell(2, "tosses"), cell(2, "undecided")), ("20", "14"));
    assert_eq!(
        (cell(2, "never_settles"), cell(2, "impact_limit")),
        ("5", "3")
    );
    assert_eq!(
        (cell(0, "p_side"), cell(0, "p_heads"), cell(0, "p_tails")),
        ("0.21", "0.49", "0.3")
    );
    assert_eq!(
        cell(0, "rel_error_side"),
        format!("{:?}", relative_error(0.21, 100))
    );
    assert_eq!(
        (cell(0, "rule_of_thumb"), cell(0, "impacts_per_toss")),
        ("0.1", "3.33")
    );
    assert_eq!((cell(1, "p_side"), cell(1, "rel_error_side")), ("0.0", ""));
    assert_eq!(
        (
            cell(3, "p_side"),
            cell(3, "p_side_lo"),
            cell(3, "p_side_hi")
        ),
        ("", "0.0", "1.0")
    );
    assert_eq!(
        (cell(3, "rule_of_thumb"), cell(3, "reached_target")),
        ("", "false")
    );
    assert_eq!(
        (
            cell(4, "jams"),
            cell(4, "overruled"),
            cell(4, "reached_target")
        ),
        ("7", "8", "true")
    );
}

/// (e, μ) alone does not define a toss in space.
#[test]
fn every_result_names_the_law_and_all_that_defines_the_toss() {
    let text = "[coin]\nratio = 1\n[surface]\nrestitution = 0.3\nfriction = 10\nrolling_friction_m = 1e-4\n\
                pivoting_friction_m = 2e-4\nrestitution_threshold_m_s = 2\n\
                restitution_exponent = 0.25\nrestitution_reference_m_s = 2\nroughness_slope = 0.06\n\
                roughness_wavelength_m = 3e-3\ntable_radius_m = 0.2\ntable_tilt_deg = 3\n\
                table_downhill_deg = 45\n[environment]\n\
                linear_drag_per_s = 1\nangular_drag_per_s = 0.05\ngyroscopic_torque = false\n\
                [launch]\npreset = \"table1\"\n[engine.volumetric]\nlaw = \"stronge\"\n\
                [stop]\ntosses = 1\n";
    let plan = coinmc::config::parse("test", text, &[]).unwrap();
    let row = Row::new(&plan, 0, Tally::default(), StoppedBy::Unfinished);
    let results = Results::new(&plan, vec![row].into());
    let table = csv(&results);
    let cells: Vec<(&str, &str)> = table[0]
        .iter()
        .zip(&table[1])
        .map(|(name, cell)| (name.as_str(), cell.as_str()))
        .collect();
    let expected = [
        ("rim_radius_m", "0.0"),
        ("restitution", "0.3"),
        ("friction", "10.0"),
        ("rolling_friction_m", "0.0001"),
        ("pivoting_friction_m", "0.0002"),
        ("restitution_threshold_m_s", "2.0"),
        ("linear_drag_per_s", "1.0"),
        ("angular_drag_per_s", "0.05"),
        ("restitution_exponent", "0.25"),
        ("restitution_reference_m_s", "2.0"),
        ("roughness_slope", "0.06"),
        ("roughness_wavelength_m", "0.003"),
        ("table_radius_m", "0.2"),
        ("table_tilt_deg", "3.0"),
        ("table_downhill_deg", "45.0"),
        ("engine", "volumetric"),
        ("law", "stronge"),
        ("gyroscopic_torque", "false"),
    ];
    assert_eq!(cells[3..21], expected);
    let published = results.rows[0].published.as_ref().unwrap();
    assert_eq!(
        published.differs,
        [
            "radius_m",
            "rolling_friction_m",
            "pivoting_friction_m",
            "restitution_exponent",
            "roughness_slope",
            "table_radius_m",
            "table_tilt_deg"
        ]
    );
}

#[test]
fn closed_forms_are_exact_and_make_no_tosses() {
    let plan = coinmc::config::parse(
        "test",
        "[coin]\nratio = [0.5, 1.5]\n[engine.analytic]\nrule = \"cross-section\"\n",
        &[],
    )
    .unwrap();
    let dir = tempfile::tempdir().unwrap();
    let report = run_whole(&plan, dir.path());
    assert_eq!(report.status, coinmc::run::Status::Complete);
    // x/(2 + x)
    for (row, p) in report.results.rows.iter().zip([0.2, 3.0 / 7.0]) {
        assert_eq!(
            (row.side.p, row.side.lo, row.side.hi),
            (row.side.p, row.side.p, row.side.p)
        );
        assert!((row.side.p - p).abs() < 1e-15);
        assert_eq!(
            (row.interval, row.engine, row.law),
            ("exact", "analytic", "cross-section")
        );
        assert_eq!((row.tally, row.half_width()), (Tally::default(), 0.0));
    }
}

#[test]
fn parquet_has_the_config_and_is_reproducible() {
    let dir = tempfile::tempdir().unwrap();
    let plan =
        plan_of("[coin]\nratio = [1.0, 2.0]\n[surface]\nrestitution = 0.5\n[stop]\ntosses = 10\n");
    run_whole(&plan, dir.path());
    let path = dir.path().join("results.parquet");
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let file = reader.metadata().file_metadata();
    assert_eq!(
        file.created_by(),
        Some(concat!("coinmc ", env!("CARGO_PKG_VERSION")))
    );
    let metadata = file.key_value_metadata().unwrap();
    let value = |key: &str| {
        metadata
            .iter()
            .find(|pair| pair.key == key)
            .and_then(|pair| pair.value.clone())
            .unwrap()
    };
    assert_eq!(value("coinmc.plan_hash"), plan.hash());
    assert_eq!(value("coinmc.config"), plan.resolved_toml);
    assert_eq!(value("coinmc.axes"), "ratio");
    assert_eq!(reader.metadata().num_row_groups(), 1);
    let first = std::fs::read(&path).unwrap();
    let results = run_whole(&plan, dir.path()).results;
    let mut bytes = Vec::new();
    write_parquet(&results, &mut bytes).unwrap();
    assert!(bytes == first);
}

#[test]
fn every_column_is_documented() {
    let document = include_str!("../../../../docs/reference/formats.md");
    let plan = plan("tosses = 1");
    let always = &plan.points[0].parameters[..9];
    for column in columns(always.iter().map(|(name, _)| &**name)) {
        let unit = if column.unit.is_empty() {
            "–"
        } else {
            column.unit
        };
        let line = format!(
            "| `{}` | {} | {unit} | {} |",
            column.name,
            column.kind.name(),
            column.doc
        );
        assert!(
            document.lines().any(|there| there == line),
            "docs/reference/formats.md lacks\n{line}"
        );
    }
}

#[test]
fn every_counter_is_documented() {
    let document = include_str!("../../../../docs/reference/formats.md");
    for counter in Tally::COUNTERS {
        let name = counter.name;
        assert!(document.contains(&format!("`{name}`")), "{name}");
    }
}
