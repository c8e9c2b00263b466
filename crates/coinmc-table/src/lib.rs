//! Tables whose columns say what they hold, in which unit.
//!
//! A [`Field`] describes a column, a [`Cell`] is a value of it. With the feature `parquet` a `ParquetTable` writes
//! them to a file, group of rows by group of rows. The file's metadata has the schema of Arrow, so that pyarrow,
//! pandas and polars find types, units and meanings.

#![cfg_attr(
    feature = "parquet",
    doc = r#"
```
use coinmc_table::{About, Cell, Field, Kind, ParquetTable};

let fields = vec![
    Field::new("name", Kind::Text, "", "What it is called."),
    Field::new("radius_m", Kind::Number, "m", "Radius of the coin."),
];
let coins = [("euro", Some(0.01163)), ("unknown", None)];
let mut file = Vec::new();
let mut table = ParquetTable::new(fields, About::by("example 1.0"), &mut file)?;
table.write_group(&coins.iter(), |(name, radius), column| match column {
    0 => Cell::Text(name),
    _ => radius.map_or(Cell::Missing, Cell::Number),
})?;
table.finish()?;
assert_eq!(&file[..4], b"PAR1");
# Ok::<(), std::io::Error>(())
```
"#
)]

#[cfg(feature = "parquet")]
mod arrow_schema;
mod cell;
#[cfg(feature = "parquet")]
mod parquet_table;

pub use cell::{Cell, Field, Kind};
#[cfg(feature = "parquet")]
pub use parquet_table::{About, ParquetTable};
