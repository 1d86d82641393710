"""Gradients of overlaps by poses. They are exact: the query finds forces, torques and areas along the way."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._arrays import as_float64
from ._core import Packing, Query
from ._poses import parts_of_pose, turned

Array = NDArray[np.float64]


def value_and_gradients(
    what: Literal["energy", "volume"], query: Query, a: Packing, b: Packing, pose_a: Any, pose_b: Any, **options: Any
) -> tuple[Array, list[Array]]:
    """Returns energies or volumes, and their gradients by the arrays of pose_a and then of pose_b.

    A pose has two arrays (positions, quaternions), one (matrices) or none. Gradients have the shape of the result before
    that of a single pose. They are those along rotations: steps off unit quaternions and orthogonal matrices change
    nothing. what: "energy" has force and torque for its gradient; "volume" has the area, which goes on where
    the volume ends at that of the smaller solid. With estimator="surface" both are the same.
    """
    got = np.asarray(query.overlap(a, b, pose_a, pose_b, **options))
    (place_a, turn_a), (place_b, _) = parts_of_pose(pose_a, "pose_a"), parts_of_pose(pose_b, "pose_b")
    arm = np.broadcast_to(place_b - place_a, (*got.shape, 3))
    # "surface" has no energy of lenses: its force and torque are of the volume.
    if what == "energy" or options.get("estimator") == "surface":
        force, torque = got["force"], got["torque"]
    else:
        force = got["area"]
        torque = _torque_of_area(query, a, b, pose_a, pose_b, turn_a, got.shape, options) - np.cross(arm, force)
    # Both bodies together can be moved and turned without any change.
    of_a = _by_pose(pose_a, -force, -(torque + np.cross(arm, force)))
    return got[what], of_a + _by_pose(pose_b, force, torque)


def _torque_of_area(
    query: Query, a: Packing, b: Packing, pose_a: Any, pose_b: Any, turn_a: Array, shape: Any, options: Any
) -> Array:
    """Torque of the areas about the translation of A. That of each lens goes through the centre of A's sphere."""
    (contacts, first), _ = query.contacts(a, b, pose_a, pose_b, **options)
    centres = a.origin + a.spheres[contacts["sphere"], :3]
    number = np.repeat(np.arange(len(first) - 1), np.diff(first))
    turns = np.broadcast_to(turn_a, (*shape, 3, 3)).reshape(-1, 3, 3)[number]
    torques = np.cross(np.einsum("nij,nj->ni", turns, centres), contacts["area"])
    total = np.zeros((len(first) - 1, 3))
    np.add.at(total, number, torques)
    return total.reshape(*shape, 3)


def _by_pose(pose: Any, force: Array, torque: Array) -> list[Array]:
    """Gradients by the arrays of a pose, of what falls by `force` for a step and by `torque` for a turn."""
    if pose is None:
        return []
    if isinstance(pose, tuple):
        q = np.broadcast_to(as_float64(pose[1], "quaternion"), (*force.shape[:-1], 4))
        u, w = q[..., :3], q[..., 3:]
        # A turn by a small w changes q by w q / 2.
        vector = w * torque + np.cross(torque, u)
        return [-force, -2 * np.concatenate([vector, -(torque * u).sum(-1, keepdims=True)], axis=-1)]
    gradient = np.zeros((*force.shape[:-1], 4, 4))
    gradient[..., :3, 3] = -force
    matrix = np.broadcast_to(as_float64(pose, "pose"), gradient.shape)
    gradient[..., :3, :3] = -np.cross(torque[..., None, :], matrix[..., :3, :3], axisc=-2, axisb=-2, axisa=-1) / 2
    return [gradient]
