"""The camera of `coinmc robot`, and the other commands of `python -m coinmc.vision`."""

import hashlib
import io
import json
import os
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest

from coinmc.vision import Classifier, MarkedCoin
from coinmc.vision.__main__ import main
from coinmc.vision._serve import serve
from coinmc.vision._sources import FileSource, SyntheticSource
from coinmc.vision._store import PhotoStore, logged
from coinmc.vision.synthetic import drawn_camera


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A coin's file, a camera's file and six photos."""
    folder = tmp_path_factory.mktemp("vision")
    MarkedCoin.of(25.0, 0.577).save(folder / "coin.json")
    coin = ["--coin", str(folder / "coin.json")]
    assert main(["synthetic", *coin, "--photos", "4", "--out", str(folder / "photos")]) == 0
    return folder


@pytest.fixture(scope="module")
def classifier():
    """A classifier of a thick coin."""
    return Classifier(MarkedCoin.of(25.0, 0.577), drawn_camera(25.0, np.random.default_rng(1)))


def replies(source, classifier, *lines) -> list[dict]:
    """Serve these lines."""
    out = io.StringIO()
    serve(source, classifier, [f"{line}\n" for line in lines], out)
    return [json.loads(line) for line in out.getvalue().splitlines()]


def take(folder, name="000001-1", **more) -> str:
    """A request for a photo."""
    request = {"throw": 1, "attempt": 1, "request": 7, "folder": str(folder), "name": name}
    return json.dumps({"take": {**request, **more}})


def classify(path, **more) -> str:
    """A request to read a photo."""
    return json.dumps({"classify": str(path), "throw": 1, "attempt": 1, "request": 7, **more})


def test_photos_are_stored_with_their_hash_and_read(tmp_path, classifier):
    truth = tmp_path / "truth.jsonl"
    source = SyntheticSource(classifier.coin, classifier.camera, truth, 1, 0.0, 0.0)
    [early] = replies(source, classifier, take(tmp_path))
    assert "tells of no throw" in early["error"]
    for attempt, face in enumerate(("heads", "side"), 1):
        line = {"throw_id": 1, "spin_mrev_s": 1, "angle_cdeg": 1, "face": face}
        truth.write_text(json.dumps(line) + "\n" + '{"throw_id": 2, "torn')
        name = f"000001-{attempt}"
        [taken] = replies(source, classifier, take(tmp_path, name, attempt=attempt))
        assert taken == {"throw": 1, "attempt": attempt, "request": 7, "image": f"{name}.jpg"}
        path = tmp_path / taken["image"]
        [read] = replies(source, classifier, classify(path, attempt=attempt))
        assert (read["throw"], read["attempt"]) == (1, attempt)
        assert (read["face"], read["shows"], read["reason"]) == (face, face, "")
        assert read["markers"] >= 2
    entries = list(logged(tmp_path))
    for entry in entries[::2]:
        content = (tmp_path / entry["image"]).read_bytes()
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()
    assert [entry["reading"]["face"] for entry in entries[1::2]] == ["heads", "side"]


def test_a_photo_is_never_replaced_or_renamed(tmp_path, made, classifier):
    source = FileSource(made / "photos" / "photo-0000.jpg")
    (tmp_path / "000001-1.jpg").write_bytes(b"as a crash left it")
    [refused, taken] = replies(
        source, classifier, take(tmp_path), take(tmp_path, "000001-2", attempt=2)
    )
    assert "000001-1.jpg exists" in refused.pop("error")
    assert refused == {"throw": 1, "attempt": 1, "request": 7}
    assert taken == {"throw": 1, "attempt": 2, "request": 7, "image": "000001-2.jpg"}
    assert (tmp_path / "000001-1.jpg").read_bytes() == b"as a crash left it"
    assert [entry["image"] for entry in logged(tmp_path)] == ["000001-2.jpg"]


def test_the_first_photo_of_a_session_shows_an_empty_table(tmp_path, classifier):
    # there is no truth yet in the first session, and an old coin in later ones
    truth = tmp_path / "truth.jsonl"
    photos = []
    for session in (1, 2):
        source = SyntheticSource(classifier.coin, classifier.camera, truth, 1, 0.0, 0.0)
        [taken] = replies(source, classifier, take(tmp_path, f"test-{session}", throw=0))
        path = tmp_path / taken["image"]
        photos.append(path.read_bytes())
        [read] = replies(source, classifier, classify(path, throw=0))
        assert (read["throw"], read["attempt"]) == (0, 1)
        assert (read["face"], read["shows"], read["markers"]) == ("none", "none", 0)
        truth.write_text('{"face": "heads"}\n')
    # the host takes no picture twice
    assert photos[0] != photos[1]


def test_a_coin_that_moves_is_told_as_leaning_and_asked_for_again(tmp_path, classifier):
    (tmp_path / "truth.jsonl").write_text('{"face": "heads"}\n')
    truth = tmp_path / "truth.jsonl"
    source = SyntheticSource(classifier.coin, classifier.camera, truth, 2, 0.0, 1.0)
    [taken] = replies(source, classifier, take(tmp_path))
    [read] = replies(source, classifier, classify(tmp_path / taken["image"]))
    # the host asks for another photo after `none`, and this one is kept
    assert (read["face"], read["shows"]) == ("none", "leaning")
    assert list(logged(tmp_path))[-1]["reading"]["shows"] == "leaning"


@pytest.mark.parametrize(
    "line",
    [
        "heads",
        "[]",
        "{}",
        "[" * 50_000,
        '{"take": 1}',
        '{"take": {"throw": 1}}',
        take("/tmp", throw=-1),
        take("/tmp", attempt=True),
        '{"classify": "PHOTO"}',
        classify("PHOTO", throw=None),
        classify("PHOTO", attempt=0.5),
        classify("PHOTO", request=None),
        classify("PHOTO", take=1),
        classify("x" * 70_000),
    ],
)
def test_bad_requests_are_answered_by_an_error(tmp_path, made, classifier, line):
    photo = made / "photos" / "photo-0000.jpg"
    [reply] = replies(FileSource(photo), classifier, line.replace("PHOTO", str(photo)))
    assert list(reply) == ["error"]
    assert not (photo.parent / "photos.jsonl").exists()


@pytest.mark.parametrize(
    "line",
    [take("/tmp/nowhere-at-all"), take("photos"), classify("/tmp/nowhere-at-all.jpg")]
    + [classify("/tmp", classify=path) for path in (["a"], "\0", "\ud800")]
    + [take("/tmp", name) for name in ("../x", "/x", "", ".x", "a b", "x" * 100, "a/b", "\ud800")],
)
def test_errors_name_throw_and_attempt_where_they_are_known(tmp_path, classifier, line):
    truth = tmp_path / "truth.jsonl"
    truth.write_text('{"face": "heads"}\n')
    source = SyntheticSource(classifier.coin, classifier.camera, truth, 1, 0.0, 0.0)
    [reply] = replies(source, classifier, line)
    assert reply.pop("error")
    assert reply == {"throw": 1, "attempt": 1, "request": 7}
    assert list(tmp_path.iterdir()) == [truth]


def test_a_photo_of_a_source_that_fails_is_an_error(tmp_path, classifier):
    [reply] = replies(FileSource(tmp_path / "missing.jpg"), classifier, take(tmp_path))
    assert "missing.jpg cannot be read" in reply.pop("error")
    assert reply == {"throw": 1, "attempt": 1, "request": 7}
    assert not list(tmp_path.iterdir())


def test_a_photo_that_another_program_renews_is_copied(tmp_path, made, classifier):
    photo = made / "photos" / "photo-0000.jpg"
    [taken] = replies(FileSource(photo), classifier, take(tmp_path))
    assert (tmp_path / taken["image"]).read_bytes() == photo.read_bytes()
    (tmp_path / "bad.jpg").write_bytes(b"no photo")
    [reply] = replies(FileSource(photo), classifier, classify(tmp_path / "bad.jpg"))
    assert "not a JPEG or PNG" in reply["error"]


def test_a_torn_line_of_the_log_costs_only_itself(tmp_path):
    store = PhotoStore(tmp_path)
    store.keep("a", "jpg", b"1")
    with (tmp_path / "photos.jsonl").open("ab") as file:
        file.write(b'{"image": "b.jp')
    store.keep("c", "jpg", b"3")
    assert [entry["image"] for entry in logged(tmp_path)] == ["a.jpg", "c.jpg"]


def test_commands_read_photos_and_name_every_bad_file(made, tmp_path, capsys):
    (tmp_path / "bad.jpg").write_bytes(b"no photo")
    photos = sorted(map(str, (made / "photos").glob("*.jpg")))
    files = ["--coin", str(made / "coin.json")]
    files += ["--calibration", str(made / "photos" / "camera.json")]
    assert main(["classify", *files, *photos, str(tmp_path / "bad.jpg"), "missing.jpg"]) == 2
    out, error = capsys.readouterr()
    lines = (made / "photos" / "truth.jsonl").read_text().splitlines()
    truth = [json.loads(line)["truth"] for line in lines]
    assert [json.loads(line)["face"] for line in out.splitlines()] == truth
    assert "bad.jpg" in error
    assert "missing.jpg" in error
    assert main(["classify", "--coin", "nothing", "--calibration", "nothing", "x"]) == 2
    assert main(["serve", "--camera", "synthetic", *files]) == 2
    assert "--truth" in capsys.readouterr().err


def test_without_opencv_the_extra_is_named(made):
    code = (
        "import sys; sys.modules['cv2'] = None\n"
        "from coinmc.vision.__main__ import main\n"
        "sys.exit(main(sys.argv[1:]))"
    )
    files = ["--coin", made / "coin.json", "--calibration", made / "photos" / "camera.json"]
    words = [sys.executable, "-c", code, "classify", *files, "x.jpg"]
    done = subprocess.run(words, capture_output=True, text=True, env={**os.environ})
    assert done.returncode == 1
    assert done.stderr == (
        'error: coinmc.vision needs cv2, which is not installed: pip install "coinmc[vision]"\n'
    )


def test_the_commands_of_the_guide_print_what_it_shows(root, tmp_path):
    text = (root / "docs" / "guide" / "vision.md").read_text()
    [block] = re.findall(r"^```console\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    commands = re.findall(r"^\$ python (.*)\n((?:[^$].*\n)*)", block, re.MULTILINE)
    assert len(commands) == 5
    for command, shown in commands:
        words = ["sh", "-c", f"{shlex.quote(sys.executable)} {command}"]
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert done.stdout.startswith(shown)
    assert len(done.stdout.splitlines()) == 3
