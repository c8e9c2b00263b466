//! Remarks that are not errors: settings without effect, or with surprising effects.

use super::checked::Checked;
use crate::engines::{EngineDescriptor, EngineKind};
use crate::plan::Point;
use coinmc_core::{Landing, Surface};

/// A key of `[surface]`, and where its value is.
type Property = (&'static str, fn(&Surface) -> f64);

const PROPERTIES: [Property; 7] = [
    ("restitution", Surface::restitution),
    ("friction", Surface::friction),
    ("rolling_friction_m", Surface::rolling_friction_m),
    ("pivoting_friction_m", Surface::pivoting_friction_m),
    (
        "restitution_threshold_m_s",
        Surface::restitution_threshold_m_s,
    ),
    ("restitution_exponent", Surface::restitution_exponent),
    ("roughness_slope", |surface| {
        surface
            .roughness()
            .map_or(0.0, |roughness| roughness.slope())
    }),
];

/// What the points give reason to remark. Every point is shown to it once.
#[derive(Debug, Default)]
pub(super) struct Notes {
    engine: Option<&'static EngineDescriptor>,
    /// Properties of contacts that are given where there are none.
    in_vain: [bool; PROPERTIES.len()],
    /// Which of the engine's remarks apply.
    remarks: Vec<bool>,
}

impl Notes {
    pub(super) fn see(&mut self, point: &Point) {
        let engine = point.engine.descriptor();
        self.engine = Some(engine);
        self.remarks.resize(engine.remarks.len(), false);
        for (applies, remark) in self.remarks.iter_mut().zip(engine.remarks) {
            *applies = *applies || (remark.applies)(&point.scene);
        }
        let surface = &point.scene.surface;
        if surface.landing() == Landing::Adhesive {
            for (given, (_, value)) in self.in_vain.iter_mut().zip(&PROPERTIES) {
                *given = *given || value(surface) != 0.0;
            }
        }
    }

    /// The remarks on a config, in the order of its tables.
    pub(super) fn texts(&self, root: &Checked) -> Vec<String> {
        let mut notes = Vec::new();
        let Some(engine) = self.engine else {
            return notes;
        };
        if engine.kind == EngineKind::ClosedForm {
            for table in ["surface", "launch", "stop"] {
                if root.get(table).is_some() {
                    notes.push(format!(
                        "[{table}] changes nothing: engine.{} makes no toss",
                        engine.name
                    ));
                }
            }
            return notes;
        }
        notes.extend(self.in_vain());
        let remarks = engine.remarks.iter().zip(&self.remarks);
        let applying = remarks.filter(|(_, applies)| **applies);
        notes.extend(applying.map(|(remark, _)| remark.text.to_owned()));
        notes
    }

    /// The remark on properties of contacts if no point has contacts.
    fn in_vain(&self) -> Option<String> {
        let given = PROPERTIES.iter().zip(self.in_vain);
        let given = given.filter(|(_, given)| *given);
        let keys: Vec<String> = given
            .map(|((key, _), _)| format!("surface.{key}"))
            .collect();
        let (last, others) = keys.split_last()?;
        let (keys, change) = if others.is_empty() {
            (last.clone(), "changes")
        } else {
            (format!("{} and {last}", others.join(", ")), "change")
        };
        Some(format!(
            "{keys} {change} nothing: with landing = \"adhesive\" the first contact decides"
        ))
    }
}
