"""PyBullet as it comes from PyPI."""

import os

from .pybullet_world import PyBulletWorld


def _parts(body: dict) -> str:
    return body["mesh"].replace(".obj", "-vhacd.obj")


class PyBulletShipped(PyBulletWorld):
    name = "pybullet"
    settings = ("moving bodies of the hulls that p.vhacd() makes with its defaults, fixed ones GEOM_FORCE_CONCAVE_TRIMESH (Quickstart "
                "Guide); 50 iterations; no damping, no sleeping")

    @classmethod
    def prepare(cls, scene: dict) -> None:
        import pybullet as p

        client = p.connect(p.DIRECT)
        for body in scene["bodies"]:
            if "mesh" in body and body["mass"] > 0 and not os.path.exists(_parts(body)):
                p.vhacd(body["mesh"], _parts(body) + ".tmp.obj", body["mesh"] + ".log", physicsClientId=client)
                os.replace(_parts(body) + ".tmp.obj", _parts(body))
        p.disconnect(client)

    def _shape(self, body: dict) -> int:
        p = self._p
        if body["mass"] == 0:
            return p.createCollisionShape(p.GEOM_MESH, fileName=body["mesh"], flags=p.GEOM_FORCE_CONCAVE_TRIMESH)
        return p.createCollisionShape(p.GEOM_MESH, fileName=_parts(body))


ENGINES = [PyBulletShipped]
