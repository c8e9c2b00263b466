//! The trace seen from the side: its records projected onto a vertical plane.

use crate::record::{Mode, Record, RecordKind};
use crate::trace::Trace;
use coinmc_core::{Coin, EventKind};
use nalgebra::Vector3;

/// The plane of the picture: `right` points right, z points up, and the eye looks along z × right.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    right: Vector3<f64>,
}

/// A record in the plane of the picture. Lengths in metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shot {
    pub(super) time_s: f64,
    pub(super) kind: RecordKind,
    pub(super) mode: Mode,
    pub(super) x: f64,
    pub(super) z: f64,
    /// u: to the right, up, and towards the eye.
    pub(super) axis: [f64; 3],
    /// Position of the coin's lowest point along x.
    pub(super) foot: f64,
    /// Downward speed of this point, m/s.
    pub(super) approach_m_s: f64,
}

impl View {
    /// The plane through the displacement from the start to the end; if it is almost zero, through
    /// the first velocity, or else through the direction in which the coin leans.
    pub(super) fn of(trace: &Trace) -> Self {
        let finite = |record: &&Record| is_finite(record);
        let mut records = trace.records.iter().filter(finite);
        let first = records.next();
        let last = records.next_back().or(first);
        let coin = trace.scene.coin.rim_distance_m();
        let candidates = first.zip(last).map(|(first, last)| {
            let (a, b) = (&first.state, &last.state);
            // candidates, with the distance that each would move or tilt the coin
            let fall = trace.scene.time_scale_s();
            [
                b.position_m - a.position_m,
                a.velocity_m_s * fall,
                a.axis.into_inner() * coin,
                b.axis.into_inner() * coin,
            ]
        });
        let right = candidates
            .into_iter()
            .flatten()
            .map(|along| Vector3::new(along.x, along.y, 0.0))
            .find(|along| along.norm() > 0.5 * coin)
            .map_or(Vector3::x(), |along| along.normalize());
        Self { right }
    }

    /// The records without NaN.
    pub(super) fn shots(&self, trace: &Trace) -> Vec<Shot> {
        let coin = &trace.scene.coin;
        trace
            .records
            .iter()
            .filter(|record| is_finite(record))
            .map(|record| self.shot(coin, record))
            .collect()
    }

    fn shot(&self, coin: &Coin, record: &Record) -> Shot {
        let state = &record.state;
        let (position, u) = (state.position_m, state.axis.into_inner());
        let towards = self.right.cross(&Vector3::z());
        let foot = coin.lowest_point_m(&u);
        let velocity = state.velocity_m_s + state.spin_rad_s.cross(&foot);
        Shot {
            time_s: state.time_s,
            kind: record.kind,
            mode: record.mode,
            x: position.dot(&self.right),
            z: position.z,
            axis: [u.dot(&self.right), u.z, u.dot(&towards)],
            foot: (position + foot).dot(&self.right),
            approach_m_s: -velocity.z,
        }
    }
}

impl Shot {
    pub(super) fn is_sample(&self) -> bool {
        self.kind == RecordKind::Sample
    }

    pub(super) fn is_impact(&self) -> bool {
        self.kind == RecordKind::Event(EventKind::Touching)
    }
}

fn is_finite(record: &Record) -> bool {
    let state = &record.state;
    [
        state.position_m,
        state.velocity_m_s,
        state.axis.into_inner(),
        state.spin_rad_s,
    ]
    .iter()
    .flatten()
    .chain([&state.time_s])
    .all(|number| number.is_finite())
}
