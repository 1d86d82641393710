"""Solids that are given by signed distances."""

import numpy as np
import pytest

import innersphere


def ball(p):
    return np.linalg.norm(p - [0.1, 0.2, 0.3], axis=1) - 0.5


def torus(p):
    return np.hypot(np.hypot(p[:, 0], p[:, 1]) - 1, p[:, 2]) - 0.3


def measures(vertices, faces):
    """Volume by the divergence theorem, Euler's number, and whether each edge is there once in each direction."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forth, back = (np.unique(way, axis=0, return_counts=True) for way in (edges, edges[:, ::-1]))
    closed = (forth[1] == 1).all() and np.array_equal(forth[0], back[0])
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6, len(vertices) - len(edges) // 2 + len(faces), closed


@pytest.mark.parametrize("cells", [16, 32])
def test_a_ball_and_a_torus(cells):
    for distance, volume, euler, low, high in (
        (ball, 4 / 3 * np.pi * 0.5**3, 2, -0.5, 1),
        (torus, 2 * np.pi**2 * 0.3**2, 0, [-1.4, -1.4, -0.4], [1.4, 1.4, 0.4]),
    ):
        vertices, faces = innersphere.surface_of(distance, low, high, cells=cells)
        got, number, closed = measures(vertices, faces)
        assert closed and number == euler
        cell = np.max(np.subtract(high, low)) / cells
        assert got == pytest.approx(volume, rel=2 * (cell / 0.3) ** 2)
        assert np.abs(distance(vertices)).max() < 0.5 * cell**2 / 0.3
        assert got < volume  # chords lie inside of what is convex


def test_the_box_cuts_off_what_reaches_out():
    """The distance to a half-space. Edges are rounded by some of a cell."""
    got, euler, closed = measures(*innersphere.surface_of(lambda p: p[:, 2] - 1, [0, 0, 0], [1, 2, 3], cells=48))
    edges = 4 * (1 + 2 + 1)
    assert closed and euler == 2
    assert 2 - edges * (3 / 48) ** 2 < got < 2


def test_the_packing_of_a_torus():
    packing = innersphere.pack(innersphere.surface_of(torus, -1.4, 1.4, cells=24), spheres=200, overlap_errors=False)
    spheres = packing.spheres.astype(float)
    assert (spheres[:, 3] <= -torus(spheres[:, :3]) + 0.01).all()
    assert packing.quality["density"] > 0.5


@pytest.mark.parametrize(
    "distance, low, high, error",
    [
        (ball, 1, 0, innersphere.InvalidArgumentError),
        (ball, 0, np.nan, innersphere.InvalidArgumentError),
        (ball, [0, 0], 1, ValueError),
        (ball, 3, 4, innersphere.EmptyInputError),
        (lambda p: np.full(len(p), np.nan), 0, 1, innersphere.NotFiniteError),
        (lambda p: 7.0, 0, 1, ValueError),
    ],
)
def test_bad_input(distance, low, high, error):
    with pytest.raises(error):
        innersphere.surface_of(distance, low, high, cells=8)
