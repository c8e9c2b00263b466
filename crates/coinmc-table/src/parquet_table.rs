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

    /// Also writes these entries, by key, into the metadata of the file.
    #[must_use]
    pub fn with_entries<K: Into<String>>(
        mut self,
        entries: impl IntoIterator<Item = (K, String)>,
    ) -> Self {
        let entries = entries.into_iter();
        self.entries
            .extend(entries.map(|(key, value)| (key.into(), value)));
        self
    }

    /// Also writes the entries into Arrow's schema, for readers that do not show a file's metadata.
    #[must_use]
    pub fn with_entries_in_schema(self) -> Self {
        Self {
            in_schema: true,
            ..self
        }
    }
}

/// A table that is written to a Parquet file. The same cells give the same bytes.
///
/// # Example
/// ```
/// use coinmc_table::{About, Cell, Field, Kind, ParquetTable};
///
/// let fields = vec![
///     Field::new("name", Kind::Text, "", "What it is called."),
///     Field::new("radius_m", Kind::Number, "m", "Radius of the coin."),
/// ];
/// let coins = [("euro", Some(0.01163)), ("unknown", None)];
/// let mut file = Vec::new();
/// let mut table = ParquetTable::new(fields, About::by("example 1.0"), &mut file)?;
/// table.write_group(&coins.iter(), |(name, radius), column| match column {
///     0 => Cell::Text(name),
///     _ => radius.map_or(Cell::Missing, Cell::Number),
/// })?;
/// table.finish()?;
/// assert_eq!(&file[..4], b"PAR1");
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct ParquetTable<'a> {
    writer: SerializedFileWriter<&'a mut (dyn Write + Send)>,
    fields: Vec<Field>,
}

impl<'a> ParquetTable<'a> {
    /// Begins a file.
    ///
    /// # Errors
    /// Those of `out`.
    ///
    /// # Panics
    /// If names, meanings and metadata make a schema of 2 GB.
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
        // a dictionary saves nothing where values hardly repeat
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

    /// Writes rows as a row group of their own, one column of which is held in memory at a time; nothing if there are
    /// none. `cell` is the cell of a row in the column with this index.
    ///
    /// # Errors
    /// Those of the file; [`InvalidInput`](io::ErrorKind::InvalidInput) where a cell is missing that must not be, or of
    /// another kind than its column. After an error the file cannot be finished.
    pub fn write_group<'c, R>(
        &mut self,
        rows: &(impl Iterator<Item = R> + Clone),
        cell: impl Fn(R, usize) -> Cell<'c>,
    ) -> io::Result<()> {
        if rows.clone().next().is_none() {
            return Ok(());
        }
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
        Kind::Count => write_values::<Int64Type>(column, field, cells, |cell| {
            cell.count().map(u64::cast_signed)
        }),
        Kind::Number => write_values::<DoubleType>(column, field, cells, Cell::number),
        Kind::Single => write_values::<FloatType>(column, field, cells, Cell::single),
        Kind::Text => write_values::<ByteArrayType>(column, field, cells, |cell| {
            cell.text().map(ByteArray::from)
        }),
        Kind::Flag => write_values::<BoolType>(column, field, cells, Cell::flag),
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
        if value.is_none() && !(cell == Cell::Missing && field.optional) {
            let told = format!("a cell of `{}` is {cell:?}, not of its kind", field.name);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
        }
        present.push(i16::from(value.is_some()));
        values.extend(value);
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
        let about = About::coinmc("1.2").with_entries([("coinmc.plan", "p".to_owned())]);
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
    fn cells_that_do_not_fit_their_column_are_refused() {
        let one = |field: Field, cell: Cell<'static>| {
            let mut file = Vec::new();
            let mut table = ParquetTable::new(vec![field], About::coinmc("1"), &mut file)?;
            table.write_group(&[()].iter(), |(), _| cell)
        };
        let field = |kind, optional| Field::new("it", kind, "1", "").with_optional(optional);
        for (kind, cell) in [
            (Kind::Count, Cell::Count(1)),
            (Kind::Number, Cell::Number(0.5)),
            (Kind::Single, Cell::Number(0.5)),
            (Kind::Text, Cell::Text("a")),
            (Kind::Flag, Cell::Flag(true)),
        ] {
            let other = if kind == Kind::Count {
                Cell::Flag(true)
            } else {
                Cell::Count(1)
            };
            assert!(one(field(kind, true), Cell::Missing).is_ok());
            for (optional, cell, fits) in [
                (false, cell, true),
                (false, Cell::Missing, false),
                (false, other, false),
                (true, other, false),
            ] {
                let told = one(field(kind, optional), cell);
                assert_eq!(told.is_ok(), fits, "{kind:?} {optional} {cell:?}");
                let refused = told.err().map(|error| error.kind());
                assert!(fits || refused == Some(io::ErrorKind::InvalidInput));
            }
        }
    }

    #[test]
    fn entries_stand_in_the_schema_where_that_is_asked_for() {
        let entries = vec![("plan".to_owned(), "p".to_owned())];
        let schema = |about: About| {
            let mut file = Vec::new();
            write(fields(), about.with_entries(entries.clone()), &mut file).unwrap();
            let reader = SerializedFileReader::new(Bytes::from(file)).unwrap();
            let metadata = reader.metadata().file_metadata();
            let mut found = metadata.key_value_metadata().unwrap().iter();
            let found = found.find(|entry| entry.key == ARROW_SCHEMA).unwrap();
            found.value.clone().unwrap()
        };
        let (alone, both) = (About::by("it"), About::by("it").with_entries_in_schema());
        assert_eq!(schema(alone), arrow_schema::encoded(&fields(), &[]));
        assert_eq!(schema(both), arrow_schema::encoded(&fields(), &entries));
    }

    #[test]
    fn a_table_without_rows_has_no_group() {
        let mut file = Vec::new();
        let mut table = ParquetTable::new(fields(), About::coinmc("1"), &mut file).unwrap();
        table.write_group(&ROWS[..0].iter(), cell).unwrap();
        table.finish().unwrap();
        let reader = SerializedFileReader::new(Bytes::from(file)).unwrap();
        assert_eq!(reader.num_row_groups(), 0);
        assert_eq!(reader.get_row_iter(None).unwrap().count(), 0);
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
