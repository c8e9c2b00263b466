"""Bullet: sequential impulses, coefficients of rolling and spinning friction.

Its rigid bodies ("maximal coordinates"), not the multibodies that pybullet makes unless told
otherwise: those take half as long again.
"""

from __future__ import annotations

import numpy as np
import pybullet
from scene import GRAVITY, Launch, Scene, axis_of, turn_to

NAME, PACKAGE = "Bullet", "pybullet"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 6e-5)
COINS = 50
in_plane = False

APART = 100.0
"""Between two coins at their launch, m. (They never touch, but boxes that overlap cost time.)"""

MOVING, STILL = 1, 2
"""Bullet's own groups of what moves and what does not."""


class World:
    """One world of coins that touch the ground alone; a toss sets the state of one of them."""

    def __init__(self, scene: Scene, step: float, coins: int):
        self.coins = coins
        self.client = client = pybullet.connect(pybullet.DIRECT)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=step * scene.second,
            numSubSteps=0,
            restitutionVelocityThreshold=0.0,
            # as many as Bullet's own default, each coin by itself
            numSolverIterations=10,
            minimumSolverIslandSize=1,
            physicsClientId=client,
        )
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=client)
        plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
        cylinder = pybullet.createCollisionShape(
            pybullet.GEOM_CYLINDER, radius=1.0, height=scene.height, physicsClientId=client
        )
        ground = pybullet.createMultiBody(0.0, plane, physicsClientId=client)
        # Bullet multiplies friction and restitution of the two bodies
        self.dynamics(ground, restitution=1.0, lateralFriction=1.0)
        self.bodies = [
            pybullet.createMultiBody(
                1.0,
                cylinder,
                basePosition=[APART * i, 0.0, 10.0],
                useMaximalCoordinates=True,
                physicsClientId=client,
            )
            for i in range(coins)
        ]
        for body in self.bodies:
            pybullet.setCollisionFilterGroupMask(body, -1, MOVING, STILL, physicsClientId=client)
            self.dynamics(
                body,
                restitution=scene.restitution,
                lateralFriction=scene.friction,
                rollingFriction=scene.rolling,
                spinningFriction=scene.rolling,
                activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            )
        # a cylinder's, which this kind of body must not be told again
        inertia = pybullet.getDynamicsInfo(self.bodies[0], -1, physicsClientId=client)[2]
        if not np.allclose(inertia, (scene.transverse, scene.transverse, scene.axial)):
            raise SystemExit(f"Bullet gives the coin the moments of inertia {inertia}")

    def dynamics(self, body: int, **settings) -> None:
        """Sets what a body is made of; no damping."""
        pybullet.changeDynamics(
            body, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=self.client, **settings
        )

    def place(self, coin: int, launch: Launch) -> None:
        body, client = self.bodies[coin], self.client
        w, x, y, z = turn_to(launch.axis)
        pybullet.resetBasePositionAndOrientation(
            body, [APART * coin, 0.0, launch.height], [x, y, z, w], physicsClientId=client
        )
        pybullet.resetBaseVelocity(
            body, list(launch.velocity), list(launch.spin), physicsClientId=client
        )

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            pybullet.stepSimulation(physicsClientId=self.client)

    def states(self):
        client = self.client
        poses = [
            pybullet.getBasePositionAndOrientation(body, physicsClientId=client)
            for body in self.bodies
        ]
        motions = [pybullet.getBaseVelocity(body, physicsClientId=client) for body in self.bodies]
        place, turn = (np.array(part) for part in zip(*poses, strict=True))
        velocity, spin = (np.array(part) for part in zip(*motions, strict=True))
        x, y, z, w = turn.T
        return place[:, 2], velocity, axis_of(w, x, y, z), spin
