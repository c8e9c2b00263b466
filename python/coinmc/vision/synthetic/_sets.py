"""Folders of rendered photos, with what they show."""

import json
import math
from pathlib import Path

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._board import Board
from coinmc.vision._coin import MarkedCoin
from coinmc.vision.synthetic import (
    Effects,
    Ends,
    SyntheticCamera,
    View,
    board_picture,
    drawn_camera,
    jpeg,
)
from coinmc.vision.synthetic._effects import developed

__all__ = ["board_set", "coin_set"]

#: In bad photos, the share of traps.
TRAPS = 0.25


def _folder(path: Path) -> Path:
    try:
        path.mkdir(parents=True, exist_ok=True)
        if any(path.iterdir()):
            raise VisionError(f"{path} is not empty: give a new folder")
    except OSError as error:
        raise VisionError(f"{path} cannot be made: {error.strerror}") from error
    return path


def coin_set(coin: MarkedCoin, out: Path, photos: int, seed: int, hard: bool) -> None:
    """Render photos of a coin, ``truth.jsonl`` and the camera's file ``camera.json``.

    Raises
    ------
    coinmc.VisionError
        If the folder is not empty.
    """
    out = _folder(out)
    rng = np.random.default_rng(seed)
    camera = drawn_camera(coin.radius_mm, rng, hard)
    camera.save(out / "camera.json")
    renderer = SyntheticCamera(coin, camera, seed)
    ends = Ends(coin.radius_mm, coin.height_mm, seed, tosses=1000)
    with (out / "truth.jsonl").open("x") as truth:
        for number in range(photos):
            if hard and rng.random() < TRAPS:
                scene = ends.trap(rng, renderer.direction_rad)
            else:
                scene = ends.rest(number, rng)
            effects = Effects.drawn(rng, hard)
            name = f"photo-{number:04}.jpg"
            photo = jpeg(renderer.photo(scene, effects, rng), effects.quality)
            (out / name).write_bytes(photo)
            line = {"photo": name, "truth": scene.truth, "kind": scene.kind}
            truth.write(json.dumps(line) + "\n")


def board_set(coin: MarkedCoin, out: Path, photos: int, seed: int, hard: bool) -> None:
    """Render photos of the board from all sides, and ``table.jpg`` with the board on the table.

    The camera is that of `coin_set` with the same seed.

    Raises
    ------
    coinmc.VisionError
        If the folder is not empty.
    """
    out = _folder(out)
    camera = drawn_camera(coin.radius_mm, np.random.default_rng(seed), hard)
    rng = np.random.default_rng([seed, 1])
    view, board = View(camera), Board()
    for number in range(photos + 1):
        pose = np.eye(4)
        if number < photos:
            pose[:3, :3] = _tilted(camera.table[:3, :3].T, rng)
            # far enough to be seen nearly whole
            away = board.size_mm[0] * camera.matrix[0, 0] / camera.size[0] * rng.uniform(0.8, 1.3)
            pose[:3, 3] = camera.centre_mm + away * camera.table[2, :3]
        pose[:3, 3] -= pose[:3, :3] @ [board.size_mm[0] / 2.0, board.size_mm[1] / 2.0, 0.0]
        effects = Effects.drawn(rng, False)
        photo = developed(board_picture(view, board, pose), effects, rng)
        name = f"board-{number:02}.jpg" if number < photos else "table.jpg"
        (out / name).write_bytes(jpeg(photo, effects.quality))


def _tilted(facing: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return a board that faces the camera, up to 45 degrees aside and any way up."""
    about, tilt = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(0.1, math.radians(45.0))
    axis = np.array([math.cos(about), math.sin(about), 0.0])
    cross = np.array([[0.0, 0.0, axis[1]], [0.0, 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    lean = np.eye(3) + math.sin(tilt) * cross + (1.0 - math.cos(tilt)) * cross @ cross
    # the board's z points at the camera, whose z points away from it
    return facing @ np.diag([1.0, -1.0, -1.0]) @ lean
