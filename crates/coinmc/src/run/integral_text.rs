//! The result of one integrated point: a few lines of text with a checksum. See
//! docs/reference/formats.md.

use super::damage::Damage;
use super::sealed::{seal, unseal};
use coinmc_core::Face;
use coinmc_quadrature::{Integral, MAX_EVALUATIONS, MIN_EVALUATIONS, Method, Share};
use std::fmt::Write;

/// Version of the format.
const FORMAT: u64 = 1;
const TITLE: &str = "coinmc integral";
/// The kinds of interval: Student's, and exact.
const KINDS: [&str; 2] = ["student-t", "exact"];

/// The text.
pub(super) fn encode(point: usize, integral: &Integral, plan_hash: &str) -> String {
    let mut text = format!(
        "{TITLE} {FORMAT}\nplan {plan_hash}\npoint {point}\nmethod {}\nevaluations {}\ninterval {}\n",
        integral.method.name(),
        integral.evaluations,
        KINDS[usize::from(integral.exact)],
    );
    for (face, Share { p, lo, hi }) in Face::ALL.iter().zip(&integral.faces) {
        // the shortest decimals that read back to the same bits
        writeln!(text, "{} {p:?} {lo:?} {hi:?}", face.name()).expect("a String takes all text");
    }
    seal(text)
}

/// Reads the text of a point that the plan integrates by `method`. Any bytes other than those that
/// [`encode`] would write are rejected.
pub(super) fn decode(
    bytes: &[u8],
    point: usize,
    method: Method,
    plan_hash: &str,
) -> Result<Integral, Damage> {
    let mut lines = unseal(bytes)?.lines();
    let mut value = |key: &str| {
        let line = lines.next().and_then(|line| line.strip_prefix(key));
        line.and_then(|line| line.strip_prefix(' '))
            .ok_or(Damage::Form)
    };
    if value(TITLE)? != FORMAT.to_string() {
        return Err(Damage::Version);
    }
    if value("plan")? != plan_hash {
        return Err(Damage::OtherPlan);
    }
    if value("point")? != point.to_string() || value("method")? != method.name() {
        return Err(Damage::OtherChunk);
    }
    let evaluations = value("evaluations")?.parse().map_err(|_| Damage::Form)?;
    let exact = value("interval")? == KINDS[1];
    let mut faces = [Share {
        p: 0.0,
        lo: 0.0,
        hi: 0.0,
    }; 3];
    for (share, face) in faces.iter_mut().zip(Face::ALL) {
        *share = numbers(value(face.name())?).ok_or(Damage::Form)?;
    }
    let integral = Integral {
        method,
        faces,
        evaluations,
        exact,
    };
    if !is_possible(&integral) {
        return Err(Damage::Counts);
    }
    if encode(point, &integral, plan_hash).as_bytes() == bytes {
        Ok(integral)
    } else {
        Err(Damage::Form)
    }
}

/// "p lo hi".
fn numbers(text: &str) -> Option<Share> {
    let mut numbers = text.split(' ').map(str::parse);
    let mut next = || numbers.next()?.ok();
    Some(Share {
        p: next()?,
        lo: next()?,
        hi: next()?,
    })
}

/// Whether an integration can have this result; in particular, some face must show.
fn is_possible(integral: &Integral) -> bool {
    let in_order = |share: &Share| 0.0 <= share.lo && share.lo <= share.p && share.p <= share.hi;
    let sum = |end: fn(&Share) -> f64| integral.faces.iter().map(end).sum::<f64>();
    let evaluations = integral.evaluations;
    let counted = if integral.exact {
        evaluations == 1
    } else {
        evaluations.is_power_of_two() && (MIN_EVALUATIONS..=MAX_EVALUATIONS).contains(&evaluations)
    };
    let exact = |share: &Share| !integral.exact || share.lo == share.p;
    counted
        && integral.faces.iter().all(exact)
        && integral
            .faces
            .iter()
            .all(|share| in_order(share) && share.hi <= 1.0)
        && sum(|share| share.p) <= 1.0 + 1e-9
        && sum(|share| share.hi) >= 1.0 - 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::sealed::MAX_BYTES;
    use coinmc_quadrature::Variable;

    const HASH: &str = "0123456789abcdef";
    const METHOD: Method = Method::Over(Variable::Rate);

    fn example() -> Integral {
        let share = |p: f64| Share {
            p,
            lo: p - 1e-5,
            hi: p + 1.3e-5,
        };
        Integral {
            method: METHOD,
            faces: [share(0.1 + 0.2), share(0.434), share(0.266)],
            evaluations: 4096,
            exact: false,
        }
    }

    #[test]
    fn files_read_back_and_any_damage_is_detected() {
        let kept = |method: &Method| !matches!(method, Method::Zone | Method::Arc);
        for method in Method::ALL.into_iter().filter(kept) {
            let mut written = Integral {
                method,
                ..example()
            };
            if method == Method::Over(Variable::Height) {
                (written.exact, written.evaluations) = (true, 1);
                for share in &mut written.faces {
                    (share.lo, share.hi) = (share.p, share.p);
                }
                written.faces[2].hi = 0.267;
            }
            let text = encode(7, &written, HASH);
            assert!(text.len() <= MAX_BYTES);
            assert_eq!(decode(text.as_bytes(), 7, method, HASH), Ok(written));
            for place in 0..text.len() {
                let mut flipped = text.clone().into_bytes();
                flipped[place] ^= 1;
                assert!(decode(&flipped, 7, method, HASH).is_err(), "{place}");
                assert!(decode(&text.as_bytes()[..place], 7, method, HASH).is_err());
            }
        }
    }

    #[test]
    fn an_exact_result_adds_up_to_one() {
        let exact = |p| Share { p, lo: p, hi: p };
        let mut written = Integral {
            faces: [0.25, 0.5, 0.25].map(exact),
            evaluations: 1,
            exact: true,
            ..example()
        };
        let read = |written: &Integral| {
            let text = encode(7, written, HASH);
            decode(text.as_bytes(), 7, METHOD, HASH)
        };
        assert_eq!(read(&written), Ok(written));
        for too_much_or_little in [0.249, 0.251] {
            written.faces[2] = exact(too_much_or_little);
            assert_eq!(read(&written), Err(Damage::Counts));
        }
    }

    #[test]
    fn foreign_files_with_a_valid_checksum_are_rejected() {
        let text = encode(7, &example(), HASH);
        let decode = |text: &str, point, hash| super::decode(text.as_bytes(), point, METHOD, hash);
        assert_eq!(decode(&text, 8, HASH), Err(Damage::OtherChunk));
        assert_eq!(decode(&text, 7, "f00"), Err(Damage::OtherPlan));
        let other = super::decode(text.as_bytes(), 7, Method::Tossed, HASH);
        assert_eq!(other, Err(Damage::OtherChunk));
        let body = unseal(text.as_bytes()).unwrap();
        for (from, to, damage) in [
            ("integral 1", "integral 2", Damage::Version),
            ("evaluations 4096", "evaluations +4096", Damage::Form),
            ("evaluations 4096", "evaluations 4194305", Damage::Counts),
            ("evaluations 4096", "evaluations 0", Damage::Counts),
            ("evaluations 4096", "evaluations 512", Damage::Counts),
            ("evaluations 4096", "evaluations 4097", Damage::Counts),
            ("interval student-t", "interval exact", Damage::Counts),
            (
                "side 0.266 0.26599 0.266013",
                "side 0.0 0.0 0.0",
                Damage::Counts,
            ),
            (
                "side 0.266 0.26599 0.266013",
                "side 0.266 0.267 0.268",
                Damage::Counts,
            ),
            (
                "side 0.266 0.26599 0.266013",
                "side 0.266 0.265 0.2659",
                Damage::Counts,
            ),
            ("side 0.266 0.26599", "side 0.266 -0.1", Damage::Counts),
            ("0.26599 0.266013", "0.26599 1.001", Damage::Counts),
            ("side 0.266", "side 0.5", Damage::Counts),
            ("side 0.266", "side NaN", Damage::Counts),
            ("side 0.266", "side 0.2660", Damage::Form),
            ("student-t", "student", Damage::Form),
            ("heads", "tails", Damage::Form),
        ] {
            let forged = seal(body.replace(from, to));
            assert_eq!(decode(&forged, 7, HASH), Err(damage), "{to}");
        }
    }
}
