"""Spheres of a packing, or as many that cover its solid."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Packing

Array = NDArray[np.float64]


class Spheres(NamedTuple):
    """Spheres that stand for a solid."""

    spheres: Array
    """(n, 4) float64: centres and radii in the frame of the solid [m]."""
    overhang: float
    """How far their union reaches out of the solid, the most at many points of it [m]: 0 for inner spheres."""


def spheres_of(packing: Packing, *, cover: bool = False, resolution: float = 0.002) -> Spheres:
    """Returns the spheres of a packing as they are, or as many that contain the solid.

    packing: packing[:n] gives n spheres.
    cover: inner spheres leave the surface out, by quality["gap_max"] at most. Planners that must not miss a collision
        want all of the solid in the spheres: these move and grow until no point of it is left out, on the surface and
        inside, as `innersphere pack --cover` does. They overlap each other.
    resolution: side of the smallest cells for which that is proven, relative to the diagonal of the solid, 1e-4 to 0.1.
        Spheres grow by up to 1.7 times this more than they must.

    Raises EmptyInputError if the surface is needed and unknown, InvalidArgumentError for the resolution.
    """
    if cover:
        return Spheres(*_core.cover(packing, resolution))
    balls = packing.spheres.astype(np.float64)
    balls[:, :3] += packing.origin
    return Spheres(balls, 0.0)
