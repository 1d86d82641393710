"""Solids and poses for the tests, and oracles that share no code with innersphere."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import innersphere

# A box from the origin to (1, 2, 3).
BOX_VERTICES = np.array([[i & 1, 2 * (i >> 1 & 1), 3 * (i >> 2)] for i in range(8)], dtype=np.float64)
BOX_FACES = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
    + [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
)


def lens(distance, r, s):
    """The volume that balls of the radii r and s share: closed form."""
    d = np.maximum(distance, 1e-300)
    cut = np.pi * (r + s - d) ** 2 * (d * d + 2 * d * (r + s) - 3 * (r - s) ** 2) / (12 * d)
    inner = 4 / 3 * np.pi * np.minimum(r, s) ** 3
    return np.where(distance >= r + s, 0, np.where(distance <= np.abs(r - s), inner, cut))


def placed(spheres, pose):
    """Centres and radii of spheres at a pose (4, 4), in double precision."""
    balls = spheres.astype(np.float64)
    return balls[:, :3] @ pose[:3, :3].T + pose[:3, 3], balls[:, 3]


def brute_force(a, b, pose_a, pose_b):
    """The sum of all lenses, and for each pair of spheres by how much it overlaps."""
    (centres_a, radii_a), (centres_b, radii_b) = placed(a, pose_a), placed(b, pose_b)
    distance = np.linalg.norm(centres_a[:, None] - centres_b[None], axis=2)
    r, s = radii_a[:, None], radii_b[None]
    return lens(distance, r, s).sum(), r + s - distance


def random_quaternions(rng, *shape):
    """Unit quaternions x y z w."""
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def matrix(position, quaternion):
    """The pose (4, 4) by Rodrigues' formula: axis and angle of the quaternion."""
    axis, w = np.asarray(quaternion[:3], float), float(quaternion[3])
    sine = np.linalg.norm(axis)
    pose = np.eye(4)
    if sine > 0:
        x, y, z = axis / sine
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        angle = 2 * np.arctan2(sine, w)
        pose[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    pose[:3, 3] = position
    return pose


def write_obj(path, vertices=BOX_VERTICES, faces=BOX_FACES):
    """Writes a mesh."""
    path.write_text(
        "".join(f"v {x} {y} {z}\n" for x, y, z in vertices) + "".join(f"f {i} {j} {k}\n" for i, j, k in faces + 1)
    )
    return path


def write_spheres(path: Path, spheres) -> Path:
    """Writes an .xyzr file."""
    path.write_text("".join(" ".join(repr(float(x)) for x in ball) + "\n" for ball in spheres))
    return path


@pytest.fixture(scope="session")
def box() -> innersphere.Packing:
    """A packed box from the origin to (1, 2, 3)."""
    return innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=300, overlap_errors=False)


@pytest.fixture(scope="session")
def ball(tmp_path_factory) -> innersphere.Packing:
    """A single sphere of radius 1 at the origin."""
    return innersphere.read(write_spheres(tmp_path_factory.mktemp("ball") / "ball.xyzr", [[0, 0, 0, 1]]))


@pytest.fixture(scope="session")
def backends() -> list[str]:
    """The backends that are here; INNERSPHERE_REQUIRE_GPU demands all of them."""
    if os.environ.get("INNERSPHERE_REQUIRE_GPU"):
        assert innersphere.cuda_available()
    return ["cpu", "auto"] + (["cuda"] if innersphere.cuda_available() else [])
