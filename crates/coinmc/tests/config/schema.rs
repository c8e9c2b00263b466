//! The checked-in JSON Schema is the one the reader uses.

use serde_json::Value;
use std::path::Path;

fn checked_in() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema/coinmc-config.schema.json");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, coinmc::config::json_schema()).unwrap();
    }
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn the_checked_in_schema_is_up_to_date() {
    assert_eq!(
        checked_in(),
        coinmc::config::json_schema(),
        "UPDATE_EXPECTED=1 writes it anew"
    );
}

#[test]
fn the_schema_is_json_and_every_key_is_explained() {
    let schema: Value = serde_json::from_str(&coinmc::config::json_schema()).unwrap();
    assert_eq!(schema["properties"]["seed"]["maximum"], u64::MAX);
    // the ratio, or a height instead
    let coin = &schema["properties"]["coin"]["allOf"][0]["anyOf"];
    assert_eq!(coin[1]["required"], serde_json::json!(["ratio"]));
    let mut keys = 0;
    visit(&schema, &mut keys);
    assert!(keys > 60, "{keys}");
}

/// Counts the described properties; none may lack a description, no object may be open.
fn visit(schema: &Value, keys: &mut usize) {
    let conditional = schema.get("type").is_none();
    for (key, property) in schema["properties"].as_object().into_iter().flatten() {
        if !conditional {
            assert!(
                property["description"]
                    .as_str()
                    .is_some_and(|d| d.len() > 3),
                "{key}"
            );
            *keys += 1;
        }
        visit(property, keys);
    }
    if schema["type"] == "object" {
        assert_eq!(schema["additionalProperties"], false);
    }
    for list in ["anyOf", "oneOf", "allOf"] {
        schema[list]
            .as_array()
            .into_iter()
            .flatten()
            .for_each(|inner| visit(inner, keys));
    }
    if schema["items"].is_object() {
        visit(&schema["items"], keys);
    }
}
