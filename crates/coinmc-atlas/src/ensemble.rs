//! Several networks, each fitted without a part of the design: their mean is the answer, and how far they differ
//! shows its error.

use crate::file::{self, ErrorModel, Header};
use crate::network::Network;
use crate::{AtlasError, Axis, FileError, Launch, Place};

/// Probabilities of heads, tails and side, with their standard errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faces {
    /// P(heads), P(tails), P(side).
    pub p: [f64; 3],
    /// Their standard errors: of the fit and of the tosses it was made of.
    pub error: [f64; 3],
}

/// A ratio at which the side comes up with a given probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// H/R.
    pub ratio: f64,
    /// Its standard error.
    pub error: f64,
}

/// The probabilities of a launch over all coins and surfaces of the atlas.
///
/// # Example
/// ```
/// use coinmc_atlas::{Atlas, Launch, Place};
/// let atlas = Atlas::of(Launch::Hand);
/// let place = Place::on(&"wood".parse()?, 0.8, atlas.radius_m());
/// let faces = atlas.faces(&place)?;
/// assert!((faces.p.iter().sum::<f64>() - 1.0).abs() < 1e-12);
/// assert!(faces.error[2] < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    header: Header,
    networks: Vec<Network>,
}

/// Values at which a root is looked for.
const STEPS: u32 = 64;

impl Atlas {
    /// The part of the atlas for a launch.
    ///
    /// # Panics
    /// Never: the tests read all parts.
    pub fn of(launch: Launch) -> Self {
        Self::read(launch.networks()).expect("a part of the atlas can be read")
    }

    /// Reads a file, as `coinmc-studies atlas` writes it.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn read(bytes: &[u8]) -> Result<Self, FileError> {
        let (header, networks) = file::read(bytes)?;
        Ok(Self { header, networks })
    }

    pub(crate) fn new(header: Header, networks: Vec<Network>) -> Self {
        Self { header, networks }
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        file::write(&self.header, &self.networks)
    }

    /// Radius of its coin, m: lengths in metres are for this size.
    pub fn radius_m(&self) -> f64 {
        self.header.radius_m
    }

    /// Tosses that it was made of.
    pub fn tosses(&self) -> u64 {
        self.header.tosses
    }

    /// Coins and surfaces that were tossed.
    pub fn points(&self) -> u64 {
        self.header.points
    }

    /// How far it reaches, in the order of [`Place::NAMES`].
    pub fn axes(&self) -> &[Axis] {
        &self.header.axes
    }

    /// The probabilities for a coin and a surface.
    ///
    /// # Errors
    /// [`AtlasError::Outside`].
    pub fn faces(&self, place: &Place) -> Result<Faces, AtlasError> {
        Ok(self.at(&place.inputs(&self.header.axes, self.header.radius_m)?))
    }

    fn at(&self, coordinates: &[f64]) -> Faces {
        let each: Vec<[f64; 3]> = self.networks.iter().map(|n| n.faces(coordinates)).collect();
        let n = each.len() as f64;
        let p = [0, 1, 2].map(|face| each.iter().map(|faces| faces[face]).sum::<f64>() / n);
        let variance = [0, 1, 2].map(|face| spread(each.iter().map(|faces| faces[face]), p[face]));
        let ErrorModel { factor, typical } = self.header.error;
        let error = [0, 1, 2].map(|face| {
            let usual = typical * p[face] * (1.0 - p[face]);
            (factor * 0.5 * (variance[face] + usual)).sqrt()
        });
        Faces { p, error }
    }

    /// The least ratio of the atlas at which the side has this probability on this surface.
    ///
    /// # Errors
    /// [`AtlasError::Outside`]; the ratio of the place does not matter.
    pub fn root(&self, place: &Place, target: f64) -> Result<Option<Root>, AtlasError> {
        let axis = &self.header.axes[0];
        let with = |ratio: f64| Place { ratio, ..*place };
        let above = |ratio: f64| Ok::<_, AtlasError>(self.faces(&with(ratio))?.p[2] - target);
        let at = |step: u32| axis.from + (axis.to - axis.from) * f64::from(step) / f64::from(STEPS);
        let mut before = above(axis.from)?;
        for step in 1..=STEPS {
            let next = above(at(step))?;
            if (before < 0.0) != (next < 0.0) {
                let (mut low, mut high) = (at(step - 1), at(step));
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    if (above(middle)? < 0.0) == (before < 0.0) {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                let width = at(1) - at(0);
                let slope = (next - before).abs() / width;
                let error = self.faces(&with(low))?.error[2] / slope;
                return Ok(Some(Root { ratio: low, error }));
            }
            before = next;
        }
        Ok(None)
    }
}

/// Variance of the networks' probabilities about their mean.
pub(crate) fn spread(each: impl Iterator<Item = f64> + Clone, mean: f64) -> f64 {
    let n = each.clone().count() as f64;
    each.map(|p| (p - mean) * (p - mean)).sum::<f64>() / (n - 1.0)
}
