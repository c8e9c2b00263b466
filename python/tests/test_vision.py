"""Photos of coins with markers: no photo is read as a face that it does not show."""

import json
import math

import cv2
import numpy as np
import pytest

import coinmc
from coinmc.vision import Board, Camera, Classifier, MarkedCoin, calibrate, print_sheets
from coinmc.vision._rest import rest_pose
from coinmc.vision._sheet import _arranged, _coin_page, _save, remarks
from coinmc.vision.synthetic import (
    TRAPS,
    Effects,
    Ends,
    SyntheticCamera,
    drawn_camera,
    jpeg,
    miscalibrated,
)
from coinmc.vision.synthetic._sets import board_set

RATIOS = [0.1, 0.2, 0.354, 0.577, 1.0, 1.5]
FACES = ("heads", "tails", "side")


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    """OpenCV in one thread: photos are small."""
    cv2.setNumThreads(1)


# ---- the sheet ----


@pytest.mark.parametrize("ratio", RATIOS)
def test_markers_are_as_large_as_they_may_be_and_none_overlap(ratio):
    coin = MarkedCoin.of(25.0, ratio)
    assert len({marker.id for marker in coin.markers}) == len(coin.markers)
    assert [len(coin.on(face)) for face in ("heads", "tails")] == [4, 4]
    assert len(coin.on("side")) >= 12
    for marker in coin.on("side"):
        assert marker.width_mm <= 0.35 * 25.0 + 1e-9
        assert np.abs(marker.corners_mm[:, 2]).max() < 0.5 * coin.height_mm
        np.testing.assert_allclose(np.hypot(*marker.corners_mm[:, :2].T), 25.0)
    for face in ("heads", "tails"):
        corners = np.concatenate([marker.corners_mm for marker in coin.on(face)])
        assert np.hypot(corners[:, 0], corners[:, 1]).max() < 25.0
    # seen from outside, corners go clockwise: their normals point out of the coin
    for marker in coin.markers:
        across, down = (
            marker.corners_mm[1] - marker.corners_mm[0],
            np.diff(marker.corners_mm[:3], axis=0)[1],
        )
        assert np.cross(down, across) @ marker.corners_mm.mean(axis=0) > 0.0


def test_a_side_too_low_for_markers_has_none_and_it_is_said():
    coin = MarkedCoin.of(25.0, 0.05)
    assert coin.on("side") == []
    assert "too low" in remarks(coin)[0]


def test_the_sheet_is_printed_at_true_scale(tmp_path):
    """Found in a picture of the page, every marker of the faces lies where the file says."""
    coin = MarkedCoin.of(25.0, 0.577)
    at = _arranged(coin)
    per_mm = 8.0
    drawn = tmp_path / "page.png"
    with_dpi = {"savefig.dpi": 25.4 * per_mm}
    import matplotlib as mpl

    with mpl.rc_context(with_dpi):
        _save(at.size, [drawn], lambda page: _coin_page(page, coin, at))
    page = cv2.imread(str(drawn), cv2.IMREAD_GRAYSCALE)
    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    settings = cv2.aruco.DetectorParameters()
    settings.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    corners, ids, _ = cv2.aruco.ArucoDetector(family, settings).detectMarkers(page)
    found = {int(i): c.reshape(4, 2) for i, c in zip(ids.ravel(), corners, strict=True)}
    assert found.keys() == {marker.id for marker in coin.markers}
    for face, (x, y), mirror in (("heads", at.faces[0], 1.0), ("tails", at.faces[1], -1.0)):
        for marker in coin.on(face):
            wanted = marker.corners_mm[:, :2] * (mirror, 1.0) + (x, y)
            shown = (found[marker.id] + 0.5) / per_mm
            shown[:, 1] = at.size[1] - shown[:, 1]
            np.testing.assert_allclose(shown, wanted, atol=0.1)
    for marker in coin.on("side"):
        edge = np.linalg.norm(np.diff(found[marker.id], axis=0), axis=1).mean() / per_mm
        # on the coin the corners are joined by chords
        chord = 2.0 * 25.0 * math.asin(marker.width_mm / 50.0)
        assert edge == pytest.approx(chord, abs=0.15)


def test_sheets_have_the_size_of_their_paper_and_replace_nothing(tmp_path):
    coin = MarkedCoin.of(25.0, 0.577)
    paths = print_sheets(coin, tmp_path / "sheet")
    assert [path.name for path in paths][:2] == ["coin.pdf", "coin.svg"]
    points = (210.0 / 25.4 * 72.0, 297.0 / 25.4 * 72.0)
    box = f"/MediaBox [ 0 0 {points[0]:.6f}"[:22].encode()
    assert box in paths[0].read_bytes()
    assert f'width="{points[0]:.6f}pt" height="{points[1]:.6f}pt"' in paths[1].read_text()
    read = MarkedCoin.load(paths[4])
    for ours, theirs in zip(coin.markers, read.markers, strict=True):
        assert (ours.id, ours.on) == (theirs.id, theirs.on)
        np.testing.assert_allclose(ours.corners_mm, theirs.corners_mm, atol=1e-6)
    with pytest.raises(coinmc.VisionError, match=r"contains coin\.pdf, .*new folder"):
        print_sheets(coin, tmp_path / "sheet")


def test_all_problems_of_a_coin_are_named():
    with pytest.raises(coinmc.VisionError, match=r"radius.*ratio"):
        MarkedCoin.of(-1.0, float("nan"))


# ---- reading ----


def sightings(coin: MarkedCoin, camera: Camera, pose: np.ndarray, ids: list[int]) -> dict:
    """Where a perfect detector sees markers of a coin."""
    seen = {}
    for number in ids:
        corners = coin.marker(number).corners_mm @ pose[:3, :3].T + pose[:3, 3]
        seen[number] = camera.project(corners)
    return seen


def visible(coin: MarkedCoin, camera: Camera, pose: np.ndarray) -> list[int]:
    """Markers that face the camera."""
    ids = []
    for marker in coin.markers:
        corners = marker.corners_mm @ pose[:3, :3].T + pose[:3, 3]
        normal = np.cross(corners[2] - corners[1], corners[1] - corners[0])
        towards = camera.centre_mm - corners.mean(axis=0)
        if normal @ towards > 0.3 * np.linalg.norm(normal) * np.linalg.norm(towards):
            ids.append(marker.id)
    return ids


@pytest.mark.parametrize("ratio", RATIOS)
def test_a_coin_shows_its_face_up_to_a_small_tilt_and_none_beyond(ratio):
    rng = np.random.default_rng(7)
    coin = MarkedCoin.of(25.0, ratio)
    ends = Ends(25.0, coin.height_mm, seed=1, tosses=10)
    for tilt in (0.0, 3.0, 12.0, 20.0, 35.0):
        for _ in range(6):
            camera = drawn_camera(25.0, rng, hard=True)
            classifier = Classifier(coin, camera)
            pose = ends.tilted(math.radians(tilt), rng.uniform(0.0, 7.0), rng)
            tails = rng.random() < 0.5
            if tails:
                pose[:3, :3] = pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])
            seen = sightings(coin, camera, pose, visible(coin, camera, pose))
            reading = classifier._judge(seen)
            if tilt <= 3.0:
                assert reading.shows == ("tails" if tails else "heads"), reading
                assert reading.deviation_deg == pytest.approx(tilt, abs=0.3)
            else:
                assert reading.face == "none", (tilt, reading)
                assert reading.reason


def test_a_lean_of_ten_degrees_is_seen_with_two_markers_of_a_thin_coin():
    """Its corners are hardly off: here the axis decides."""
    rng = np.random.default_rng(7)
    coin = MarkedCoin.of(25.0, 0.1)
    ends = Ends(25.0, coin.height_mm, seed=1, tosses=10)
    for _ in range(20):
        camera = drawn_camera(25.0, rng, hard=True)
        pose = ends.tilted(math.radians(10.5), rng.uniform(0.0, 7.0), rng)
        seen = sightings(coin, camera, pose, visible(coin, camera, pose)[:2])
        assert Classifier(coin, camera)._judge(seen).face == "none"


def test_one_marker_is_never_a_face_nor_are_two_that_disagree():
    rng = np.random.default_rng(3)
    coin = MarkedCoin.of(25.0, 0.577)
    camera = drawn_camera(25.0, rng)
    classifier = Classifier(coin, camera)
    pose = rest_pose("heads", coin.height_mm, 25.0, np.array([3.0, -4.0, 1.0]))
    both = sightings(coin, camera, pose, [0, 1])
    assert classifier._judge(both).shows == "heads"
    alone = classifier._judge({0: both[0]})
    assert (alone.shows, alone.markers, alone.confidence) == ("none", 1, 0.0)
    # a marker of heads beside one of tails
    assert classifier._judge({0: both[0], 5: both[1]}).shows == "none"
    # and where there are as many of one kind as of the other
    seen = sightings(coin, camera, pose, [0, 1])
    other = rest_pose("tails", coin.height_mm, 25.0, np.array([-9.0, 8.0, 2.0]))
    seen |= sightings(coin, camera, other, [4, 5])
    assert classifier._judge(seen).shows == "none"


def test_a_face_that_is_not_on_the_table_is_not_read_as_one_that_is():
    rng = np.random.default_rng(4)
    coin = MarkedCoin.of(25.0, 0.577)
    camera = drawn_camera(25.0, rng)
    pose = rest_pose("heads", coin.height_mm, 25.0, np.array([3.0, -4.0, 1.0]))
    pose[2, 3] += 15.0
    seen = sightings(coin, camera, pose, [0, 1, 2, 3])
    assert Classifier(coin, camera)._judge(seen).shows == "leaning"


def test_two_coins_are_none():
    rng = np.random.default_rng(5)
    coin = MarkedCoin.of(12.0, 0.577)
    camera = drawn_camera(25.0, rng)
    renderer = SyntheticCamera(coin, camera)
    poses = [
        rest_pose("heads", coin.height_mm, 12.0, np.array([x, 0.0, 1.0])) for x in (-18.0, 18.0)
    ]
    from coinmc.vision.synthetic import Scene
    from coinmc.vision.synthetic._effects import developed
    from coinmc.vision.synthetic._raycast import Cylinder, cast
    from coinmc.vision.synthetic._textures import printed

    assert Scene("none", "empty", None).pose is None
    solids = [Cylinder(12.0, coin.height_mm, pose, printed(coin)) for pose in poses]
    picture = cast(renderer._view, solids, renderer._table)
    reading = Classifier(coin, camera).classify(developed(picture, Effects(), rng))
    assert (reading.shows, reading.reason) == ("none", "a marker is seen twice")


@pytest.mark.parametrize("ratio", RATIOS)
def test_rendered_photos_are_read_and_traps_are_not(ratio):
    """A few dozen photos; benches/python/vision.py has ten thousand."""
    rng = np.random.default_rng([11, round(1000 * ratio)])
    coin = MarkedCoin.of(25.0, ratio)
    ends = Ends(25.0, coin.height_mm, seed=3, tosses=100)
    camera = drawn_camera(25.0, rng)
    renderer = SyntheticCamera(coin, camera)
    classifier = Classifier(coin, miscalibrated(camera, rng))
    for face in FACES:
        scene = ends.lying(face, rng)
        effects = Effects.drawn(rng, hard=False)
        photo = jpeg(renderer.photo(scene, effects, rng), effects.quality)
        grey = cv2.imdecode(np.frombuffer(photo, np.uint8), cv2.IMREAD_GRAYSCALE)
        reading = classifier.classify(grey)
        assert reading.shows == face, reading
        assert 0.0 < reading.confidence < 1.0
        assert np.linalg.norm(reading.pose[:3, 3] - scene.pose[:3, 3]) < 4.0
    for trap in TRAPS:
        scene = trap(ends, rng, renderer.direction_rad)
        if scene is not None:
            reading = classifier.classify(renderer.photo(scene, Effects.drawn(rng, True), rng))
            assert reading.face in ("none", scene.truth), (scene.kind, reading)


# ---- the camera ----


def test_calibration_finds_the_camera_that_took_the_photos(tmp_path):
    coin = MarkedCoin.of(25.0, 0.577)
    board_set(coin, tmp_path / "board", photos=6, seed=5, hard=False)
    true = drawn_camera(25.0, np.random.default_rng(5))
    photos = sorted((tmp_path / "board").glob("board-*.jpg"))
    found = calibrate(photos, tmp_path / "board" / "table.jpg")
    assert found.rms_px < 0.3
    np.testing.assert_allclose(found.matrix, true.matrix, atol=5.0)
    assert found.centre_mm[2] == pytest.approx(true.centre_mm[2], abs=0.5)
    # the normal of the table, which decides
    assert found.table[:3, 2] @ true.table[:3, 2] > math.cos(math.radians(0.2))
    found.save(tmp_path / "camera.json")
    again = Camera.load(tmp_path / "camera.json")
    np.testing.assert_array_equal(again.matrix, found.matrix)
    # a print that is 2 % too large is told by its squares, and makes all lengths larger
    larger = calibrate(photos, tmp_path / "board" / "table.jpg", Board().scaled(27.54))
    assert larger.centre_mm[2] == pytest.approx(1.02 * found.centre_mm[2], rel=1e-3)
    (tmp_path / "bad.jpg").write_bytes(b"no photo")
    bad = [*photos[:5], tmp_path / "bad.jpg", tmp_path / "missing.jpg"]
    with pytest.raises(coinmc.VisionError, match=r"bad\.jpg.*missing\.jpg"):
        calibrate(bad, photos[0])
    with pytest.raises(coinmc.VisionError, match="at least 6"):
        calibrate(photos[:5], photos[0])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "not JSON"),
        ("[1]", "not a coinmc-coin file"),
        ('{"format": "coinmc-camera"}', "not a coinmc-coin file"),
        ('{"format": "coinmc-coin", "version": 2}', "version 2"),
        ('{"format": "coinmc-coin", "version": 1}', "radius_mm.*height_mm.*dictionary.*markers"),
        ("[" * 100_000, "not JSON"),
        (" " * (2 << 20), "too large"),
    ],
)
def test_bad_coin_files_are_refused_with_all_problems(tmp_path, text, told):
    (tmp_path / "coin.json").write_text(text)
    with pytest.raises(coinmc.VisionError, match=told):
        MarkedCoin.load(tmp_path / "coin.json")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"dictionary": []}, r"json: dictionary must be one of DICT_4X4_50, DICT_4X4_100$"),
        ({"dictionary": "DICT_5X5_50"}, r"json: dictionary must be one of DICT_4X4_50,[^;]*$"),
        (
            {"markers": [{"id": 0, "on": "heads", "corners_mm": [[10**400] * 3] * 4}]},
            "marker 0 must have id, on and corners_mm",
        ),
        ({"radius_mm": 10**400}, "radius_mm must be a number from"),
    ],
)
def test_every_bad_value_of_a_coin_is_named(tmp_path, change, told):
    MarkedCoin.of(25.0, 0.577).save(tmp_path / "good.json")
    good = json.loads((tmp_path / "good.json").read_text())
    (tmp_path / "coin.json").write_text(json.dumps({**good, **change}))
    with pytest.raises(coinmc.VisionError, match=told):
        MarkedCoin.load(tmp_path / "coin.json")


@pytest.mark.parametrize("kind", [MarkedCoin, Camera])
def test_an_endless_file_is_not_read(kind):
    with pytest.raises(coinmc.VisionError) as raised:
        kind.load("/dev/zero")
    assert str(raised.value) == "/dev/zero cannot be read: it is not a plain file"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"rms_px": None}, "rms_px must be a number$"),
        ({"size_px": [1]}, "size_px must be 2 numbers$"),
        ({"matrix_px": [[10**400, 0, 0]] * 3}, "matrix_px must be 3 x 3 numbers$"),
    ],
)
def test_every_bad_value_of_a_camera_is_named(tmp_path, change, told):
    drawn_camera(25.0, np.random.default_rng(1)).save(tmp_path / "good.json")
    good = json.loads((tmp_path / "good.json").read_text())
    (tmp_path / "c.json").write_text(json.dumps({**good, **change}))
    with pytest.raises(coinmc.VisionError, match=told):
        Camera.load(tmp_path / "c.json")


def test_a_camera_below_the_table_is_refused(tmp_path):
    camera = drawn_camera(25.0, np.random.default_rng(1))
    upside_down = camera.table @ np.diag([1.0, -1.0, -1.0, 1.0])
    Camera(camera.size, camera.matrix, camera.distortion, upside_down).save(tmp_path / "c.json")
    with pytest.raises(coinmc.VisionError, match="above the table"):
        Camera.load(tmp_path / "c.json")
