//! Fits to synthetic film: how often the intervals hold the truth.
//!
//! Every case is one drop with its own restitution, friction and first state, filmed at 240 frames
//! a second with 0.5 mm and 0.5° of noise, and fitted as `coinmc film fit` does by default.

use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Coin, Estimate, IntervalMethod, Philox4x64, unit_interval};
use coinmc_film::{Estimated, Fit, Law, Model, Options, Parameter, Shared, Synthetic, fit};
use std::f64::consts::TAU;

/// Second word of the key of the cases.
const CASES: u64 = 99;
const RATIO: f64 = 1.0;
const RADIUS_M: f64 = 0.01;
const STATES: [&str; 6] = ["x_m", "vx_m_s", "z_m", "vz_m_s", "theta_rad", "omega_rad_s"];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Film {
    /// Drops
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    cases: u64,

    /// Bounces that count
    #[arg(long, default_value_t = 2)]
    bounces: usize,
}

/// A case and what came of it: the fit, or `None` where there is none.
struct Tried {
    truth: Synthetic,
    fit: Option<Fit>,
}

impl Film {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let first = seed.saturating_sub(1).saturating_mul(1_000_000);
        let numbers: Vec<u64> = (1..=self.cases).map(|case| first + case).collect();
        let options = Options {
            bounces: self.bounces,
            ..Options::default()
        };
        let tried = survey(&numbers, |number| one(*number, &options));
        let title = format!(
            "Share of {} drops whose 95 % interval holds the truth (95 % intervals)",
            self.cases
        );
        let columns = ["parameter", "fits", "open", "held", "share", "lo", "hi"];
        let mut table = Table::new(title, &columns);
        for parameter in [Parameter::Restitution, Parameter::Friction] {
            table.push(shared_row(parameter, &tried));
        }
        for (place, name) in STATES.into_iter().enumerate() {
            table.push(state_row(place, name, &tried));
        }
        let mut report = Report::new(table);
        let failed = tried.iter().filter(|tried| tried.fit.is_none()).count();
        report.remark(format!(
            "{failed} drops without a fit, which count as not held"
        ));
        report
    }
}

/// Restitution 0.3 to 0.8, friction 0.05 to 0.4, 10 to 30 cm high, any angle, up to 15 rad/s and
/// 20 cm/s either way.
fn one(number: u64, options: &Options) -> Tried {
    let philox = Philox4x64::new([number, CASES]);
    let between = |i: u64, from: f64, to: f64| {
        from + (to - from) * unit_interval(philox.block([i, 0, 0, 0])[0])
    };
    let truth = Synthetic {
        seed: number,
        shared: Shared {
            restitution: between(4, 0.3, 0.8),
            friction: between(5, 0.05, 0.4),
            ..Shared::default()
        },
        start: [
            0.0,
            between(0, -0.2, 0.2),
            between(1, 0.1, 0.3),
            0.0,
            between(2, 0.0, TAU),
            between(3, -15.0, 15.0),
        ],
        ..Synthetic::default()
    };
    let coin = Coin::cylinder(RATIO, RADIUS_M).expect("a possible coin");
    let model = Model {
        law: Law::Moreau,
        coin,
        gravity_m_s2: 9.81,
    };
    let fit = truth
        .film(&model)
        .and_then(|film| fit(&model, &[film], options).ok());
    Tried { truth, fit }
}

fn shared_row(parameter: Parameter, tried: &[Tried]) -> Vec<String> {
    let estimate = |tried: &Tried| tried.fit.as_ref()?.estimate(parameter).copied();
    let open = |estimate: &Estimated| !estimate.is_determined();
    let opened = tried.iter().filter_map(estimate).filter(open).count();
    let held = tried.iter().filter(|one| {
        let truth = one.truth.shared.get(parameter);
        estimate(one).is_some_and(|estimate| {
            estimate.lo.is_none_or(|lo| lo <= truth) && estimate.hi.is_none_or(|hi| truth <= hi)
        })
    });
    row(parameter.name(), tried, opened, held.count())
}

fn state_row(place: usize, name: &str, tried: &[Tried]) -> Vec<String> {
    let held = tried.iter().filter(|one| {
        let Some(fit) = &one.fit else {
            return false;
        };
        let drop = &fit.drops[0];
        let miss = drop.start[place] - one.truth.start[place];
        // angles are the same up to whole turns
        let miss = if name == "theta_rad" {
            libm::remainder(miss, TAU)
        } else {
            miss
        };
        drop.half_width[place].is_none_or(|half_width| miss.abs() <= half_width)
    });
    row(name, tried, 0, held.count())
}

fn row(name: &str, tried: &[Tried], open: usize, held: usize) -> Vec<String> {
    let fits = tried.iter().filter(|tried| tried.fit.is_some()).count();
    let (held, n) = (held as u64, tried.len() as u64);
    let share = Estimate::new(held, 0, n, 0.95, IntervalMethod::Wilson);
    vec![
        name.to_owned(),
        fits.to_string(),
        open.to_string(),
        held.to_string(),
        number::probability(share.p),
        number::probability(share.lo),
        number::probability(share.hi),
    ]
}
