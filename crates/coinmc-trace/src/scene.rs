//! The scene that viewers draw: the coin, the ground and a mark at each impact.

use crate::record::{Record, RecordKind};
use crate::trace::Trace;
use coinmc_core::{Coin, EventKind, State};
use coinmc_recording::foxglove::{
    Color, CubePrimitive, CylinderPrimitive, Pose, SceneEntity, SceneEntityDeletion, SceneUpdate,
    SpherePrimitive, Time, Vector3,
};
use nalgebra::Vector3 as Vector;

/// Frames of reference.
pub(super) const WORLD: &str = "world";
pub(super) const COIN: &str = "coin";

const BODY: [f64; 4] = [0.55, 0.53, 0.5, 1.0];
/// As in SVG pictures: two colours that colour-blind readers can distinguish.
const HEADS: [f64; 4] = [0.0, 0.447, 0.698, 1.0];
const TAILS: [f64; 4] = [0.835, 0.369, 0.0, 1.0];
const GROUND: [f64; 4] = [0.8, 0.8, 0.8, 0.6];
const MARK: [f64; 4] = [0.84, 0.15, 0.16, 0.9];

/// Thickness of the paint on the coin, relative to its height.
const PAINT: f64 = 0.02;

/// The coin's lowest point, m; if a whole face or line is lowest, its middle.
pub(super) fn contact_m(coin: &Coin, state: &State) -> Vector<f64> {
    state.position_m + coin.lowest_point_m(&state.axis)
}

/// The scene of a toss that begins at `start`, which replaces that of an earlier toss.
pub(super) fn initial(trace: &Trace, start: Time) -> SceneUpdate {
    SceneUpdate {
        deletions: vec![SceneEntityDeletion {
            timestamp: start,
            r#type: 1,
            id: String::new(),
        }],
        entities: vec![coin(&trace.scene.coin, start), ground(trace, start)],
    }
}

/// A mark at an impact.
pub(super) fn mark(trace: &Trace, record: &Record, number: u64, at: Time) -> SceneUpdate {
    let size = 0.12 * trace.scene.coin.rim_distance_m();
    let place = contact_m(&trace.scene.coin, &record.state);
    let mut entity = SceneEntity::new(at, WORLD, format!("impact-{number}"));
    entity.spheres.push(SpherePrimitive {
        pose: Pose::at(vector(&place)),
        size: Vector3::new(size, size, size),
        color: Color::new(MARK),
    });
    SceneUpdate {
        deletions: Vec::new(),
        entities: vec![entity],
    }
}

/// A cylinder, or the frustum of a cone, with painted faces, and a dash on heads that shows its rotation.
fn coin(coin: &Coin, at: Time) -> SceneEntity {
    let (radius, height) = (coin.radius_m(), coin.height_m());
    let [heads, tails] = coin.outer_rims();
    let (above, below) = (heads.distance_m, tails.distance_m);
    let (heads, tails) = (heads.radius_m, tails.radius_m);
    let cylinder = |z: f64, radius: f64, height: f64, color| CylinderPrimitive {
        pose: Pose::at(Vector3::new(0.0, 0.0, z)),
        size: Vector3::new(2.0 * radius, 2.0 * radius, height),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Color::new(color),
    };
    let body = CylinderPrimitive {
        bottom_scale: tails / radius,
        top_scale: heads / radius,
        ..cylinder(0.5 * (above - below), radius, height, BODY)
    };
    let mut entity = SceneEntity::new(at, COIN, "coin");
    let paint = PAINT * height;
    entity.cylinders = vec![
        body,
        cylinder(above, 0.9 * heads, paint, HEADS),
        cylinder(-below, 0.9 * tails, paint, TAILS),
    ];
    entity.cubes.push(CubePrimitive {
        pose: Pose::at(Vector3::new(0.6 * heads, 0.0, above)),
        size: Vector3::new(0.5 * heads, 0.08 * heads, 2.0 * paint),
        color: Color::new(BODY),
    });
    entity
}

/// A slab below the whole toss, whose upper face is the surface.
fn ground(trace: &Trace, at: Time) -> SceneEntity {
    let rim = trace.scene.coin.rim_distance_m();
    let places = || trace.records.iter().map(|record| record.state.position_m);
    let reach = |axis: usize| {
        let (mut from, mut to) = (0.0_f64, 0.0_f64);
        for place in places().filter(|place| place[axis].is_finite()) {
            (from, to) = (from.min(place[axis]), to.max(place[axis]));
        }
        (0.5 * (from + to), to - from + 8.0 * rim)
    };
    let ((x, width), (y, depth)) = (reach(0), reach(1));
    let thickness = 0.1 * rim;
    let mut entity = SceneEntity::new(at, WORLD, "ground");
    entity.cubes.push(CubePrimitive {
        pose: Pose::at(Vector3::new(x, y, -0.5 * thickness)),
        size: Vector3::new(width, depth, thickness),
        color: Color::new(GROUND),
    });
    entity
}

pub(super) fn vector(v: &Vector<f64>) -> Vector3 {
    Vector3::new(v.x, v.y, v.z)
}

/// Whether a record is an impact, which gets a mark.
pub(super) fn is_impact(record: &Record) -> bool {
    record.kind == RecordKind::Event(EventKind::Impact)
}
