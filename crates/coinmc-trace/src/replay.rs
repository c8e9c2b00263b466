//! Replaying tosses.

use crate::error::TraceError;
use crate::recorder::{MAX_RECORDS, Recorder};
use crate::trace::Trace;
use coinmc::plan::{MAX_TOSSES, Plan, Point, Stop};
use coinmc::run::stream;
use coinmc_core::{DynEngine, Engine, Launch, Outcome, Scene};

/// Greatest sampling rate, 1/s.
pub const MAX_RATE_HZ: f64 = 1e9;

/// Replays a toss of a plan with `rate_hz` samples per second (0 for events only), with at most
/// [`MAX_RECORDS`] records.
///
/// # Errors
/// [`TraceError`] if the plan has no such toss, its engine is a closed form, or the rate is out of
/// range.
///
/// # Example
/// ```
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 100",
///     &[],
/// ).unwrap();
/// let trace = coinmc_trace::replay(&plan, 0, 42, 100.0)?;
/// assert_eq!(trace.outcome, coinmc_trace::outcome(&plan, 0, 42)?);
/// # Ok::<(), coinmc_trace::TraceError>(())
/// ```
pub fn replay(plan: &Plan, point: usize, toss: u64, rate_hz: f64) -> Result<Trace, TraceError> {
    replay_within(plan, point, toss, rate_hz, MAX_RECORDS)
}

/// [`replay()`] with at most `max_records` records, for many traces at once.
///
/// # Errors
/// Those of [`replay()`].
pub fn replay_within(
    plan: &Plan,
    point: usize,
    toss: u64,
    rate_hz: f64,
    max_records: usize,
) -> Result<Trace, TraceError> {
    let launch = launch(plan, point, toss)?;
    let trace = record(plan, point, &launch, rate_hz, max_records)?;
    Ok(Trace { toss, ..trace })
}

/// Records a given launch at a point of a plan, otherwise like [`replay_within`]; the trace has
/// toss number 0.
///
/// # Errors
/// [`TraceError`] if the plan has no such point, its engine is a closed form, or the rate is out of
/// range.
pub fn record(
    plan: &Plan,
    point: usize,
    launch: &Launch,
    rate_hz: f64,
    max_records: usize,
) -> Result<Trace, TraceError> {
    if !(0.0..=MAX_RATE_HZ).contains(&rate_hz) {
        return Err(TraceError::Rate(rate_hz));
    }
    let launch = *launch;
    let scene = point_of(plan, point)?.scene;
    let mut recorder = Recorder::new(&scene, rate_hz, max_records);
    let outcome = engine_of(plan, point)?.toss(&mut (), &launch, &mut recorder);
    Ok(Trace {
        point,
        toss: 0,
        engine: plan.points[point].engine.name(),
        scene,
        launch,
        rate_hz,
        outcome,
        samples_until_s: recorder.samples_until_s(),
        events_until_s: recorder.events_until_s(),
        records: recorder.into_records(),
    })
}

/// The outcome of a toss of a plan, without recording it; the same as in the run.
///
/// # Errors
/// Those of [`replay()`].
pub fn outcome(plan: &Plan, point: usize, toss: u64) -> Result<Outcome, TraceError> {
    let launch = launch(plan, point, toss)?;
    Ok(engine_of(plan, point)?.toss(&mut (), &launch, &mut ()))
}

/// The launch of a toss of a plan.
///
/// # Errors
/// [`TraceError::NoSuchPoint`], [`TraceError::NoTraces`], [`TraceError::NoSuchToss`].
pub fn launch(plan: &Plan, point: usize, toss: u64) -> Result<Launch, TraceError> {
    let found = point_of(plan, point)?;
    if !found.engine.makes_tosses() {
        let engine = found.engine.name();
        return Err(TraceError::NoTraces { point, engine });
    }
    let tosses = max_tosses(plan);
    if toss >= tosses {
        return Err(TraceError::NoSuchToss { toss, tosses });
    }
    let uniforms = &mut stream(plan, point).toss(toss);
    Ok(found.launches.launch(&found.scene.coin, uniforms))
}

/// A sampling rate that shows a toss well, 1/s: 24 samples per turn of the coin at launch, and 20
/// within the toppling time sqrt(D/g), rounded up to 1, 2 or 5 times a power of ten.
pub fn default_rate_hz(scene: &Scene, launch: &Launch) -> f64 {
    let turns = launch.spin_rad_s.norm() / std::f64::consts::TAU;
    let wanted = (24.0 * turns).max(20.0 / scene.time_scale_s());
    if !(wanted > 1e-6 && wanted < MAX_RATE_HZ) {
        return wanted.clamp(1e-6, MAX_RATE_HZ);
    }
    let exponent = libm::floor(libm::log10(wanted));
    let ten: f64 = format!("1e{exponent}").parse().unwrap_or(wanted);
    let steps = [1.0, 2.0, 5.0, 10.0];
    let step = steps.into_iter().find(|step| step * ten >= wanted);
    step.map_or(wanted, |step| step * ten)
}

/// Greatest number of tosses per point of the plan.
pub(super) fn max_tosses(plan: &Plan) -> u64 {
    let tosses = match plan.stop {
        Stop::Tosses(tosses) => tosses,
        Stop::Targets(targets) => targets.max_tosses,
    };
    tosses.min(MAX_TOSSES)
}

pub(super) fn point_of(plan: &Plan, point: usize) -> Result<&Point, TraceError> {
    let points = plan.points.len();
    let found = plan.points.get(point);
    found.ok_or(TraceError::NoSuchPoint { point, points })
}

/// The engine of a point.
pub(super) fn engine_of(plan: &Plan, point: usize) -> Result<DynEngine, TraceError> {
    let found = point_of(plan, point)?;
    let engine = found.build_engine();
    let engine = engine.map_err(|source| TraceError::Settings { point, source })?;
    engine.ok_or_else(|| TraceError::NoTraces {
        point,
        engine: found.engine.name(),
    })
}
