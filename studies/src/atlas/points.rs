//! The points of designs and what was tossed there, as a table.

use anyhow::{Context, ensure};
use coinmc_atlas::{Counts, Design, Place};
use coinmc_table::{About, Cell, Field, Kind, ParquetTable};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

/// Version of the table.
const FORMAT: &str = "2";

/// The column that tells which of the configs a point was tossed with.
const DESIGN: &str = "design";
/// Most rows that are read.
const MOST_ROWS: i64 = 10_000_000;

/// How a count is found.
type Count = fn(&Counts) -> u64;

/// The counts of a point.
const COUNTS: [(&str, &str, Count); 4] = [
    ("heads", "tosses that showed heads", |counts| {
        counts.faces[0]
    }),
    ("tails", "tosses that showed tails", |counts| {
        counts.faces[1]
    }),
    ("side", "tosses that showed the side", |counts| {
        counts.faces[2]
    }),
    ("undecided", "tosses that showed no face", |counts| {
        counts.undecided
    }),
];

/// Writes coins, surfaces (in single precision, as networks are fitted to them) and counts as Parquet, with the
/// configs in its metadata. The same designs give the same bytes.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_points(designs: &[Design], out: &mut (dyn Write + Send)) -> io::Result<()> {
    let of_place = Place::NAMES.map(|name| Field::new(name, Kind::Single, "", ""));
    let of_counts = COUNTS.map(|(name, doc, _)| Field::new(name, Kind::Count, "1", doc));
    let of_design = "number of its config, coinmc.config_N in the metadata";
    let of_design = Field::new(DESIGN, Kind::Count, "1", of_design);
    let fields = of_place.into_iter().chain(of_counts).chain([of_design]);

    let numbered = || designs.iter().zip(1..);
    let configs = numbered().map(|(design, number)| (config_key(number), design.config()));
    let about = [("coinmc.atlas_format".to_owned(), FORMAT)]
        .into_iter()
        .chain(configs)
        .map(|(key, value)| (key, value.to_owned()));
    let about = About::coinmc(env!("CARGO_PKG_VERSION")).with_entries(about);

    let mut table = ParquetTable::new(fields.collect(), about, out)?;
    let rows = numbered().flat_map(|(design, number)| {
        let points = design.points().iter();
        points.map(move |point| (number, point))
    });
    table.write_group(&rows, |(number, (place, counts)), column| {
        let place = place.numbers();
        match column.checked_sub(place.len()) {
            None => Cell::Number(place[column]),
            Some(count) => COUNTS
                .get(count)
                .map_or(Cell::Count(number), |(.., of)| Cell::Count(of(counts))),
        }
    })?;
    table.finish()
}

/// Reads the designs of such a table.
///
/// # Errors
/// What is missing, or why it cannot be read.
pub(super) fn read_points(path: &Path) -> anyhow::Result<Vec<Design>> {
    let reader = SerializedFileReader::new(File::open(path)?)?;
    let metadata = reader.metadata().file_metadata();
    ensure!(
        metadata.num_rows() <= MOST_ROWS,
        "more than {MOST_ROWS} rows"
    );
    let entries = metadata.key_value_metadata().cloned().unwrap_or_default();
    let entry = |key: &str| {
        let mut entries = entries.iter();
        let found = entries.find(|entry| entry.key == key);
        found.and_then(|entry| entry.value.clone())
    };
    ensure!(
        entry("coinmc.atlas_format").as_deref() == Some(FORMAT),
        "it is no table of an atlas"
    );
    let configs = (1..).map_while(|number| entry(&config_key(number)));
    let mut designs: Vec<(String, Vec<(Place, Counts)>)> =
        configs.map(|config| (config, Vec::new())).collect();
    for row in reader.get_row_iter(None)? {
        let row = Row(row?);
        let number = usize::try_from(row.count(DESIGN)?)?;
        let design = number.checked_sub(1).and_then(|i| designs.get_mut(i));
        let (_, points) = design.context("a point has no config")?;
        points.push(row.point()?);
    }
    let designs = designs.into_iter();
    Ok(designs
        .map(|(config, points)| Design::new(config, points))
        .collect::<Result<_, _>>()?)
}

/// A row of a table that is read.
struct Row(record::Row);

impl Row {
    fn point(&self) -> anyhow::Result<(Place, Counts)> {
        let mut place = [0.0; Place::NAMES.len()];
        for (number, name) in place.iter_mut().zip(Place::NAMES) {
            *number = self.single(name)?.into();
        }
        let mut counts = [0; COUNTS.len()];
        for (count, (name, ..)) in counts.iter_mut().zip(COUNTS) {
            *count = self.count(name)?;
        }
        let [heads, tails, side, undecided] = counts;
        let counts = Counts {
            faces: [heads, tails, side],
            undecided,
        };
        Ok((Place::of(place), counts))
    }

    fn count(&self, name: &str) -> anyhow::Result<u64> {
        match self.cell(name)? {
            record::Field::ULong(count) => Ok(*count),
            _ => Err(unusual(name)),
        }
    }

    fn single(&self, name: &str) -> anyhow::Result<f32> {
        match self.cell(name)? {
            record::Field::Float(number) => Ok(*number),
            _ => Err(unusual(name)),
        }
    }

    fn cell(&self, name: &str) -> anyhow::Result<&record::Field> {
        let mut cells = self.0.get_column_iter();
        let found = cells.find(|(there, _)| *there == name);
        found
            .map(|(_, cell)| cell)
            .with_context(|| format!("no column `{name}`"))
    }
}

fn unusual(name: &str) -> anyhow::Error {
    anyhow::anyhow!("a cell of `{name}` is missing or of another type than usual")
}

fn config_key(number: u64) -> String {
    format!("coinmc.config_{number}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_atlas::Launch;

    fn designs() -> Vec<Design> {
        let config = |seed: u64| {
            let design = Launch::Hand.design();
            format!("seed = {seed}\n{design}")
        };
        let point = |i: u64| {
            let place = Place::of([0.8, 0.5, 0.3, 0.01, 0.001, 0.02, 1e-3 * (1.0 + i as f64)]);
            let counts = Counts {
                faces: [10 + i, 20, 30],
                undecided: i,
            };
            (place, counts)
        };
        [(1, 3), (3, 2)]
            .map(|(seed, points)| {
                let points = (0..points).map(|i| point(i + seed)).collect();
                Design::new(config(seed), points).unwrap()
            })
            .into()
    }

    #[test]
    fn a_table_is_read_as_it_was_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("points.parquet");
        write_points(&designs(), &mut File::create_new(&path).unwrap()).unwrap();
        assert_eq!(read_points(&path).unwrap(), designs());
    }

    /// The shipped tables can be made again to the byte: what is read of them is written as it was.
    #[test]
    fn shipped_tables_are_written_to_the_byte() {
        for name in ["hand", "dropped", "rolled"] {
            let path = format!(
                "{}/../data/atlas/{name}.parquet",
                env!("CARGO_MANIFEST_DIR")
            );
            let shipped = std::fs::read(&path).unwrap();
            let mut written = Vec::new();
            write_points(&read_points(Path::new(&path)).unwrap(), &mut written).unwrap();
            assert!(written == shipped, "{name}");
        }
    }

    #[test]
    fn tables_with_other_columns_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let read = |fields: Vec<Field>, cell: &dyn Fn(usize) -> Cell<'static>| {
            let path = dir.path().join("other.parquet");
            let mut file = File::create(&path).unwrap();
            let entries = [
                ("coinmc.atlas_format", FORMAT.to_owned()),
                ("coinmc.config_1", String::new()),
            ];
            let about = About::coinmc("1").with_entries(entries);
            let mut table = ParquetTable::new(fields, about, &mut file).unwrap();
            table
                .write_group(&[()].iter(), |(), column| cell(column))
                .unwrap();
            table.finish().unwrap();
            read_points(&path).unwrap_err().to_string()
        };
        let count = |name: &str| Field::new(name, Kind::Count, "1", "");
        let told = read(vec![count("heads")], &|_| Cell::Count(1));
        assert_eq!(told, "no column `design`");
        let number = Field::new(DESIGN, Kind::Number, "1", "");
        let told = read(vec![number], &|_| Cell::Number(1.0));
        assert_eq!(
            told,
            "a cell of `design` is missing or of another type than usual"
        );
        let told = read(vec![count(DESIGN), count(Place::NAMES[0])], &|_| {
            Cell::Count(1)
        });
        assert!(
            told.contains(Place::NAMES[0]) && told.contains("another type"),
            "{told}"
        );
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("points.parquet");
        std::fs::write(&path, b"PAR1 and no more").unwrap();
        assert!(read_points(&path).is_err());
        let mut whole = Vec::new();
        write_points(&designs(), &mut whole).unwrap();
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        assert!(read_points(&path).is_err());
    }
}
