//! Explanation of how an integrated point is computed.

use coinmc_analytic::Rule;
use coinmc_quadrature::{Method, REPLICATES};

/// What decides the face of a point that needs no tosses.
const DECIDES: &str =
    "what decides is the axis when the centre comes down to the distance of the rim";

/// What is computed, with `left` random numbers left to Sobol points.
pub(super) fn computed(method: Method, left: usize) -> String {
    let rule = |rule: Rule| {
        format!(
            "closed form {rule}, exact: P(side) = {}, x = H/R ({DECIDES}, and there it is uniform)",
            rule.formula()
        )
    };
    match (method, left) {
        (Method::Zone, _) => rule(Rule::Zone),
        (Method::Arc, _) => rule(Rule::Arc),
        (Method::Over(variable), 0) => {
            format!(
                "closed form over {}, exact ({DECIDES})",
                variable.description()
            )
        }
        (Method::Over(variable), left) => format!(
            "quadrature: {} in closed form ({DECIDES}), {} at {REPLICATES} independently scrambled \
             sets of Sobol points, with a Student interval",
            variable.description(),
            others(left)
        ),
        (Method::Tossed, 0) => "one toss: nothing is random".to_owned(),
        (Method::Tossed, left) => format!(
            "quadrature: tosses to the first contact, the {} of their launches at {REPLICATES} \
             independently scrambled sets of Sobol points, with a Student interval",
            numbers(left)
        ),
    }
}

fn others(left: usize) -> String {
    match left {
        1 => "the other random number of the launch".to_owned(),
        left => format!("the other {left} random numbers of the launch"),
    }
}

fn numbers(left: usize) -> String {
    match left {
        1 => "random number".to_owned(),
        left => format!("{left} random numbers"),
    }
}
