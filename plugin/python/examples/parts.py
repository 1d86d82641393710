"""Solids of the examples, as packings. They are packed once, into the folder `packings`."""

from functools import cache

import numpy as np

import innersphere


def packed(surface, spheres=2000):
    """Packs a solid: vertices and faces, or the name of one of innersphere's own."""
    mesh = innersphere.solid(surface) if isinstance(surface, str) else surface
    return innersphere.pack(mesh, spheres=spheres, cache="packings", overlap_errors=False)


@cache
def peg():
    """A cylinder of 0.5 m, 0.8 m high."""
    return packed(
        innersphere.surface_of(
            lambda q: np.maximum(np.hypot(q[:, 0], q[:, 1]) - 0.25, np.abs(q[:, 2]) - 0.4), -0.42, 0.42, cells=32
        )
    )


@cache
def plate():
    """A plate of 1 x 1 x 0.4 m with a hole of 0.26 m radius."""

    def distance(q):
        block = (np.abs(q) - [0.5, 0.5, 0.2]).max(axis=1)
        return np.maximum(block, 0.26 - np.hypot(q[:, 0], q[:, 1]))

    return packed(innersphere.surface_of(distance, [-0.55, -0.55, -0.25], [0.55, 0.55, 0.25], cells=28))


@cache
def mug():
    """A cup about y, open at +y, with a handle at +z."""

    def distance(q):
        r, y = np.hypot(q[:, 0], q[:, 2]), q[:, 1]
        cup = np.maximum(np.maximum(r - 0.4, np.abs(y) - 0.5), -np.maximum(r - 0.3, -0.4 - y))
        handle = np.hypot(np.hypot(q[:, 2] - 0.4, y) - 0.25, q[:, 0]) - 0.06
        return np.minimum(cup, np.maximum(handle, 0.35 - r))

    return packed(innersphere.surface_of(distance, [-0.45, -0.55, -0.45], [0.45, 0.55, 0.75], cells=26))


@cache
def hook():
    """A bar along x that bends up at its end."""

    def distance(q):
        bar = np.linalg.norm(q - np.clip(q, [-0.6, 0, 0], [0.3, 0, 0]), axis=1)
        end = np.linalg.norm(q - np.clip(q, [0.3, 0, 0], [0.3, 0, 0.2]), axis=1)
        return np.minimum(bar, end) - 0.05

    return packed(innersphere.surface_of(distance, [-0.7, -0.1, -0.1], [0.4, 0.1, 0.3], cells=40))


@cache
def small_mug():
    """A cup on z = 0, 8 cm wide and 10 cm high, with walls of 5 mm."""

    def distance(q):
        r, z = np.hypot(q[:, 0], q[:, 1]), q[:, 2]
        return np.maximum(np.maximum(r - 0.04, np.abs(z - 0.05) - 0.05), -np.maximum(r - 0.035, 0.008 - z))

    return packed(innersphere.surface_of(distance, [-0.045, -0.045, -0.005], [0.045, 0.045, 0.105], cells=26), 3000)
