"""PyBullet as it comes from PyPI."""

import os
import subprocess
import sys

from .pybullet_world import PyBulletWorld


def _parts(body: dict) -> str:
    return body["mesh"].replace(".obj", "-vhacd.obj")


def vhacd(mesh: str, parts: str) -> None:
    """PyBullet's, with its defaults; in a process of its own, as it prints its progress at length."""
    code = "import pybullet, sys; pybullet.connect(pybullet.DIRECT); pybullet.vhacd(*sys.argv[1:])"
    subprocess.run([sys.executable, "-c", code, mesh, parts, parts + ".log"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


class PyBulletShipped(PyBulletWorld):
    name = "pybullet"
    settings = ("moving bodies of the hulls that p.vhacd() makes with its defaults, fixed ones GEOM_FORCE_CONCAVE_TRIMESH (Quickstart "
                "Guide); 50 iterations; no damping, no sleeping")

    @classmethod
    def prepare(cls, body: dict) -> None:
        if os.path.exists(_parts(body)):
            return
        made = _parts(body) + ".tmp.obj"
        vhacd(body["mesh"], made)
        os.replace(made, _parts(body))

    def _shape(self, body: dict) -> int:
        p = self._p
        if body["mass"] == 0:
            return p.createCollisionShape(p.GEOM_MESH, fileName=body["mesh"], flags=p.GEOM_FORCE_CONCAVE_TRIMESH)
        return p.createCollisionShape(p.GEOM_MESH, fileName=_parts(body))


ENGINES = [PyBulletShipped]
