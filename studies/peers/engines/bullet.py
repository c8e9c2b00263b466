"""Bullet: sequential impulses, coefficients of rolling and spinning friction."""

from __future__ import annotations

import pybullet
from decide import face, follow
from scene import GRAVITY, Launch, Scene, turn_to

NAME, PACKAGE = "Bullet", "pybullet"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 6e-5)
in_plane = False


class Tosser:
    """One world; a toss sets its one body's state."""

    def __init__(self, scene: Scene, step: float):
        self.scene, self.step = scene, step * scene.second
        self.client = client = pybullet.connect(pybullet.DIRECT)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=self.step,
            numSubSteps=0,
            restitutionVelocityThreshold=0.0,
            physicsClientId=client,
        )
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=client)
        plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
        cylinder = pybullet.createCollisionShape(
            pybullet.GEOM_CYLINDER, radius=1.0, height=scene.height, physicsClientId=client
        )
        ground = pybullet.createMultiBody(0.0, plane, physicsClientId=client)
        self.coin = pybullet.createMultiBody(
            1.0, cylinder, basePosition=[0.0, 0.0, 10.0], physicsClientId=client
        )
        # Bullet multiplies friction and restitution of the two bodies
        for body, of_coin in ((ground, False), (self.coin, True)):
            pybullet.changeDynamics(
                body,
                -1,
                restitution=scene.restitution if of_coin else 1.0,
                lateralFriction=scene.friction if of_coin else 1.0,
                rollingFriction=scene.rolling if of_coin else 0.0,
                spinningFriction=scene.rolling if of_coin else 0.0,
                linearDamping=0.0,
                angularDamping=0.0,
                physicsClientId=client,
            )
        pybullet.changeDynamics(
            self.coin,
            -1,
            localInertiaDiagonal=[scene.transverse, scene.transverse, scene.axial],
            maxJointVelocity=1e9,
            activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=client,
        )

    def toss(self, launch: Launch) -> str | None:
        client, coin = self.client, self.coin
        w, x, y, z = turn_to(launch.axis)
        pybullet.resetBasePositionAndOrientation(
            coin, [0.0, 0.0, launch.height], [x, y, z, w], physicsClientId=client
        )
        pybullet.resetBaseVelocity(
            coin, list(launch.velocity), list(launch.spin), physicsClientId=client
        )

        def advance(steps):
            for _ in range(steps):
                pybullet.stepSimulation(physicsClientId=client)

        def look():
            place, turn = pybullet.getBasePositionAndOrientation(coin, physicsClientId=client)
            velocity, spin = pybullet.getBaseVelocity(coin, physicsClientId=client)
            axis = pybullet.getMatrixFromQuaternion(turn)[2::3]
            return face(self.scene, place[2], velocity, axis, spin)

        return follow(self.scene, self.step, advance, look)
