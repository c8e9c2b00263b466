//! Messages as Protocol Buffers: the fields of the JSON that serde makes of them, by their names.
//!
//! What is `null` in JSON is absent; in a list of numbers it is NaN.

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use prost_reflect::prost::Message;
use prost_reflect::{
    DescriptorPool, DynamicMessage, FieldDescriptor, Kind, MapKey, MessageDescriptor,
    Value as Field,
};
use serde_json::{Map, Value};
use std::collections::HashMap;
use thiserror::Error;

/// Why a message or a schema is not what it should be.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SchemaError {
    /// The schema is no set of file descriptors.
    #[error("its schema is no Protobuf descriptor set: {0}")]
    NoDescriptors(String),
    /// The schema does not define the message.
    #[error("its schema does not define {0}")]
    NoMessage(String),
    /// The message has a field that its schema lacks.
    #[error("{message} has no field `{field}`")]
    NoField {
        /// Name of the message.
        message: String,
        /// Name of the field.
        field: String,
    },
    /// A field is of another type than its schema says.
    #[error("`{field}` of {message} is not of the type that its schema says")]
    Type {
        /// Name of the message.
        message: String,
        /// Name of the field.
        field: String,
    },
}

/// The message of this name in a serialised `FileDescriptorSet`.
pub(crate) fn message_of(set: &[u8], name: &str) -> Result<MessageDescriptor, SchemaError> {
    let pool = DescriptorPool::decode(set)
        .map_err(|error| SchemaError::NoDescriptors(error.to_string()))?;
    pool.get_message_by_name(name)
        .ok_or_else(|| SchemaError::NoMessage(name.to_owned()))
}

/// Encodes a message that serde made JSON of.
pub(crate) fn encode(
    message: &MessageDescriptor,
    json: &Value,
    out: &mut Vec<u8>,
) -> Result<(), SchemaError> {
    let none = Map::new();
    let (maps, others): (Map<_, _>, Map<_, _>) = json
        .as_object()
        .unwrap_or(&none)
        .iter()
        .map(|(name, value)| (name.clone(), value.clone()))
        .partition(|(name, _)| message.get_field_by_name(name).is_some_and(|f| f.is_map()));
    append(&dynamic(message, &others)?, out);
    for (name, entries) in &maps {
        let field = message.get_field_by_name(name).expect("found above");
        let entries = entries.as_object().ok_or_else(|| wrong_type(&field))?;
        for (key, value) in entries {
            append(&with_entry(message, &field, key, value)?, out);
        }
    }
    Ok(())
}

fn append(message: &DynamicMessage, out: &mut Vec<u8>) {
    message.encode(out).expect("a vector grows as is needed");
}

/// The message with one entry of a map and nothing else. Parts of a message that follow one another are one
/// message; so entries keep their order, which a whole map of the library does not.
fn with_entry(
    message: &MessageDescriptor,
    field: &FieldDescriptor,
    key: &str,
    value: &Value,
) -> Result<DynamicMessage, SchemaError> {
    let Kind::Message(entry) = field.kind() else {
        return Err(wrong_type(field));
    };
    let value = one(&entry.map_entry_value_field(), value)?;
    let map = HashMap::from([(MapKey::String(key.to_owned()), value)]);
    let mut part = DynamicMessage::new(message.clone());
    part.set_field(field, Field::Map(map));
    Ok(part)
}

fn dynamic(
    message: &MessageDescriptor,
    json: &Map<String, Value>,
) -> Result<DynamicMessage, SchemaError> {
    if is_time(message) {
        return Ok(time(message, json));
    }
    let mut fields = DynamicMessage::new(message.clone());
    for (name, value) in json.iter().filter(|(_, value)| !value.is_null()) {
        let field = message
            .get_field_by_name(name)
            .ok_or_else(|| SchemaError::NoField {
                message: message.full_name().to_owned(),
                field: name.clone(),
            })?;
        fields.set_field(&field, whole(&field, value)?);
    }
    Ok(fields)
}

fn is_time(message: &MessageDescriptor) -> bool {
    matches!(
        message.full_name(),
        "google.protobuf.Timestamp" | "google.protobuf.Duration"
    )
}

/// Protobuf's names of the parts of a time are longer than those of Foxglove's JSON.
fn time(message: &MessageDescriptor, json: &Map<String, Value>) -> DynamicMessage {
    let part = |name| json.get(name).and_then(Value::as_i64).unwrap_or(0);
    let mut fields = DynamicMessage::new(message.clone());
    fields.set_field_by_name("seconds", Field::I64(part("sec")));
    // below 1e9
    let nanos = i32::try_from(part("nsec")).unwrap_or(0);
    fields.set_field_by_name("nanos", Field::I32(nanos));
    fields
}

/// The value of a whole field: one, or a list. (Maps are for whole messages, not within others.)
fn whole(field: &FieldDescriptor, json: &Value) -> Result<Field, SchemaError> {
    let wrong = || wrong_type(field);
    if field.is_map() {
        return Err(wrong());
    }
    if field.is_list() {
        let items = json.as_array().ok_or_else(wrong)?.iter();
        let items = items.map(|item| one(field, item));
        return Ok(Field::List(items.collect::<Result<_, _>>()?));
    }
    one(field, json)
}

fn one(field: &FieldDescriptor, json: &Value) -> Result<Field, SchemaError> {
    let value = match field.kind() {
        Kind::Double if json.is_null() => Some(Field::F64(f64::NAN)),
        Kind::Double => json.as_f64().map(Field::F64),
        Kind::Bool => json.as_bool().map(Field::Bool),
        Kind::Int32 | Kind::Sint32 | Kind::Sfixed32 => json
            .as_i64()
            .and_then(|n| n.try_into().ok())
            .map(Field::I32),
        Kind::Int64 | Kind::Sint64 | Kind::Sfixed64 => json.as_i64().map(Field::I64),
        Kind::Uint32 | Kind::Fixed32 => json
            .as_u64()
            .and_then(|n| n.try_into().ok())
            .map(Field::U32),
        Kind::Uint64 | Kind::Fixed64 => json.as_u64().map(Field::U64),
        Kind::Enum(_) => {
            let number = json.as_i64().and_then(|n| n.try_into().ok());
            number.map(Field::EnumNumber)
        }
        Kind::Bytes => {
            let bytes = json.as_str().and_then(|text| BASE64.decode(text).ok());
            bytes.map(|bytes| Field::Bytes(bytes.into()))
        }
        // what has fields of its own, in a schema that does not name them, stays JSON
        Kind::String => Some(Field::String(
            json.as_str()
                .map_or_else(|| json.to_string(), str::to_owned),
        )),
        Kind::Message(message) => {
            let fields = json.as_object().ok_or_else(|| wrong_type(field))?;
            Some(Field::Message(dynamic(&message, fields)?))
        }
        Kind::Float => None,
    };
    value.ok_or_else(|| wrong_type(field))
}

fn wrong_type(field: &FieldDescriptor) -> SchemaError {
    SchemaError::Type {
        message: field.parent_message().full_name().to_owned(),
        field: field.name().to_owned(),
    }
}
