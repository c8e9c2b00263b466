//! Tosses on surfaces with given parameters.

use crate::{CalibrationError, Parameter};
use coinmc::plan::{Plan, Point};
use coinmc_core::{Domain, Roughness, Stream, Surface, SurfaceError};
use coinmc_questions::Workers;
use std::ops::Range;

/// Heads, tails and side, as counted.
pub(crate) type Faces = [u64; 3];

/// Where tosses are made: the first point of a plan with other parameters.
#[derive(Debug, Clone)]
pub(crate) struct At {
    pub(crate) point: Point,
    pub(crate) tosses: Range<u64>,
}

/// A surface like this one with these parameters.
pub(crate) fn surface_with(
    like: &Surface,
    parameters: &[Parameter],
    values: &[f64],
) -> Result<Surface, SurfaceError> {
    let of = |parameter: Parameter| {
        let place = parameters.iter().position(|known| *known == parameter);
        place.map_or(parameter.of_surface(like), |place| values[place])
    };
    let slope = of(Parameter::RoughnessSlope);
    let ground = like.roughness();
    let ground = ground.map(|ground| Roughness::new(slope, ground.wavelength_m()));
    let ground = ground.transpose()?;
    let surface = like
        .with_impact(of(Parameter::Restitution), of(Parameter::Friction))?
        .with_friction_lengths(
            of(Parameter::RollingFriction),
            of(Parameter::PivotingFriction),
        )?;
    Ok(surface.with_roughness(ground))
}

/// The first point of a plan, on a surface with these values of these parameters.
///
/// # Errors
/// [`SurfaceError`] if no surface has them.
pub fn point_with(
    plan: &Plan,
    parameters: &[Parameter],
    values: &[f64],
) -> Result<Point, SurfaceError> {
    let mut point = plan.points[0].clone();
    point.scene.surface = surface_with(&point.scene.surface, parameters, values)?;
    Ok(point)
}

/// The random numbers of all tosses of a calibration.
pub(crate) fn launches(seed: u64) -> Stream {
    Stream::new(seed, Domain::Launch, 0)
}

/// Counts the faces of each piece of work; tosses without a face are in none of the counts.
pub(crate) fn count(
    work: &[At],
    stream: &Stream,
    workers: &Workers<'_>,
) -> Result<Vec<Faces>, CalibrationError> {
    workers.each(work.len(), &|index| {
        let At { point, tosses } = &work[index];
        let mut faces = [0; 3];
        workers.outcomes(point, stream, tosses.clone(), &mut |_, outcome| {
            if let Some(face) = outcome.face() {
                faces[face as usize] += 1;
            }
        })?;
        Ok(faces)
    })
}

/// The face of each toss at two points with the same random numbers.
pub(crate) fn pairs(
    points: [&Point; 2],
    stream: &Stream,
    tosses: u64,
    workers: &Workers<'_>,
) -> Result<Vec<[Option<usize>; 2]>, CalibrationError> {
    const PIECE: u64 = 256;
    let pieces = usize::try_from(tosses.div_ceil(PIECE)).unwrap_or(usize::MAX);
    let found = workers.each(pieces, &|index| {
        let first = index as u64 * PIECE;
        let range = first..(first + PIECE).min(tosses);
        let mut found = vec![[None; 2]; usize::try_from(range.end - first).unwrap_or(0)];
        for (side, point) in points.iter().enumerate() {
            workers.outcomes(point, stream, range.clone(), &mut |toss, outcome| {
                let place = usize::try_from(toss - first).expect("a piece is small");
                found[place][side] = outcome.face().map(|face| face as usize);
            })?;
        }
        Ok::<_, CalibrationError>(found)
    })?;
    Ok(found.concat())
}
