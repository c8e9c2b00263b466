//! Makes a launch's part of the atlas of the tosses of its design.
//!
//! A part of the design is left out of each network, which shows how wrong a network is where it was not fitted. The
//! parts are runs of neighbouring points: 2^n of them fill the whole box evenly, which every fourth point of a Sobol'
//! sequence does not. With the mean square error M of one network about the true probability (the noise of the counts taken
//! off) and the variance V between networks, M = V + B, with a part B that all of them share. The mean of K networks
//! has the error V/K + B = V (M/V - 1 + 1/K). V is taken half from the place itself and half as a share of p(1 - p).

use crate::ensemble::spread;
use crate::file::{ErrorModel, Header};
use crate::network::{Network, single};
use crate::train::{Sample, Training, train};
use crate::{Atlas, Counts, Design, FitError, Place};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Networks of a part.
const NETWORKS: usize = 4;
/// Fewest points that are fitted.
const FEWEST: usize = 1000;

/// Fits networks to a design, tossed with one seed or several; `None` if `go_on` says so.
///
/// # Errors
/// [`FitError`].
pub fn fit(
    launch: &str,
    designs: &[Design],
    training: &Training,
    threads: usize,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Atlas>, FitError> {
    let first = designs.first().ok_or(FitError::TooFew(0))?;
    let plans = designs.iter().map(|design| design.plan_hash().to_owned());
    let axes = first.axes().to_vec();
    let mut header = Header::new(launch, plans.collect(), first.radius_m(), axes);
    let mut parts = vec![Vec::new(); NETWORKS];
    for design in designs {
        if (design.axes(), design.radius_m()) != (first.axes(), first.radius_m()) {
            return Err(FitError::NotADesign(
                "its coins and surfaces are not those of the first".to_owned(),
            ));
        }
        let points = design.points().len();
        for (index, (place, counts)) in design.points().iter().enumerate() {
            header.points += 1;
            header.tosses += counts.tosses();
            header.undecided += counts.undecided;
            parts[part_of(index, points)].extend(sample(place, counts, &header));
        }
    }
    let samples = parts.iter().map(Vec::len).sum();
    if samples < FEWEST {
        return Err(FitError::TooFew(samples));
    }
    let Some(networks) = networks(&parts, training, threads, go_on) else {
        return Ok(None);
    };
    header.hidden.clone_from(&training.hidden);
    header.networks = NETWORKS;
    header.error = error_model(&parts, &networks);
    Ok(Some(Atlas::new(header, networks)))
}

/// The counts of a point; `None` if no toss showed a face.
fn sample(place: &Place, counts: &Counts, header: &Header) -> Option<Sample> {
    let inputs = place.coordinates(&header.axes, header.radius_m);
    let [heads, _, side] = counts.faces;
    let shown = counts.tosses() - counts.undecided;
    (shown > 0).then(|| Sample {
        place: inputs.into_iter().map(single).collect(),
        shown: shown as f32,
        side: side as f32,
        heads: heads as f32,
    })
}

/// The part that a point belongs to, and the number of the network that does not see it.
fn part_of(index: usize, points: usize) -> usize {
    index * NETWORKS / points
}

/// The networks, each without its part of the samples.
fn networks(
    parts: &[Vec<Sample>],
    training: &Training,
    threads: usize,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<Network>> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut made = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= NETWORKS {
                return made;
            }
            let kept = parts.iter().enumerate().filter(|(part, _)| *part != number);
            let kept: Vec<&Sample> = kept.flat_map(|(_, samples)| samples).collect();
            made.push((number, train(&kept, training, number as u64, go_on)));
        }
    };
    let mut made: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, NETWORKS))
            .map(|_| scope.spawn(work))
            .collect();
        let joined = workers
            .into_iter()
            .map(|worker| worker.join().expect("a fit does not panic"));
        joined.flatten().collect()
    });
    made.sort_by_key(|(number, _)| *number);
    made.into_iter().map(|(_, network)| network).collect()
}

/// How the error follows from the networks' spread, by the points that each has not seen.
fn error_model(parts: &[Vec<Sample>], networks: &[Network]) -> ErrorModel {
    let (mut squares, mut variance, mut binomial) = (0.0, 0.0, 0.0);
    let samples = parts.iter().enumerate();
    for (part, sample) in samples.flat_map(|(part, samples)| samples.iter().map(move |s| (part, s)))
    {
        let n = f64::from(sample.shown);
        if n < 2.0 {
            continue;
        }
        let place: Vec<f64> = sample.place.iter().map(|x| f64::from(*x)).collect();
        let each: Vec<f64> = networks
            .iter()
            .map(|network| network.faces(&place)[2])
            .collect();
        let share = f64::from(sample.side) / n;
        let off = share - each[part];
        squares += off * off - share * (1.0 - share) / (n - 1.0);
        let mean = each.iter().sum::<f64>() / each.len() as f64;
        variance += spread(each.iter().copied(), mean);
        binomial += mean * (1.0 - mean);
    }
    let of_mean = 1.0 / networks.len() as f64;
    ErrorModel {
        // where the noise hides the error, networks are as wrong as they differ
        factor: (squares / variance - 1.0).max(0.0) + of_mean,
        typical: variance / binomial,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Domain, Stream, UniformSource};

    fn truth(place: &[f32]) -> f64 {
        let x = f64::from(2.0 * place[0] + place[0] * place[1]);
        1.0 / (1.0 + libm::exp(-x))
    }

    /// Counts of 50 tosses at random places of a square.
    fn samples(points: u64) -> Vec<Vec<Sample>> {
        let stream = Stream::new(7, Domain::Launch, 0);
        let sample = |point| {
            let mut uniforms = stream.toss(point);
            let place: Vec<f32> = (0..2)
                .map(|d| single(2.0 * uniforms.uniform(d) - 1.0))
                .collect();
            let p = truth(&place);
            let mut count = |q: f64, from: u16, n: u16| {
                let shown = (from..from + n).filter(|d| uniforms.uniform((*d).into()) < q);
                u16::try_from(shown.count()).expect("at most n")
            };
            let side = count(p, 2, 50);
            let heads = count(0.5, 100, 50 - side);
            Sample {
                place,
                shown: 50.0,
                side: side.into(),
                heads: heads.into(),
            }
        };
        let part = |part| {
            (part * points / 4..(part + 1) * points / 4)
                .map(sample)
                .collect()
        };
        (0..4).map(part).collect()
    }

    /// A known surface is found, and as well as the error model says; the same counts give the same
    /// networks for any number of threads.
    #[test]
    fn a_known_surface_is_found_within_its_own_error() {
        let samples = samples(1024);
        let training = Training {
            hidden: vec![8],
            epochs: 200,
            rate: 0.02,
        };
        let networks = networks(&samples, &training, 1, &|| true).unwrap();
        assert_eq!(
            super::networks(&samples, &training, 3, &|| true).unwrap(),
            networks
        );
        assert_eq!(super::networks(&samples, &training, 2, &|| false), None);
        let model = error_model(&samples, &networks);
        let (mut off, mut claimed) = (0.0, 0.0);
        for sample in samples.iter().flatten() {
            let place: Vec<f64> = sample.place.iter().map(|x| f64::from(*x)).collect();
            let each = networks.iter().map(|network| network.faces(&place)[2]);
            let p = each.clone().sum::<f64>() / 4.0;
            off += (p - truth(&sample.place)).powi(2);
            claimed += model.factor * 0.5 * (spread(each, p) + model.typical * p * (1.0 - p));
        }
        let (off, claimed) = ((off / 1024.0).sqrt(), (claimed / 1024.0).sqrt());
        assert!(off < 0.01, "{off}");
        assert!(
            (0.5..2.0).contains(&(claimed / off)),
            "claimed {claimed}, true {off}"
        );
    }
}
