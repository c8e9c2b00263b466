//! A map of basins: the face over two quantities of the launch, a toss for every pixel.

use crate::keyframes::Fineness;
use crate::quantity::Quantity;
use crate::replay;
use crate::samples::MOST_RECORDS;
use coinmc::engines::EngineKind;
use coinmc::plan::Plan;
use coinmc_core::Launch;
use coinmc_trace::{Trace, TraceError, default_rate_hz, launch, outcome_name, record};
use serde_json::{Value, json};
use thiserror::Error;

/// Most pixels of a map: each holds its toss, some kilobytes.
pub const MAX_PIXELS: usize = 10_000;

/// A map of basins.
#[derive(Debug, Clone)]
pub struct Map {
    point: usize,
    sides: [Side; 2],
    launch: Launch,
    traces: Vec<Trace>,
}

/// A side of a map: its quantity, its ends (the outer edges of the pixels), and the number of pixels.
type Side = (Quantity, f64, f64, usize);

/// Why there is no map.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MapError {
    /// Both sides vary the same quantity.
    #[error("both sides of the map are {0}: give two different quantities")]
    SameQuantity(Quantity),
    /// A side has no length.
    #[error("{quantity} must go from one finite number to another, not from {from} to {to}")]
    Range {
        /// The side.
        quantity: Quantity,
        /// Its beginning.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// Too many pixels, or none.
    #[error(
        "a map has 1 to {MAX_PIXELS} pixels, each with its toss, not {columns} times {rows}: \
         `coinmc.plot.basin` of Python draws finer ones"
    )]
    Pixels {
        /// Pixels across.
        columns: usize,
        /// Pixels up.
        rows: usize,
    },
    /// An engine in the plane tosses no coin out of it.
    #[error("the engine `{engine}` tosses in the xz plane: {quantity} has no place in it")]
    NotPlanar {
        /// The engine.
        engine: &'static str,
        /// The side.
        quantity: Quantity,
    },
    /// The point or the toss does not exist, or cannot be recorded.
    #[error(transparent)]
    Trace(#[from] TraceError),
}

impl Map {
    /// Tosses every pixel: launches of toss `toss` of a point, with the quantities of both sides replaced. Each
    /// side is a quantity, its ends (the outer edges of the pixels), and the number of pixels.
    ///
    /// `go_on` is called before each toss with the number of those done; `None` if it returned false.
    ///
    /// # Errors
    /// [`MapError`].
    pub fn toss(
        plan: &Plan,
        point: usize,
        toss: u64,
        sides: [(Quantity, f64, f64, usize); 2],
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<Option<Self>, MapError> {
        check(&sides)?;
        check_plane(plan, point, &sides)?;
        let base = launch(plan, point, toss)?;
        let [(x, x_from, x_to, columns), (y, y_from, y_to, rows)] = sides;
        let mut traces = Vec::with_capacity(columns * rows);
        for pixel in 0..columns * rows {
            if !go_on(pixel) {
                return Ok(None);
            }
            let mut launch = base;
            x.set(&mut launch, centre(x_from, x_to, columns, pixel % columns));
            y.set(&mut launch, centre(y_from, y_to, rows, pixel / columns));
            let rate = default_rate_hz(&plan.points[point].scene, &launch);
            traces.push(record(plan, point, &launch, rate, MOST_RECORDS)?);
        }
        Ok(Some(Self {
            point,
            sides,
            launch: base,
            traces,
        }))
    }

    pub(crate) fn to_json(&self, plan: &Plan) -> Value {
        let sides = self.sides.map(|(quantity, from, to, pixels)| {
            json!({ "name": quantity.to_string(), "from": from, "to": to, "pixels": pixels })
        });
        let scene = self.traces.first().map(|trace| replay::scene(&trace.scene));
        let pixels = self.traces.iter().map(|trace| {
            json!({
                "outcome": outcome_name(&trace.outcome),
                "impacts": trace.records.iter().filter(|record| replay::is_impact(record)).count(),
                "keys": replay::keys(trace, Fineness::COARSE),
            })
        });
        json!({
            "at": replay::at(plan, self.point, &plan.axes),
            "engine": plan.points[self.point].engine.name(),
            "launch": {
                "height_m": self.launch.height_m,
                "velocity_m_s": self.launch.velocity_m_s.as_slice(),
                "axis": self.launch.axis.as_slice(),
                "spin_rad_s": self.launch.spin_rad_s.as_slice(),
            },
            "sides": sides,
            "scene": scene,
            "pixels": pixels.collect::<Vec<_>>(),
        })
    }
}

fn check(sides: &[Side; 2]) -> Result<(), MapError> {
    let [(x, .., columns), (y, .., rows)] = *sides;
    if x.is_same(y) {
        return Err(MapError::SameQuantity(x));
    }
    for &(quantity, from, to, _) in sides {
        if !(from.is_finite() && to.is_finite() && from != to) {
            return Err(MapError::Range { quantity, from, to });
        }
    }
    let pixels = columns.checked_mul(rows);
    if pixels.is_none_or(|pixels| pixels == 0 || pixels > MAX_PIXELS) {
        return Err(MapError::Pixels { columns, rows });
    }
    Ok(())
}

fn check_plane(plan: &Plan, point: usize, sides: &[Side; 2]) -> Result<(), MapError> {
    // a point that does not exist is told of by the launch
    let engine = plan
        .points
        .get(point)
        .map(|point| point.engine.descriptor());
    let planar = engine.filter(|engine| engine.kind == EngineKind::Planar);
    let out = sides.iter().find(|(quantity, ..)| !quantity.is_planar());
    match (planar, out) {
        (Some(engine), Some(&(quantity, ..))) => Err(MapError::NotPlanar {
            engine: engine.name,
            quantity,
        }),
        _ => Ok(()),
    }
}

/// The centre of a pixel.
fn centre(from: f64, to: f64, pixels: usize, pixel: usize) -> f64 {
    from + (pixel as f64 + 0.5) * ((to - from) / pixels as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_trace::outcome;

    fn plan() -> Plan {
        let config = "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
            launch.preset = 'clean'\nengine.volumetric = {}\nstop.tosses = 10";
        coinmc::config::parse("test", config, &[]).unwrap_or_else(|e| panic!("{e}"))
    }

    /// The map of one pixel around a toss's own launch is that toss.
    #[test]
    fn a_pixel_is_the_toss_of_its_launch() {
        let plan = plan();
        let own = launch(&plan, 0, 3).unwrap();
        let around = |x: f64| (x - 0.5, x + 0.5);
        let (a, b) = around(own.spin_rad_s.x);
        let sides = [
            (Quantity::Spin(0), a, b, 1),
            (
                Quantity::Height,
                own.height_m - 1e-3,
                own.height_m + 1e-3,
                1,
            ),
        ];
        let map = Map::toss(&plan, 0, 3, sides, |_| true).unwrap().unwrap();
        assert_eq!(
            map.traces[0].outcome.face(),
            outcome(&plan, 0, 3).unwrap().face()
        );
        assert!(Map::toss(&plan, 0, 3, sides, |_| false).unwrap().is_none());
    }

    #[test]
    fn impossible_maps_are_refused() {
        let plan = plan();
        let toss = |sides| {
            Map::toss(&plan, 0, 0, sides, |_| true)
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        let (height, spin) = (
            (Quantity::Height, 0.1, 0.2, 4),
            (Quantity::Spin(0), 0.0, 1.0, 4),
        );
        assert!(toss([height, height]).contains("both sides"));
        assert!(
            toss([height, (Quantity::Spin(0), 1.0, 1.0, 4)])
                .contains("one finite number to another")
        );
        assert!(
            toss([height, (Quantity::Spin(0), 0.0, 1.0, usize::MAX)]).contains("1 to 10000 pixels")
        );
        assert!(toss([spin, (Quantity::TiltDeg, 0.0, 1.0, 0)]).contains("not 4 times 0"));
        let flat = "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
            launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 10";
        let flat = coinmc::config::parse("test", flat, &[]).unwrap_or_else(|e| panic!("{e}"));
        let error = Map::toss(&flat, 0, 0, [height, spin], |_| true)
            .map(|_| ())
            .unwrap_err();
        assert!(
            error.to_string().contains("wx_rad_s has no place in it"),
            "{error}"
        );
    }
}
