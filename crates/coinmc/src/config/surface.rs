//! Surfaces: expansion of materials, and what a surface in space has where the config does not say it.

use super::checked::{Checked, CheckedValue};
use crate::engines::EngineKind;
use coinmc_core::schema::{Value, Values};
use coinmc_core::{EngineDescriptor, Landing, Material, Surface, Unmodelled};

/// A surface spelled out, and remarks on what was taken for it.
pub(super) struct SpelledOut {
    pub(super) surface: Checked,
    pub(super) notes: Vec<String>,
}

/// The surface with its material expanded, except for numbers given in the config, and with everything
/// else that it needs on this engine.
pub(super) fn spelled_out(
    surface: &Checked,
    engine: Option<&EngineDescriptor>,
    unmodelled: &[&Unmodelled],
) -> SpelledOut {
    let mut spelled = Spelled {
        given: surface,
        taken: Vec::new(),
        notes: Vec::new(),
    };
    let landing = surface.get("landing").and_then(Checked::word);
    let adhesive = landing == Some(Landing::Adhesive.name());
    let material = surface.get("material").and_then(Checked::word);
    match material.and_then(|name| name.parse::<Material>().ok()) {
        Some(material) if adhesive => spelled.notes.push(format!(
            "surface.material = \"{}\" changes nothing: with landing = \"adhesive\" the first contact \
             decides",
            material.name
        )),
        Some(material) => spelled.expand(&material, engine, unmodelled),
        None => {}
    }
    if !adhesive && engine.is_some_and(|engine| engine.kind == EngineKind::Spatial) {
        spelled.estimate();
    }
    spelled.fill_with_zero(adhesive || material.is_some());
    spelled.finish()
}

struct Spelled<'a> {
    given: &'a Checked,
    taken: Vec<(&'static str, Value)>,
    notes: Vec<String>,
}

impl Spelled<'_> {
    /// Whether the config or a material gives this key, or one that says the same.
    fn has(&self, key: &str) -> bool {
        let has = |key| {
            self.given.get(key).is_some() || self.taken.iter().any(|(taken, _)| *taken == key)
        };
        alternatives(key).iter().any(|key| has(key)) || has(key)
    }

    /// The key of the config whose number takes the place of a material's.
    fn replacing(&self, key: &str) -> Option<&'static str> {
        let own = [key];
        let instead = match alternatives(key) {
            [] => &own,
            several => several,
        };
        let entries = match &self.given.value {
            CheckedValue::Table(entries) => entries.as_slice(),
            _ => &[],
        };
        let mut given = entries.iter().map(|(given, _)| *given);
        given.find(|given| instead.contains(given))
    }

    /// Takes the numbers of a material that are not given and that the engine models.
    fn expand(
        &mut self,
        material: &Material,
        engine: Option<&EngineDescriptor>,
        unmodelled: &[&Unmodelled],
    ) {
        let is_modelled = |key: &str| {
            // of the two numbers of a ground the slope says whether there is one
            let key = match key {
                "roughness_wavelength_m" => "roughness_slope",
                _ => key,
            };
            !unmodelled
                .iter()
                .any(|refused| refused.table == "surface" && refused.key == key)
        };
        let mut missing = Vec::new();
        for (key, number) in material.numbers() {
            if let Some(given) = self.replacing(key) {
                self.notes.push(format!(
                    "surface.{given} is given and replaces the {key} = {:?} of material = \"{}\"",
                    number.value, material.name
                ));
            } else if is_modelled(key) {
                self.taken.push((key, Value::Number(number.value)));
            } else {
                missing.push(key);
            }
        }
        if let (Some(engine), Some((last, others))) = (engine, missing.split_last()) {
            let list = if others.is_empty() {
                (*last).to_owned()
            } else {
                format!("{} and {last}", others.join(", "))
            };
            self.notes.push(format!(
                "material = \"{}\" without its {list}: engine.{} does not model them",
                material.name, engine.name
            ));
        }
    }

    /// Takes estimates for the friction lengths that neither the config nor a material gives.
    fn estimate(&mut self) {
        let estimates = Surface::estimates();
        let number = |key| estimates.number(key).unwrap_or(0.0);
        if !self.has("rolling_friction_m") {
            self.take(&estimates, "rolling_friction_m");
            self.notes.push(format!(
                "surface.rolling_friction_m is not given: taken as {:?} (estimate; 0 would let the coin \
                 roll for ever)",
                number("rolling_friction_m")
            ));
        }
        if !self.has("pivoting_friction_m") {
            self.take(&estimates, "contact_patch_m");
            self.notes.push(format!(
                "surface.pivoting_friction_m is not given: taken as (3π/16) · friction · contact_patch_m \
                 with contact_patch_m = {:?} (estimate)",
                number("contact_patch_m")
            ));
        }
    }

    fn take(&mut self, from: &Values, key: &'static str) {
        self.taken
            .extend(from.get(key).map(|value| (key, value.clone())));
    }

    /// What counts as 0 where it is absent: what nothing asks for. Restitution and friction only if
    /// they may be absent, as their absence has been reported otherwise.
    fn fill_with_zero(&mut self, all: bool) {
        let mut keys = vec!["rolling_friction_m", "pivoting_friction_m"];
        if all {
            keys.extend(["restitution", "friction"]);
        }
        for key in keys {
            if !self.has(key) {
                self.taken.push((key, Value::Number(0.0)));
            }
        }
    }

    /// The surface, its keys in the order of the schema.
    fn finish(self) -> SpelledOut {
        let Self {
            given,
            taken,
            notes,
        } = self;
        let span = given.span;
        let CheckedValue::Table(_) = given.value else {
            let surface = given.clone();
            return SpelledOut { surface, notes };
        };
        // without its material, and where that is invalid without knowing what it would have given
        let entries = Surface::schema().fields.into_iter().filter_map(|field| {
            let key = field.name;
            if key == "material" {
                return given
                    .get(key)
                    .filter(|material| material.word().is_none())
                    .map(|material| (key, material.clone()));
            }
            let of_material = || taken.iter().find(|(taken, _)| *taken == key);
            given.get(key).map_or_else(
                || of_material().map(|(_, value)| (key, Checked::of_value(span, value))),
                |checked| Some((key, checked.clone())),
            )
        });
        let surface = Checked::new(span, CheckedValue::Table(entries.collect()));
        SpelledOut { surface, notes }
    }
}

/// The keys of which a config has one at most, this one among them; none if it stands alone.
fn alternatives(key: &str) -> &'static [&'static str] {
    let mut groups = Surface::ALTERNATIVES.into_iter();
    groups.find(|group| group.contains(&key)).unwrap_or(&[])
}
