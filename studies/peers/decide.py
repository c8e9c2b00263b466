"""When a toss is decided: the same rule for every engine.

A coin whose energy is below m g D (D from the rim to the centre) can never again stand on its rim,
so its face is that of its tilt. This is coinmc's own rule, and it spares peers the long wait for
rest, in which they differ most.
"""

from __future__ import annotations

import math

from scene import GRAVITY, Scene

LOOK_EVERY = 5e-3
"""Between two looks at the energy, s of the real toss: so rare that looking costs little."""
GIVE_UP = 20.0
"""After which a toss counts as undecided, s of the real toss."""


def face(scene: Scene, z: float, velocity, axis, spin) -> str | None:
    """``heads``, ``tails`` or ``side`` if energy decides it, else None.

    z, velocity (3,), unit axis (3,) and spin (3,), all in the frame of the scene and of the
    laboratory; potential zero at the surface.
    """
    spare = GRAVITY * (scene.rim - z)
    if not spare > 0.0:
        return None
    (vx, vy, vz), (ux, uy, uz), (wx, wy, wz) = velocity, axis, spin
    along = wx * ux + wy * uy + wz * uz
    across = max(0.0, wx * wx + wy * wy + wz * wz - along * along)
    motion = vx * vx + vy * vy + vz * vz + scene.axial * along * along + scene.transverse * across
    if not 0.5 * motion < spare:
        return None
    if abs(uz) < 0.5 * scene.height / scene.rim:
        return "side"
    return "heads" if uz > 0.0 else "tails"


def face_in_plane(scene: Scene, z: float, velocity, angle: float, spin: float) -> str | None:
    """The same for a rectangle in the plane, turned by ``angle`` rad from lying on its face."""
    axis = (math.sin(angle), 0.0, math.cos(angle))
    return face(scene, z, (velocity[0], 0.0, velocity[1]), axis, (0.0, spin, 0.0))


def follow(scene: Scene, step: float, advance, look) -> str | None:
    """Advances until decided; ``advance(n)`` makes n steps of ``step`` s (of the scene's frame)."""
    steps = max(1, round(LOOK_EVERY * scene.second / step))
    for _ in range(int(GIVE_UP * scene.second / (steps * step)) + 1):
        advance(steps)
        found = look()
        if found is not None:
            return found
    return None
