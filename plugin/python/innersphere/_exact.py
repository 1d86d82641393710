"""Volumes that solids share, from their triangles: slow, and right."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import InvalidArgumentError, MissingLibraryError, NotFiniteError
from ._pack import triangles_of
from ._poses import parts_of_pose

exact_dtype = np.dtype([("volume", np.float64), ("centroid", np.float64, 3)])
"""The type of what exact_overlap() returns: fields of Query.overlap()'s results."""


def exact_overlap(a: Any, b: Any, pose_a: Any = None, pose_b: Any = None, *, repair: bool = False) -> NDArray[Any]:
    """The volume that two solids share, by intersecting their triangles: to see how far off Query.overlap() is.

    It takes milliseconds a pose where a query takes microseconds. Needs Manifold (pip install manifold3d).

    a, b: closed meshes, as pack() takes them, or packings, whose surface is in single precision. What their shells share
        counts once.
    pose_a, pose_b: as Query.overlap() takes them.
    repair: closes open meshes first, as pack() does.

    Returns a structured array of exact_dtype, of the shape of the poses:

    volume    that they share [m^3]
    centroid  of that volume, relative to the translation of pose_a [m]; zero where they share nothing

    Raises MissingLibraryError without Manifold; TypeError and ValueError for arrays of the wrong type or shape;
    NotASolidError; InvalidArgumentError for a surface that Manifold does not take; InvalidArgumentError and NotFiniteError,
    with the number of the query in C's order, for poses that are none.
    """
    try:
        import manifold3d
    except ImportError:
        raise MissingLibraryError("exact overlaps need Manifold: pip install manifold3d") from None
    solids = [_manifold(manifold3d, mesh, name, repair) for mesh, name in ((a, "a"), (b, "b"))]
    (place_a, turn_a), (place_b, turn_b) = parts_of_pose(pose_a, "pose_a"), parts_of_pose(pose_b, "pose_b")
    shape = np.broadcast_shapes(place_a.shape[:-1], turn_a.shape[:-2], place_b.shape[:-1], turn_b.shape[:-2])
    placed_a, placed_b = (
        np.concatenate(
            [np.broadcast_to(turn, (*shape, 3, 3)), np.broadcast_to(place, (*shape, 3))[..., None]], axis=-1
        ).reshape(-1, 3, 4)
        for turn, place in ((turn_a, np.zeros(3)), (turn_b, place_b - place_a))
    )
    found = np.zeros(len(placed_a), exact_dtype)
    for i, poses in enumerate(zip(placed_a, placed_b)):
        for name, pose in zip(("A", "B"), poses):
            if not np.isfinite(pose).all():
                raise NotFiniteError(f"query {i}: the placement of {name} has a number that is not finite")
            if not np.allclose(pose[:, :3] @ pose[:, :3].T, np.eye(3), atol=1e-4):
                raise InvalidArgumentError(f"query {i}: the placement of {name} turns by no rotation")
        shared = solids[0].transform(poses[0]) ^ solids[1].transform(poses[1])
        found[i] = _volume_and_centroid(shared.to_mesh64())
    return found.reshape(shape)


def _manifold(manifold3d: Any, mesh: Any, name: str, repair: bool) -> Any:
    if isinstance(mesh, _core.Packing):
        if len(mesh.faces) == 0:
            raise InvalidArgumentError(f"{name} is a packing without a surface")
        vertices, faces = mesh.vertices + mesh.origin, mesh.faces
    else:
        vertices, faces = _core.surface_of_mesh(triangles_of(mesh, 1.0), name, repair)
    whole = _manifold_of_shells(manifold3d, vertices, faces, name)
    # Manifold counts what shells share once for each of them: bodies are found, with their cavities, and united.
    shells = [shell.to_mesh64() for shell in whole.decompose()]
    if len(shells) == 1:
        return whole
    corners = [np.asarray(shell.vert_properties)[:, :3] for shell in shells]
    first = np.cumsum([0, *map(len, corners)])
    rows = [np.asarray(shell.tri_verts).astype(np.int64) + start for shell, start in zip(shells, first)]
    bodies = _core.bodies_of(np.ascontiguousarray(np.concatenate(corners)), np.concatenate(rows))
    parts = [_manifold_of_shells(manifold3d, *body, name) for body in bodies]
    return manifold3d.Manifold.batch_boolean(parts, manifold3d.OpType.Add)


def _manifold_of_shells(manifold3d: Any, vertices: Any, faces: Any, name: str) -> Any:
    mesh = manifold3d.Mesh64(np.ascontiguousarray(vertices, np.float64), faces.astype(np.uint64))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise InvalidArgumentError(f"Manifold does not take the surface of {name}: {solid.status().name}")
    return solid


def _volume_and_centroid(mesh: Any) -> tuple[float, NDArray[np.float64]]:
    """By the divergence theorem: the tetrahedra from one point to all triangles."""
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    if len(corners) == 0:
        return 0.0, np.zeros(3)
    middle = corners.mean((0, 1))
    p, q, r = np.moveaxis(corners - middle, 1, 0)
    volumes = np.einsum("ij,ij->i", p, np.cross(q, r)) / 6
    volume = volumes.sum()
    if volume <= 0:
        return 0.0, np.zeros(3)
    return float(volume), middle + (volumes[:, None] * (p + q + r)).sum(0) / (4 * volume)
