//! Traces as Parquet, with units and the config in its metadata.

use crate::table::FORMAT;
use crate::table::{self, Row};
use crate::trace::Trace;
use coinmc::plan::Plan;
use coinmc_table::{About, Field, ParquetTable};
use serde_json::Value;
use std::io::{self, Write};

/// Writes the table of records, one row group per toss. The same traces give the same bytes.
///
/// # Errors
/// Errors of `out`.
pub fn write_parquet(
    plan: &Plan,
    traces: &[Trace],
    out: &mut (dyn Write + Send),
) -> io::Result<()> {
    let columns = table::columns();
    let fields = columns
        .iter()
        .map(|c| Field::new(c.name, c.kind, c.unit, c.doc));
    let mut table = ParquetTable::new(fields.collect(), about(plan, traces), out)?;
    for trace in traces {
        let rows: Vec<Row<'_>> = table::rows(std::slice::from_ref(trace)).collect();
        table.write_group(&rows.iter(), |row, column| columns[column].cell(row))?;
    }
    table.finish()
}

fn about(plan: &Plan, traces: &[Trace]) -> About {
    let tosses: Vec<Value> = traces.iter().map(|trace| trace.to_json(plan)).collect();
    let entries = [
        ("coinmc.trace_format", FORMAT.to_string()),
        (
            "coinmc.program_version",
            env!("CARGO_PKG_VERSION").to_owned(),
        ),
        ("coinmc.plan_hash", plan.hash()),
        ("coinmc.config", plan.resolved_toml.clone()),
        ("coinmc.tosses", Value::Array(tosses).to_string()),
    ];
    About::coinmc(env!("CARGO_PKG_VERSION")).with_entries(entries)
}
