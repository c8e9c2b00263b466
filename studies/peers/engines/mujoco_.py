"""MuJoCo: soft contacts, friction lengths, no coefficient of restitution.

Restitution is asked for by the damping ratio of the contact, as its manual advises: an oscillator
of damping ratio ζ comes back after half a period with e = exp(−πζ/sqrt(1 − ζ²)). Half a period is
six steps, about the least that resolves it.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from scene import GRAVITY, Launch, Scene, turn_to

NAME, PACKAGE = "MuJoCo", "mujoco"
STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
COINS = 8
in_plane = False


class World:
    """One model of coins that touch the ground alone; a toss sets the state of one of them."""

    def __init__(self, scene: Scene, step: float, coins: int):
        self.coins, step = coins, step * scene.second
        log = math.log(max(scene.restitution, 1e-3))
        damping = -log / math.hypot(math.pi, log)
        # (time constant, ζ): the oscillator's frequency is 1/(time constant · ζ), here 1/(2 steps)
        stiff = f"{2.0 * step / damping} {damping}"
        rolling = max(scene.rolling, 1e-9)
        friction = f"{scene.friction} {rolling} {rolling}"
        contact = f'condim="6" friction="{friction}" solref="{stiff}" solimp="0.99 0.99 0.01"'
        coin = f"""<body pos="0 0 10"><freejoint/>
              <inertial pos="0 0 0" mass="1"
                diaginertia="{scene.transverse} {scene.transverse} {scene.axial}"/>
              <geom type="cylinder" size="1 {0.5 * scene.height}" contype="0" conaffinity="1"
                {contact}/>
            </body>"""
        xml = f"""<mujoco>
          <option timestep="{step}" gravity="0 0 {-GRAVITY}" cone="elliptic"
            iterations="10" ls_iterations="10"/>
          <worldbody>
            <geom type="plane" size="0 0 1" contype="1" conaffinity="0" {contact}/>
            {coin * coins}
          </worldbody></mujoco>"""
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)
        # views of the simulation's own arrays, a row a coin
        self.position = self.data.qpos.reshape(coins, 7)
        self.velocity = self.data.qvel.reshape(coins, 6)
        self.turns = self.data.xmat[1:].reshape(coins, 3, 3)
        self.warm = self.data.qacc_warmstart.reshape(coins, 6)

    def place(self, coin: int, launch: Launch) -> None:
        turn = turn_to(launch.axis)
        self.position[coin] = (0.0, 0.0, launch.height, *turn)
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, turn)
        self.velocity[coin, :3] = launch.velocity
        # MuJoCo's angular velocity is in the body's frame
        self.velocity[coin, 3:] = matrix.reshape(3, 3).T @ launch.spin
        self.warm[coin] = 0.0

    def advance(self, steps: int) -> None:
        mujoco.mj_step(self.model, self.data, nstep=steps)

    def states(self):
        spin = np.einsum("ijk,ik->ij", self.turns, self.velocity[:, 3:])
        return self.position[:, 2], self.velocity[:, :3], self.turns[:, :, 2], spin
