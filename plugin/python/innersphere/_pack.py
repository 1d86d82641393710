"""Packings from meshes and from files."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import as_count, as_float64, as_indices
from ._errors import InvalidArgumentError
from ._progress import ProgressBar


def pack(
    mesh: Any,
    *,
    spheres: int = 10000,
    min_radius: float = 0.0,
    density: float = 0.0,
    gap: float = 0.0,
    order: Literal["radius", "coverage"] = "radius",
    delta: float = 0.1,
    overlap_errors: bool = True,
    threads: int = 0,
    repair: bool = False,
    scale: float | Sequence[float] = 1.0,
    name: str | None = None,
    cache: str | os.PathLike[str] | None = None,
    progress: bool | Callable[[str, float], object] = False,
) -> _core.Packing:
    """Fills a solid with spheres that do not overlap.

    mesh: the path of a mesh (OBJ, STL, PLY, OFF, glTF, ...); a tuple of vertices (n, 3) and faces (m, 3), which are
        rows of vertices, counter-clockwise seen from outside; or an object with such arrays as ``vertices`` and
        ``faces``, like a trimesh.Trimesh. It must bound a volume.

    The first limit that is reached ends the packing; 0 sets none, and one has to be set. Down to 1e-4 of the diagonal there
    are millions of spheres, which takes many minutes.
    spheres: number of spheres. 256 are enough for contacts, thousands for volumes.
    min_radius: radius of the smallest sphere [m]; 0: 1e-4 of the diagonal.
    density: fraction of the solid that is filled, 0 to 1.
    gap: largest distance from a sphere of 50,000 points spread over the surface [m].

    order: what the first spheres are chosen for. "radius": the largest come first, and fill most. "coverage": after a few
        of the largest, spheres come first where the surface is farthest from all before, so that few spheres are in all thin
        walls and slender parts.
    delta: each sphere has at least 1/(1+delta) of the largest possible radius, 0.001 to 1. Less is denser and slower.
    overlap_errors: whether to measure how far volumes of overlaps are off, which takes more than half of the time.
    threads: 0 are all cores. The result does not depend on it.
    repair: whether an open mesh is packed all the same. Vertices within 1e-4 of the diagonal are welded where it is open,
        holes closed with flat fans, the ends of pipes with rings.
    scale: factor for all coordinates: 0.001 for millimetres; or three, for x, y and z, as the scale of a URDF: [-1, 1, 1]
        packs the mirror image.
    name: of the solid, for messages and provenance; None: the path, or "mesh".
    cache: folder in which packings are kept, so that the same mesh with the same options is packed once; None: none.
    progress: True shows a bar on the standard error stream. A function gets the stage and the fraction of it that is
        done, 0 to 1; if it returns False, packing ends with CancelledError; what it raises is raised here.
        Ctrl-C ends packing, too.

    Returns the packing; its ``warnings`` say what was mended. Raises TypeError and ValueError for arrays of the wrong
    type or shape, NotASolidError with the defect and its place, InvalidArgumentError, NotFiniteError, EmptyInputError,
    NoSphereFitsError, FileMissingError, FormatError, CancelledError.
    """
    if isinstance(mesh, (str, os.PathLike)):
        name = os.fspath(mesh) if name is None else name
    triangles = triangles_of(mesh, scale)
    spheres = as_count(spheres, "spheres")
    if spheres == min_radius == density == gap == 0:
        raise InvalidArgumentError("spheres is 0, so that nothing ends the packing; name spheres, min_radius, density or gap")
    bar = ProgressBar() if progress is True else None
    callback = bar if progress is True else None if progress is False or progress is None else progress
    if callback is not None and not callable(callback):
        raise TypeError(f"progress is of the type {type(progress).__name__}; it must be True, False or a function")
    try:
        return _core.pack(
            triangles,
            "mesh" if name is None else name,
            spheres,
            min_radius,
            density,
            gap,
            order,
            delta,
            overlap_errors,
            as_count(threads, "threads"),
            repair,
            "" if cache is None else os.fspath(cache),
            callback,
        )
    finally:
        if bar is not None:
            bar.close()


def read(path: str | os.PathLike[str]) -> _core.Packing:
    """Reads a packing from a .cbor, .json or .xyzr file, as the tool and Packing.save() write them.

    Raises FileMissingError, FormatError, UnsupportedVersionError, EmptyInputError, NotFiniteError.
    """
    return _core.read(path)


def triangles_of(mesh: Any, scale: Any) -> _core.Mesh:
    """Makes the triangles of a mesh that is given as pack() takes it."""
    factors = _factors(scale)
    largest = float(np.abs(factors).max())
    triangles = _evenly_scaled(mesh, largest)
    triangles.stretch((factors / largest).tolist())
    return triangles


def _factors(scale: Any) -> NDArray[np.float64]:
    """Those of the three axes. One number is of all, and does not mirror; of three, each may."""
    factors = as_float64(scale, "scale")
    if factors.shape == ():
        if not (np.isfinite(factors) and factors > 0):
            raise InvalidArgumentError(f"scale is {scale}; it must be positive")
    elif factors.shape != (3,):
        raise ValueError(f"scale has the shape {factors.shape}; it must be a number or (3,)")
    elif not (np.isfinite(factors) & (factors != 0)).all():
        raise InvalidArgumentError(f"scale is {factors.tolist()}; it must be finite and not 0")
    return np.broadcast_to(factors, 3)


def _evenly_scaled(mesh: Any, scale: float) -> _core.Mesh:
    if isinstance(mesh, (str, os.PathLike)):
        return _core.read_mesh(os.fspath(mesh), scale)
    if isinstance(mesh, (tuple, list)):
        if len(mesh) != 2:
            raise ValueError(f"mesh has {len(mesh)} parts; it must be vertices and faces")
        vertices, faces = mesh
    elif hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        vertices, faces = mesh.vertices, mesh.faces
    else:
        of_scene = "; join the meshes of a scene: scene.to_mesh()" if hasattr(mesh, "geometry") else ""
        raise TypeError(
            f"mesh is of the type {type(mesh).__name__}; it must be a path, a tuple of vertices and faces, or an "
            f"object that has both{of_scene}"
        )
    vertices = np.ascontiguousarray(as_float64(vertices, "vertices") * scale)
    faces = as_indices(faces, "faces")
    for array, what in ((vertices, "vertices"), (faces, "faces")):
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"{what} has the shape {array.shape}; it must be (n, 3)")
    return _core.mesh_of(vertices, faces)
