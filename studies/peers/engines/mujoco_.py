"""MuJoCo: soft contacts, friction lengths, no coefficient of restitution.

Restitution is asked for by the damping ratio of the contact, as its manual advises: an oscillator
of damping ratio ζ comes back after half a period with e = exp(−πζ/sqrt(1 − ζ²)). Half a period is
six steps, about the least that resolves it.
"""

from __future__ import annotations

import math

import mujoco
from decide import face, follow
from scene import GRAVITY, Launch, Scene, turn_to

NAME, PACKAGE = "MuJoCo", "mujoco"
STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
in_plane = False


class Tosser:
    """One model; a toss sets its state."""

    def __init__(self, scene: Scene, step: float):
        self.scene, self.step = scene, step * scene.second
        log = math.log(max(scene.restitution, 1e-3))
        damping = -log / math.hypot(math.pi, log)
        # (time constant, ζ): the oscillator's frequency is 1/(time constant · ζ), here 1/(2 steps)
        stiff = f"{2.0 * self.step / damping} {damping}"
        rolling = max(scene.rolling, 1e-9)
        friction = f"{scene.friction} {rolling} {rolling}"
        contact = f'condim="6" friction="{friction}" solref="{stiff}" solimp="0.99 0.99 0.01"'
        xml = f"""<mujoco>
          <option timestep="{self.step}" gravity="0 0 {-GRAVITY}" integrator="implicitfast"
            cone="elliptic"/>
          <worldbody>
            <geom type="plane" size="0 0 1" {contact}/>
            <body pos="0 0 10"><freejoint/>
              <inertial pos="0 0 0" mass="1"
                diaginertia="{scene.transverse} {scene.transverse} {scene.axial}"/>
              <geom type="cylinder" size="1 {0.5 * scene.height}" {contact}/>
            </body>
          </worldbody></mujoco>"""
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)

    def toss(self, launch: Launch) -> str | None:
        model, data = self.model, self.data
        mujoco.mj_resetData(model, data)
        data.qpos[:3] = (0.0, 0.0, launch.height)
        data.qpos[3:] = turn_to(launch.axis)
        data.qvel[:3] = launch.velocity
        mujoco.mj_kinematics(model, data)
        turn = data.xmat[1].reshape(3, 3)
        # MuJoCo's angular velocity is in the body's frame
        data.qvel[3:] = turn.T @ launch.spin

        def look():
            turn = data.xmat[1].reshape(3, 3)
            return face(self.scene, data.qpos[2], data.qvel[:3], turn[:, 2], turn @ data.qvel[3:])

        return follow(self.scene, self.step, lambda n: mujoco.mj_step(model, data, nstep=n), look)
