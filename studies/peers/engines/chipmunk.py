"""Chipmunk, by way of pymunk: a rectangle in the plane with the coin's moment of inertia."""

from __future__ import annotations

import math

import pymunk
from decide import face_in_plane, follow
from scene import GRAVITY, Launch, Scene

NAME, PACKAGE = "Chipmunk", "pymunk"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 5e-5)
in_plane = True


class Tosser:
    """One space; a toss sets its one body's state."""

    def __init__(self, scene: Scene, step: float):
        self.scene, self.step = scene, step * scene.second
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -GRAVITY)
        self.space.iterations = 20
        # metres: what may overlap, and how fast the rest is pushed out, are meant for pixels
        self.space.collision_slop = 1e-4
        floor = pymunk.Segment(self.space.static_body, (-1e6, -1.0), (1e6, -1.0), 1.0)
        self.coin = pymunk.Body(1.0, scene.transverse)
        edge = pymunk.Poly.create_box(self.coin, (2.0, scene.height))
        # Chipmunk multiplies friction and restitution of the two shapes
        floor.elasticity, floor.friction = 1.0, 1.0
        edge.elasticity, edge.friction = scene.restitution, scene.friction
        self.space.add(floor, self.coin, edge)

    def toss(self, launch: Launch) -> str | None:
        coin = self.coin
        coin.position = (0.0, launch.height)
        # coinmc turns about y, from z to x; Chipmunk from x to y: clockwise against anticlockwise
        coin.angle = -math.atan2(launch.axis[0], launch.axis[2])
        coin.velocity = (launch.velocity[0], launch.velocity[2])
        coin.angular_velocity = -launch.spin[1]
        self.space.reindex_shapes_for_body(coin)

        def advance(steps):
            for _ in range(steps):
                self.space.step(self.step)

        def look():
            return face_in_plane(
                self.scene, coin.position.y, coin.velocity, -coin.angle, -coin.angular_velocity
            )

        return follow(self.scene, self.step, advance, look)
