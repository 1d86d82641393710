"""Surfaces of solids that are given by distances."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import EmptyInputError, InvalidArgumentError, NotFiniteError


def surface_of(
    distance: Callable[[NDArray[np.float64]], Any], low: Any, high: Any, *, cells: int = 64
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Makes the surface of a solid that is given by a signed distance: pack(surface_of(...)).

    distance: gets points (n, 3) [m], and returns n numbers: negative inside, positive outside, zero on the surface. They
        need not be distances; the nearer they are to them, the more exact is the surface.
    low, high: corners of a box that the solid lies in [m]: three numbers, or one for all axes. What reaches out is cut off.
    cells: of the grid, along the longest side of the box. The surface is off by some hundredth of a cell where it is
        smooth, edges are rounded by a cell, and what is thinner than a cell may be lost.

    Returns vertices (n, 3) and faces (m, 3), closed, counter-clockwise seen from outside. By marching tetrahedra
    (A. Doi and A. Koide, IEICE Transactions E74, 1991). Raises EmptyInputError if the distance is nowhere negative,
    NotFiniteError, InvalidArgumentError, and ValueError for the wrong number of numbers.
    """
    low, high = np.broadcast_to(low, 3).astype(float), np.broadcast_to(high, 3).astype(float)
    if not (np.isfinite(low).all() and np.isfinite(high).all() and (high > low).all() and cells >= 1):
        raise InvalidArgumentError(f"the box from {low} to {high} with {cells} cells has no inside")
    step = float((high - low).max() / cells)
    shape = np.ceil((high - low) / step - 1e-9).astype(int) + 1
    axes = [low[k] + step * np.arange(shape[k]) for k in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=3).reshape(-1, 3)
    values = np.asarray(distance(points), dtype=float)
    if values.shape != (len(points),):
        raise ValueError(f"distance returned the shape {values.shape} for {len(points)} points")
    if not np.isfinite(values).all():
        raise NotFiniteError("distance returned a number that is not finite")
    grid = np.maximum(values, np.maximum(low - points, points - high).max(axis=1)).reshape(shape)
    if not (grid < 0).any():
        raise EmptyInputError("distance is negative nowhere on the grid: nothing is inside")
    # Not on the vertices of the grid: triangles would have no area.
    least = 1e-3 * step
    grid = np.where(np.abs(grid) < least, np.copysign(least, grid), grid)
    return _marching_tetrahedra(grid, points)


# The six tetrahedra of a cell go from its lowest corner to its highest, in each order of the axes. All of them turn the
# same way, those of odd orders after two corners have changed places.
_TETRAHEDRA = []
for _order in itertools.permutations(range(3)):
    _corners = np.cumsum([np.zeros(3, int), *np.eye(3, dtype=int)[list(_order)]], axis=0)
    if np.linalg.det(np.eye(3)[list(_order)]) < 0:
        _corners = _corners[[0, 2, 1, 3]]
    _TETRAHEDRA.append(_corners)

# Which corners are inside (bits), and the triangles as edges (from, to); outwards for tetrahedra of positive volume.
_TRIANGLES: dict[int, list[list[tuple[int, int]]]] = {}
for _inside in range(1, 15):
    _in = [k for k in range(4) if _inside >> k & 1]
    _out = [k for k in range(4) if not _inside >> k & 1]
    if len(_in) == 2:
        _ring = [(_in[0], _out[0]), (_in[0], _out[1]), (_in[1], _out[1]), (_in[1], _out[0])]
        _found = [_ring[:3], [_ring[0], _ring[2], _ring[3]]]
    else:
        _found = [[(i, o) for i in _in for o in _out]]
    _unit = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])  # turns as the tetrahedra do
    _outward = _unit[_out].mean(0) - _unit[_in].mean(0)
    for _triangle in _found:
        _a, _b, _c = ((_unit[i] + _unit[o]) / 2 for i, o in _triangle)
        if np.dot(np.cross(_b - _a, _c - _a), _outward) < 0:
            _triangle.reverse()
    _TRIANGLES[_inside] = _found


def _marching_tetrahedra(
    grid: NDArray[np.float64], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    values = grid.ravel()
    numbers = np.arange(grid.size).reshape(grid.shape)
    size = np.array(grid.shape) - 1
    edges = []  # a row for each triangle: three edges of two points of the grid
    for corners in _TETRAHEDRA:
        tetrahedron = np.stack([numbers[tuple(slice(c, c + n) for c, n in zip(at, size))].ravel() for at in corners], 1)
        inside = (values[tetrahedron] < 0) @ [1, 2, 4, 8]
        for case, triangles in _TRIANGLES.items():
            here = tetrahedron[inside == case]
            edges += [here[:, np.array(triangle)] for triangle in triangles]
    ends = np.sort(np.concatenate(edges), axis=2).reshape(-1, 2)
    ends, faces = np.unique(ends, axis=0, return_inverse=True)
    d = values[ends]
    t = d[:, :1] / (d[:, :1] - d[:, 1:])
    vertices = points[ends[:, 0]] + t * (points[ends[:, 1]] - points[ends[:, 0]])
    return vertices, faces.reshape(-1, 3)
