//! Results of chunks and points in a few bytes each, as a run may have a million.

use super::chunk_result::{ChunkResult, Tossed};
use crate::plan::StoppedBy;
use coinmc_core::Tally;
use coinmc_quadrature::{Integral, Method, Share};

/// A result in a few dozen bytes: counters that are not 0, in seven bits a byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Packed(Box<[u8]>);

/// What is counted of a point, or how it was integrated: all that its row is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counted {
    pub(super) tally: Tally,
    pub(super) integral: Option<Integral>,
    /// Tosses of the pilot, and the confidence of the intervals, where the point stops at targets and its
    /// pilot has ended.
    pub(super) look: Option<(u64, f64)>,
    pub(super) stopped_by: StoppedBy,
}

const TOSSED: u8 = 0;
const INTEGRATED: u8 = 1;

impl From<&ChunkResult> for Packed {
    fn from(result: &ChunkResult) -> Self {
        let mut bytes = Vec::with_capacity(48);
        match result {
            ChunkResult::Tossed(tossed) => {
                bytes.push(TOSSED);
                write_number(&mut bytes, tossed.microseconds);
                write_tally(&mut bytes, &tossed.tally);
            }
            ChunkResult::Integrated(integral) => {
                bytes.push(INTEGRATED);
                write_integral(&mut bytes, integral);
            }
        }
        Self(bytes.into())
    }
}

impl From<&Packed> for ChunkResult {
    fn from(packed: &Packed) -> Self {
        let mut bytes = Reader(&packed.0);
        if bytes.byte() == INTEGRATED {
            return Self::Integrated(bytes.integral());
        }
        let microseconds = bytes.number();
        Self::Tossed(Tossed {
            tally: bytes.tally(),
            microseconds,
        })
    }
}

impl From<&Counted> for Packed {
    fn from(counted: &Counted) -> Self {
        let mut bytes = Vec::with_capacity(48);
        bytes.push(counted.stopped_by as u8);
        bytes.push(u8::from(counted.integral.is_some()) | u8::from(counted.look.is_some()) << 1);
        if let Some(integral) = &counted.integral {
            write_integral(&mut bytes, integral);
        }
        if let Some((pilot, confidence)) = counted.look {
            write_number(&mut bytes, pilot);
            bytes.extend(confidence.to_le_bytes());
        }
        write_tally(&mut bytes, &counted.tally);
        Self(bytes.into())
    }
}

impl From<&Packed> for Counted {
    fn from(packed: &Packed) -> Self {
        let mut bytes = Reader(&packed.0);
        let stopped_by = StoppedBy::ALL[usize::from(bytes.byte())];
        let parts = bytes.byte();
        let integral = (parts & 1 > 0).then(|| bytes.integral());
        let look = (parts & 2 > 0).then(|| (bytes.number(), bytes.real()));
        Self {
            tally: bytes.tally(),
            integral,
            look,
            stopped_by,
        }
    }
}

fn write_number(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number.to_le_bytes()[0] | 0x80);
        number >>= 7;
    }
    bytes.push(number.to_le_bytes()[0]);
}

/// Which counters are not 0, and these.
fn write_tally(bytes: &mut Vec<u8>, tally: &Tally) {
    let counts = tally.to_array();
    let used = counts.iter().rev();
    let used = used.fold(0, |used, &count| used << 1 | u64::from(count > 0));
    write_number(bytes, used);
    for &count in counts.iter().filter(|&&count| count > 0) {
        write_number(bytes, count);
    }
}

fn write_integral(bytes: &mut Vec<u8>, integral: &Integral) {
    let method = Method::ALL
        .iter()
        .position(|known| *known == integral.method);
    write_number(bytes, method.map_or(0, |index| index as u64));
    write_number(bytes, integral.evaluations);
    bytes.push(u8::from(integral.exact));
    for Share { p, lo, hi } in integral.faces {
        for number in [p, lo, hi] {
            bytes.extend(number.to_le_bytes());
        }
    }
}

/// Reads what was written in this process.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().expect("what was written");
        self.0 = rest;
        *first
    }

    fn number(&mut self) -> u64 {
        let (mut number, mut shift) = (0, 0);
        loop {
            let byte = self.byte();
            number |= u64::from(byte & 0x7f) << shift;
            shift += 7;
            if byte < 0x80 {
                return number;
            }
        }
    }

    fn real(&mut self) -> f64 {
        let (number, rest) = self.0.split_first_chunk().expect("what was written");
        self.0 = rest;
        f64::from_le_bytes(*number)
    }

    fn tally(&mut self) -> Tally {
        let used = self.number();
        let mut counts = [0; Tally::COUNTERS.len()];
        for (index, count) in counts.iter_mut().enumerate() {
            if used >> index & 1 > 0 {
                *count = self.number();
            }
        }
        Tally::from_array(counts)
    }

    fn integral(&mut self) -> Integral {
        let method = Method::ALL[usize::from(self.byte())];
        let (evaluations, exact) = (self.number(), self.byte() > 0);
        let faces = [(); 3].map(|()| Share {
            p: self.real(),
            lo: self.real(),
            hi: self.real(),
        });
        Integral {
            method,
            faces,
            evaluations,
            exact,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_packed_reads_back(
            counts in prop::collection::vec(prop::sample::select(vec![0, 1, 127, 128, 1 << 40, u64::MAX]),
                Tally::COUNTERS.len()),
            microseconds in any::<u64>(),
            numbers in prop::array::uniform9(any::<f64>().prop_filter("equal to itself", |n| !n.is_nan())),
            method in prop::sample::select(Method::ALL.to_vec()),
            stopped_by in prop::sample::select(StoppedBy::ALL.to_vec()),
            look in any::<Option<(u64, bool)>>(),
            is_integrated in any::<bool>(),
        ) {
            let tally = Tally::from_array(counts.try_into().unwrap());
            let share = |i: usize| Share { p: numbers[i], lo: numbers[i + 1], hi: numbers[i + 2] };
            let integral = Integral {
                method,
                faces: [share(0), share(3), share(6)],
                evaluations: microseconds,
                exact: is_integrated,
            };
            for result in [
                ChunkResult::Tossed(Tossed { tally, microseconds }),
                ChunkResult::Integrated(integral),
            ] {
                prop_assert_eq!(ChunkResult::from(&Packed::from(&result)), result);
            }
            let counted = Counted {
                tally,
                integral: is_integrated.then_some(integral),
                look: look.map(|(pilot, _)| (pilot, 0.95)),
                stopped_by,
            };
            prop_assert_eq!(Counted::from(&Packed::from(&counted)), counted);
        }
    }
}
