"""PhysX 5, by way of sapien: its cylinder is a prism, and it knows no rolling friction."""

from __future__ import annotations

import warnings

import numpy as np
from scene import GRAVITY, Launch, Scene, axis_of, turn_to

with warnings.catch_warnings():
    # it looks for graphics, which are not needed
    warnings.simplefilter("ignore")
    import sapien
    from sapien import physx

NAME, PACKAGE = "PhysX", "sapien"
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4, 6e-5)
COINS = 200
in_plane = False

APART = 10.0
"""Between two coins at their launch, m. (They never touch, but boxes that overlap cost time.) Not
more: PhysX has single precision."""

# sapien's cylinder lies along x
ALONG_X = np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])


class World:
    """One system of coins that touch the ground alone; a toss sets the state of one of them."""

    def __init__(self, scene: Scene, step: float, coins: int):
        self.coins = coins
        physx.set_scene_config(
            gravity=np.array([0.0, 0.0, -GRAVITY], dtype=np.float32), bounce_threshold=1e-3
        )
        physx.set_body_config(sleep_threshold=0.0)
        # contacts are looked for within a hundredth of the radius
        physx.set_shape_config(contact_offset=0.01, rest_offset=0.0)
        self.system = physx.PhysxCpuSystem()
        self.system.timestep = step * scene.second
        self.world = sapien.Scene([self.system])
        material = physx.PhysxMaterial(scene.friction, scene.friction, scene.restitution)
        ground = sapien.Entity()
        plane = physx.PhysxCollisionShapePlane(material)
        # its normal is x
        plane.local_pose = sapien.Pose(q=ALONG_X)
        plane.set_collision_groups([1, 2, 0, 0])
        floor = physx.PhysxRigidStaticComponent()
        floor.attach(plane)
        ground.add_component(floor)
        self.world.add_entity(ground)
        # in rows, as single precision is finest near the origin
        side = int(np.ceil(np.sqrt(coins)))
        self.places = [
            (APART * (i % side - side // 2), APART * (i // side - side // 2)) for i in range(coins)
        ]
        self.bodies, self.entities = [], []
        for _ in range(coins):
            self.add(scene, material)

    def add(self, scene: Scene, material) -> None:
        """Adds a coin."""
        cylinder = physx.PhysxCollisionShapeCylinder(1.0, 0.5 * scene.height, material)
        cylinder.local_pose = sapien.Pose(q=ALONG_X)
        cylinder.set_collision_groups([2, 1, 0, 0])
        body = physx.PhysxRigidDynamicComponent()
        body.attach(cylinder)
        body.mass = 1.0
        body.cmass_local_pose = sapien.Pose()
        body.inertia = [scene.transverse, scene.transverse, scene.axial]
        body.linear_damping = body.angular_damping = 0.0
        body.max_angular_velocity = 1e4
        entity = sapien.Entity()
        entity.add_component(body)
        self.world.add_entity(entity)
        self.bodies.append(body)
        self.entities.append(entity)

    def place(self, coin: int, launch: Launch) -> None:
        x, y = self.places[coin]
        self.entities[coin].pose = sapien.Pose(p=[x, y, launch.height], q=turn_to(launch.axis))
        body = self.bodies[coin]
        body.linear_velocity = launch.velocity
        body.angular_velocity = launch.spin
        body.wake_up()

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            self.system.step()

    def states(self):
        poses = [entity.pose for entity in self.entities]
        height = np.array([pose.p[2] for pose in poses])
        w, x, y, z = np.array([pose.q for pose in poses]).T
        velocity = np.array([body.linear_velocity for body in self.bodies])
        spin = np.array([body.angular_velocity for body in self.bodies])
        return height, velocity, axis_of(w, x, y, z), spin
