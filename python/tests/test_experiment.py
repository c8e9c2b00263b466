"""A robot's journal: what it says and cannot say; and the robot itself with rendered photos."""

import hashlib
import json
import os
import shlex
import subprocess
import sys
import tracemalloc
import zlib

import numpy as np
import pyarrow as pa
import pytest

import coinmc
from coinmc.experiment import Confusion
from coinmc.experiment import open as open_day

FACES = ("heads", "tails", "side")


@pytest.fixture
def journal(tmp_path, examples):
    """Makes the directory of an experiment with these throws."""

    def made(throws: list[tuple[int, int, str]], planned: int | None = None):
        """Throws are spin in 1/1000 rev/s, angle in 1/100 degree, and face or reason."""
        planned = planned or len(throws)
        config = coinmc.Config(examples / "robot.toml", {"stop.tosses": planned})
        folder = tmp_path / "day"
        (folder / "photos").mkdir(parents=True)
        (folder / "experiment.toml").write_text(config._plan.resolved)
        # format 1 of docs/guide/robot.md
        bodies = [f"coinmc-robot-journal 1 {config._plan.hash} {planned}"]
        for number, (spin, angle, end) in enumerate(throws, 1):
            bodies.append(f"I {number} {spin} {angle} {1000 * number}")
            if end in FACES:
                image = f"{number:06}-1.jpg"
                line = f"R {number} {end} {spin} {angle} 1 {image} {1000 * number + 9}"
                bodies += [line, f"D {number}"]
            else:
                bodies.append(f"V {number} {end}")
        text, crc = "", 0
        for body in bodies:
            crc = zlib.crc32(body.encode(), crc)
            text += f"{body} {crc:08x}\n"
        (folder / "journal.txt").write_text(text)
        return folder

    return made


def test_throws_without_a_result_are_bounded_and_never_dropped(journal):
    ends = ["heads"] * 40 + ["tails"] * 30 + ["side"] * 20 + ["unread"] * 6 + ["fault-103"] * 4
    day = open_day(journal([(1000, 9000, end) for end in ends], planned=120))
    assert (len(day), day.planned, day.announced) == (100, 120, 100)
    assert day.counts == {"heads": 40, "tails": 30, "side": 20, "undecided": 10}
    assert day.voids == {"unread": 6, "fault-103": 4}
    assert day.bounds() == {"heads": (0.4, 0.5), "tails": (0.3, 0.4), "side": (0.2, 0.3)}
    for face, (low, high) in day.bounds().items():
        estimate = day.estimate()[face]
        assert estimate.lo < low < high < estimate.hi
        assert estimate.n == 100
        corrected = day.corrected(Confusion(np.diag([900, 900, 900])))[face]
        assert corrected.lo < low < high < corrected.hi
        assert corrected.lo == pytest.approx(estimate.lo, abs=0.02)
        assert corrected.hi == pytest.approx(estimate.hi, abs=0.02)
    table = pa.table(day)
    assert table.num_rows == 100
    assert table.column("boot").null_count == 10
    assert np.isnan(day["measured_spin_rev_s"]).sum() == 10


def test_wrong_readings_are_corrected_with_the_error_of_their_rates():
    """In 95 % of days the intervals hold the truth. More than ten misses in 60 days happen by
    chance once in 2000 tests, for three faces."""
    rng = np.random.default_rng(26)
    true = np.array([0.5, 0.3, 0.2])
    rates = np.array([[0.95, 0.03, 0.02], [0.02, 0.97, 0.01], [0.05, 0.03, 0.92]])
    held, plain = np.zeros(3), np.zeros(3)
    for _ in range(60):
        checked = np.array([rng.multinomial(300, row) for row in rates])
        read = rng.multinomial(20_000, true @ rates)
        counts = dict(zip(FACES, read.tolist(), strict=True))
        found = Confusion(checked).corrected(counts, seed=int(rng.integers(1 << 31)))
        for place, face in enumerate(FACES):
            held[place] += found[face].lo <= true[place] <= found[face].hi
            half = 1.96 * np.sqrt(true[place] * (1.0 - true[place]) / 20_000)
            plain[place] += abs(read[place] / 20_000 - true[place]) <= half
    assert (held >= 50).all(), held
    # counts that are not corrected miss
    assert plain.min() < 30, plain


def test_confusions_are_counted_and_checked():
    counted = Confusion.of(
        ["heads", "heads", "tails", "side", "side"], ["heads", "none", "heads", "side", "side"]
    )
    assert counted.counts.tolist() == [[1, 0, 0], [1, 0, 0], [0, 0, 2]]
    for bad in (
        [[1, 0], [0, 1]],
        np.eye(3),
        [[1, 0, 0], [0, 0, 0], [0, 0, 1]],
        -np.eye(3, dtype=int),
    ):
        with pytest.raises(ValueError, match=r"confusion matrix|counts are"):
            Confusion(bad)


def test_the_model_is_tossed_with_the_spins_and_angles_of_the_throws(journal):
    rng = np.random.default_rng(1)
    settings = [
        (int(s), int(a))
        for s, a in zip(rng.integers(5001, size=60), rng.integers(18001, size=60), strict=True)
    ]
    day = open_day(journal([(*setting, "heads") for setting in settings]))
    told = day.predict(measured=False)
    model = np.array(FACES)[told.p.argmax(axis=1)]
    # the column that the program computes
    assert (model == day["model_face"]).all()
    assert (day.predict().p == told.p).all()
    estimate = told.estimate()["side"]
    assert estimate.lo < told.p[:, 2].mean() < estimate.hi
    assert estimate.n == 60
    jittered = day.predict(repeats=20, spin_sd_rev_s=0.05, angle_sd_deg=2.0)
    assert jittered.counts.sum(axis=1).tolist() == [20] * 60
    assert (jittered.p > 0.0).sum() > 80
    # errors of the settings are the same for two models with the same seed
    again = day.predict(repeats=20, spin_sd_rev_s=0.05, angle_sd_deg=2.0)
    assert (again.counts == jittered.counts).all()


def test_the_likelihood_is_greatest_at_the_restitution_that_made_the_faces(journal):
    rng = np.random.default_rng(2)
    settings = np.column_stack([rng.integers(5001, size=400), rng.integers(18001, size=400)])
    blank = open_day(journal([(s, a, "heads") for s, a in settings.tolist()]))
    faces = np.array(FACES)[blank.predict().p.argmax(axis=1)]
    faces[::10] = ""
    options = {"repeats": 30, "spin_sd_rev_s": 0.002, "angle_sd_deg": 0.05}

    def fit(e: float):
        model = blank.predict(**options, overrides={"surface.restitution": e})
        return model.log_likelihood(faces)

    best, *others = (fit(e) for e in (0.5, 0.35, 0.45, 0.55, 0.65))
    assert (best.throws, best.unread) == (360, 40)
    assert best.lo < best.value < 0.0
    assert best.lo < best.hi < best.value
    # a hundred times as likely as any of them: the coin is chaotic, and the settings have errors
    assert all(best.value > other.value + 4.6 for other in others)


def test_damage_is_named(journal, tmp_path):
    folder = journal([(1000, 9000, "heads")] * 3)
    path = folder / "journal.txt"
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*lines[:4], lines[4].replace("9000", "9001"), *lines[5:]]))
    with pytest.raises(coinmc.RunError, match="line 5 is damaged"):
        open_day(folder)
    # an incomplete last line, as a loss of power leaves it
    path.write_text("".join(lines)[:-5])
    assert len(open_day(path)) == 2
    with pytest.raises(coinmc.RunError, match="contains no experiment"):
        open_day(tmp_path)


def photo_log(folder, entries: list[dict | str]) -> None:
    """Write a log of photos, whose entries may be texts."""
    lines = [{"format": "coinmc-photos", "version": 1}, *entries]
    texts = [line if isinstance(line, str) else json.dumps(line) for line in lines]
    (folder / "photos" / "photos.jsonl").write_text("\n".join(texts) + "\n")


def test_a_bad_line_of_the_log_of_photos_costs_only_itself(journal):
    folder = journal([(1000, 9000, "heads")] * 2)
    names = ["000001-1.jpg", "000002-1.jpg"]
    for name in names:
        (folder / "photos" / name).write_bytes(b"photo")
    digest = hashlib.sha256(b"photo").hexdigest()
    photo_log(
        folder,
        [
            *({"image": name, "throw": 1, "sha256": digest} for name in names),
            {"image": "a\0b", "throw": 1, "sha256": digest},
            {"image": "a\x1b[2Jb", "throw": 1, "sha256": digest},
            {"image": names[0], "throw": [1]},
            f'{{"image": "{names[0]}", "reading": {{"confidence": {"1" * 400}, "markers": 3}}}}',
        ],
    )
    day = open_day(folder)
    assert day["photos"].tolist() == [2, 0]
    assert np.isnan(day["confidence"]).all()
    assert day["markers"][0] == 3
    assert day.check_photos() == []


def test_photos_are_plain_files_of_the_size_of_photos(journal):
    folder = journal([(1000, 9000, "heads")])
    os.mkfifo(folder / "photos" / "pipe.jpg")
    with (folder / "photos" / "large.jpg").open("wb") as file:
        file.truncate(2 << 30)
    names = ["large.jpg", "missing.jpg", "pipe.jpg"]
    photo_log(folder, [{"image": name, "throw": 1, "sha256": "00"} for name in names])
    tracemalloc.start()
    problems = open_day(folder).check_photos()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 8 << 20
    assert problems == [
        "large.jpg is larger than 64 MiB",
        "missing.jpg cannot be read: No such file or directory",
        "pipe.jpg cannot be read: it is not a plain file",
        "000001-1.jpg is not in the log",
    ]
    (folder / "photos" / "photos.jsonl").unlink()
    os.mkfifo(folder / "photos" / "photos.jsonl")
    with pytest.raises(coinmc.VisionError, match=r"photos\.jsonl cannot be read: it is not"):
        open_day(folder)


def test_the_page_needs_nothing_else_and_replaces_nothing(journal, tmp_path):
    folder = journal([(1000, 9000, face) for face in (*FACES, "unread")] * 5)
    folder = folder.rename(folder.with_name("<b>day"))
    day = open_day(folder)
    page = day.page(tmp_path / "day.html", confusion=Confusion(np.diag([9, 9, 9])))
    text = page.read_text()
    assert "<b>day" not in text
    assert "&lt;b&gt;day" in text
    assert "http" not in text
    assert "<script" not in text
    assert "5 unread" in text
    with pytest.raises(FileExistsError):
        day.page(page)


def test_a_robot_throws_and_its_photos_are_read(program, examples, tmp_path):
    """The simulated robot, with a noisy line and a reset, and rendered photos."""
    throws = 10
    vision = [sys.executable, "-m", "coinmc.vision"]
    sheet = [*vision, "sheet", "--radius-mm", "12.5", "--ratio", "1.5"]
    subprocess.run(sheet, cwd=tmp_path, check=True, capture_output=True)
    config = [examples / "robot.toml", "--set", f"stop.tosses={throws}"]
    sim = [program, "robot", "sim", *config, "--name", "port", "--truth", "truth.jsonl"]
    sim += ["--memory", "memory", "--speed", "200", "--noise", "0.005"]
    serve = [*vision, "serve", "--camera", "synthetic", "--truth", "truth.jsonl"]
    serve += ["--moving", "0.2"]
    run = [program, "robot", "run", *config, "--out", "day", "--port", "port", "--speed", "200"]
    run += ["--camera", "exec " + shlex.join(serve), "--camera-timeout", "50", "--quiet"]
    pipe = subprocess.PIPE
    with subprocess.Popen(sim, cwd=tmp_path, stdin=pipe, stdout=pipe, text=True) as robot:
        robot.stdout.readline()
        done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        robot.kill()
    assert done.returncode == 0, done.stderr
    day = open_day(tmp_path / "day")
    lines = (tmp_path / "truth.jsonl").read_text().splitlines()
    truth = {(line := json.loads(text))["throw_id"]: line["face"] for text in lines}
    assert len(lines) == len(truth) == len(day) == throws
    assert day["id"].tolist() == list(range(1, throws + 1))
    for number, face, void in zip(day["id"], day["face"], day["void"], strict=True):
        assert void or face == truth[number]
    assert day.counts["undecided"] <= 2
    # some photos showed a coin that still moved, and were taken again
    assert day["photos"].sum() > throws
    assert np.nanmin(day["markers"]) >= 2
    assert day.check_photos() == []
    photo = next((tmp_path / "day" / "photos").glob("*.jpg"))
    photo.write_bytes(photo.read_bytes()[:-1])
    assert day.check_photos() == [f"{photo.name} was changed"]
