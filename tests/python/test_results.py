"""The results open in Python, and all their forms say the same."""

import csv
import json

import pyarrow.parquet as pq
import pytest

CONFIG = """
[coin]
ratio = [0.5, 1.0, 1.5]
[surface]
restitution = 0.5
friction = 0.3
[launch]
preset = "robot"
[engine.flat]
[stop]
tosses = 20_000
"""

IN_SPACE = """
[coin]
ratio = [0.25, 1.0]
radius_m = 0.5
[surface]
restitution = 0.3
friction = 10.0
rolling_friction_m = [0.0, 0.001]
pivoting_friction_m = 0.0
restitution_threshold_m_s = 2.0
[environment]
linear_drag_per_s = 1.0
angular_drag_per_s = 0.05
gyroscopic_torque = false
[launch]
preset = "table1"
[engine.volumetric]
law = "stronge"
[stop]
tosses = 2_000
"""

CLOSED = """
[coin]
ratio = [0.5, 1.0]
[engine.analytic]
rule = "arc"
"""


ENGINES = {"flat": CONFIG, "volumetric": IN_SPACE, "analytic": CLOSED}


@pytest.fixture(scope="module", params=ENGINES.values(), ids=ENGINES.keys())
def run(request, coinmc, tmp_path_factory):
    """A finished run: its directory and what was printed."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "toss.toml").write_text(request.param)
    done = coinmc("run", "toss.toml", "--out", "out", "--format", "json", cwd=folder)
    return folder / "out", json.loads(done.stdout)


def typed(text: str, value):
    """A CSV cell as the type of the value it is compared with."""
    if text == "":
        return None
    if isinstance(value, bool):
        return {"true": True, "false": False}[text.lower()]
    return type(value)(text)


def test_parquet_csv_and_json_agree(run):
    folder, document = run
    table = pq.read_table(folder / "results.parquet")
    rows = table.to_pylist()
    with (folder / "results.csv").open(newline="") as file:
        cells = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert len(rows) == len(cells) == len(document["rows"]) > 0
    for row, cell, entry in zip(rows, cells, document["rows"], strict=True):
        assert list(row) == list(cell) == list(entry)
        assert entry == row
        # Numbers are written with as many digits as bring them back.
        assert {name: typed(cell[name], value) for name, value in row.items()} == row


def test_columns_have_units_and_descriptions(run):
    folder, _ = run
    schema = pq.read_schema(folder / "results.parquet")
    assert "ratio" in schema.names
    for field in schema:
        metadata = field.metadata or {}
        assert metadata.get(b"description") or metadata.get(b"doc"), field
        if str(field.type) in ("double", "uint64"):
            assert metadata.get(b"unit"), field
    assert schema.field("radius_m").metadata[b"unit"] == b"m"


def test_the_intervals_hold_the_estimates(run):
    folder, _ = run
    for row in pq.read_table(folder / "results.parquet").to_pylist():
        for face in ("heads", "tails", "side"):
            assert 0 <= row[f"p_{face}_lo"] <= row[f"p_{face}"] <= row[f"p_{face}_hi"] <= 1
        if row["tosses"]:
            assert row["p_side"] == row["side"] / row["tosses"]
            counted = row["heads"] + row["tails"] + row["side"] + row["undecided"]
            assert counted == row["tosses"]


def test_all_that_defines_a_toss_is_named(run):
    folder, document = run
    for row in pq.read_table(folder / "results.parquet").to_pylist():
        assert row["law"]
        assert row["engine"] in ENGINES
        assert row["gyroscopic_torque"] == (row["engine"] != "volumetric")
        drag = row["linear_drag_per_s"], row["angular_drag_per_s"]
        assert drag == ((1.0, 0.05) if row["engine"] == "volumetric" else (0.0, 0.0))
        assert row["rolling_friction_m"] >= row["pivoting_friction_m"] == 0.0
    published = [entry["side"] for entry in document["published"]]
    in_space = document["rows"][0]["engine"] == "volumetric"
    assert published == ([661, 661, 495, 495] if in_space else [])
