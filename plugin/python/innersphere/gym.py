"""An environment for learners, with the API of Gymnasium: a nut is to be screwed down its bolt, in PyBullet.

    import gymnasium
    import innersphere.gym

    envs = gymnasium.make_vec("innersphere/NutOnBolt-v0", 8, vectorization_mode="async", vector_kwargs={"context": "spawn"})

runs eight of them in processes of their own, each with a PyBullet client of its own. Needs pip install gymnasium pybullet.
"""

from __future__ import annotations

import math
import os
from typing import Any

import gymnasium
import numpy as np
import pybullet as p
from numpy.typing import NDArray

from ._arrays import as_float64
from ._core import solid
from ._errors import InvalidArgumentError, NotFiniteError
from ._pack import pack
from .pybullet import attach

PITCH = 0.125  # of the thread [m]
_TURN = 2 * math.pi / PITCH  # by which a nut turns for each metre, counter-clockwise seen from above as it rises


class NutOnBolt(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """A nut of 1 kg on a fixed bolt. Gravity is too weak to turn it against friction; a wrench has to.

    action: force and torque on the nut, relative to `strength`: 6 numbers from -1 to 1. They act at its centre of mass,
        along the axes of the world, for 1/20 s. Numbers outside count as -1 or 1. Raises InvalidArgumentError for another
        shape than (6,), NotFiniteError for nan and infinity, TypeError for what is no array of real numbers.
    observation: position of the nut's mesh [m], its orientation (quaternion x y z w), velocity [m/s] and angular velocity
        [rad/s]: 13 numbers.
    reward: how far the nut came down in this step, in pitches.
    terminated: when the nut is at 0.1 m, near the bolt's head. truncated: after 200 steps.

    An episode begins with the nut somewhere on the thread, from 0.35 to 0.6 m, chosen by the seed. The same seed and
    actions give the same episode.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}
    goal = 0.1  # height at which an episode ends [m]
    substeps = 12  # of 1/240 s
    strength = np.array([5, 5, 5, 1, 1, 1])  # [N], [N m]
    friction = 0.5  # of each; PyBullet takes the product

    def __init__(
        self, spheres: int = 1000, cache: str | os.PathLike[str] | None = None, render_mode: str | None = None
    ) -> None:
        """spheres: of each packing. cache: folder in which packings are kept, for processes that start together."""
        self.render_mode = render_mode
        self.action_space = gymnasium.spaces.Box(-1, 1, (6,), np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (13,), np.float32)
        self._bolt, self._nut = (
            pack(solid(name), spheres=spheres, cache=cache, overlap_errors=False, name=name) for name in ("bolt", "nut")
        )
        self._client = p.connect(p.DIRECT)
        self._sim = attach(self._client)
        self._body = -1
        self._height = 0.0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        p.resetSimulation(physicsClientId=self._client)
        p.setGravity(0, 0, -9.81, physicsClientId=self._client)
        height = float(self.np_random.uniform(0.35, 0.6))
        turn = p.getQuaternionFromEuler([0, 0, _TURN * height])
        visual = None if self.render_mode else -1
        bolt = self._sim.create_body(self._bolt, visual=visual)
        self._body = self._sim.create_body(self._nut, 1.0, [0, 0, height], turn, visual=visual)
        for body in (bolt, self._body):
            p.changeDynamics(body, -1, lateralFriction=self.friction, restitution=0, physicsClientId=self._client)
        self._height = height
        return self._observation(), {}

    def _observation(self) -> NDArray[np.float32]:
        position, orientation = self._sim.mesh_pose(self._body)
        velocity, spin = p.getBaseVelocity(self._body, physicsClientId=self._client)
        return np.array([*position, *orientation, *velocity, *spin], dtype=np.float32)

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        numbers = as_float64(action, "action")
        if numbers.shape != self.action_space.shape:
            raise InvalidArgumentError(f"action has the shape {numbers.shape}; it must be (6,): force and torque")
        if not np.isfinite(numbers).all():
            raise NotFiniteError(f"action is {numbers.tolist()}; it must be finite")
        wrench = self.strength * np.clip(numbers, -1, 1)
        for _ in range(self.substeps):
            at = p.getBasePositionAndOrientation(self._body, physicsClientId=self._client)[0]
            force, torque = wrench[:3].tolist(), wrench[3:].tolist()
            p.applyExternalForce(self._body, -1, force, at, p.WORLD_FRAME, physicsClientId=self._client)
            p.applyExternalTorque(self._body, -1, torque, p.WORLD_FRAME, physicsClientId=self._client)
            p.stepSimulation(physicsClientId=self._client)
        observation = self._observation()
        reward = (self._height - float(observation[2])) / PITCH
        self._height = float(observation[2])
        return observation, reward, self._height <= self.goal, False, {}

    def render(self) -> Any:
        if self.render_mode is None:
            return None
        view = p.computeViewMatrixFromYawPitchRoll([0, 0, 0.4], 2.5, 30, -25, 0, 2)
        lens = p.computeProjectionMatrixFOV(40, 4 / 3, 0.01, 100)
        pixels = p.getCameraImage(320, 240, view, lens, renderer=p.ER_TINY_RENDERER, physicsClientId=self._client)[2]
        return np.reshape(pixels, (240, 320, 4))[..., :3].astype(np.uint8)

    def close(self) -> None:
        if p.isConnected(self._client):
            p.disconnect(self._client)


gymnasium.register("innersphere/NutOnBolt-v0", entry_point="innersphere.gym:NutOnBolt", max_episode_steps=200)
