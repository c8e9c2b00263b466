//! Error messages for tosses that cannot be traced.

use crate::plans::flat;
use coinmc_trace::{Query, TraceError, replay, search};

#[test]
fn points_and_tosses_that_do_not_exist() {
    let plan = flat("moreau", 10);
    let error = replay(&plan, 2, 0, 0.0).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("there is no point 2: this config has 2"),
        "{error}"
    );
    let error = replay(&plan, 1, 10, 0.0).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("there is no toss 10: this config has 10"),
        "{error}"
    );
    assert!(replay(&plan, 1, 9, 0.0).is_ok());
    assert!(replay(&plan, 0, u64::MAX, 0.0).is_err());
}

#[test]
fn a_closed_form_has_no_traces() {
    let plan = coinmc::config::parse("test", "coin.ratio = 1\nengine.analytic.rule = 'arc'", &[]);
    let error = replay(&plan.clone().unwrap(), 0, 0, 0.0).unwrap_err();
    assert!(
        matches!(
            error,
            TraceError::NoTraces {
                engine: "analytic",
                ..
            }
        ),
        "{error}"
    );
    let query = Query {
        points: &[0],
        conditions: &[],
        longest: None,
        count: 1,
        limit: 10,
    };
    assert!(matches!(
        search(&plan.unwrap(), &query, |_| true),
        Err(TraceError::NoTraces { .. })
    ));
}

#[test]
fn invalid_sampling_rates() {
    let plan = flat("moreau", 10);
    for rate in [-1.0, f64::NAN, f64::INFINITY, 2e9] {
        assert!(matches!(
            replay(&plan, 0, 0, rate),
            Err(TraceError::Rate(_))
        ));
    }
}
