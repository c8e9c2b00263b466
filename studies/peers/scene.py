"""A coin on a surface, as every engine is given it.

Peers see the toss in a frame in which the radius is 1 m and gravity 9.81 m/s² (Froude scaling:
lengths by 1/R, times by 1/sqrt(R)). It is the same toss, and spares them their troubles with small
bodies: margins, slop and thresholds that are meant for metres.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

GRAVITY = 9.81
MARGIN = 0.5
"""Height of the rim above the ground where an engine takes over, m: what a coin of 1 cm that has
fallen from 1 m moves in a step of 1 ms."""


@dataclass(frozen=True)
class Scene:
    """A uniform cylinder of radius 1 m and mass 1 kg over the plane z = 0."""

    height: float
    """Height, m (H/R of the real coin)."""
    restitution: float
    friction: float
    rolling: float
    """Friction length of rolling and of pivoting, m (ρ/R of the real coin)."""
    second: float
    """One second of the real toss, s."""

    @property
    def rim(self) -> float:
        """Distance of the rim from the centre, m."""
        return float(np.hypot(1.0, 0.5 * self.height))

    @property
    def transverse(self) -> float:
        """Moment of inertia about a diameter, kg m²."""
        return (3.0 + self.height**2) / 12.0

    @property
    def axial(self) -> float:
        """Moment of inertia about the axis, kg m²."""
        return 0.5


@dataclass(frozen=True)
class Launch:
    """One state of motion, in the frame of its scene."""

    height: float
    """Of the centre, m."""
    velocity: np.ndarray
    """(3,), m/s."""
    axis: np.ndarray
    """(3,), the outward normal of heads."""
    spin: np.ndarray
    """(3,), rad/s."""


def read(config: Path, ratio: float) -> tuple[Scene, dict]:
    """The scene of a config at a ratio, and the config with only that ratio."""
    tables = tomllib.loads(config.read_text())
    coin, surface = tables["coin"], tables["surface"]
    radius = coin.get("radius_m", 0.01)
    if {"linear_drag_per_s", "angular_drag_per_s"} & set(tables.get("environment", {})):
        raise SystemExit(f"{config}: peers are not given drag")
    coin["ratio"] = ratio
    in_space = "volumetric" in tables["engine"]
    if in_space and "rolling_friction_m" not in surface:
        raise SystemExit(f"{config}: peers need rolling_friction_m, coinmc would estimate it")
    return (
        Scene(
            height=ratio,
            restitution=surface["restitution"],
            friction=surface["friction"],
            # nothing rolls in the plane
            rolling=surface["rolling_friction_m"] / radius if in_space else 0.0,
            second=float(1.0 / np.sqrt(radius)),
        ),
        tables,
    )


def scaled(launches: np.ndarray, scene: Scene) -> list[Launch]:
    """coinmc's launches (SI, see ``coinmc.launches``) in the frame of the scene."""
    length, time = scene.second**2, scene.second
    return [
        Launch(
            height=float(launch["position_m"][2]) * length,
            velocity=np.array(launch["velocity_m_s"]) * (length / time),
            axis=np.array(launch["axis"]),
            spin=np.array(launch["spin_rad_s"]) / time,
        )
        for launch in launches
    ]


def fallen(launch: Launch, scene: Scene) -> Launch:
    """The launch when it may first touch, so that nobody follows its free flight step by step.

    Nothing is farther from the centre than the rim, so nothing touches before the centre has come
    down to that height; `MARGIN` is left to the engine. Without drag the axis u turns about the
    angular momentum at the steady rate Ω = L/I_t, and ω = Ω + (1 − I_a/I_t) (ω·u) u (Euler's
    equations of a symmetric body).
    """
    above = launch.height - scene.rim - MARGIN
    if above <= 0.0:
        return launch
    rise = launch.velocity[2]
    time = (rise + np.sqrt(rise * rise + 2.0 * GRAVITY * above)) / GRAVITY
    own = float(launch.spin @ launch.axis) * (1.0 - scene.axial / scene.transverse)
    steady = launch.spin - own * launch.axis
    axis = turned(launch.axis, steady, time)
    return Launch(
        height=scene.rim + MARGIN,
        velocity=launch.velocity - np.array([0.0, 0.0, GRAVITY * time]),
        axis=axis,
        spin=steady + own * axis,
    )


def turned(vector: np.ndarray, rate: np.ndarray, time: float) -> np.ndarray:
    """``vector`` turned for ``time`` s at the angular velocity ``rate`` (Rodrigues)."""
    speed = float(np.linalg.norm(rate))
    if speed == 0.0:
        return vector
    about, angle = rate / speed, speed * time
    return (
        np.cos(angle) * vector
        + np.sin(angle) * np.cross(about, vector)
        + (1.0 - np.cos(angle)) * float(about @ vector) * about
    )


def axis_of(w, x, y, z) -> np.ndarray:
    """(…, 3), where the unit quaternion (w, x, y, z) turns e_z."""
    across = (2.0 * (x * z + w * y), 2.0 * (y * z - w * x))
    return np.stack((*across, 1.0 - 2.0 * (x * x + y * y)), axis=-1)


def turn_to(axis: np.ndarray) -> np.ndarray:
    """The unit quaternion (w, x, y, z) that turns e_z to ``axis`` the short way."""
    w = np.sqrt(max(0.0, 0.5 * (1.0 + axis[2])))
    if w < 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    return np.array([w, -axis[1] / (2.0 * w), axis[0] / (2.0 * w), 0.0])
