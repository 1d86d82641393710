"""Poses: random ones for sweeps, and their parts."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import as_float64
from ._errors import InvalidArgumentError, NotFiniteError

_STEPS = 2  # of Philox's counter for a pose; each gives four numbers


def random_poses(
    count: int, low: Any, high: Any, *, seed: int = 0, first: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Makes random poses: places evenly between two corners, all turns alike.

    low, high: the corners of the box of places [m]: three numbers, or one for all axes.
    first: the number of the first pose. Pose n of a seed is the same, in whichever block it is made.

    Returns positions (count, 3) and unit quaternions (count, 4), x y z w, as Query.overlap() takes them. Raises
    InvalidArgumentError for a negative count or first, NotFiniteError for corners.
    """
    if count < 0 or first < 0:
        raise InvalidArgumentError(f"count is {count} and first is {first}; both must be 0 or more")
    low, high = np.broadcast_to(low, 3).astype(float), np.broadcast_to(high, 3).astype(float)
    if not np.isfinite([low, high]).all():
        raise NotFiniteError(f"low is {low.tolist()} and high is {high.tolist()}; both must be finite")
    source = np.random.Philox(key=seed)
    source.advance(_STEPS * first)
    u = np.random.Generator(source).random((count, 4 * _STEPS))
    # K. Shoemake, Uniform random rotations, Graphics Gems III, 1992
    r1, r2, a, b = np.sqrt(1 - u[:, 3]), np.sqrt(u[:, 3]), 2 * np.pi * u[:, 4], 2 * np.pi * u[:, 5]
    return low + (high - low) * u[:, :3], np.stack([r1 * np.sin(a), r1 * np.cos(a), r2 * np.sin(b), r2 * np.cos(b)], 1)


def parts_of_pose(pose: Any, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Translation (..., 3) and rotation matrix (..., 3, 3) of a pose, as Query.overlap() takes it.

    Raises TypeError and ValueError for arrays of the wrong type or shape."""
    if pose is None:
        return np.zeros(3), np.eye(3)
    if not isinstance(pose, tuple):
        matrix = _shaped(pose, (4, 4), name, "; it must be (..., 4, 4), or a tuple of positions and quaternions")
        return matrix[..., :3, 3], matrix[..., :3, :3]
    if len(pose) != 2:
        raise ValueError(f"{name} is a tuple of {len(pose)}; a tuple holds positions and quaternions")
    q = _shaped(pose[1], (4,), f"the quaternion of {name}")
    # Column k is what becomes of axis k.
    columns = [turned(q, np.eye(3)[k]) for k in range(3)]
    return _shaped(pose[0], (3,), f"the position of {name}"), np.stack(columns, axis=-1)


def _shaped(values: Any, inner: tuple[int, ...], name: str, wanted: str = "") -> NDArray[np.float64]:
    array = as_float64(values, name, wanted)
    if array.shape[-len(inner) :] != inner:
        raise ValueError(f"{name} has the shape {array.shape}; it must be (..., {', '.join(map(str, inner))})")
    return array


def turned(q: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turns a vector by unit quaternions x y z w."""
    u, w = q[..., :3], q[..., 3:]
    along: NDArray[np.float64] = (w * w - (u * u).sum(-1, keepdims=True)) * v
    return along + 2 * ((u @ v)[..., None] * u + w * np.cross(u, v))
