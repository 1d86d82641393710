"""Bullet in C++, by the program bench_bullet: packings, and Bullet's own ways to collide concave solids."""

import subprocess

from .base import Program
from .programs import program


class _Bullet(Program):
    shape: str
    solver = "bullet"

    @classmethod
    def version(cls) -> str:
        return subprocess.run([program("bench_bullet"), "--version"], check=True, capture_output=True, text=True).stdout.strip()

    @classmethod
    def command(cls, scene_file: str, rate: int, out: str) -> list[str]:
        return [program("bench_bullet"), scene_file, str(rate), out, "--shape", cls.shape, "--solver", cls.solver]


class Packings(_Bullet):
    name, shape = "innersphere", "packing"
    settings = "packings of 1,000 spheres, Bullet's solver with its 10 iterations and two friction directions (README)"


class PackingsSubstep(_Bullet):
    name, shape, solver = "innersphere-substep", "packing", "substep"
    settings = "packings of 1,000 spheres, SubstepSolver with its defaults (plugin/README.md)"


class GImpact(_Bullet):
    name, shape = "bullet-gimpact", "gimpact"
    settings = ("moving bodies btGImpactMeshShape with a margin of 1e-4 of the diagonal (the best for chains and bowls of five "
                "tried), fixed ones btBvhTriangleMeshShape; 10 iterations, two friction directions")


class Hulls(_Bullet):
    name, shape = "bullet-hulls", "hulls"
    settings = ("moving bodies btCompoundShape of CoACD's hulls (threshold 0.02), shrunk by a margin of 1e-3 of the diagonal; fixed "
                "ones btBvhTriangleMeshShape; 10 iterations, two friction directions")


class Spheres(_Bullet):
    name, shape = "bullet-spheres", "spheres"
    settings = "as bullet-hulls, of the packing's 1,000 spheres"


ENGINES = [Packings, PackingsSubstep, GImpact, Hulls, Spheres]
