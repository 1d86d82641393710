"""Spheres that cover a surface: those of a packing, grown."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._core import Packing
from ._errors import EmptyInputError

Array = NDArray[np.float64]


class Spheres(NamedTuple):
    """Spheres that stand for a solid."""

    spheres: Array
    """(n, 4) float64: centres and radii in the frame of the solid [m]."""
    overhang: float
    """How far a sphere reaches out of the solid at most [m]: 0 for inner spheres."""


def spheres_of(packing: Packing, *, cover: bool = False, resolution: float = 0.01) -> Spheres:
    """Returns the spheres of a packing as they are, or grown so that they cover its surface.

    packing: packing[:n] gives n spheres.
    cover: inner spheres leave the surface out, by quality["gap_max"] at most. Planners that must not miss a collision
        want all of the surface in the spheres: then each grows until it holds what is nearer to it than to the others.
        No point of the surface is left out; points deep inside may be.
    resolution: longest distance between points that are looked at, relative to the diagonal of the surface. Spheres
        grow by up to 0.58 of it more than they must.

    Raises EmptyInputError if the surface is needed and unknown.
    """
    balls = packing.spheres.astype(np.float64)
    overhang = 0.0
    if cover:
        if len(packing.faces) == 0:
            raise EmptyInputError("the packing has no surface that could be covered")
        corners = packing.vertices[packing.faces].astype(np.float64)
        step = resolution * float(np.linalg.norm(np.ptp(packing.vertices, axis=0)))
        grown = _grown(balls, corners, step)
        overhang = float((grown - balls[:, 3]).max())
        balls[:, 3] = grown
    balls[:, :3] += packing.origin
    return Spheres(balls, overhang)


def _grown(balls: Array, corners: Array, step: float) -> Array:
    """Radii with which the balls hold all of the triangles."""
    radii = balls[:, 3].copy()
    # A point of a triangle is nearer to one of its corners than the longest edge / sqrt(3) (H. Jung, 1901).
    margin = step / np.sqrt(3)
    for points in _points(corners, step):
        distance = np.linalg.norm(points[:, None] - balls[None, :, :3], axis=2)
        nearest = (distance - balls[:, 3]).argmin(axis=1)
        needed = distance[np.arange(len(points)), nearest] + margin
        np.maximum.at(radii, nearest, needed)
    return radii


def _points(corners: Array, step: float) -> Any:
    """Points of triangles, some thousand at a time: corners of smaller triangles whose edges are no longer than `step`."""
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    parts = np.maximum(np.ceil(edges / step), 1).astype(int)
    for n in np.unique(parts):
        i, j = np.array([(i, j) for i in range(n + 1) for j in range(n + 1 - i)]).T
        weights = np.stack([i, j, n - i - j], 1) / n
        triangles = corners[parts == n]
        for part in np.array_split(triangles, -(-len(triangles) * len(weights) // 20_000)):
            yield np.einsum("wk,tkx->twx", weights, part).reshape(-1, 3)
