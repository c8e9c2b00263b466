//! A launch's part of the atlas as a file: one line of JSON, then all numbers of the networks, single precision,
//! little-endian, network by network and layer by layer (weights row by row, then biases).

use crate::network::Network;
use crate::{Axis, FileError, Place};
use serde::{Deserialize, Serialize};

/// Version of the format.
const FORMAT: u32 = 2;
/// Largest sizes that are read.
const MOST_UNITS: usize = 1024;
const MOST_LAYERS: usize = 8;
const MOST_NETWORKS: usize = 64;

/// What the first line says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Header {
    /// Version of the format.
    pub(crate) atlas_format: u32,
    /// The launch.
    pub(crate) launch: String,
    /// Hashes of the plans whose tosses they were fitted to.
    pub(crate) plans: Vec<String>,
    /// Radius of the coin, m.
    pub(crate) radius_m: f64,
    /// Points and tosses of the design, and how many of these showed no face.
    pub(crate) points: u64,
    pub(crate) tosses: u64,
    pub(crate) undecided: u64,
    /// What the inputs are, but for the last one, the lean.
    pub(crate) axes: Vec<Axis>,
    /// Units of each hidden layer.
    pub(crate) hidden: Vec<usize>,
    /// How many networks.
    pub(crate) networks: usize,
    /// How the error of an answer follows from how far the networks differ: see `ensemble`.
    pub(crate) error: ErrorModel,
}

/// The error of a probability p: its variance is `factor` times the mean of the networks' variance there and
/// of `typical` p(1 - p).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct ErrorModel {
    pub(crate) factor: f64,
    pub(crate) typical: f64,
}

/// The bytes of a file.
pub(crate) fn write(header: &Header, networks: &[Network]) -> Vec<u8> {
    let mut bytes = serde_json::to_vec(header).expect("names and numbers");
    bytes.push(b'\n');
    let numbers = networks.iter().flat_map(Network::numbers);
    bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
    bytes
}

impl Header {
    pub(crate) fn new(launch: &str, plans: Vec<String>, radius_m: f64, axes: Vec<Axis>) -> Self {
        Self {
            atlas_format: FORMAT,
            launch: launch.to_owned(),
            plans,
            radius_m,
            points: 0,
            tosses: 0,
            undecided: 0,
            axes,
            hidden: vec![],
            networks: 0,
            error: ErrorModel {
                factor: 0.0,
                typical: 0.0,
            },
        }
    }
}

/// Reads a file.
pub(crate) fn read(bytes: &[u8]) -> Result<(Header, Vec<Network>), FileError> {
    let end = bytes.iter().position(|byte| *byte == b'\n');
    let (line, rest) = bytes.split_at(end.ok_or(FileError::Short)?);
    let header: Header = serde_json::from_slice(line)?;
    if header.atlas_format != FORMAT {
        return Err(FileError::Version(header.atlas_format));
    }
    let possible = |units: &usize| (1..=MOST_UNITS).contains(units);
    let sound = header.hidden.len() <= MOST_LAYERS
        && (1..=MOST_NETWORKS).contains(&header.networks)
        && header.hidden.iter().all(possible);
    if !sound {
        return Err(FileError::Sizes);
    }
    let axes = header.axes.iter().map(|axis| axis.name.as_str());
    if !axes.eq(Place::NAMES) {
        return Err(FileError::Axes);
    }
    let (words, odd) = rest[1..].as_chunks::<4>();
    let mut numbers = words.iter().map(|word| f32::from_le_bytes(*word));
    let mut networks = Vec::new();
    for _ in 0..header.networks {
        let mut network = Network::zero(header.axes.len() + 1, &header.hidden);
        network.set(&mut numbers)?;
        networks.push(network);
    }
    if numbers.next().is_some() || !odd.is_empty() {
        return Err(FileError::Long);
    }
    Ok((header, networks))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> (Header, Vec<Network>) {
        let axes = Place::NAMES.map(|name| Axis {
            name: name.to_owned(),
            from: 0.1,
            to: 2.0,
            log: false,
        });
        let mut header = Header::new("hand", vec!["abc".to_owned()], 0.01, axes.into());
        (header.hidden, header.networks) = (vec![3], 2);
        let mut networks = vec![Network::zero(8, &[3]); 2];
        let mut numbers = (0..70_u8).map(f32::from);
        for network in &mut networks {
            network.set(&mut numbers).unwrap();
        }
        (header, networks)
    }

    #[test]
    fn a_file_is_read_as_it_was_written() {
        let (header, networks) = file();
        assert_eq!(
            read(&write(&header, &networks)).unwrap(),
            (header, networks)
        );
    }

    #[test]
    fn files_that_are_none_are_refused() {
        let (header, networks) = file();
        let bytes = write(&header, &networks);
        for cut in 0..bytes.len() {
            assert!(read(&bytes[..cut]).is_err(), "{cut} bytes");
        }
        assert!(matches!(
            read(&[&bytes[..], &[0]].concat()),
            Err(FileError::Long)
        ));
        let of = |change: &dyn Fn(&mut Header)| {
            let mut header = header.clone();
            change(&mut header);
            read(&write(&header, &networks))
        };
        assert!(matches!(
            of(&|h| h.atlas_format = 1),
            Err(FileError::Version(1))
        ));
        for change in [
            &(|h: &mut Header| h.networks = usize::MAX) as &dyn Fn(&mut Header),
            &|h| h.networks = 0,
            &|h| h.hidden = vec![usize::MAX],
            &|h| h.hidden = vec![1; 9],
        ] {
            assert!(matches!(of(change), Err(FileError::Sizes)));
        }
        for change in [
            &(|h: &mut Header| h.axes.clear()) as &dyn Fn(&mut Header),
            &|h| h.axes.truncate(5),
            &|h| h.axes.swap(0, 1),
        ] {
            assert!(matches!(of(change), Err(FileError::Axes)));
        }
    }
}
