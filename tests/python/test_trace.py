"""Traces read back by independent readers: mcap, pyarrow, csv, json; schemas validated."""

import csv
import json
import math
import shutil
import subprocess
from itertools import pairwise

import jsonschema
import pyarrow.parquet as pq
import pytest
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader

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
    "/scene": "foxglove.SceneUpdate",
    "/toss": "coinmc.Toss",
    "/state": "coinmc.State",
    "/energy": "coinmc.Energy",
    "/mode": "coinmc.Mode",
    "/events": "coinmc.Event",
}


@pytest.fixture(scope="module")
def folder(coinmc, tmp_path_factory):
    """Traces of four tosses in all formats, the MCAP in both compressions."""
    folder = tmp_path_factory.mktemp("trace")
    (folder / "toss.toml").write_text(CONFIG)
    outs = [part for name in ("csv", "jsonl", "parquet", "mcap") for part in ("-o", f"t.{name}")]
    tosses = ("toss.toml", "--point", "0,1", "--toss", "3,8", "--rate", "300")
    coinmc("trace", *tosses, *outs, cwd=folder)
    coinmc("trace", *tosses, "-o", "lz4.mcap", "--compression", "lz4", cwd=folder)
    return folder


@pytest.fixture(scope="module", params=["t.mcap", "lz4.mcap"])
def mcap(request, folder):
    return folder / request.param


@pytest.fixture(scope="module")
def messages(folder):
    """Every message of the MCAP: topic, log time, JSON."""
    with (folder / "t.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        return [
            (channel.topic, message.log_time, json.loads(message.data))
            for _, channel, message in reader.iter_messages(log_time_order=False)
        ]


def test_every_message_is_what_its_schema_says(mcap):
    validators = {}
    with mcap.open("rb") as file:
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
