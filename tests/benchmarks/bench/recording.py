"""What a run left behind: where all bodies were after each step."""

import json
import pathlib

import numpy as np
from scipy.spatial.transform import Rotation

GRAVITY = 9.81  # [m/s^2]


class Recording:
    """Poses of the bodies at times 0, dt, 2 dt, ...; bodies are known by their names."""

    def __init__(self, scene: dict, rate: int, poses: np.ndarray) -> None:
        self.scene, self.dt = scene, 1 / rate
        self.names = [body["name"] for body in scene["bodies"]]
        self.position = poses[:, :, :3]  # of the centre of mass, [step, body, axis]
        with np.errstate(invalid="ignore", divide="ignore"):
            rotation = poses[:, :, 3:] / np.linalg.norm(poses[:, :, 3:], axis=2, keepdims=True)
        if not np.isfinite(poses).all():
            raise ValueError("poses are not finite")
        self.rotation = rotation  # quaternions x y z w
        self.steps = len(poses) - 1
        self.seconds = self.steps * self.dt

    @classmethod
    def read(cls, scene: dict, rate: int, path: pathlib.Path) -> "Recording":
        return cls(scene, rate, np.fromfile(path).reshape(-1, len(scene["bodies"]), 7))

    def step_at(self, time: float) -> int:
        return min(max(round(time / self.dt), 0), self.steps)

    def index(self, name: str) -> int:
        return self.names.index(name)

    def all_of(self, name: str | None) -> list[int]:
        """The moving bodies that a description made, or all of them."""
        return [i for i, n in enumerate(self.names) if self.scene["bodies"][i]["mass"] > 0
                and (name is None or n == name or n.rpartition(".")[0] == name)]

    def rotations(self, body: int) -> Rotation:
        return Rotation.from_quat(self.rotation[:, body])

    def mesh_position(self, body: int) -> np.ndarray:
        """Where the origin of the mesh's frame is, at all times [m]."""
        offset = np.array(self.scene["bodies"][body]["mesh_frame"])[:3, 3]
        return self.position[:, body] + self.rotations(body).apply(offset)

    def turn(self, body: int, a: int, b: int) -> float:
        """The angle between the rotations at two steps [rad]."""
        return float((self.rotations(body)[a].inv() * self.rotations(body)[b]).magnitude())

    def spin(self, body: int) -> np.ndarray:
        """Angular velocities between steps, in the world's axes [rad/s]."""
        r = self.rotations(body)
        return (r[1:] * r[:-1].inv()).as_rotvec() / self.dt

    def energy(self) -> np.ndarray:
        """Of all bodies that move, in the middle of each step [J]: there a body that falls freely has what it had."""
        total = np.zeros(self.steps)
        for i, body in enumerate(self.scene["bodies"]):
            if body["mass"] == 0:
                continue
            position = self.position[:, i]
            velocity = np.diff(position, axis=0) / self.dt
            r = self.rotations(i)
            spin = (r[:-1].inv() * r[1:]).as_rotvec() / self.dt  # in the body's axes, which are principal
            total += body["mass"] * ((velocity**2).sum(1) / 2 + GRAVITY * (position[1:, 2] + position[:-1, 2]) / 2)
            total += (np.array(body["inertia"]) * spin**2).sum(1) / 2
        return total


def read_scene(path: pathlib.Path) -> dict:
    return json.loads(path.read_text())
