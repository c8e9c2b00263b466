//! Calibrations of synthetic coins: how often the intervals hold the truth, how much each kind of
//! measurement tells, and how noisy the likelihood is.
//!
//! Each coin has parameters drawn from the prior. What is measured on it is simulated with the errors that
//! the tables of the config state, counts by real tosses, and its true P(side) is found by many more tosses.

use crate::survey::survey;
use anyhow::Context;
use clap::Args;
use coinmc::config::Override;
use coinmc_bench::{Report, Table, number};
use coinmc_calibrate::{Kind, Model, Observations, Posterior, Prediction, Settings};
use coinmc_core::{Domain, Estimate, Face, IntervalMethod, Stream, UniformSource};
use coinmc_questions::Workers;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A thick coin on a plane; 300 of its tosses are counted.
const PLANE: &str = "
coin = { ratio = 1.2, radius_m = 0.012 }
surface = { restitution = 0.5, friction = 0.3 }
counts = { heads = 100, tails = 100, side = 100 }
";
/// A thin coin on ground as rough as wood, whose slope is then unknown, too. Sixty times it is set rolling upright
/// at .3 m/s besides.
const ROUGH: &str = r#"
coin = { ratio = 0.2, radius_m = 0.012 }
surface = { material = "wood" }

[[counts]]
heads = 100
tails = 100
side = 100

[[counts]]
heads = 20
tails = 20
side = 20
[counts.launch]
height_m = 0
velocity_m_s = [0, 0.3, 0]
orientation = { tilt_deg = { normal = { mean = 90, sd = 2 } } }
spin = { about = { axis = [1, 0, 0], rate_rad_s = -25 } }
"#;
/// The rest of the scene and the measurements; the readings stand for those of each coin.
const MEASURED: &str = r#"
prior = { material = "wood" }
launch = { preset = "hand", height_m = 0.3 }
engine.volumetric = {}
tilt = { angle_deg = [16, 17, 18] }
roll_out = { ramp_height_m = 0.01, distance_m = [2.5, 2.5, 2.5], distance_back_m = [2.5, 2.5, 2.5] }
spin_down = { from_rad_s = 40, to_rad_s = 20, time_s = 10 }
whirr = { time_s = [0, 1, 2, 3], frequency_hz = [20, 23, 29, 45] }
bounces = { drop_height_m = 0.1, time_s = [0, 0.143, 0.214] }
"#;

/// Coins for each kind of measurement alone, and seeds of the likelihood.
const ALONE: usize = 60;
const SEEDS: u64 = 8;
/// Draws of the posterior of one coin, and those at which the likelihood is compared.
const DRAWS: u64 = 2000;
const COMPARED: usize = 500;
/// 95 % of a normal distribution.
const Z95: f64 = 1.96;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Calibrate {
    /// Synthetic coins
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    coins: u64,

    /// Tosses that find the true P(side) of each
    #[arg(long, value_parser = number::count, default_value = "8192", value_name = "N")]
    truth: u64,

    /// Surfaces of the design
    #[arg(long, value_parser = number::count, default_value = "1024", value_name = "N")]
    points: u64,

    /// Tosses on each
    #[arg(long, value_parser = number::count, default_value = "256", value_name = "N")]
    tosses: u64,

    /// Tosses of the prediction for each coin, which takes most of the time
    #[arg(long, value_parser = number::count, default_value = "32768", value_name = "N")]
    predicted: u64,

    /// A coin of H/R = 0.2 that also rolls, on ground as rough as wood, in place of one of 1.2 on a plane
    #[arg(long)]
    rough: bool,
}

/// A coin whose truth is known.
struct Coin {
    truth: Vec<f64>,
    side: f64,
    /// Of each of the counts.
    counts: Vec<[u64; 3]>,
    readings: Vec<f64>,
}

impl Calibrate {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let title = format!("Calibrations of {} synthetic coins", self.coins);
        let mut table = Table::new(title, &["what", "of", "value", "lo", "hi", "n"]);
        let begun = Instant::now();
        let model = self.model(seed, false)?;
        let design_s = begun.elapsed().as_secs_f64();
        let coins = self.coins(&model, seed)?;
        let begun = Instant::now();
        let covered = survey(&coins, |coin| coin.covered(&model, self.truth))
            .into_iter()
            .collect::<anyhow::Result<Vec<Vec<bool>>>>()?;
        let posterior_s = begun.elapsed().as_secs_f64();
        let names = names(&model);
        for (place, name) in names.iter().enumerate() {
            let held = covered.iter().filter(|covered| covered[place]);
            table.push(self.coverage(name, held.count()));
        }
        table.push(self.predicted(&model, &coins)?);
        // no film is simulated: `coinmc-studies film` does
        for kind in Kind::ALL.into_iter().filter(|kind| *kind != Kind::Film) {
            contraction(&mut table, &model, kind, &coins)?;
        }
        let error = model.fits().map(|fit| fit.error).fold(0.0, f64::max);
        table.push(row(
            "error of the fit",
            "P(face)",
            error,
            [error; 2],
            model.tosses(),
        ));
        for (name, paired) in [("own launches", false), ("shared launches", true)] {
            let noise = self.noise(&model, &coins[0], seed, paired)?;
            table.push(row(
                "noise of log_prob, nats",
                name,
                noise,
                [noise; 2],
                SEEDS,
            ));
        }
        let call = call_ms(&model, &coins[0])?;
        table.push(row(
            "log_prob of 1000 rows, ms",
            "one thread",
            call,
            [call; 2],
            1000,
        ));
        let mut report = Report::new(table);
        report.remark(format!(
            "Design {design_s:.1} s, all posteriors {posterior_s:.1} s; P(side) is held within its interval \
             widened by the error of the true one, {} tosses.",
            self.truth
        ));
        Ok(report)
    }

    /// How often the interval of P(side) that `coinmc calibrate` prints, by tosses, holds the truth.
    fn predicted(&self, model: &Model, coins: &[Coin]) -> anyhow::Result<Vec<String>> {
        let mut held = 0;
        for coin in coins {
            let model = coin.measured(model);
            let posterior = Posterior::of(&model)?;
            let predicted =
                with_workers(|workers| Ok(Prediction::of(&model, &posterior, workers)?))?;
            let side = predicted.side();
            held += usize::from(coin.is_side_in([side.lo, side.p, side.hi], self.truth));
        }
        Ok(self.coverage("P(side) by tosses", held))
    }

    /// The share of intervals that hold the truth.
    fn coverage(&self, of: &str, held: usize) -> Vec<String> {
        let share = Estimate::new(
            held as u64,
            0,
            self.coins,
            0.95,
            IntervalMethod::ClopperPearson,
        );
        row("coverage", of, share.p, [share.lo, share.hi], self.coins)
    }

    fn model(&self, seed: u64, paired: bool) -> anyhow::Result<Model> {
        let set: Override = format!("seed={seed}").parse()?;
        let scene = if self.rough { ROUGH } else { PLANE };
        let config = format!("{MEASURED}{scene}");
        let observed = Observations::parse("study", &config, &[set], Path::new(""))?;
        let settings = Settings {
            points: self.points,
            tosses: self.tosses,
            draws: DRAWS,
            predicted: self.predicted,
            paired,
        };
        with_workers(|workers| Ok(Model::new(observed, settings, workers)?))
    }

    /// Coins from the prior, with their measurements and their true P(side).
    fn coins(&self, model: &Model, seed: u64) -> anyhow::Result<Vec<Coin>> {
        let stream = Stream::new(seed, Domain::Parameters, 1);
        let d = model.parameters().len();
        let truths: Vec<Vec<f64>> = (0..self.coins)
            .map(|coin| {
                let mut uniforms = stream.toss(coin);
                let uniforms: Vec<f64> = (0..).take(d).map(|k| uniforms.uniform(k)).collect();
                model.of_uniforms(&uniforms)
            })
            .collect();
        let measured =
            with_workers(|workers| Ok(model.simulate(&truths, seed + 1000, workers)?))?;
        // the first counts are in the scene that is predicted
        let mut tossed = vec![[0; 3]; model.observed().counts.len()];
        tossed[0][0] = self.truth;
        let many = model.with_measured(&tossed, &[]);
        let faces = with_workers(|workers| Ok(many.simulate(&truths, seed + 2000, workers)?))?;
        let coin = |((truth, row), faces): ((Vec<f64>, Vec<f64>), Vec<f64>)| {
            let shown: f64 = faces[..3].iter().sum();
            let (counts, readings) = row.split_at(3 * tossed.len());
            // counts are whole
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let counts = counts
                .chunks_exact(3)
                .map(|faces| [0, 1, 2].map(|face| faces[face] as u64));
            Coin {
                truth,
                side: faces[2] / shown,
                counts: counts.collect(),
                readings: readings.to_vec(),
            }
        };
        Ok(truths
            .into_iter()
            .zip(measured)
            .zip(faces)
            .map(coin)
            .collect())
    }

    /// Standard deviation of differences of ln of the posterior density between places of the posterior,
    /// over models that differ in their seed.
    fn noise(&self, model: &Model, coin: &Coin, seed: u64, paired: bool) -> anyhow::Result<f64> {
        let posterior = Posterior::of(&coin.measured(model))?;
        let places = &posterior.draws[..COMPARED];
        let models = (0..SEEDS).map(|k| self.model(seed + 100 + k, paired));
        let mut logs = vec![];
        for other in models {
            let other = coin.measured(&other?);
            let log: Vec<f64> = places.iter().map(|place| other.log_prob(place)).collect();
            let mean = log.iter().sum::<f64>() / log.len() as f64;
            logs.push(log.into_iter().map(|log| log - mean).collect::<Vec<_>>());
        }
        let mut squares = 0.0;
        for place in 0..COMPARED {
            let at: Vec<f64> = logs.iter().map(|log| log[place]).collect();
            let mean = at.iter().sum::<f64>() / at.len() as f64;
            let square: f64 = at.iter().map(|log| (log - mean) * (log - mean)).sum();
            squares += square / (at.len() - 1) as f64;
        }
        Ok((squares / COMPARED as f64).sqrt())
    }
}

impl Coin {
    fn measured(&self, model: &Model) -> Model {
        model.with_measured(&self.counts, &self.readings)
    }

    /// Whether the interval of each parameter, and that of P(side), holds the truth.
    fn covered(&self, model: &Model, tosses: u64) -> anyhow::Result<Vec<bool>> {
        let model = self.measured(model);
        let posterior = Posterior::of(&model)?;
        let parameters = posterior.summaries.iter().zip(&self.truth);
        let mut covered: Vec<bool> = parameters
            .map(|(summary, truth)| summary.lo <= *truth && *truth <= summary.hi)
            .collect();
        let interval = posterior.face_interval(&model, Face::Side);
        covered.push(self.is_side_in(interval, tosses));
        Ok(covered)
    }

    /// Whether an interval, widened by the error of the true P(side), holds it.
    fn is_side_in(&self, [lo, p, hi]: [f64; 3], tosses: u64) -> bool {
        let own = Z95 * (self.side * (1.0 - self.side) / tosses as f64).sqrt();
        let arm = |arm: f64| (arm * arm + own * own).sqrt();
        p - arm(p - lo) <= self.side && self.side <= p + arm(hi - p)
    }
}

/// The mean spread that is left by measurements of one kind alone.
fn contraction(table: &mut Table, model: &Model, kind: Kind, coins: &[Coin]) -> anyhow::Result<()> {
    let few = &coins[..coins.len().min(ALONE)];
    let prior = Posterior::of(&model.with_kinds(&[]))?;
    let width = |posterior: &Posterior, model: &Model| {
        let [lo, _, hi] = posterior.face_interval(model, Face::Side);
        hi - lo
    };
    let before = width(&prior, model);
    let left = survey(few, |coin| {
        let model = coin.measured(model).with_kinds(&[kind]);
        let posterior = Posterior::of(&model)?;
        let summaries = posterior.summaries.iter();
        let mut left: Vec<f64> = summaries.map(|summary| summary.contraction).collect();
        left.push(width(&posterior, &model) / before);
        Ok(left)
    })
    .into_iter()
    .collect::<anyhow::Result<Vec<Vec<f64>>>>()?;
    for (place, name) in names(model).iter().enumerate() {
        let column: Vec<f64> = left.iter().map(|left| left[place]).collect();
        let mean = column.iter().sum::<f64>() / column.len() as f64;
        let low = column.iter().copied().fold(f64::INFINITY, f64::min);
        let high = column.iter().copied().fold(0.0, f64::max);
        let what = format!("spread left by {}", kind.name());
        table.push(row(&what, name, mean, [low, high], few.len() as u64));
    }
    Ok(())
}

/// The time of 1000 rows of `log_prob`, ms.
fn call_ms(model: &Model, coin: &Coin) -> anyhow::Result<f64> {
    let model = coin.measured(model);
    let posterior = Posterior::of(&model)?;
    let rows = posterior.draws.get(..1000).context("a thousand draws")?;
    let begun = Instant::now();
    let sum: f64 = rows.iter().map(|row| model.log_prob(row)).sum();
    anyhow::ensure!(sum.is_finite(), "a draw without density");
    Ok(1e3 * begun.elapsed().as_secs_f64())
}

fn names(model: &Model) -> Vec<String> {
    let parameters = model.parameters().into_iter();
    let keys = parameters.map(|parameter| parameter.key().to_owned());
    keys.chain(["P(side)".to_owned()]).collect()
}

fn row(what: &str, of: &str, value: f64, [lo, hi]: [f64; 2], n: u64) -> Vec<String> {
    let number = |x: f64| format!("{x:.4}");
    vec![
        what.to_owned(),
        of.to_owned(),
        number(value),
        number(lo),
        number(hi),
        n.to_string(),
    ]
}

fn with_workers<T>(work: impl FnOnce(&Workers<'_>) -> anyhow::Result<T>) -> anyhow::Result<T> {
    let cancel = AtomicBool::new(false);
    let threads = std::num::NonZeroUsize::new(rayon::current_num_threads());
    work(&Workers {
        threads,
        cancel: &cancel,
        made: &|_| (),
    })
}
