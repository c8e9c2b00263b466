"""PhysX 5, by way of sapien: its cylinder is a prism, and it knows no rolling friction."""

from __future__ import annotations

import warnings

import numpy as np
from decide import face, follow
from scene import GRAVITY, Launch, Scene, turn_to

with warnings.catch_warnings():
    # it looks for graphics, which are not needed
    warnings.simplefilter("ignore")
    import sapien
    from sapien import physx

NAME, PACKAGE = "PhysX", "sapien"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 6e-5)
in_plane = False

# sapien's cylinder lies along x
ALONG_X = np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])


class Tosser:
    """One system; a toss sets its one body's state."""

    def __init__(self, scene: Scene, step: float):
        self.scene, self.step = scene, step * scene.second
        physx.set_scene_config(
            gravity=np.array([0.0, 0.0, -GRAVITY], dtype=np.float32), bounce_threshold=1e-3
        )
        physx.set_body_config(sleep_threshold=0.0)
        # contacts are looked for within a hundredth of the radius
        physx.set_shape_config(contact_offset=0.01, rest_offset=0.0)
        self.system = physx.PhysxCpuSystem()
        self.system.timestep = self.step
        self.world = sapien.Scene([self.system])
        material = physx.PhysxMaterial(scene.friction, scene.friction, scene.restitution)
        ground = sapien.Entity()
        plane = physx.PhysxCollisionShapePlane(material)
        # its normal is x
        plane.local_pose = sapien.Pose(q=ALONG_X)
        floor = physx.PhysxRigidStaticComponent()
        floor.attach(plane)
        ground.add_component(floor)
        self.world.add_entity(ground)
        cylinder = physx.PhysxCollisionShapeCylinder(1.0, 0.5 * scene.height, material)
        cylinder.local_pose = sapien.Pose(q=ALONG_X)
        self.body = physx.PhysxRigidDynamicComponent()
        self.body.attach(cylinder)
        self.body.mass = 1.0
        self.body.cmass_local_pose = sapien.Pose()
        self.body.inertia = [scene.transverse, scene.transverse, scene.axial]
        self.body.linear_damping = self.body.angular_damping = 0.0
        self.body.max_angular_velocity = 1e4
        self.coin = sapien.Entity()
        self.coin.add_component(self.body)
        self.world.add_entity(self.coin)

    def toss(self, launch: Launch) -> str | None:
        body = self.body
        self.coin.pose = sapien.Pose(p=[0.0, 0.0, launch.height], q=turn_to(launch.axis))
        body.linear_velocity = launch.velocity
        body.angular_velocity = launch.spin
        body.wake_up()

        def advance(steps):
            for _ in range(steps):
                self.system.step()

        def look():
            pose = self.coin.pose
            w, x, y, z = pose.q
            axis = (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y))
            return face(self.scene, pose.p[2], body.linear_velocity, axis, body.angular_velocity)

        return follow(self.scene, self.step, advance, look)
