//! From the checked config to the values that scenes, launches and engines read.

use super::at::{At, Fault};
use super::form::{COMPONENTS, Form, What};
use coinmc_core::schema::{ReadError, Value, Values};

/// What a table describes at a point, by a reader of its values.
pub(super) fn read<T>(
    form: &Form,
    at: &At<'_>,
    reader: impl FnOnce(&Values) -> Result<T, ReadError>,
) -> Result<T, Fault> {
    reader(&values(form, at)?).map_err(|error| {
        if error.is_mismatch() && !at.sound {
            // a rule of the table was broken, and that has been reported
            return Fault::Reported;
        }
        let blamed = find(form, error.path());
        Fault::problem(blamed.span, error.to_string(), error.help())
    })
}

/// The value under a path of keys, or the last one on the way that exists.
fn find(mut form: &Form, path: impl Iterator<Item = &'static str>) -> &Form {
    for key in path {
        let Some(inner) = step(untagged(form), key) else {
            return form;
        };
        form = inner;
    }
    untagged(form)
}

fn step<'f>(form: &'f Form, key: &str) -> Option<&'f Form> {
    match &form.what {
        What::Vector(components) => {
            let index = COMPONENTS.iter().position(|name| *name == key)?;
            components.get(index)
        }
        _ => form.get(key),
    }
}

/// The value itself, without the tags that say which alternative it is.
fn untagged(mut form: &Form) -> &Form {
    while let What::Tagged(_, inner) = &form.what {
        form = inner;
    }
    form
}

/// The values of a table at a point.
fn values(form: &Form, at: &At<'_>) -> Result<Values, Fault> {
    match value(form, at)? {
        Value::Table(values) => Ok(values),
        _ => Err(Fault::Reported),
    }
}

fn value(form: &Form, at: &At<'_>) -> Result<Value, Fault> {
    Ok(match &form.what {
        What::Invalid => return Err(Fault::Reported),
        What::Number(..) => Value::Number(at.number(form)?),
        What::Real(number) => Value::Number(*number),
        What::Integer(number) => Value::Integer(*number),
        What::Boolean(holds) => Value::Boolean(*holds),
        What::Word(word) => Value::Word(word),
        What::Vector(components) => {
            let components = components.iter().map(|component| value(component, at));
            Value::Vector(components.collect::<Result<_, _>>()?)
        }
        What::Table(entries) => {
            let entries = entries
                .iter()
                .map(|(key, form)| Ok((*key, value(form, at)?)));
            Value::Table(Values::new(entries.collect::<Result<_, _>>()?))
        }
        What::Tagged(tag, inner) => Value::Tagged(tag, Box::new(value(inner, at)?)),
    })
}
