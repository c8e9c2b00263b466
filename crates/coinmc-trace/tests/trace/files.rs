//! All file formats of a trace agree.

use crate::plans::{flat, space};
use coinmc::plan::Plan;
use coinmc::results::Kind;
use coinmc_recording::{Compression, Encoding, Unsynced, salvage};
use coinmc_trace::{Trace, columns, replay, write_csv, write_jsonl, write_mcap, write_parquet};
use serde_json::Value;
use std::io::Cursor;

fn traces() -> (Plan, Vec<Trace>) {
    let plan = space("moreau", 5);
    let traces = [(0, 1), (1, 4)];
    let traces = traces.map(|(point, toss)| replay(&plan, point, toss, 200.0).unwrap());
    (plan, traces.into())
}

fn csv(traces: &[Trace]) -> String {
    let mut bytes = Vec::new();
    write_csv(traces, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn jsonl(plan: &Plan, traces: &[Trace]) -> Vec<Value> {
    let mut bytes = Vec::new();
    write_jsonl(plan, traces, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn csv_has_a_line_per_record_and_numbers_that_read_back() {
    let (_, traces) = traces();
    let text = csv(&traces);
    let mut lines = text.lines();
    let names: Vec<_> = columns().iter().map(|column| column.name).collect();
    assert_eq!(lines.next().unwrap(), names.join(","));
    let records = traces.iter().flat_map(|trace| &trace.records);
    let place = |name| names.iter().position(|n| *n == name).unwrap();
    let mut count = 0;
    for (line, record) in lines.zip(records) {
        let cells: Vec<_> = line.split(',').collect();
        assert_eq!(cells.len(), names.len());
        let number = |name| cells[place(name)].parse::<f64>().unwrap();
        assert_eq!(number("time_s").to_bits(), record.state.time_s.to_bits());
        assert_eq!(number("qx").to_bits(), record.orientation.i.to_bits());
        assert_eq!(cells[place("kind")], record.kind.name());
        count += 1;
    }
    assert_eq!(
        count,
        traces
            .iter()
            .map(|trace| trace.records.len())
            .sum::<usize>()
    );
}

#[test]
fn json_lines_agree_with_csv() {
    let (plan, traces) = traces();
    let text = csv(&traces);
    let mut cells = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let lines = jsonl(&plan, &traces);
    assert_eq!(
        (&lines[0]["type"], &lines[0]["format"]),
        (&"file".into(), &1.into())
    );
    assert_eq!(lines[0]["plan_hash"], plan.hash());
    let mut tosses = 0;
    for line in &lines[1..] {
        if line["type"] == "toss" {
            assert_eq!(line["toss"], traces[tosses].toss);
            assert_eq!(line["outcome"]["impacts"], traces[tosses].outcome.impacts);
            tosses += 1;
            continue;
        }
        let row = cells.next().expect("as many records");
        for (column, cell) in columns().iter().zip(row) {
            let value = &line[column.name];
            if column.kind == Kind::Text {
                assert_eq!(value, cell);
            } else {
                // written exactly (the Python tests compare bits), read here to an ulp
                let (a, b): (f64, f64) = (value.as_f64().unwrap(), cell.parse().unwrap());
                assert!((a - b).abs() <= 3e-16 * b.abs(), "{}: {a} {b}", column.name);
            }
        }
    }
    assert_eq!((tosses, cells.next()), (2, None));
}

#[test]
fn the_mcap_is_undamaged_and_has_all_records() {
    let (plan, traces) = traces();
    let none = Compression::None;
    for (encoding, compression) in [
        (Encoding::Protobuf, none),
        (Encoding::Protobuf, Compression::Lz4),
        (Encoding::Json, none),
    ] {
        let mut bytes = Vec::new();
        write_mcap(&plan, &traces, encoding, compression, &mut bytes).unwrap();
        let recovered = salvage(Cursor::new(bytes), Unsynced(Vec::new())).unwrap();
        assert!(recovered.was_whole());
        let records: usize = traces.iter().map(|trace| trace.records.len()).sum();
        // transform, pose, state and energy of each
        assert!(recovered.messages > 4 * records as u64);
        assert_eq!((recovered.channels, recovered.metadata), (8, 3));
    }
}

#[test]
fn the_same_traces_give_the_same_bytes() {
    let write = || {
        let (plan, traces) = traces();
        let [mut mcap, mut parquet, mut jsonl] = [Vec::new(), Vec::new(), Vec::new()];
        let (encoding, compression) = (Encoding::Protobuf, Compression::Lz4);
        write_mcap(&plan, &traces, encoding, compression, &mut mcap).unwrap();
        write_parquet(&plan, &traces, &mut parquet).unwrap();
        write_jsonl(&plan, &traces, &mut jsonl).unwrap();
        (mcap, parquet, jsonl, csv(&traces))
    };
    assert_eq!(write(), write());
}

#[test]
fn a_trace_of_events_only_can_be_written() {
    let plan = flat("moreau", 2);
    let trace = replay(&plan, 0, 0, 0.0).unwrap();
    let traces = [trace];
    assert_eq!(csv(&traces).lines().count(), traces[0].records.len() + 1);
    assert_eq!(jsonl(&plan, &traces).len(), traces[0].records.len() + 2);
    assert_eq!(csv(&[]).lines().count(), 1);
}
