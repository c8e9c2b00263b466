//! Derivatives: every number of a scene changed a little.

use super::Fair;
use crate::output::FORMAT_VERSION;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, four_decimals_for, grouped, in_ascii, signed};
use coinmc_core::Face;
use coinmc_questions::sensitivity::{Sensitivity, Steps, sensitivities};
use coinmc_questions::{Interval, QuestionError, Workers};
use serde_json::{Value, json};

/// What was found.
pub(super) struct Local {
    face: Face,
    steps: Steps,
    fair: Fair,
    /// Strongest first.
    sensitivities: Vec<Sensitivity>,
}

impl Local {
    pub(super) fn find(
        face: Face,
        steps: Steps,
        fair: Fair,
        workers: &Workers<'_>,
    ) -> Result<Self, QuestionError> {
        let mut sensitivities = sensitivities(&fair.template, &steps, workers)?;
        let size = |one: &Sensitivity| one.of(face).value.abs();
        sensitivities.sort_by(|a, b| size(b).total_cmp(&size(a)));
        Ok(Self {
            face,
            steps,
            fair,
            sensitivities,
        })
    }

    pub(super) fn text(&self, style: &Style) -> String {
        let face = self.face.name();
        let mut columns = vec![
            Column::left("parameter"),
            Column::right("value"),
            Column::right(format!("dP({face})/d ln")),
            Column::left("interval"),
        ];
        if self.fair.root.is_some() {
            columns.push(Column::right("d(H/R)/d ln"));
            columns.push(Column::left("interval"));
        } else {
            columns.push(Column::right("elasticity"));
            columns.push(Column::left("interval"));
        }
        columns.push(Column::right("changed").droppable(1));
        let any_undecided = self.sensitivities.iter().any(|one| most_undecided(one) > 0);
        if any_undecided {
            columns.push(Column::right("undecided"));
        }
        let mut table = Table::new(columns);
        for one in &self.sensitivities {
            let derivative = one.of(self.face);
            let mut cells = vec![one.parameter.key.clone(), compact(one.parameter.value)];
            cells.extend(shown(derivative));
            match &self.fair.root {
                Some(root) => cells.extend(shown(one.shift(self.face, root))),
                None => cells.extend(shown(one.elasticity(self.face))),
            }
            cells.push(format!("{:.1} %", 100.0 * one.changed));
            if any_undecided {
                cells.push(grouped(most_undecided(one)));
            }
            table.push(cells);
        }
        let mut text = String::new();
        text += &self.fair.heading(self.face);
        text += &table.render(style).text;
        if any_undecided {
            text += "Undecided: tosses of one value, the more of the two; every interval holds whatever they \
                     would have shown\n";
        }
        let tosses = grouped(self.steps.tosses);
        let note = format!(
            "{tosses} tosses with either value, {} apart",
            percent(self.steps.step)
        );
        text += &format!("{}\n", style.paint(Colors::Faint, &note));
        let one_sided = self.sensitivities.iter().filter(|one| one.is_one_sided());
        for note in one_sided.map(at_an_end) {
            text += &format!("{}\n", style.paint(Colors::Faint, &note));
        }
        if style.unicode { text } else { in_ascii(&text) }
    }

    pub(super) fn document(&self) -> Value {
        let interval = |derivative: Interval| json!({ "value": derivative.value, "lo": derivative.lo, "hi": derivative.hi });
        let rows = self.sensitivities.iter().map(|one| {
            json!({
                "parameter": one.parameter.key,
                "value": one.parameter.value,
                "from": one.values[0],
                "to": one.values[1],
                "tosses": one.tosses,
                "changed": one.changed,
                "undecided_from": one.undecided[0],
                "undecided_to": one.undecided[1],
                "d_p_heads": interval(one.of(Face::Heads)),
                "d_p_tails": interval(one.of(Face::Tails)),
                "d_p_side": interval(one.of(Face::Side)),
                "elasticity": interval(one.elasticity(self.face)),
                "fair_ratio_shift": self.fair.root.as_ref().map(|root| interval(one.shift(self.face, root))),
            })
        });
        json!({
            "format_version": FORMAT_VERSION,
            "kind": "sensitivity",
            "face": self.face.name(),
            "step": self.steps.step,
            "fair_ratio": self.fair.root.as_ref().map(|root| root.value),
            "rows": rows.collect::<Vec<_>>(),
        })
    }
}

/// Undecided tosses with the value that has more of them.
fn most_undecided(one: &Sensitivity) -> u64 {
    one.undecided[0].max(one.undecided[1])
}

/// A derivative and its interval as cells.
fn shown(derivative: Interval) -> [String; 2] {
    let decimals = four_decimals_for(derivative.half_width());
    [
        signed(derivative.value, decimals),
        format!(
            "[{}, {}]",
            signed(derivative.lo, decimals),
            signed(derivative.hi, decimals)
        ),
    ]
}

/// That a parameter was moved to one side only.
fn at_an_end(one: &Sensitivity) -> String {
    let [from, to] = one.values.map(compact);
    let key = &one.parameter.key;
    format!(
        "{key}: from {from} to {to}, as its range ends there; right to the first order of the step"
    )
}

fn percent(share: f64) -> String {
    format!("{} %", compact(100.0 * share))
}
