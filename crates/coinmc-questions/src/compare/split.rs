//! The faces of undecided tosses with which a model agrees best with counts.
//!
//! A model that was tossed has N tosses, of which so many are undecided and could have shown any face. By how much the
//! counts k of n tosses and the model's counts M disagree is measured by the likelihood ratio of two samples,
//!
//! ```text
//! G(M) = 2 Σ [M_j ln M_j − (k_j + M_j) ln(k_j + M_j)] + const,    ∂G/∂M_j = −2 ln(1 + k_j/M_j),
//! ```
//!
//! where const depends on k and N alone. G is convex, as 1/M − 1/(k + M) ≥ 0. So it is least where no undecided
//! toss can be moved to a face of larger k_j/M_j: each is given to the face for which k_j/M_j is largest, and those
//! that receive any end with the same. With any other split the counts contradict the model more.

/// The model's counts with all undecided tosses shared out so that they agree best with the counts seen, of which
/// there is at least one.
pub(super) fn most_favourable(model: [u64; 3], undecided: u64, seen: [u64; 3]) -> [u64; 3] {
    let short = |face: usize| seen[face] as f64 / model[face] as f64;
    let mut faces: Vec<usize> = (0..3).filter(|face| seen[*face] > 0).collect();
    faces.sort_by(|a, b| short(*b).total_cmp(&short(*a)));
    // tosses of the model for each toss seen, once so many faces have received theirs
    let level = |receivers: &[usize]| {
        let sum = |counts: [u64; 3]| receivers.iter().map(|face| counts[*face]).sum::<u64>();
        (sum(model) + undecided) as f64 / sum(seen) as f64
    };
    let mut receivers = &faces[..1];
    for more in 2..=faces.len() {
        let next = faces[more - 1];
        if seen[next] as f64 * level(receivers) > model[next] as f64 {
            receivers = &faces[..more];
        }
    }
    let level = level(receivers);
    let mut shared = model;
    let mut left = undecided;
    for face in receivers {
        // at most all tosses of the model
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let target = (seen[*face] as f64 * level) as u64;
        let given = target.saturating_sub(model[*face]).min(left);
        shared[*face] += given;
        left -= given;
    }
    // what rounding left over
    shared[receivers[0]] += left;
    shared
}

#[cfg(test)]
mod tests {
    use super::*;

    /// G without its constant.
    fn disagreement(model: [u64; 3], seen: [u64; 3]) -> f64 {
        let x_ln_x = |x: u64| {
            if x == 0 {
                0.0
            } else {
                x as f64 * libm::log(x as f64)
            }
        };
        (0..3)
            .map(|face| 2.0 * (x_ln_x(model[face]) - x_ln_x(model[face] + seen[face])))
            .sum()
    }

    /// All splits of up to 60 undecided tosses.
    #[test]
    fn no_split_agrees_better() {
        for (model, undecided, seen) in [
            ([600, 620, 100], 60, [10, 10, 10]),
            ([60, 62, 30], 50, [10, 10, 10]),
            ([10, 30, 30], 40, [9, 8, 1]),
            ([10, 0, 0], 9, [0, 0, 7]),
            ([0, 0, 0], 30, [1, 2, 3]),
            ([40, 10, 10], 0, [1, 2, 3]),
        ] {
            let found = most_favourable(model, undecided, seen);
            assert_eq!(
                found.iter().sum::<u64>(),
                model.iter().sum::<u64>() + undecided
            );
            let mut least = f64::INFINITY;
            for heads in 0..=undecided {
                for tails in 0..=undecided - heads {
                    let split = [heads, tails, undecided - heads - tails];
                    let with = [0, 1, 2].map(|face| model[face] + split[face]);
                    least = least.min(disagreement(with, seen));
                }
            }
            // whole tosses are shared out to within one
            let of = disagreement(found, seen);
            assert!(
                of < least + 0.02,
                "{model:?} {undecided} {seen:?}: {found:?} {of} {least}"
            );
            assert!(found.iter().zip(model).all(|(shared, own)| *shared >= own));
        }
    }
}
