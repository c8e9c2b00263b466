//! What there is to choose from.

use coinmc_core::{Marginal, Material, Preset};
use serde_json::{Map, Value, json};

pub(crate) fn about() -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "build": coinmc_build::BUILD,
        "materials": Material::ALL.iter().map(material).collect::<Vec<_>>(),
        "launches": Preset::ALL.map(launch),
    })
}

fn launch(preset: Preset) -> Value {
    let launches = preset.distribution();
    let height_m = match launches.height_m {
        Marginal::Constant(height_m) => Some(height_m),
        _ => None,
    };
    json!({
        "name": preset.name(),
        "doc": preset.source(),
        "planar": launches.is_planar(),
        "height_m": height_m,
    })
}

fn material(material: &Material) -> Value {
    let numbers = material.numbers().into_iter();
    let numbers = numbers.map(|(key, number)| (key.to_owned(), json!(number.value)));
    json!({
        "name": material.name,
        "doc": material.doc,
        "numbers": numbers.collect::<Map<_, _>>(),
    })
}
