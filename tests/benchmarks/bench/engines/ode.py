"""Open Dynamics Engine, by the program bench_ode."""

import subprocess

from .base import Program
from .programs import program


class Ode(Program):
    name = "ode"
    settings = ("triangle meshes, with the last transforms set (manual, Trimesh class); dWorldQuickStep with 50 iterations, ERP 0.2, a "
                "surface layer of 1e-4 of the smallest body and contacts that part at 0.5 m/s at most (manual), pyramids of "
                "friction (dContactApprox1), at most 512 contacts a pair: with 64 a nut leaves its thread")

    @classmethod
    def version(cls) -> str:
        return subprocess.run([program("bench_ode"), "--version"], check=True, capture_output=True, text=True).stdout.strip()

    @classmethod
    def command(cls, scene_file: str, rate: int, out: str) -> list[str]:
        return [program("bench_ode"), scene_file, str(rate), out]


ENGINES = [Ode]
