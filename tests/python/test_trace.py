"""Traces read back by independent readers: mcap with protobuf and json, pyarrow, csv."""

import csv
import importlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import foxglove_schemas_protobuf
import jsonschema
import pyarrow.parquet as pq
import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from grpc_tools import protoc
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap_protobuf.decoder import DecoderFactory

CONFIG = """
[coin]
ratio = [0.4, 1.2]
radius_m = 0.01
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = 1e-4
pivoting_friction_m = 1e-4
[launch]
preset = "clean"
[engine.volumetric]
[stop]
tosses = 100
"""

RADIUS = 0.01
TOSSES = [(0, 3), (0, 8), (1, 3), (1, 8)]
TOPICS = {
    "/tf": "foxglove.FrameTransform",
    "/pose": "foxglove.PoseInFrame",
    "/scene": "foxglove.SceneUpdate",
    "/toss": "coinmc.Toss",
    "/state": "coinmc.State",
    "/energy": "coinmc.Energy",
    "/mode": "coinmc.Mode",
    "/events": "coinmc.Event",
}


@pytest.fixture(scope="module")
def folder(coinmc, tmp_path_factory):
    """Traces of four tosses in all formats, the MCAP in both encodings and compressions."""
    folder = tmp_path_factory.mktemp("trace")
    (folder / "toss.toml").write_text(CONFIG)
    outs = [part for name in ("csv", "jsonl", "parquet", "mcap") for part in ("-o", f"t.{name}")]
    tosses = ("toss.toml", "--point", "0,1", "--toss", "3,8", "--rate", "300")
    coinmc("trace", *tosses, *outs, cwd=folder)
    coinmc("trace", *tosses, "-o", "lz4.mcap", "--compression", "lz4", cwd=folder)
    json = ("-o", "json.mcap", "--encoding", "json")
    coinmc("trace", *tosses, *json, cwd=folder)
    return folder


@pytest.fixture(scope="module", params=["t.mcap", "lz4.mcap", "json.mcap"])
def mcap(request, folder):
    return folder / request.param


@pytest.fixture(scope="module")
def messages(folder):
    """Every message of the MCAP in JSON: topic, log time, JSON."""
    with (folder / "json.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        return [
            (channel.topic, message.log_time, json.loads(message.data))
            for _, channel, message in reader.iter_messages(log_time_order=False)
        ]


def test_every_message_is_what_its_schema_says(folder):
    validators = {}
    with (folder / "json.mcap").open("rb") as file:
        counted = 0
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert (channel.message_encoding, schema.encoding) == ("json", "jsonschema")
            assert TOPICS[channel.topic] == schema.name
            if schema.id not in validators:
                document = json.loads(schema.data)
                jsonschema.Draft202012Validator.check_schema(document)
                validators[schema.id] = jsonschema.Draft202012Validator(document)
            validators[schema.id].validate(json.loads(message.data))
            counted += 1
        file.seek(0)
        summary = make_reader(file).get_summary()
        assert summary.statistics.message_count == counted > 1000
        assert {channel.topic for channel in summary.channels.values()} == set(TOPICS)


def same(of_json, decoded) -> bool:
    """Whether a value of a message is the same in JSON and as decoded from Protobuf."""
    if isinstance(of_json, dict) and set(of_json) == {"sec", "nsec"}:
        return (of_json["sec"], of_json["nsec"]) == (decoded.seconds, decoded.nanos)
    if isinstance(of_json, dict) and hasattr(decoded, "keys"):
        return of_json.keys() == decoded.keys() and all(
            same(value, decoded[name]) for name, value in of_json.items()
        )
    if isinstance(of_json, dict):
        return all(
            not decoded.HasField(name) if value is None else same(value, getattr(decoded, name))
            for name, value in of_json.items()
        )
    if isinstance(of_json, list):
        return len(of_json) == len(decoded) and all(map(same, of_json, decoded))
    return of_json == decoded


@pytest.mark.parametrize("name", ["t.mcap", "lz4.mcap"])
def test_protobuf_says_the_same_as_json(folder, messages, name):
    with (folder / name).open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        decoded = list(reader.iter_decoded_messages(log_time_order=False))
    assert len(decoded) == len(messages) > 1000
    for (schema, channel, message, found), (topic, time, of_json) in zip(
        decoded, messages, strict=True
    ):
        assert (channel.message_encoding, schema.encoding) == ("protobuf", "protobuf")
        assert (channel.topic, message.log_time) == (topic, time)
        assert schema.name == TOPICS[topic] == found.DESCRIPTOR.full_name
        assert same(of_json, found), (topic, of_json, found)
        # nothing beside what JSON has
        assert {field.name for field, _ in found.ListFields()} <= of_json.keys()


def test_protobuf_schemas_are_those_of_foxglove_and_of_the_sources(folder, root, tmp_path):
    """Field by field: Foxglove's own package for theirs, the compiler of Protobuf for ours."""
    compiled = tmp_path / "trace.bin"
    sources = root / "crates/coinmc-trace/src/schemas"
    arguments = ["", f"-I{sources}", f"--descriptor_set_out={compiled}", "trace.proto"]
    assert protoc.main(arguments) == 0
    ours = FileDescriptorSet.FromString(compiled.read_bytes())
    with (folder / "t.mcap").open("rb") as file:
        schemas = make_reader(file).get_summary().schemas.values()
    assert {schema.name for schema in schemas} == set(TOPICS.values())
    for schema in schemas:
        found = FileDescriptorSet.FromString(schema.data)
        if schema.name.startswith("coinmc."):
            assert found == ours
            continue
        pool = DescriptorPool()
        for described in found.file:
            pool.Add(described)
        message = pool.FindMessageTypeByName(schema.name)
        name = schema.name.removeprefix("foxglove.")
        module = importlib.import_module(f"{foxglove_schemas_protobuf.__name__}.{name}_pb2")
        theirs = getattr(module, name).DESCRIPTOR
        assert fields(message) == fields(theirs)


def fields(message) -> dict:
    """What a message is on the wire: numbers and types of its fields, and of those within."""
    return {
        field.name: (
            field.number,
            field.type,
            field.is_repeated,
            fields(field.message_type) if field.message_type else None,
        )
        for field in message.fields
    }


def test_the_robots_schema_is_that_of_its_source(root, tmp_path):
    compiled = tmp_path / "robot.bin"
    sources = root / "crates/coinmc-robot/src"
    arguments = ["", f"-I{sources}", f"--descriptor_set_out={compiled}", "robot.proto"]
    assert protoc.main(arguments) == 0
    assert (sources / "robot.bin").read_bytes() == compiled.read_bytes()


def test_the_layout_shows_what_is_in_the_file(coinmc, messages):
    """Every topic and field that the viewer's layout names is there."""
    layout = json.loads(coinmc("trace", "layout").stdout)
    shown = set(re.findall(r'"(/[a-z_.]+)"', json.dumps(layout)))
    there = {}
    for topic, _, message in messages:
        there.setdefault(topic, message)
    assert {path.partition(".")[0] for path in shown} <= set(TOPICS)
    for path in shown:
        topic, _, field = path.partition(".")
        assert not field or field in there[topic], path
    panels = set(re.findall(r'"([A-Za-z0-9]+![a-z]+)"', json.dumps(layout["layout"])))
    assert panels == set(layout["configById"])


def test_rerun_shows_the_pose(folder, messages, tmp_path):
    beside = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    tool = shutil.which("rerun", path=beside)
    if tool is None:
        pytest.skip("the command `rerun` is not installed (pip install rerun-sdk)")
    recording = tmp_path / "t.rrd"
    convert = [tool, "mcap", "convert", folder / "t.mcap", "-o", recording]
    subprocess.run(convert, check=True, capture_output=True)
    printed = [tool, "rrd", "print", recording]
    told = subprocess.run(printed, check=True, capture_output=True, text=True).stdout

    def rows(entity, component) -> int:
        """Rows that Rerun has of a component that it draws."""
        found = re.findall(rf"with (\d+) rows .* - {entity} - .*\b{component}\b", told)
        return sum(map(int, found))

    records = sum(topic == "/tf" for topic, _, _ in messages)
    assert rows("/tf", "Transform3D:translation") == records > 500
    assert rows("/pose", "InstancePoses3D:quaternions") == records


def test_every_record_can_be_read_front_to_back(mcap):
    with mcap.open("rb") as file:
        records = list(StreamReader(file, emit_chunks=False, validate_crcs=True).records)
    assert len(records) > 1000


def test_times_never_run_backwards(messages):
    for topic in TOPICS:
        times = [time for name, time, _ in messages if name == topic]
        assert times
        assert all(a <= b for a, b in pairwise(times)), topic


def test_a_transforms_own_time_is_its_log_time(messages):
    for topic, time, message in messages:
        if topic == "/tf":
            stamp = message["timestamp"]
            assert stamp["sec"] * 1_000_000_000 + stamp["nsec"] == time
            assert (message["parent_frame_id"], message["child_frame_id"]) == ("world", "coin")


def lowest(transform, height):
    """Lowest point of the cylinder as the transform places it."""
    q = transform["rotation"]
    x, y, z, w = (q[name] for name in "xyzw")
    # the heights of the body's unit vectors: the last row of the rotation's matrix
    ex, ey, ez = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    return transform["translation"]["z"] - height / 2 * abs(ez) - RADIUS * math.hypot(ex, ey)


def test_at_an_impact_the_transform_puts_the_rim_on_the_plane(messages):
    transform, height, impacts = None, None, 0
    for topic, time, message in messages:
        if topic == "/toss":
            height = message["parameters"]["ratio"] * RADIUS
        elif topic == "/tf":
            transform = time, message
        elif topic == "/events" and message["kind"] in ("touching", "impact"):
            assert transform[0] == time
            assert abs(lowest(transform[1], height)) < 1e-9
            assert abs(message["contact_m"][2]) < 1e-9
            impacts += 1
    assert impacts > 20


def test_the_scene_has_coin_ground_and_a_mark_at_each_impact(messages):
    tosses, marks, impacts = 0, 0, 0
    for topic, _, message in messages:
        if topic == "/scene":
            for entity in message["entities"]:
                marks += entity["id"].startswith("impact-")
                if entity["id"] == "coin":
                    tosses += 1
                    assert entity["frame_id"] == "coin"
                    assert entity["cylinders"][0]["size"]["x"] == 2 * RADIUS
        elif topic == "/events":
            impacts += message["kind"] == "impact"
    assert tosses == len(TOSSES)
    assert marks == impacts > 0


def test_the_metadata_tells_the_run_and_every_toss(mcap, coinmc, folder):
    with mcap.open("rb") as file:
        metadata = {record.name: record.metadata for record in make_reader(file).iter_metadata()}
    about = metadata["coinmc"]
    plan = json.loads(coinmc("check", "toss.toml", "--format", "json", cwd=folder).stdout)
    assert about["plan_hash"] == plan["plan_hash"]
    assert about["config"] == plan["resolved_config"]
    assert about["trace_format"] == "1"
    for point, toss in TOSSES:
        told = metadata[f"toss {point}/{toss}"]
        assert json.loads(told["outcome"])["ended"] == "decided"
        assert json.loads(told["launch"])["height_m"] > 0


def rows(folder):
    table = pq.read_table(folder / "t.parquet").to_pylist()
    with (folder / "t.csv").open(newline="") as file:
        cells = list(csv.DictReader(file))
    lines = [json.loads(line) for line in (folder / "t.jsonl").open()]
    return table, cells, [line for line in lines if line["type"] == "record"]


def test_all_formats_say_the_same(folder, messages):
    table, cells, lines = rows(folder)
    states = [message for topic, _, message in messages if topic == "/state"]
    assert len(table) == len(cells) == len(lines) == len(states) > 500
    for row, cell, line, state in zip(table, cells, lines, states, strict=True):
        assert list(row) == list(cell)
        del line["type"]
        assert row == line == state
        assert {name: type(value)(cell[name]) for name, value in row.items()} == row


def test_columns_have_units_and_the_file_its_run(folder):
    schema = pq.read_schema(folder / "t.parquet")
    for field in schema:
        assert field.metadata[b"description"], field
        assert str(field.type) == "string" or field.metadata[b"unit"], field
    metadata = pq.read_metadata(folder / "t.parquet").metadata
    tosses = json.loads(metadata[b"coinmc.tosses"])
    assert [(toss["point"], toss["toss"]) for toss in tosses] == TOSSES
    assert pq.ParquetFile(folder / "t.parquet").num_row_groups == len(TOSSES)


def test_the_outcomes_are_those_of_the_run(folder, coinmc):
    """Every toss of a point, replayed: together the counts of the run."""
    out = ("--set", "stop.tosses=40", "--set", "coin.ratio=1.2", "--format", "json", "--quiet")
    run = json.loads(coinmc("run", "toss.toml", *out, cwd=folder).stdout)["rows"][0]
    every = ",".join(map(str, range(40)))
    done = coinmc("trace", "toss.toml", "--toss", every, "--rate", "0", *out, cwd=folder)
    outcomes = [toss["outcome"] for toss in json.loads(done.stdout)["tosses"]]
    for face in ("heads", "tails", "side"):
        assert sum(outcome["face"] == face for outcome in outcomes) == run[face]
    assert sum(outcome["impacts"] for outcome in outcomes) == run["impacts_per_toss"] * 40


def test_what_is_left_of_a_file_is_recovered(folder, coinmc, tmp_path):
    whole = (folder / "lz4.mcap").read_bytes()
    torn, anew = tmp_path / "torn.mcap", tmp_path / "anew.mcap"
    torn.write_bytes(whole[: len(whole) * 2 // 3])
    done = coinmc("trace", "recover", torn, "-o", anew, "--format", "json")
    report = json.loads(done.stdout)
    with anew.open("rb") as file:
        found = sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages())
    assert report["messages"] == found
    assert not report["had_end"]


def test_the_mcap_tools_find_nothing_wrong(mcap):
    tool = shutil.which("mcap")
    if tool is None:
        pytest.skip("the command `mcap` is not installed (see https://mcap.dev/guides/cli)")
    subprocess.run([tool, "doctor", mcap], check=True)


def test_the_foxglove_schemas_are_whole(root):
    """Every schema beside the sources is one."""
    for path in sorted((root / "crates/coinmc-recording/schemas").glob("*.json")):
        document = json.loads(path.read_text())
        jsonschema.Draft202012Validator.check_schema(document)
        assert document["title"] == f"foxglove.{path.stem}"
