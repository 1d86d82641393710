"""Spheres of a packing, as many that cover its solid, or as many whose union is near to it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Packing
from ._errors import InvalidArgumentError

Array = NDArray[np.float64]


class Spheres(NamedTuple):
    """Spheres that stand for a solid."""

    spheres: Array
    """(n, 4) float64: centres and radii in the frame of the solid [m]."""
    overhang: float
    """How far their union reaches out of the solid, the most at many points of it [m]: 0 for inner spheres."""


def spheres_of(
    packing: Packing,
    *,
    cover: bool = False,
    clump: bool = False,
    resolution: float = 0.002,
    outside_weight: float = 1.0,
) -> Spheres:
    """Returns the spheres of a packing as they are, as many that contain the solid, or as many that come near to it.

    packing: packing[:n] gives n spheres.
    cover: inner spheres leave the surface out, by quality["gap_max"] at most. Planners that must not miss a collision
        want all of the solid in the spheres: these move and grow until no point of it is left out, on the surface and
        inside, as `innersphere pack --cover` does. They overlap each other. Pack with order="coverage", as it does: covers of
        spheres that are chosen by radius reach out up to four times as far.
    clump: for grains and haptics: spheres that may overlap and reach out a little, of which the union is as near to
        the solid as can be, as `innersphere pack --clump` does. 1,000 at most.
    resolution: side of the smallest cells for which a cover is proven, relative to the diagonal of the solid, 1e-4 to
        0.1. Spheres grow by up to 1.7 times this more than they must.
    outside_weight: how much volume of a clump outside of the solid counts against volume that is left out, 1 to 100.

    Raises EmptyInputError if the surface is needed and unknown, InvalidArgumentError for the resolution or weight, for
    too many spheres of a clump, and for cover and clump at once.
    """
    if cover and clump:
        raise InvalidArgumentError("a cover contains the solid, a clump comes near to it: ask for one of them")
    if cover:
        return Spheres(*_core.cover(packing, resolution))
    if clump:
        return Spheres(*_core.clump(packing, outside_weight))
    balls = packing.spheres.astype(np.float64)
    balls[:, :3] += packing.origin
    return Spheres(balls, 0.0)
