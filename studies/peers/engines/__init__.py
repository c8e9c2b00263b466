"""Peers: one module an engine, imported only when its package is installed.

A module has

* ``PACKAGE``, what ``pip install`` calls it, and ``NAME``, what people do;
* ``STEPS``, time steps worth trying, s of the real toss, coarse to fine;
* ``COINS``, how many in one world make it fastest;
* ``in_plane``: whether it tosses a rectangle in the plane;
* ``World(scene, step, coins)``, a `decide.World`.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util

MODULES = {"mujoco": "mujoco_", "bullet": "bullet", "physx": "physx", "chipmunk": "chipmunk"}


def load(name: str):
    """The engine's module, or None if its package is not installed."""
    packages = {"mujoco": "mujoco", "bullet": "pybullet", "physx": "sapien", "chipmunk": "pymunk"}
    if importlib.util.find_spec(packages[name]) is None:
        return None
    return importlib.import_module(f"engines.{MODULES[name]}")


def version(module) -> str:
    """Name and version of its package."""
    return f"{module.PACKAGE} {importlib.metadata.version(module.PACKAGE)}"
