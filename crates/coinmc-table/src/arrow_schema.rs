//! The schema of Arrow, as Parquet files carry it: a message of Arrow's IPC format, in base64.
//!
//! <https://arrow.apache.org/docs/format/Columnar.html#schema-message>; tables and numbers of their fields are those of
//! `format/Schema.fbs` and `format/Message.fbs` of Apache Arrow. The `flatbuffers` crate lays them out; the code that
//! Arrow's own crate generates for them comes with all of Arrow.

use crate::cell::{Field, Kind};
use base64::Engine as _;
use flatbuffers::{
    FlatBufferBuilder, ForwardsUOffset, TableFinishedWIPOffset, UnionWIPOffset, VOffsetT, Vector,
    WIPOffset,
};

/// Where field number `index` of a table is in its layout.
const fn slot(index: VOffsetT) -> VOffsetT {
    4 + 2 * index
}

/// `MetadataVersion` 5.
const VERSION: i16 = 4;
/// `MessageHeader.Schema`.
const SCHEMA: u8 = 1;
/// What precedes every message.
const CONTINUATION: [u8; 4] = [0xff; 4];

type Builder = FlatBufferBuilder<'static>;
/// A table that is written.
type Table = WIPOffset<TableFinishedWIPOffset>;
type Tables = WIPOffset<Vector<'static, ForwardsUOffset<TableFinishedWIPOffset>>>;

/// The schema of a table, for the key `ARROW:schema` of a Parquet file.
pub(crate) fn encoded(fields: &[Field], about: &[(String, String)]) -> String {
    let mut builder = Builder::new();
    let fields: Vec<Table> = fields.iter().map(|f| field(&mut builder, f)).collect();
    let fields = builder.create_vector(&fields);
    let mut about: Vec<(&str, &str)> = about.iter().map(|(k, v)| (&**k, &**v)).collect();
    about.sort_unstable();
    let about = (!about.is_empty()).then(|| key_values(&mut builder, about));
    let start = builder.start_table();
    builder.push_slot_always(slot(1), fields);
    if let Some(about) = about {
        builder.push_slot_always(slot(2), about);
    }
    let schema = builder.end_table(start);

    let start = builder.start_table();
    builder.push_slot(slot(0), VERSION, 0);
    builder.push_slot(slot(1), SCHEMA, 0);
    builder.push_slot_always(slot(2), schema.as_union_value());
    let message = builder.end_table(start);
    builder.finish(message, None);

    let message = builder.finished_data();
    let length = u32::try_from(message.len()).expect("a schema below 4 GB");
    let framed = [&CONTINUATION, &length.to_le_bytes()[..], message].concat();
    base64::prelude::BASE64_STANDARD.encode(framed)
}

fn field(builder: &mut Builder, field: &Field) -> Table {
    let metadata: Vec<_> = field.metadata().collect();
    let metadata = (!metadata.is_empty()).then(|| key_values(builder, metadata));
    let name = builder.create_string(&field.name);
    let children = builder.create_vector::<Table>(&[]);
    let (kind, layout) = layout(builder, field.kind);
    let start = builder.start_table();
    builder.push_slot_always(slot(0), name);
    builder.push_slot(slot(2), kind, 0);
    builder.push_slot(slot(1), field.optional, false);
    builder.push_slot_always(slot(5), children);
    builder.push_slot_always(slot(3), layout);
    if let Some(metadata) = metadata {
        builder.push_slot_always(slot(6), metadata);
    }
    builder.end_table(start)
}

/// The number of a type, and the table that describes it.
fn layout(builder: &mut Builder, kind: Kind) -> (u8, WIPOffset<UnionWIPOffset>) {
    /// Members of the union `Type`.
    const INT: u8 = 2;
    const FLOATING_POINT: u8 = 3;
    const UTF8: u8 = 5;
    const BOOL: u8 = 6;
    /// Of `Precision`.
    const SINGLE: i16 = 1;
    const DOUBLE: i16 = 2;
    let start = builder.start_table();
    let number = match kind {
        Kind::Count => {
            // not signed, which is the default
            builder.push_slot(slot(0), 64_i32, 0);
            INT
        }
        Kind::Number => {
            builder.push_slot(slot(0), DOUBLE, 0);
            FLOATING_POINT
        }
        Kind::Single => {
            builder.push_slot(slot(0), SINGLE, 0);
            FLOATING_POINT
        }
        Kind::Text => UTF8,
        Kind::Flag => BOOL,
    };
    (number, builder.end_table(start).as_union_value())
}

fn key_values<'t>(
    builder: &mut Builder,
    entries: impl IntoIterator<Item = (&'t str, &'t str)>,
) -> Tables {
    let mut entry = |(key, value)| {
        let (key, value) = (builder.create_string(key), builder.create_string(value));
        let start = builder.start_table();
        builder.push_slot_always(slot(0), key);
        builder.push_slot_always(slot(1), value);
        builder.end_table(start)
    };
    let entries: Vec<Table> = entries.into_iter().map(&mut entry).collect();
    builder.create_vector(&entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A schema that pyarrow 26 reads as these fields, of these types, with this metadata:
    /// `pyarrow.ipc.read_schema(pyarrow.py_buffer(base64.b64decode(text)))`.
    const READ_BY_PYARROW: &str = concat!(
        "/////8QCAAAQAAAAAAAKAA4ADAALAAQACgAAABQAAAAAAAABBAAKAAwAAAAIAAQACgAAAAgAAABIAAAAAgAAACQAAAAEAAAAsP3/",
        "/wgAAAAMAAAAAQAAADIAAAABAAAAYgAAAMz9//8IAAAADAAAAAEAAAAxAAAAAQAAAGEAAAAFAAAAsAEAAAQBAADAAAAAQAAAAAQA",
        "AABc////EAAAABAAAAAAAAAGDAAAAMT///8AAAAABQAAAGtub3duABIAGAAUABIAEwAIAAAADAAEABIAAAAsAAAAFAAAABQAAAAA",
        "AAEFEAAAAAQABAAEAAAAAAAAAAQAAABuYW1lAAAAAAEAAAAEAAAAcP7//wgAAAAcAAAAEgAAAFdoYXQgaXQgaXMgY2FsbGVkLgAA",
        "CwAAAGRlc2NyaXB0aW9uABAAFAAQAAAADwAEAAAACAAQAAAAEAAAABQAAAAAAAADEAAAALr///8AAAEAAAAAAAYAAABzYW1wbGUA",
        "AAAAEgAaABQAEgATAAgAAAAMAAQAEgAAADgAAAAYAAAAHAAAAAAAAQMYAAAAAAAGAAgABgAGAAAAAAACAAAAAAAIAAAAbGVuZ3Ro",
        "X20AAAAAAgAAACgAAAAEAAAAPP///wgAAAAMAAAAAQAAAG0AAAAEAAAAdW5pdAAAAABc////CAAAABQAAAAJAAAASG93IGxvbmcu",
        "AAAACwAAAGRlc2NyaXB0aW9uAAAAEgAaABQAAAATAAgAAAAMAAQAEgAAADQAAAAYAAAAHAAAAAAAAAIYAAAAAAAGAAgABAAGAAAA",
        "QAAAAAAAAAAFAAAAY291bnQAAAACAAAAMAAAAAQAAADg////CAAAAAwAAAABAAAAMQAAAAQAAAB1bml0AAAAAAgADAAIAAQACAAA",
        "AAgAAAAUAAAACQAAAEhvdyBtYW55LgAAAAsAAABkZXNjcmlwdGlvbgA=",
    );

    #[test]
    fn the_schema_is_the_one_that_arrow_reads() {
        let fields = [
            Field::new("count", Kind::Count, "1", "How many."),
            Field::new("length_m", Kind::Number, "m", "How long."),
            Field::new("sample", Kind::Single, "", ""),
            Field::new("name", Kind::Text, "", "What it is called.").with_optional(true),
            Field::new("known", Kind::Flag, "", ""),
        ];
        let about = [("b", "2"), ("a", "1")].map(|(key, text)| (key.to_owned(), text.to_owned()));
        assert_eq!(encoded(&fields, &about), READ_BY_PYARROW);
    }
}
