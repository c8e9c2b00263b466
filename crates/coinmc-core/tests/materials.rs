//! The checked-in table of materials, of which documentation is made, is that of the program.

use coinmc_core::Material;
use std::fmt::Write;
use std::path::Path;

/// A row for each number: sources hold no quotation marks, so quoting a cell takes nothing more.
fn csv() -> String {
    let mut text = "material,description,key,value,source\n".to_owned();
    for material in &Material::ALL {
        for (key, number) in material.numbers() {
            writeln!(
                text,
                "{},\"{}\",{key},{:?},\"{}\"",
                material.name, material.doc, number.value, number.source
            )
            .unwrap();
        }
    }
    text
}

#[test]
fn the_checked_in_table_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/materials.csv");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, csv()).unwrap();
    }
    let checked_in = std::fs::read_to_string(&path).unwrap();
    assert_eq!(checked_in, csv(), "UPDATE_EXPECTED=1 writes it anew");
}
