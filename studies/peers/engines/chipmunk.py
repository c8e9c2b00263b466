"""Chipmunk, by way of pymunk: a rectangle in the plane with the coin's moment of inertia."""

from __future__ import annotations

import math

import numpy as np
import pymunk
from pymunk import batch
from scene import GRAVITY, Launch, Scene

NAME, PACKAGE = "Chipmunk", "pymunk"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 5e-5)
COINS = 200
in_plane = True

APART = 100.0
"""Between two coins at their launch, m. (They never touch, but boxes that overlap cost time.)"""

FIELDS = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)


class World:
    """One space of coins that touch the ground alone; a toss sets the state of one of them."""

    def __init__(self, scene: Scene, step: float, coins: int):
        self.coins, self.step = coins, step * scene.second
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -GRAVITY)
        self.space.iterations = 20
        # metres: what may overlap, and how fast the rest is pushed out, are meant for pixels
        self.space.collision_slop = 1e-4
        floor = pymunk.Segment(self.space.static_body, (-1e6, -1.0), (1e6, -1.0), 1.0)
        # Chipmunk multiplies friction and restitution of the two shapes
        floor.elasticity, floor.friction = 1.0, 1.0
        self.space.add(floor)
        self.bodies = []
        for _ in range(coins):
            body = pymunk.Body(1.0, scene.transverse)
            edge = pymunk.Poly.create_box(body, (2.0, scene.height))
            edge.elasticity, edge.friction = scene.restitution, scene.friction
            edge.filter = pymunk.ShapeFilter(group=1)
            self.space.add(body, edge)
            self.bodies.append(body)
        self.states_of_all = batch.Buffer()
        # a space gives the states of all its bodies, a resting one of its own among them, in an
        # order of its own
        batch.get_space_bodies(self.space, batch.BodyFields.BODY_ID, self.states_of_all)
        order = np.frombuffer(self.states_of_all.int_buf(), dtype=np.uintp).tolist()
        self.rows = [order.index(body.id) for body in self.bodies]

    def place(self, coin: int, launch: Launch) -> None:
        body = self.bodies[coin]
        body.position = (APART * coin, launch.height)
        # coinmc turns about y, from z to x; Chipmunk from x to y: clockwise against anticlockwise
        body.angle = -math.atan2(launch.axis[0], launch.axis[2])
        body.velocity = (launch.velocity[0], launch.velocity[2])
        body.angular_velocity = -launch.spin[1]
        self.space.reindex_shapes_for_body(body)

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            self.space.step(self.step)

    def states(self):
        self.states_of_all.clear()
        batch.get_space_bodies(self.space, FIELDS, self.states_of_all)
        rows = np.frombuffer(self.states_of_all.float_buf()).reshape(-1, 6)
        _, z, turned, along, up, rate = rows[self.rows].T
        none = np.zeros(self.coins)
        velocity = np.column_stack((along, none, up))
        axis = np.column_stack((np.sin(-turned), none, np.cos(turned)))
        return z, velocity, axis, np.column_stack((none, -rate, none))
