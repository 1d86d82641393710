"""What an engine is to the bench."""

import numpy as np


class Absent(Exception):
    """The engine is not on this machine."""


class Engine:
    """An engine that Python drives. Its library is imported in version() and __init__() only."""

    name: str
    settings: str  # in words, with the page of its documentation that advises them

    @classmethod
    def version(cls) -> str:
        """Raises Absent, or ImportError."""
        raise NotImplementedError

    @classmethod
    def prepare(cls, body: dict) -> None:
        """Makes what it needs of a body's mesh and keeps it beside that; not timed. No two processes prepare the same mesh."""

    def __init__(self, scene: dict, dt: float) -> None:
        """Builds a scene of scene.prepare(), to be moved in steps of dt [s]."""
        raise NotImplementedError

    def step(self, time: float) -> None:
        """From `time` to `time + dt`."""
        raise NotImplementedError

    def poses(self) -> np.ndarray:
        """Of all bodies: place of the centre of mass and quaternion x y z w of the principal frame."""
        raise NotImplementedError


class Program:
    """An engine that a program drives, which gets a scene file, the rate and where to write: OUT.f64 has the poses at all
    steps, OUT.json what run.py would write."""

    name: str
    settings: str

    @classmethod
    def version(cls) -> str:
        raise NotImplementedError

    @classmethod
    def prepare(cls, body: dict) -> None:
        pass

    @classmethod
    def command(cls, scene_file: str, rate: int, out: str) -> list[str]:
        raise NotImplementedError


def in_body_axes(body: dict, axis: list[float]) -> np.ndarray:
    """An axis of the world, in those of a body as it starts."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(body["rotation"]).inv().apply(axis)
