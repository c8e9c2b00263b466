//! Traces as MCAP, for viewers and for programs in any language.
//!
//! Several tosses share a file and its topics, each starting a second after the end of the previous
//! one, so that a viewer plays them in sequence.

use crate::record::{Mode, Record, RecordKind};
use crate::scene::{self, COIN, WORLD, contact_m, vector};
use crate::table::FORMAT;
use crate::trace::Trace;
use crate::{table, to_json};
use coinmc::plan::Plan;
use coinmc_core::{EventKind, Scene, State};
use coinmc_recording::foxglove::{
    FrameTransform, Pose, PoseInFrame, Quaternion, SceneUpdate, Time,
};
use coinmc_recording::{
    Channel, Compression, Encoding, Error, Options, Recorder, Schema, Unsynced,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;

/// A layout for Lichtblick and Foxglove that shows a trace's MCAP: the coin, its height and energy, its
/// mode and its events.
pub const LAYOUT: &str = include_str!("layout.json");

/// Log time of the first launch, and the pause between tosses, ns.
const PAUSE_NS: u64 = 1_000_000_000;

/// coinmc's own messages, from `schemas/trace.proto`.
const PROTOBUF: &[u8] = include_bytes!("schemas/trace.bin");

/// The channels of a file.
struct Channels {
    transforms: Channel<FrameTransform>,
    poses: Channel<PoseInFrame>,
    scene: Channel<SceneUpdate>,
    tosses: Channel<Value>,
    states: Channel<Value>,
    energies: Channel<Value>,
    modes: Channel<Value>,
    events: Channel<Value>,
}

/// Writes traces. The same traces give the same bytes.
///
/// # Errors
/// Errors of `out`.
pub fn write_mcap(
    plan: &Plan,
    traces: &[Trace],
    encoding: Encoding,
    compression: Compression,
    out: impl Write,
) -> Result<(), Error> {
    let options = Options {
        profile: String::new(),
        library: format!("coinmc {}", env!("CARGO_PKG_VERSION")),
        compression,
        encoding,
    };
    let mut recorder = Recorder::new(Unsynced(out), &options)?;
    recorder.metadata("coinmc", &file_metadata(plan))?;
    let channels = Channels::open(&mut recorder)?;
    let mut start = PAUSE_NS;
    for trace in traces {
        let end = write_toss(&mut recorder, &channels, plan, trace, start)?;
        start = end.saturating_add(PAUSE_NS);
    }
    for trace in traces {
        let name = format!("toss {}/{}", trace.point, trace.toss);
        recorder.metadata(&name, &values(&trace.to_json(plan)))?;
    }
    recorder.finish().map(drop)
}

impl Channels {
    fn open<W: Write>(recorder: &mut Recorder<Unsynced<W>>) -> Result<Self, Error> {
        let own = |name, json: &'static str| Schema::new(name, json, PROTOBUF);
        Ok(Self {
            tosses: recorder.channel(
                "/toss",
                &own("coinmc.Toss", include_str!("schemas/Toss.json")),
            )?,
            transforms: recorder.channel("/tf", &Schema::FRAME_TRANSFORM)?,
            poses: recorder.channel("/pose", &Schema::POSE_IN_FRAME)?,
            scene: recorder.channel("/scene", &Schema::SCENE_UPDATE)?,
            states: recorder.channel(
                "/state",
                &own("coinmc.State", include_str!("schemas/State.json")),
            )?,
            energies: recorder.channel(
                "/energy",
                &own("coinmc.Energy", include_str!("schemas/Energy.json")),
            )?,
            modes: recorder.channel(
                "/mode",
                &own("coinmc.Mode", include_str!("schemas/Mode.json")),
            )?,
            events: recorder.channel(
                "/events",
                &own("coinmc.Event", include_str!("schemas/Event.json")),
            )?,
        })
    }
}

/// Writes a toss that begins at `start`, ns; returns its end.
fn write_toss<W: Write>(
    recorder: &mut Recorder<Unsynced<W>>,
    channels: &Channels,
    plan: &Plan,
    trace: &Trace,
    start: u64,
) -> Result<u64, Error> {
    let mut toss = trace.to_json(plan);
    toss["begins_ns"] = json!(start);
    recorder.write(&channels.tosses, start, &toss)?;
    let initial = scene::initial(trace, Time::from_ns(start));
    recorder.write(&channels.scene, start, &initial)?;
    let (mut impacts, mut mode, mut now) = (0, None, start);
    for row in table::rows(std::slice::from_ref(trace)) {
        let record = row.record;
        // times within a toss never decrease, despite rounding
        now = now.max(start.saturating_add(nanoseconds(record.state.time_s)));
        if is_finite(record) {
            recorder.write(&channels.transforms, now, &transform(record, now))?;
            recorder.write(&channels.poses, now, &pose(record, now))?;
        }
        recorder.write(&channels.states, now, &to_json::record(&row).into())?;
        recorder.write(&channels.energies, now, &energy(trace, record))?;
        if mode.replace(record.mode) != Some(record.mode) {
            recorder.write(&channels.modes, now, &mode_message(trace, record))?;
        }
        if let RecordKind::Event(kind) = record.kind {
            if scene::is_impact(record) {
                impacts += 1;
                let mark = scene::mark(trace, record, impacts, Time::from_ns(now));
                recorder.write(&channels.scene, now, &mark)?;
            }
            recorder.write(&channels.events, now, &event(trace, record, kind, impacts))?;
        }
    }
    Ok(now)
}

/// Whether position and orientation are finite; those of a failed toss may be NaN, which viewers
/// cannot draw.
fn is_finite(record: &Record) -> bool {
    let place = record.state.position_m.iter();
    place
        .chain(record.orientation.coords.iter())
        .all(|x| x.is_finite())
}

fn transform(record: &Record, now: u64) -> FrameTransform {
    FrameTransform {
        timestamp: Time::from_ns(now),
        parent_frame_id: WORLD.to_owned(),
        child_frame_id: COIN.to_owned(),
        translation: vector(&record.state.position_m),
        rotation: quaternion(record),
    }
}

/// The same, for viewers without frames.
fn pose(record: &Record, now: u64) -> PoseInFrame {
    PoseInFrame {
        timestamp: Time::from_ns(now),
        frame_id: WORLD.to_owned(),
        pose: Pose {
            position: vector(&record.state.position_m),
            orientation: quaternion(record),
        },
    }
}

fn quaternion(record: &Record) -> Quaternion {
    let q = record.orientation;
    Quaternion {
        x: q.i,
        y: q.j,
        z: q.k,
        w: q.w,
    }
}

fn energy(trace: &Trace, record: &Record) -> Value {
    let (scene, state) = (&trace.scene, &record.state);
    json!({
        "point": trace.point,
        "toss": trace.toss,
        "time_s": state.time_s,
        "total_j_kg": record.energy_j_kg,
        "potential_j_kg": state.potential_j_kg(scene),
        "translation_j_kg": 0.5 * state.velocity_m_s.norm_squared(),
        "rotation_j_kg": rotation_j_kg(scene, state),
    })
}

fn rotation_j_kg(scene: &Scene, state: &State) -> f64 {
    let axial = state.spin_rad_s.dot(&state.axis);
    let across = (state.spin_rad_s - state.axis.into_inner() * axial).norm_squared();
    let coin = &scene.coin;
    0.5 * (coin.axial_gyration_m2() * axial * axial + coin.transverse_gyration_m2() * across)
}

fn mode_message(trace: &Trace, record: &Record) -> Value {
    json!({
        "point": trace.point,
        "toss": trace.toss,
        "time_s": record.state.time_s,
        "mode": record.mode.name(),
        "code": Mode::ALL.iter().position(|mode| *mode == record.mode),
    })
}

fn event(trace: &Trace, record: &Record, kind: EventKind, impacts: u64) -> Value {
    let state = &record.state;
    json!({
        "point": trace.point,
        "toss": trace.toss,
        "time_s": state.time_s,
        "kind": RecordKind::Event(kind).name(),
        "impact": impacts,
        "position_m": to_json::vector(&state.position_m),
        "contact_m": to_json::vector(&contact_m(&trace.scene.coin, state)),
        "velocity_m_s": to_json::vector(&state.velocity_m_s),
        "spin_rad_s": to_json::vector(&state.spin_rad_s),
        "energy_j_kg": record.energy_j_kg,
    })
}

/// Metadata of the file.
fn file_metadata(plan: &Plan) -> BTreeMap<String, String> {
    let pairs = [
        ("trace_format", FORMAT.to_string()),
        ("program_version", env!("CARGO_PKG_VERSION").to_owned()),
        ("plan_hash", plan.hash()),
        ("config", plan.resolved_toml.clone()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

/// The entries of an object as texts, because metadata can only hold text.
fn values(object: &Value) -> BTreeMap<String, String> {
    let entries = object.as_object().into_iter().flatten();
    entries
        .map(|(key, value)| match value {
            Value::String(text) => (key.clone(), text.clone()),
            other => (key.clone(), other.to_string()),
        })
        .collect()
}

/// The nearest whole nanosecond; 0 for NaN.
fn nanoseconds(time_s: f64) -> u64 {
    // the cast saturates
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let ns = libm::round(time_s * 1e9) as u64;
    ns
}
