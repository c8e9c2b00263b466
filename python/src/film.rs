//! Drops on film: reading Tracker exports and fitting laws of impact.

use crate::errors;
use crate::plan::Plan;
use crate::supervise::wait_for;
use coinmc::plan::Point;
use coinmc_core::{Coin, Scene, Surface};
use coinmc_film::text::{AngleOf, Choice, read};
use coinmc_film::{
    Coordinate, FilmedDrop, Fit, Frame, Law, Loss, Model, Options, Parameter, Ranked, Settings,
    compare, fit_all, parameters,
};
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// What the reader needs to know about a file.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct ReaderOptions {
    x: Option<String>,
    y: Option<String>,
    angle: Option<String>,
    ends: Option<(String, String)>,
    length_m: Option<f64>,
    angle_rad: Option<f64>,
    angle_of: String,
}

/// Reads a text exported by Tracker.
#[pyfunction]
pub(crate) fn read_film<'py>(
    py: Python<'py>,
    name: &str,
    bytes: &[u8],
    options: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let options: ReaderOptions = options.extract()?;
    let choice = Choice {
        x: options.x,
        y: options.y,
        angle: options.angle,
        ends: options.ends,
        length_m: options.length_m,
        angle_rad: options.angle_rad,
        angle_of: match options.angle_of.as_str() {
            "face" => AngleOf::Face,
            "axis" => AngleOf::Axis,
            "tilt" => AngleOf::Tilt,
            _ => return Err(errors::value("angle_of is face, axis or tilt")),
        },
    };
    let footage = read(name, bytes, &choice).map_err(|found| errors::footage(&found))?;
    let frames = &footage.drop.frames;
    let time: Vec<f64> = frames.iter().map(|frame| frame.time_s).collect();
    let seen: Vec<f64> = frames
        .iter()
        .flat_map(|frame| frame.seen.map(|value| value.unwrap_or(f64::NAN)))
        .collect();
    let dict = PyDict::new(py);
    dict.set_item("name", &footage.drop.name)?;
    dict.set_item("time_s", time.into_pyarray(py))?;
    dict.set_item("seen", seen.into_pyarray(py).reshape([frames.len(), 3])?)?;
    dict.set_item("rate_hz", footage.drop.rate_hz())?;
    dict.set_item("used", &footage.used)?;
    dict.set_item("missing", footage.missing)?;
    Ok(dict)
}

/// A drop from Python: its name, times and observed coordinates.
type Drop<'py> = (
    String,
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray2<'py, f64>,
);

/// The options of a fit. Absent ones come from the config, or have their defaults without one.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct FitRequest {
    ratio: Option<f64>,
    radius_m: Option<f64>,
    gravity_m_s2: Option<f64>,
    restitution: Option<f64>,
    friction: Option<f64>,
    floor_m: f64,
    laws: Vec<String>,
    free: Option<Vec<String>>,
    bounces: usize,
    until_s: f64,
    loss: String,
    confidence: f64,
}

/// Fits laws to drops: one dict per law, the best by AIC first. The first point of a config gives
/// the coin, the surface, gravity, and the parameters of its own law.
#[pyfunction]
#[pyo3(signature = (drops, options, config=None))]
pub(crate) fn fit_film<'py>(
    py: Python<'py>,
    drops: Vec<Drop<'py>>,
    options: &Bound<'py, PyDict>,
    config: Option<&Plan>,
) -> PyResult<Bound<'py, PyList>> {
    let drops = drops.iter().map(filmed).collect::<PyResult<Vec<_>>>()?;
    let point = config.map(|plan| plan.point(0)).transpose()?;
    let request: FitRequest = options.extract()?;
    let models = request.models(point)?;
    let options = request.options(point)?;
    let fits = wait_for(py, move || fit_all(&models, &drops, &options))?;
    let fits = fits.map_err(errors::film)?;
    let made = compare(&fits)
        .iter()
        .map(|ranked| as_dict(py, &fits[ranked.fit], ranked))
        .collect::<PyResult<Vec<_>>>()?;
    PyList::new(py, made)
}

fn filmed((name, time, seen): &Drop<'_>) -> PyResult<FilmedDrop> {
    let (time, seen) = (time.as_slice()?, seen.as_slice()?);
    if seen.len() != 3 * time.len() {
        return Err(errors::value("a drop has three coordinates per frame"));
    }
    let frames = time.iter().zip(seen.chunks_exact(3));
    let frames = frames.map(|(&time_s, seen)| Frame {
        time_s,
        seen: [seen[0], seen[1], seen[2]].map(|value| value.is_finite().then_some(value)),
    });
    Ok(FilmedDrop {
        name: name.clone(),
        frames: frames.collect(),
    })
}

impl FitRequest {
    fn models(&self, point: Option<&Point>) -> PyResult<Vec<Model>> {
        let coin = self.coin(point)?;
        let configured = point.map_or(Scene::STANDARD_GRAVITY_M_S2, |p| p.scene.gravity_m_s2());
        let gravity_m_s2 = self.gravity_m_s2.unwrap_or(configured);
        let surface = Surface::new(0.0, 0.0).map_err(errors::value)?;
        Scene::new(coin, surface, gravity_m_s2).map_err(errors::value)?;
        let laws = self.laws.iter().map(|name| law(name, point));
        laws.map(|law| {
            Ok(Model {
                law: law?,
                coin,
                gravity_m_s2,
            })
        })
        .collect()
    }

    fn coin(&self, point: Option<&Point>) -> PyResult<Coin> {
        let configured = point.map(|point| point.scene.coin);
        let (ratio, radius_m) = match (self.ratio, self.radius_m, configured) {
            (None, None, Some(coin)) => return Ok(coin),
            (ratio, radius_m, Some(coin)) => {
                let radius_m = radius_m.unwrap_or(coin.radius_m());
                (ratio.unwrap_or(coin.ratio()), radius_m)
            }
            (Some(ratio), Some(radius_m), None) => (ratio, radius_m),
            _ => {
                return Err(errors::value(
                    "say what was dropped: give a config, or ratio and radius_m",
                ));
            }
        };
        Coin::cylinder(ratio, radius_m).map_err(errors::value)
    }

    fn options(&self, point: Option<&Point>) -> PyResult<Options> {
        let usual = Options::default();
        let surface = point.map(|point| point.scene.surface);
        let restitution = surface.map_or(usual.shared.restitution, |s| s.restitution());
        let restitution = self.restitution.unwrap_or(restitution);
        let friction = surface.map_or(usual.shared.friction, |s| s.friction());
        let friction = self.friction.unwrap_or(friction);
        Surface::new(restitution, friction).map_err(errors::value)?;
        if !self.floor_m.is_finite() {
            return Err(errors::value("floor_m must be finite"));
        }
        if self.until_s.is_nan() || self.until_s <= 0.0 {
            return Err(errors::value("until_s must be positive"));
        }
        let free = self.free.as_ref().map(|names| {
            let found = names.iter();
            let found =
                found.map(|name| named(name, &Parameter::ALL, Parameter::name, "parameter"));
            found.collect::<PyResult<_>>()
        });
        Ok(Options {
            free: free.transpose()?.unwrap_or(usual.free),
            shared: usual
                .shared
                .with(Parameter::Restitution, restitution)
                .with(Parameter::Friction, friction)
                .with(Parameter::Floor, self.floor_m),
            bounces: self.bounces,
            until_s: self.until_s,
            loss: match self.loss.as_str() {
                "square" => Loss::Square,
                "huber" => Loss::Huber,
                _ => return Err(errors::value("the losses are square and huber")),
            },
            confidence: self.confidence,
        })
    }
}

/// The law with this name: one without parameters, or that of the config.
fn law(name: &str, point: Option<&Point>) -> PyResult<Law> {
    if let Some(settings) = point.and_then(|point| point.engine.settings::<Settings>())
        && settings.law.name() == name
    {
        return Ok(settings.law);
    }
    named(name, &Law::RIGID, Law::name, "law").map_err(|_| {
        let names = Law::RIGID.map(Law::name).join(", ");
        errors::value(format!(
            "there is no law {name:?} here; choose from {names}, or give a config with this law as \
             engine.flat.law"
        ))
    })
}

fn named<T: Copy>(
    name: &str,
    all: &[T],
    name_of: impl Fn(T) -> &'static str,
    what: &str,
) -> PyResult<T> {
    let found = all.iter().copied().find(|known| name_of(*known) == name);
    found.ok_or_else(|| {
        let names: Vec<_> = all.iter().copied().map(name_of).collect();
        let names = names.join(", ");
        errors::value(format!("there is no {what} {name:?}; there are {names}"))
    })
}

fn as_dict<'py>(py: Python<'py>, fit: &Fit, ranked: &Ranked) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("law", fit.model.law.name())?;
    dict.set_item("n", fit.n)?;
    dict.set_item("fitted", fit.fitted)?;
    dict.set_item("log_likelihood", fit.log_likelihood)?;
    dict.set_item("confidence", fit.confidence)?;
    dict.set_item("aic", ranked.aic)?;
    dict.set_item("bic", ranked.bic)?;
    dict.set_item("delta_aic", ranked.delta_aic)?;
    dict.set_item("delta_bic", ranked.delta_bic)?;
    dict.set_item("weight", ranked.weight)?;
    let values = parameters(fit.model.law).iter();
    let values: Vec<_> = values.map(|p| (p.name(), fit.shared.get(*p))).collect();
    dict.set_item("values", values)?;
    let fitted = fit.parameters.iter();
    let fitted: Vec<_> = fitted
        .map(|p| (p.parameter.name(), p.value, p.std_error, p.lo, p.hi))
        .collect();
    dict.set_item("parameters", fitted)?;
    let noise = fit.noise.iter();
    let noise: Vec<_> = noise
        .map(|noise| {
            (
                noise.coordinate.name(),
                noise.n,
                noise.sigma,
                noise.correlation,
            )
        })
        .collect();
    dict.set_item("noise", noise)?;
    let remarks: Vec<String> = fit.remarks.iter().map(ToString::to_string).collect();
    dict.set_item("remarks", remarks)?;
    let drops = fit.drops.iter().map(|drop| {
        let half_width = drop.half_width.map(|width| width.unwrap_or(f64::NAN));
        let (name, impacts) = (drop.name.clone(), drop.impacts_s.clone());
        (
            name,
            drop.start,
            half_width,
            drop.frames,
            drop.of_frames,
            impacts,
        )
    });
    dict.set_item("drops", drops.collect::<Vec<_>>())?;
    dict.set_item("residuals", residuals(py, fit)?)?;
    Ok(dict)
}

/// The residuals as columns; drop, frame and coordinate are indices.
fn residuals<'py>(py: Python<'py>, fit: &Fit) -> PyResult<Bound<'py, PyDict>> {
    let all = &fit.residuals;
    let dict = PyDict::new(py);
    let whole = |of: &dyn Fn(&coinmc_film::Residual) -> usize| {
        let values: Vec<u64> = all.iter().map(|residual| of(residual) as u64).collect();
        values.into_pyarray(py)
    };
    let real = |of: &dyn Fn(&coinmc_film::Residual) -> f64| {
        let values: Vec<f64> = all.iter().map(of).collect();
        values.into_pyarray(py)
    };
    let coordinate = |residual: &coinmc_film::Residual| {
        let of = |known: &Coordinate| *known == residual.coordinate;
        Coordinate::ALL.iter().position(of).unwrap_or(0)
    };
    dict.set_item("drop", whole(&|residual| residual.drop))?;
    dict.set_item("frame", whole(&|residual| residual.frame))?;
    dict.set_item("coordinate", whole(&coordinate))?;
    dict.set_item("time_s", real(&|residual| residual.time_s))?;
    dict.set_item("seen", real(&|residual| residual.seen))?;
    dict.set_item("residual", real(&|residual| residual.residual))?;
    dict.set_item("standardised", real(&|residual| residual.standardised))?;
    Ok(dict)
}
