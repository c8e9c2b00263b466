//! A table as a Parquet file.

use crate::arrow_schema;
use crate::cell::{Cell, Field, Kind};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};
use std::fmt::Display;
use std::io::{self, Write};
use std::sync::Arc;

/// What a file says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct About {
    program: String,
    entries: Vec<(String, String)>,
    in_schema: bool,
}

impl About {
    /// Says which program writes it, with its version, and no more.
    pub fn by(program: impl Into<String>) -> Self {
        Self {
            program: program.into(),
            entries: Vec::new(),
            in_schema: false,
        }
    }

    /// Says that this version of coinmc writes it.
    pub fn coinmc(version: &str) -> Self {
        Self::by(format!("coinmc {version}"))
    }

    /// Also says this in the file's metadata, under keys that begin with `coinmc.`.
    #[must_use]
    pub fn with_entries<K: Display>(
        mut self,
        entries: impl IntoIterator<Item = (K, String)>,
    ) -> Self {
        let entries = entries.into_iter();
        let entries = entries.map(|(key, value)| (format!("coinmc.{key}"), value));
        self.entries.extend(entries);
        self
    }

    /// Also says it in Arrow's schema, for those who read no metadata of files.
    #[must_use]
    pub fn in_schema(self) -> Self {
        Self {
            in_schema: true,
            ..self
        }
    }
}

/// A table that is written to a Parquet file. The same cells give the same bytes.
pub struct ParquetTable<'a> {
    writer: SerializedFileWriter<&'a mut (dyn Write + Send)>,
    fields: Vec<Field>,
}

impl<'a> ParquetTable<'a> {
    /// Begins a file.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(
        fields: Vec<Field>,
        about: About,
        out: &'a mut (dyn Write + Send),
    ) -> io::Result<Self> {
        let in_schema = if about.in_schema {
            &about.entries[..]
        } else {
            &[]
        };
        let of_arrow = arrow_schema::encoded(&fields, in_schema);
        let of_arrow = KeyValue::new(ARROW_SCHEMA.to_owned(), of_arrow);
        let entries = about.entries.into_iter();
        let entries = entries.map(|(key, value)| KeyValue::new(key, value));
        // no two samples are alike
        let singles = fields.iter().filter(|field| field.kind == Kind::Single);
        let properties = singles
            .fold(WriterProperties::builder(), |properties, field| {
                properties.set_column_dictionary_enabled(field.name.as_str().into(), false)
            })
            .set_created_by(about.program)
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(entries.chain([of_arrow]).collect()))
            .build();
        let schema = schema(&fields).map_err(io_error)?;
        let writer = SerializedFileWriter::new(out, schema, Arc::new(properties));
        Ok(Self {
            writer: writer.map_err(io_error)?,
            fields,
        })
    }

    /// Writes rows as a group of their own. `cell` is the cell of a row in the column with this index.
    ///
    /// # Errors
    /// Those of the file; [`InvalidInput`](io::ErrorKind::InvalidInput) where a cell is missing, or of another kind
    /// than its column's, and may not be.
    pub fn write_group<'c, R>(
        &mut self,
        rows: &(impl Iterator<Item = R> + Clone),
        cell: impl Fn(R, usize) -> Cell<'c>,
    ) -> io::Result<()> {
        let mut group = self.writer.next_row_group().map_err(io_error)?;
        for (index, field) in self.fields.iter().enumerate() {
            let column = group.next_column().map_err(io_error)?;
            let column = column.ok_or_else(|| io::Error::other("a column too many"))?;
            write_cells(column, field, rows.clone().map(|row| cell(row, index)))?;
        }
        group.close().map(drop).map_err(io_error)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(self) -> io::Result<()> {
        self.writer.close().map(drop).map_err(io_error)
    }
}

/// The key under which Arrow's readers look for its schema.
const ARROW_SCHEMA: &str = "ARROW:schema";

/// Parquet's own schema.
fn schema(fields: &[Field]) -> Result<TypePtr, ParquetError> {
    let column = |field: &Field| {
        let (physical, logical) = match field.kind {
            Kind::Count => (Physical::INT64, Some(LogicalType::integer(64, false))),
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Single => (Physical::FLOAT, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Kind::Flag => (Physical::BOOLEAN, None),
        };
        let repetition = if field.optional {
            Repetition::OPTIONAL
        } else {
            Repetition::REQUIRED
        };
        let column = Type::primitive_type_builder(&field.name, physical)
            .with_logical_type(logical)
            .with_repetition(repetition);
        column.build().map(Arc::new)
    };
    let columns = fields.iter().map(column).collect::<Result<_, _>>()?;
    let root = Type::group_type_builder("arrow_schema").with_fields(columns);
    root.build().map(Arc::new)
}

/// Writes the cells of a column.
fn write_cells<'c>(
    column: SerializedColumnWriter<'_>,
    field: &Field,
    cells: impl Iterator<Item = Cell<'c>>,
) -> io::Result<()> {
    match field.kind {
        // Parquet's unsigned numbers are signed ones with the same bits
        Kind::Count => write_values::<Int64Type>(column, field, cells, |cell| match cell {
            Cell::Count(count) => Some(count.cast_signed()),
            _ => None,
        }),
        Kind::Number => write_values::<DoubleType>(column, field, cells, number),
        Kind::Single => {
            #[allow(clippy::cast_possible_truncation)] // it is asked for
            let single = |cell| number(cell).map(|number| number as f32);
            write_values::<FloatType>(column, field, cells, single)
        }
        Kind::Text => write_values::<ByteArrayType>(column, field, cells, |cell| match cell {
            Cell::Text(text) => Some(ByteArray::from(text)),
            _ => None,
        }),
        Kind::Flag => write_values::<BoolType>(column, field, cells, |cell| match cell {
            Cell::Flag(flag) => Some(flag),
            _ => None,
        }),
    }
}

fn number(cell: Cell<'_>) -> Option<f64> {
    match cell {
        Cell::Number(number) => Some(number),
        _ => None,
    }
}

fn write_values<'c, T: DataType>(
    mut column: SerializedColumnWriter<'_>,
    field: &Field,
    cells: impl Iterator<Item = Cell<'c>>,
    value: impl Fn(Cell<'c>) -> Option<T::T>,
) -> io::Result<()> {
    let (mut values, mut present) = (Vec::new(), Vec::new());
    for cell in cells {
        let value = value(cell);
        present.push(i16::from(value.is_some()));
        values.extend(value);
    }
    if !field.optional && values.len() < present.len() {
        let told = format!("a cell of `{}` is missing or of another kind", field.name);
        return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
    }
    let levels = field.optional.then_some(&present[..]);
    let typed = column.typed::<T>();
    typed.write_batch(&values, levels, None).map_err(io_error)?;
    column.close().map_err(io_error)
}

/// An error of the Parquet writer; a system error keeps its kind, so that callers recognise a full disk.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytes::Bytes;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field as Read;

    /// A column of each kind.
    fn fields() -> Vec<Field> {
        vec![
            Field::new("count", Kind::Count, "1", "How many."),
            Field::new("length_m", Kind::Number, "m", "How long."),
            Field::new("sample", Kind::Single, "1", ""),
            Field::new("name", Kind::Text, "", "What it is called.").with_optional(true),
            Field::new("known", Kind::Flag, "", ""),
        ]
    }

    type Row = (u64, Option<f64>, f64, Option<&'static str>, bool);

    const ROWS: [Row; 3] = [
        (u64::MAX, Some(0.1), 0.1, Some("Bär, \"1\""), true),
        (0, None, -0.5, None, false),
        (1 << 63, Some(-0.0), 1e-3, Some(""), true),
    ];

    fn cell(row: &Row, column: usize) -> Cell<'static> {
        match column {
            0 => Cell::Count(row.0),
            1 => row.1.map_or(Cell::Missing, Cell::Number),
            2 => Cell::Number(row.2),
            3 => row.3.map_or(Cell::Missing, Cell::Text),
            _ => Cell::Flag(row.4),
        }
    }

    fn write(fields: Vec<Field>, about: About, out: &mut (dyn Write + Send)) -> io::Result<()> {
        let mut table = ParquetTable::new(fields, about, out)?;
        table.write_group(&ROWS[..2].iter(), cell)?;
        table.write_group(&ROWS[2..].iter(), cell)?;
        table.finish()
    }

    #[test]
    fn what_is_written_is_read() {
        let about = About::coinmc("1.2").with_entries([("plan", "p".to_owned())]);
        let mut file = Vec::new();
        write(fields(), about, &mut file).unwrap();
        let reader = SerializedFileReader::new(Bytes::from(file)).unwrap();
        let metadata = reader.metadata().file_metadata();
        assert_eq!(metadata.created_by(), Some("coinmc 1.2"));
        let entries = metadata.key_value_metadata().unwrap();
        let entry = |key| entries.iter().find(|entry| entry.key == key).unwrap();
        assert_eq!(entry("coinmc.plan").value.as_deref(), Some("p"));
        assert!(entry("ARROW:schema").value.is_some());
        assert_eq!(reader.num_row_groups(), 2);
        let rows = reader.get_row_iter(None).unwrap();
        let rows: Vec<_> = rows.map(|row| row.unwrap().into_columns()).collect();
        assert_eq!(rows.len(), ROWS.len());
        for (read, (count, length, sample, name, known)) in rows.into_iter().zip(ROWS) {
            #[allow(clippy::cast_possible_truncation)]
            let expected = [
                ("count", Read::ULong(count)),
                ("length_m", length.map_or(Read::Null, Read::Double)),
                ("sample", Read::Float(sample as f32)),
                (
                    "name",
                    name.map_or(Read::Null, |name| Read::Str(name.into())),
                ),
                ("known", Read::Bool(known)),
            ];
            let expected = expected.map(|(name, cell)| (name.to_owned(), cell));
            assert_eq!(read, expected);
        }
    }

    #[test]
    fn a_cell_that_must_not_be_missing_is_refused() {
        let mut fields = fields();
        fields[3].optional = false;
        let error = write(fields, About::coinmc("1"), &mut Vec::new()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        assert!(error.to_string().contains("`name`"), "{error}");
    }

    /// A disk that takes so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let left = self.0.checked_sub(bytes.len());
            self.0 = left.ok_or(io::ErrorKind::StorageFull)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_told_as_such() {
        let mut whole = Vec::new();
        write(fields(), About::coinmc("1"), &mut whole).unwrap();
        for room in 0..whole.len() {
            let error = write(fields(), About::coinmc("1"), &mut Disk(room)).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{room}: {error}");
        }
        write(fields(), About::coinmc("1"), &mut Disk(whole.len())).unwrap();
    }
}
