//! Counts of faces.

use coinmc_core::schema::{
    Absent, Field, Kind, ReadError, TableKind, Values, Whole, field, fields,
};

/// The keys of the faces.
const FACES: [&str; 3] = ["heads", "tails", "side"];

/// Most tosses that may be counted.
const MOST: u64 = 1_000_000_000_000;

/// Counts of heads, tails and side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CountsGiven {
    pub(crate) faces: [u64; 3],
    /// Tosses that showed no face.
    pub(crate) lost: u64,
}

impl CountsGiven {
    pub(crate) fn schema() -> TableKind {
        let whole = Whole { low: 0, high: MOST };
        let count = |name, doc, absent| -> Field { field(name, doc, Kind::Integer(whole), absent) };
        fields(vec![
            count("heads", "Tosses that showed heads.", Absent::Required),
            count("tails", "Tosses that showed tails.", Absent::Required),
            count("side", "Tosses that ended on the side.", Absent::Required),
            count(
                "lost",
                "Tosses that showed no face, such as those that left the table.",
                Absent::Omitted,
            ),
            count(
                "tosses",
                "All tosses, as a check: the counts must add up to it.",
                Absent::Omitted,
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let optional = |key| match values.get(key) {
            Some(_) => values.integer::<u64>(key).map(Some),
            None => Ok(None),
        };
        let mut faces = [0; 3];
        for (count, key) in faces.iter_mut().zip(FACES) {
            *count = values.integer(key)?;
        }
        let [heads, tails, side] = faces;
        let lost = optional("lost")?.unwrap_or(0);
        let sum = heads + tails + side + lost;
        if let Some(tosses) = optional("tosses")?
            && tosses != sum
        {
            let without = if lost > 0 {
                format!(", {lost} lost,")
            } else {
                String::new()
            };
            let parts = format!("{heads} heads, {tails} tails and {side} on the side{without}");
            return Err(ReadError::new(format!(
                "the counts do not add up: {parts} are {sum}, not {tosses} tosses"
            ))
            .with_help("give tosses without a face as `lost`")
            .at("tosses"));
        }
        if heads + tails + side == 0 {
            return Err(ReadError::new("no toss is counted").at("side"));
        }
        Ok(Self { faces, lost })
    }
}
