//! Numbers, lists and ranges.

use super::Walker;
use crate::config::checked::{Checked, CheckedValue};
use crate::config::diagnostics::quoted;
use crate::config::quantity::{Quantity, Range};
use crate::config::schema::{self, Bounds};
use crate::config::source::Span;
use crate::config::tree::{Node, Table, Value};

/// Most measured numbers under one key.
const MOST_READINGS: usize = 10_000;

impl Walker<'_> {
    /// A number that may be swept.
    pub(super) fn quantity(&mut self, bounds: Bounds, node: &Node, path: &str) -> Checked {
        let quantity = match &node.value {
            Value::List(items) => self.list(bounds, items, node.span, path),
            Value::Table(table) => self.range(bounds, table, node.span, path),
            Value::Integer(_) | Value::Float(_) => {
                self.real(bounds, node, path).map(Quantity::Constant)
            }
            _ => {
                let expected = "a number, a list of numbers or a range {from, to, steps}";
                return self.wrong_type(node, path, expected);
            }
        };
        match quantity {
            Some(quantity) => Checked::new(node.span, CheckedValue::Number(quantity, None)),
            None => Checked::invalid(node.span),
        }
    }

    /// A measured number, or several.
    pub(super) fn reals(&mut self, bounds: Bounds, node: &Node, path: &str) -> Checked {
        let items = match &node.value {
            Value::List(items) if items.is_empty() => {
                let message = format!("`{path}` is an empty list: at least one number is needed");
                self.problems.add(node.span, message);
                return Checked::invalid(node.span);
            }
            Value::List(items) => items.as_slice(),
            Value::Integer(_) | Value::Float(_) => std::slice::from_ref(node),
            _ => return self.wrong_type(node, path, "a number or a list of numbers"),
        };
        if items.len() > MOST_READINGS {
            let found = items.len();
            let message =
                format!("`{path}` holds {found} numbers, {MOST_READINGS} at most are allowed");
            self.problems.add(node.span, message);
            return Checked::invalid(node.span);
        }
        let values = items.iter().map(|item| self.real(bounds, item, path));
        // every wrong number is reported, not only the first
        match values.collect::<Vec<_>>().into_iter().collect() {
            Some(values) => Checked::new(node.span, CheckedValue::Reals(values)),
            None => Checked::invalid(node.span),
        }
    }

    /// A single number within bounds. An integer is a number too.
    pub(super) fn real(&mut self, bounds: Bounds, node: &Node, path: &str) -> Option<f64> {
        let value = match node.value {
            Value::Integer(value) => value as f64,
            Value::Float(value) => value,
            _ => {
                self.wrong_type(node, path, "a number");
                return None;
            }
        };
        if bounds.contains(value) {
            // adding zero makes a negative zero positive: two texts for one value otherwise
            return Some(value + 0.0);
        }
        let found = quoted(self.sources.text(node.span));
        let wanted = if value.is_finite() { "" } else { "finite, " };
        let message = format!("`{path}` must be {wanted}{bounds}, found {found}");
        self.problems.add(node.span, message);
        None
    }

    fn list(&mut self, bounds: Bounds, items: &[Node], span: Span, path: &str) -> Option<Quantity> {
        if items.is_empty() {
            self.problems.add(
                span,
                format!("`{path}` is an empty list: give at least one number"),
            );
            return None;
        }
        let values: Vec<Option<f64>> = items
            .iter()
            .map(|item| self.real(bounds, item, path))
            .collect();
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| {
            values[a]
                .unwrap_or(f64::NAN)
                .total_cmp(&values[b].unwrap_or(f64::NAN))
                .then(a.cmp(&b))
        });
        let mut distinct = true;
        for pair in order.windows(2) {
            if values[pair[0]].is_some() && values[pair[0]] == values[pair[1]] {
                let item = &items[pair[1]];
                let found = quoted(self.sources.text(item.span));
                let message = format!("`{path}` has the value {found} twice");
                self.problems
                    .add_with_help(item.span, message, "remove one of them");
                distinct = false;
            }
        }
        let values: Option<Vec<f64>> = values.into_iter().collect();
        match values? {
            values if !distinct || values.is_empty() => None,
            values if values.len() == 1 => Some(Quantity::Constant(values[0])),
            values => Some(Quantity::List(values)),
        }
    }

    fn range(&mut self, bounds: Bounds, table: &Table, span: Span, path: &str) -> Option<Quantity> {
        let checked = self.table(&schema::range(bounds), table, span, path);
        let real = |key: &str| match checked.get(key)?.value {
            CheckedValue::Real(value) => Some((value, checked.get(key)?.span)),
            _ => None,
        };
        let (from, to) = (real("from"), real("to"));
        let log = checked.get("scale").and_then(Checked::word)? == "log";
        let mut sound = true;
        if let (Some((from, _)), Some((to, to_span))) = (from, to)
            && from >= to
        {
            let message =
                format!("the range of `{path}` is empty: `to` must be larger than `from` ({from})");
            self.problems.add(to_span, message);
            sound = false;
        }
        if let Some((from, from_span)) = from
            && log
            && from <= 0.0
        {
            let message = format!("a logarithmic range of `{path}` must begin above 0");
            self.problems.add(from_span, message);
            sound = false;
        }
        let CheckedValue::Integer(steps) = checked.get("steps")?.value else {
            return None;
        };
        let range = Range {
            from: from?.0,
            to: to?.0,
            steps,
            log,
        };
        sound.then_some(Quantity::Range(range))
    }
}
