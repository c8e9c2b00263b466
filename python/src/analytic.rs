//! Closed forms over arrays.

use crate::errors;
use coinmc_analytic::keller::HeadsBand;
use coinmc_analytic::{Rule, keller, precession, well_depth, zone};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

/// The closed form that the tosses of an engine tend to where nothing bounces; `None` if it makes
/// none.
#[pyfunction]
pub(crate) fn no_bounce_rule(engine: &str) -> Option<&'static str> {
    coinmc::engines::no_bounce_rule(engine).map(Rule::name)
}

/// A closed form of one, two or three numbers.
#[derive(Clone, Copy)]
enum Form {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
    Side(Rule),
    Faces(Rule),
    Fair(Rule),
}

impl Form {
    /// The form with this name; for a rule, prefixed with the quantity, as in `side:arc`.
    fn named(name: &str) -> Option<Self> {
        if let Some((what, rule)) = name.split_once(':') {
            let rule: Rule = rule.parse().ok()?;
            return match what {
                "side" => Some(Self::Side(rule)),
                "heads" => Some(Self::Faces(rule)),
                "fair" => Some(Self::Fair(rule)),
                _ => None,
            };
        }
        Some(match name {
            "precession_heads" => {
                Self::Two(|x, psi| precession::thick::probabilities(x, psi).heads)
            }
            "precession_tails" => {
                Self::Two(|x, psi| precession::thick::probabilities(x, psi).tails)
            }
            "precession_side" => Self::Two(precession::thick::p_side),
            "precession_fair" => Self::Two(precession::thick::fair_ratio),
            "same_side" => Self::One(precession::thin::p_same_side),
            "other_side" => Self::One(precession::thin::p_other_side),
            "psi" => Self::One(precession::thin::psi_rad),
            "side_depth" => Self::One(well_depth::side_depth),
            "face_depth" => Self::One(well_depth::face_depth),
            "zone_area" => Self::Two(zone::area_m2),
            "half_turns" => Self::Three(keller::half_turns),
            "band_slowest" => Self::Three(|n, u, g| band(n, u, g, |band| band.slowest_rad_s)),
            "band_fastest" => Self::Three(|n, u, g| band(n, u, g, |band| band.fastest_rad_s)),
            "is_heads" => Self::One(|h| f64::from(u8::from(keller::is_heads(h)))),
            "heads_in_window" => Self::Two(keller::p_heads_in_window),
            "bias_bound" => Self::One(keller::bias_bound),
            _ => return None,
        })
    }

    fn fill(self, arguments: &[&[f64]], out: &mut [f64]) -> PyResult<()> {
        let one = |f: &dyn Fn(f64) -> f64, a: &[f64], out: &mut [f64]| {
            out.iter_mut().zip(a).for_each(|(out, a)| *out = f(*a));
        };
        match (self, arguments) {
            (Self::One(f), [a]) => one(&f, a, out),
            (Self::Side(rule), [a]) => one(&|x| rule.p_side(x), a, out),
            (Self::Faces(rule), [a]) => one(&|x| rule.probabilities(x).heads, a, out),
            (Self::Fair(rule), [a]) => one(&|p| rule.fair_ratio(p), a, out),
            (Self::Two(f), [a, b]) => {
                for ((out, a), b) in out.iter_mut().zip(*a).zip(*b) {
                    *out = f(*a, *b);
                }
            }
            (Self::Three(f), [a, b, c]) => {
                for (((out, a), b), c) in out.iter_mut().zip(*a).zip(*b).zip(*c) {
                    *out = f(*a, *b, *c);
                }
            }
            _ => return Err(errors::value("wrong number of arguments")),
        }
        Ok(())
    }
}

/// An edge of Keller's band after `turns` turns; NaN unless `turns` is a whole number.
fn band(turns: f64, speed_m_s: f64, gravity_m_s2: f64, edge: fn(HeadsBand) -> f64) -> f64 {
    if !(0.0..=f64::from(u32::MAX)).contains(&turns) || turns.trunc() != turns {
        return f64::NAN;
    }
    // exact: a whole number of 32 bits
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let turns = turns as u32;
    edge(HeadsBand::after_turns(turns, speed_m_s, gravity_m_s2))
}

/// Fills `out` with a closed form of arguments of the same length.
#[pyfunction]
pub(crate) fn closed_form(
    py: Python<'_>,
    name: &str,
    arguments: Vec<PyReadonlyArray1<'_, f64>>,
    mut out: PyReadwriteArray1<'_, f64>,
) -> PyResult<()> {
    let form = Form::named(name)
        .ok_or_else(|| errors::value(format!("no closed form is called {name}")))?;
    let out = out.as_slice_mut()?;
    let arguments = arguments
        .iter()
        .map(PyReadonlyArray1::as_slice)
        .collect::<Result<Vec<_>, _>>()?;
    if arguments.iter().any(|argument| argument.len() != out.len()) {
        return Err(errors::value("arguments must be equally long"));
    }
    py.detach(|| form.fill(&arguments, out))
}
