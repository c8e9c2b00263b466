"""When a toss is decided, and how worlds full of coins are followed until all are.

A coin whose energy is below m g D (D from the rim to the centre) can never again stand on its rim,
so its face is that of its tilt. This is coinmc's own rule, and it spares peers the long wait for
rest, in which they differ most.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scene import GRAVITY, Launch, Scene

FACES = ("heads", "tails", "side")
UNDECIDED = -1
LOOK_EVERY = 5e-3
"""Between two looks at the energy, s of the real toss: so rare that looking costs little."""
GIVE_UP = 20.0
"""After which a toss counts as undecided, s of the real toss."""


class World(Protocol):
    """Coins that move side by side, each as if it were alone."""

    coins: int
    """How many."""

    def place(self, coin: int, launch: Launch) -> None:
        """Gives one coin a new toss."""

    def advance(self, steps: int) -> None:
        """Moves all coins by so many time steps."""

    def states(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Heights of the centres (n,), velocities, axes and spins (n, 3), in the laboratory."""


@dataclass
class Tossed:
    """What became of the launches that were tossed."""

    faces: np.ndarray
    """Index of `FACES`, or `UNDECIDED`."""
    seconds: float
    """Processor time of them."""


def faces(scene: Scene, z, velocity, axis, spin) -> np.ndarray:
    """Index of `FACES` where energy decides it, else `UNDECIDED`.

    z (n,), velocity, unit axis and spin (n, 3), all in the frame of the scene and of the
    laboratory; potential zero at the surface.
    """
    spare = GRAVITY * (scene.rim - z)
    along = np.einsum("ij,ij->i", spin, axis)
    across = np.maximum(0.0, np.einsum("ij,ij->i", spin, spin) - along**2)
    speed = np.einsum("ij,ij->i", velocity, velocity)
    motion = speed + scene.axial * along**2 + scene.transverse * across
    up = axis[:, 2]
    named = np.where(np.abs(up) < 0.5 * scene.height / scene.rim, 2, np.where(up > 0.0, 0, 1))
    return np.where((spare > 0.0) & (0.5 * motion < spare), named, UNDECIDED)


def follow(
    scene: Scene, step: float, world: World, launches: list[Launch], budget: float
) -> Tossed:
    """Tosses launches for ``budget`` s of processor time, and those begun to their end.

    A coin that is decided gets the next launch at once, so the world is full until the time is up
    or the launches run out: only until then is time taken, as an emptying world wastes it. What one
    coin takes from one look to the next, times the looks that the tosses took, is the time of them.
    No toss is cut off for being long.
    """
    steps = max(1, round(LOOK_EVERY * scene.second / step))
    limit = int(GIVE_UP * scene.second / (steps * step)) + 1
    found = np.full(len(launches), UNDECIDED)
    looks = np.zeros(len(launches), dtype=int)
    toss = np.arange(world.coins)
    for coin in toss:
        world.place(coin, launches[coin])
    begun = time.process_time()
    placed, rounds, full = world.coins, 0, None
    while np.any(toss >= 0):
        world.advance(steps)
        codes = faces(scene, *world.states())
        moving = toss >= 0
        looks[toss[moving]] += 1
        rounds += 1
        over = moving & ((codes != UNDECIDED) | (looks[toss] >= limit))
        for coin in np.flatnonzero(over):
            found[toss[coin]] = codes[coin]
            if full is None and placed < len(launches):
                world.place(coin, launches[placed])
                toss[coin] = placed
                placed += 1
            else:
                toss[coin] = -1
        passed = time.process_time() - begun
        if full is None and (np.any(toss < 0) or passed > budget):
            full = rounds, passed
    rounds, seconds = full
    a_look = seconds / (rounds * world.coins)
    return Tossed(found[:placed], a_look * int(looks.sum()))
