"""Pages: one file each, that a browser shows without a message and without a network."""

import hashlib
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

CONFIG = """
coin.ratio = [0.4, 1.2]
surface.restitution = [0.4, 0.6]
surface.friction = 0.3
surface.rolling_friction_m = 1e-4
surface.table_tilt_deg = 0.3
launch.preset = "hand"
engine.volumetric = {}
stop.tosses = 200
"""
DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)


def data(page: Path) -> dict:
    return json.loads(DATA.search(page.read_text(encoding="utf-8"))[1])


@pytest.fixture(scope="module")
def pages(coinmc, tmp_path_factory) -> Path:
    """A folder with a report, tosses and a map."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "space.toml").write_text(CONFIG)
    level = CONFIG.replace("surface.table_tilt_deg = 0.3\n", "")
    (folder / "cone.toml").write_text(f"coin.draft_deg = 5.0\n{level}")
    for words in (
        "run space.toml --out a-run --quiet",
        "report a-run -o report.html --title <b>&amp;</script>",
        "trace space.toml --point 0,1 --toss 3 -o tosses.html -o tosses.jsonl --rate 3000 --quiet",
        "trace cone.toml --point 0,3 --toss 3 -o cones.html -o cones.jsonl --rate 3000 --quiet",
        "trace map space.toml --over wy_rad_s=0..30:6 --over height_m=0.2..0.5:4 -o map.html -q",
    ):
        coinmc(*words.split(), cwd=folder)
    return folder


def test_the_report_holds_the_results_to_the_last_digit(pages):
    [run] = data(pages / "report.html")["runs"]
    lines = (pages / "a-run/results.csv").read_text().splitlines()
    names = lines[0].split(",")
    for column in run["columns"]:
        place = names.index(column["name"])
        for row, line in enumerate(lines[1:]):
            value = column["values"][row] if "values" in column else column["all"]
            cell = line.split(",")[place]
            if isinstance(value, bool):
                assert cell == str(value).lower()
            elif isinstance(value, float | int):
                assert float(cell) == value
            else:
                assert cell == (value or "")
    assert [column["name"] for column in run["columns"]] == names


# What a browser says when something fails, and what the page has once it has been drawn.
SHOWN = {
    "report.html": [
        'id="probability"',
        'id="map"',
        'id="tosses"',
        'id="provenance"',
        "Download CSV",
    ],
    "tosses.html": ['class="viewer"', "<canvas", "impact", "lift-off"],
    "map.html": ['class="map"', "wy_rad_s", 'class="viewer"'],
}


@pytest.mark.parametrize("page", SHOWN)
def test_a_browser_shows_it_without_a_message(pages, page, tmp_path):
    browser = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if browser is None:
        pytest.skip("no Chromium is installed")
    command = [
        browser, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle",
        "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--enable-logging=stderr",
        "--force-prefers-reduced-motion",
        f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=1500", "--dump-dom",
        (pages / page).as_uri(),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    messages = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
    assert not messages
    missing = [text for text in SHOWN[page] if text not in done.stdout]
    assert not missing, done.stderr[-2000:]


@pytest.mark.parametrize("page", SHOWN)
def test_it_needs_nothing_but_itself(pages, page):
    text = (pages / page).read_text(encoding="utf-8")
    assert "default-src 'none'" in text
    # the only addresses are in the licences
    tags = re.sub(r"<pre>.*?</pre>|<script.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r"""(?:src|href)\s*=\s*["'](?!data:|#)""", tags)
    assert "<b>" not in tags


# Prints how far the motion of a page is from the records of the same toss: degrees of the axis,
# sizes of the coin.
COMPARE = """
import { readFileSync } from "node:fs";
const { Motion, turn } = await import(process.argv[2]);
const { tosses } = JSON.parse(readFileSync(process.argv[3], "utf8"));
const text = readFileSync(process.argv[4], "utf8");
const lines = text.trim().split("\\n").map((line) => JSON.parse(line));
const worst = { degrees: 0, shift: 0, energy: 0, height: 0, records: 0 };
for (const toss of tosses) {
  const motion = new Motion(toss.scene, toss.keys);
  const size = Math.hypot(toss.scene.radius_m, toss.scene.height_m / 2);
  for (const record of lines) {
    // at an instant of events there are states before and after
    if (record.kind !== "sample" || record.point !== toss.point) continue;
    const state = motion.at(record.time_s);
    const u = turn(state.turn, 0, 0, 1);
    const cosine = u[0] * record.ux + u[1] * record.uy + u[2] * record.uz;
    const place = [record.x_m, record.y_m, record.z_m];
    const shift = Math.hypot(...place.map((x, i) => state.place[i] - x));
    worst.degrees = Math.max(worst.degrees, (Math.acos(Math.min(1, cosine)) * 180) / Math.PI);
    worst.shift = Math.max(worst.shift, shift / size);
    worst.records += 1;
    if (record.mode !== "flight") continue;
    worst.energy = Math.max(worst.energy, Math.abs(motion.energy(state) / record.energy_j_kg - 1));
    const height = Math.abs(motion.lowest(state)[2] - record.lowest_m) / size;
    worst.height = Math.max(worst.height, height);
  }
}
console.log(JSON.stringify(worst));
"""


@pytest.mark.parametrize("page", ["tosses", "cones"])
def test_the_page_moves_the_coin_as_the_engine_does(root, pages, page, tmp_path):
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    (tmp_path / "compare.mjs").write_text(COMPARE)
    (tmp_path / "data.json").write_text(json.dumps(data(pages / f"{page}.html")))
    module = root / "crates/coinmc-report/web/src/toss/motion.js"
    command = [node, "compare.mjs", module.as_uri(), "data.json", pages / f"{page}.jsonl"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    worst = json.loads(done.stdout)
    assert worst["records"] > 1000
    # as `keyframes.rs` promises
    assert worst["degrees"] <= 0.26
    assert worst["shift"] <= 0.0041
    # energies and lowest points follow from them: seven digits, a quarter of a degree
    assert worst["energy"] < 1e-4
    assert worst["height"] < 0.01


def test_the_bundle_is_of_its_sources(root):
    web = root / "crates/coinmc-report/web"
    files = [*(web / "src").rglob("*"), *(web / "licences").rglob("*"), web / "package-lock.json"]
    lines = []
    for path in sorted(
        (path for path in files if path.is_file()),
        key=lambda path: str(path.relative_to(web)).encode(),
    ):
        lines.append(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(web)}\n")
    found = hashlib.sha256("".join(lines).encode()).hexdigest()
    assert found == (web / "dist/SOURCES.sha256").read_text().strip(), "run scripts/web"


def test_the_bundle_is_built_again_to_the_byte(root):
    target = Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))
    if not (target / "web/installed.json").exists():
        pytest.skip("its packages are not there (scripts/web installs them)")
    done = subprocess.run(
        ["scripts/web", "--check"], cwd=root, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
