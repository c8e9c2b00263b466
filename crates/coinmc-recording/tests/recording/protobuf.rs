//! Messages as Protocol Buffers, and schemas that do not describe them.

use crate::common::transform;
use coinmc_recording::foxglove::{
    Color, CompressedImage, CubePrimitive, FrameTransform, Log, LogLevel, Pose, SceneEntity,
    SceneEntityDeletion, SceneUpdate, Time, Vector3,
};
use coinmc_recording::{Error, Options, Recorder, Schema, SchemaError, Unsynced};
use prost_reflect::{DescriptorPool, DynamicMessage, Value as Field};
use serde::Serialize;
use serde_json::{Value, json};

/// The message, written to a recording and decoded by the schema in it.
fn read_back<T: Serialize>(schema: &Schema, message: &T) -> DynamicMessage {
    let mut recorder = Recorder::new(Unsynced(Vec::new()), &Options::default()).unwrap();
    let channel = recorder.channel::<T>("/topic", schema).unwrap();
    recorder.write(&channel, 0, message).unwrap();
    let bytes = recorder.finish().unwrap().0;
    let read = mcap::MessageStream::new(&bytes).unwrap().next().unwrap();
    let read = read.unwrap();
    assert_eq!(read.channel.message_encoding, "protobuf");
    let schema = read.channel.schema.as_ref().unwrap();
    assert_eq!(schema.encoding, "protobuf");
    let pool = DescriptorPool::decode(&*schema.data).unwrap();
    let name = pool.get_message_by_name(&schema.name).unwrap();
    DynamicMessage::decode(name, &*read.data).unwrap()
}

/// The field at a path of names.
fn at<'a>(message: &'a DynamicMessage, path: &str) -> std::borrow::Cow<'a, Field> {
    match path.split_once('.') {
        None => message.get_field_by_name(path).unwrap(),
        Some((name, rest)) => {
            let inner = message.get_field_by_name(name).unwrap();
            let inner = match &*inner {
                Field::List(items) => items[0].as_message().unwrap().clone(),
                other => other.as_message().unwrap().clone(),
            };
            std::borrow::Cow::Owned(at(&inner, rest).into_owned())
        }
    }
}

#[test]
fn a_transform_has_all_its_numbers() {
    let read = read_back::<FrameTransform>(&Schema::FRAME_TRANSFORM, &transform(1_234_567_890));
    assert_eq!(*at(&read, "timestamp.seconds"), Field::I64(1));
    assert_eq!(*at(&read, "timestamp.nanos"), Field::I32(234_567_890));
    assert_eq!(*at(&read, "child_frame_id"), Field::String("coin".into()));
    assert_eq!(*at(&read, "translation.z"), Field::F64(1.0 / 3.0));
    assert_eq!(*at(&read, "rotation.w"), Field::F64(1.0));
}

#[test]
fn enumerations_bytes_and_lists_are_those_of_the_schema() {
    let log = Log {
        timestamp: Time::from_ns(5),
        level: LogLevel::Error,
        message: "µ".to_owned(),
        name: String::new(),
        file: String::new(),
        line: 7,
    };
    let read = read_back(&Schema::LOG, &log);
    assert_eq!(*at(&read, "level"), Field::EnumNumber(4));
    assert_eq!(*at(&read, "line"), Field::U32(7));

    let data: Vec<u8> = (0..=255).collect();
    let image = CompressedImage {
        timestamp: Time::from_ns(5),
        frame_id: "camera".to_owned(),
        data: data.clone(),
        format: "png".to_owned(),
    };
    let read = read_back(&Schema::COMPRESSED_IMAGE, &image);
    assert_eq!(*at(&read, "data"), Field::Bytes(data.into()));

    let mut entity = SceneEntity::new(Time::from_ns(5), "world", "ground");
    entity.cubes.push(CubePrimitive {
        pose: Pose::at(Vector3::new(1.0, 2.0, 3.0)),
        size: Vector3::new(4.0, 5.0, 6.0),
        color: Color::new([0.5; 4]),
    });
    let update = SceneUpdate {
        deletions: vec![SceneEntityDeletion {
            timestamp: Time::from_ns(5),
            r#type: 1,
            id: String::new(),
        }],
        entities: vec![entity],
    };
    let read = read_back(&Schema::SCENE_UPDATE, &update);
    assert_eq!(*at(&read, "deletions.type"), Field::EnumNumber(1));
    assert_eq!(*at(&read, "entities.frame_locked"), Field::Bool(true));
    assert_eq!(*at(&read, "entities.cubes.size.y"), Field::F64(5.0));
}

/// Numbers that JSON cannot hold are absent, as everything that is `null`.
#[test]
fn what_is_not_finite_is_absent() {
    let mut broken = transform(0);
    broken.translation.x = f64::NAN;
    let read = read_back(&Schema::FRAME_TRANSFORM, &broken);
    let translation = at(&read, "translation").into_owned();
    assert!(!translation.as_message().unwrap().has_field_by_name("x"));
    assert!(translation.as_message().unwrap().has_field_by_name("z"));
}

#[test]
fn schemas_that_do_not_describe_a_message_are_rejected() {
    let problem = |schema: &Schema, message: Value| {
        let mut recorder = Recorder::new(Unsynced(Vec::new()), &Options::default()).unwrap();
        let written = recorder
            .channel::<Value>("/topic", schema)
            .and_then(|channel| recorder.write(&channel, 0, &message));
        match written {
            Err(Error::Schema { topic, source }) => {
                assert_eq!(topic, "/topic");
                source
            }
            other => panic!("{other:?}"),
        }
    };
    let log = &Schema::LOG;
    let unknown = problem(log, json!({ "massage": "tossed" }));
    assert!(matches!(unknown, SchemaError::NoField { field, .. } if field == "massage"));
    for wrong in [
        json!({ "line": -1 }),
        json!({ "line": 1_u64 << 32 }),
        json!({ "line": "7" }),
        json!({ "level": "error" }),
        json!({ "timestamp": 5 }),
    ] {
        let wrong = problem(log, wrong);
        assert!(matches!(wrong, SchemaError::Type { .. }), "{wrong}");
    }
    let garbage = Schema::new("a.B", "{}", b"\xff\xff\xff\xff\x01");
    assert!(matches!(
        problem(&garbage, json!({})),
        SchemaError::NoDescriptors(_)
    ));
    let other = Schema {
        name: "foxglove.Grid".into(),
        ..Schema::LOG
    };
    assert!(matches!(
        problem(&other, json!({})),
        SchemaError::NoMessage(_)
    ));
}
