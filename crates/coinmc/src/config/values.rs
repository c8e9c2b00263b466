//! From the checked config to the values that scenes, launches and engines read.

use super::at::{At, Fault};
use super::checked::{COMPONENTS, Checked, CheckedValue};
use coinmc_core::schema::{ReadError, Value, Values};

/// Reads what a table describes at a point.
pub(super) fn read<T>(
    checked: &Checked,
    at: &At<'_>,
    reader: impl FnOnce(&Values) -> Result<T, ReadError>,
) -> Result<T, Fault> {
    reader(&values(checked, at)?).map_err(|error| fault(checked, at, &error))
}

/// The same, with all that is wrong in the table and not just what the reader meets first: a key that
/// it blames counts as absent from then on. What is described without such keys serves to look for
/// problems elsewhere.
pub(super) fn read_on<T>(
    checked: &Checked,
    at: &At<'_>,
    faults: &mut Vec<Fault>,
    reader: impl Fn(&Values) -> Result<T, ReadError>,
) -> Option<T> {
    let mut values = values(checked, at)
        .map_err(|fault| faults.push(fault))
        .ok()?;
    let mut whole = true;
    loop {
        let error = match reader(&values) {
            Ok(read) => return Some(read),
            Err(error) => error,
        };
        if whole || !error.is_mismatch() {
            faults.push(fault(checked, at, &error));
        }
        whole = false;
        let mut path = error.path();
        let (key, None) = (path.next()?, path.next()) else {
            return None;
        };
        values.get(key)?;
        values = values.without(key);
    }
}

/// What a reader found wrong.
fn fault(checked: &Checked, at: &At<'_>, error: &ReadError) -> Fault {
    if error.is_mismatch() && !at.sound {
        // a rule of the table is violated, which has been reported
        return Fault::Reported;
    }
    let blamed = find(checked, error.path());
    Fault::problem(blamed.span, error.to_string(), error.help())
}

/// The value under a path of keys, or the last one on the way that exists.
fn find(mut checked: &Checked, path: impl Iterator<Item = &'static str>) -> &Checked {
    for key in path {
        let Some(inner) = step(untagged(checked), key) else {
            return checked;
        };
        checked = inner;
    }
    untagged(checked)
}

fn step<'f>(checked: &'f Checked, key: &str) -> Option<&'f Checked> {
    match &checked.value {
        CheckedValue::Vector(components) => {
            let index = COMPONENTS.iter().position(|name| *name == key)?;
            components.get(index)
        }
        _ => checked.get(key),
    }
}

/// The value itself, without the tags that name the alternative.
fn untagged(mut checked: &Checked) -> &Checked {
    while let CheckedValue::Tagged(_, inner) = &checked.value {
        checked = inner;
    }
    checked
}

/// The values of a table at a point.
fn values(checked: &Checked, at: &At<'_>) -> Result<Values, Fault> {
    match value(checked, at)? {
        Value::Table(values) => Ok(values),
        _ => Err(Fault::Reported),
    }
}

fn value(checked: &Checked, at: &At<'_>) -> Result<Value, Fault> {
    Ok(match &checked.value {
        CheckedValue::Invalid => return Err(Fault::Reported),
        CheckedValue::Number(..) => Value::Number(at.number(checked)?),
        CheckedValue::Real(number) => Value::Number(*number),
        CheckedValue::Reals(numbers) => Value::Numbers(numbers.clone()),
        CheckedValue::Integer(number) => Value::Integer(*number),
        CheckedValue::Boolean(holds) => Value::Boolean(*holds),
        CheckedValue::Word(word) => Value::Word(word),
        CheckedValue::Texts(texts) => Value::Texts(texts.clone()),
        CheckedValue::Vector(components) => {
            let components = components.iter().map(|component| value(component, at));
            Value::Vector(components.collect::<Result<_, _>>()?)
        }
        CheckedValue::Table(entries) => {
            let entries = entries
                .iter()
                .map(|(key, checked)| Ok((*key, value(checked, at)?)));
            Value::Table(Values::new(entries.collect::<Result<_, _>>()?))
        }
        CheckedValue::Tagged(tag, inner) => Value::Tagged(tag, Box::new(value(inner, at)?)),
    })
}
