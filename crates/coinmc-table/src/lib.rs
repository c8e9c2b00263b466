#![doc = include_str!("../README.md")]

#[cfg(feature = "parquet")]
mod arrow_schema;
mod cell;
#[cfg(feature = "parquet")]
mod parquet_table;

pub use cell::{Cell, Field, Kind};
#[cfg(feature = "parquet")]
pub use parquet_table::{About, ParquetTable};
