//! Short ways of writing the schema.

use super::Absent::{Is, Required};
use super::{Absent, Bounds, Fallback, Field, Kind, TableKind};

pub(super) fn field(name: &'static str, doc: &'static str, kind: Kind, absent: Absent) -> Field {
    Field {
        name,
        doc,
        kind,
        absent,
    }
}

pub(super) fn number(
    name: &'static str,
    doc: &'static str,
    bounds: Bounds,
    absent: Absent,
) -> Field {
    field(name, doc, Kind::Number(bounds), absent)
}

pub(super) fn marginal(
    name: &'static str,
    doc: &'static str,
    bounds: Bounds,
    absent: Absent,
) -> Field {
    field(name, doc, marginal_kind(bounds), absent)
}

pub(super) fn marginal_kind(bounds: Bounds) -> Kind {
    let spread = Bounds::closed(0.0, bounds.high);
    let uniform = fields(vec![
        number("from", "Lower end.", bounds, Required),
        number("to", "Upper end.", bounds, Required),
    ]);
    let normal = fields(vec![
        number("mean", "Mean.", bounds, Required),
        number("sd", "Standard deviation.", spread, Required),
    ]);
    let distributions = vec![
        table("uniform", "Uniform between two values.", uniform, Required),
        table("normal", "Normal.", normal, Required),
    ];
    Kind::Marginal(bounds, distributions)
}

pub(super) fn table(
    name: &'static str,
    doc: &'static str,
    kind: TableKind,
    absent: Absent,
) -> Field {
    field(name, doc, Kind::Table(kind), absent)
}

pub(super) fn fields(fields: Vec<Field>) -> TableKind {
    TableKind {
        fields,
        rules: vec![],
    }
}

pub(super) fn default(value: f64) -> Absent {
    Is(Fallback::Number(value))
}
